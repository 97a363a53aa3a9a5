#pragma once
// The concepts between mesh and result, as docs/structures.md lays them out. Plain data; numbers are 0-based.
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lacon/structures/mesh.hpp"
#include "lacon/structures/table.hpp"

namespace lacon {

struct Model {
  std::string mesh;
  std::string phenomenon;
  int dimension = 3;
  std::vector<std::string> elements;  ///< names of rows of the element catalogue, "D_PLAN/TRIA3"
  std::vector<std::int32_t> element;  ///< of each cell: index into elements, -1 for none
};

/// Factor keyword -> parameter -> value, or the id of a function.
struct Material {
  std::map<std::string, std::map<std::string, std::variant<double, std::string>>> laws;
};

struct MaterialField {
  std::string mesh;
  std::string model;                   ///< may be empty
  std::vector<std::string> materials;  ///< ids
  std::vector<std::int32_t> material;  ///< of each cell, -1 for none
};

/// A number, or the value of a function of the study.
struct LoadValue {
  double value = 0;      ///< where there is no function
  std::string function;  ///< id of a function or formula

  bool operator==(const LoadValue&) const = default;
};

/// One component of a load on a node or a cell.
struct LoadTerm {
  std::int32_t place;
  std::string component;  ///< "DX", "PRES", "FY"
  LoadValue value;
};

/// A displacement in a relation.
struct RelationTerm {
  std::int32_t node;
  std::string component;
  double coefficient;
};

/// The sum of coefficient * displacement is `value`; it is held by a multiplier of its own.
struct Relation {
  std::string source;  ///< the keyword it comes from
  std::vector<RelationTerm> terms;
  LoadValue value;
};

struct Load {
  std::string model;
  std::string kind;                ///< "cine" or "meca"
  std::vector<LoadTerm> imposed;   ///< displacements of nodes
  std::vector<LoadTerm> nodal;     ///< forces on nodes; SIGM at no node (-1): those of the field of stresses `function`
  std::vector<LoadTerm> pressure;  ///< PRES (positive towards the body) and CISA_2D (along the tangent) on skin cells
  std::vector<LoadTerm> force;     ///< FX, FY, FZ on cells, for each unit of their length, area or volume
  std::vector<LoadTerm> gravity;   ///< FX, FY, FZ on body cells, for each unit of mass
  std::vector<LoadTerm> strain;    ///< EPXX, ..., EPYZ on body cells: strains without stress; EPSI on none (-1): a field
  std::vector<Relation> relations;
};

struct ContactZone {
  std::string slave_group, master_group;
  std::vector<std::int32_t> slave, master;  ///< cells
  std::vector<std::int32_t> patches;        ///< of the mesh
  std::string jacobian;                     ///< INITIAL, ACTUALISE
  std::string search;                       ///< RAPIDE, ROBUSTE
  std::string initial_status;               ///< INTERPENETRE, OUI, NON
  double tolerance = 1e-8;                  ///< RESI_APPA
  double distance_limit = -1;               ///< COEF_MULT_APPA; not positive: that of overlaps alone
  std::vector<std::int32_t> held_open;      ///< patches that never get into contact (SANS_GROUP_NO, ...)
  std::string resolution = "OUI";           ///< RESOLUTION; NON: no patch gets into contact, overlaps are told
  double overlap_tolerance = 0;             ///< TOLE_INTERP: the overlap that is told, with RESOLUTION='NON'
  std::string gliding = "NON";              ///< GLISSIERE; OUI: what is in contact stays in contact
  LoadValue slave_offset, master_offset;    ///< DIST_ESCL, DIST_MAIT: by these the skins stand out of their cells

  bool has_offset() const { return slave_offset != LoadValue{} || master_offset != LoadValue{}; }
};

/// A skin cell that AFFE_MODELE left without element, and the one that contact gives it: of its body's modelisation.
struct SkinElement {
  std::int32_t cell;
  std::string element;  ///< row of the element catalogue
};

struct SlaveElement {
  std::int32_t cell;
  std::int32_t patch;
  std::int32_t rank;    ///< place in the patch, 0-based
  std::string element;  ///< row of catalog/contact.toml
};

struct Contact {
  std::string model, mesh;
  std::string algorithm = "LAC";
  bool smoothing = false;
  bool frozen_gap = false;  ///< VARIATION_JEU='FIGEE': forces along the slave's normal, not the derivative of the gap
  bool verify_normals = true;
  double resi_geom = 1e-6;
  /// CONT_STAT_ELAS: how many iterations without a change of status the matrix stays elastic for
  std::int64_t elastic_iterations = 0;
  bool stops_at_overlap = false;  ///< STOP_INTERP: an overlap with RESOLUTION='NON' ends the computation
  std::vector<ContactZone> zones;
  std::vector<SlaveElement> slaves;  ///< zone by zone
  std::vector<SkinElement> skins;

  /// A model with the elements of `skins` too.
  Model completed(Model of_bodies) const;
};

/// A spring between two nodes, or between a node and the ground: the force on the first is -stiffness (u_first - u_second).
struct Spring {
  std::int32_t first, second = -1;    ///< nodes; -1: the ground
  std::array<double, 6> stiffness{};  ///< lower triangle of a symmetric matrix, row by row, in the axes of the mesh
};

/// AFFE_CARA_ELEM: what elements have beside their material.
struct ElementCharacteristics {
  std::string model, mesh;
  std::vector<Spring> springs;
};

/// A piecewise function of one parameter.
struct Function {
  std::string parameter;  ///< "INST"
  std::string interpolation[2] = {"LIN", "LIN"};
  std::string extension_left = "EXCLU", extension_right = "EXCLU";
  std::vector<double> x, y;  ///< x increasing

  /// Throws FUNCTION_1 where x is outside and the extension is EXCLU, DEFI_FONCTION_9 where it is prolonged beyond what
  /// logarithms reach; `label` names the function in the message.
  double operator()(double at, std::string_view label) const;
};

/// A Python expression, which only the launcher evaluates.
struct Formula {
  std::vector<std::string> parameters;
  std::string expression;
};

/// What is done with a step that fails: cut into equal parts, again where these fail.
struct StepCut {
  bool cut = false;     ///< ACTION='DECOUPE'
  int cut_into = 4;     ///< SUBD_PAS
  int cut_levels = 3;   ///< SUBD_NIVEAU
  double smallest = 0;  ///< SUBD_PAS_MINI
};

/// An event, beside a solution that fails, by which a step counts as failed (DEFI_LIST_INST, ECHEC/EVENEMENT).
struct StepEvent {
  std::string event;  ///< RESI_MAXI, DIVE_RESI, DELTA_GRANDEUR
  double limit = 0;   ///< RESI_GLOB_MAXI, VALE_REF
  std::string place;  ///< DELTA_GRANDEUR: NOM_CHAM, NOM_CMP, GROUP_NO, ... as JSON
  StepCut action;
};

/// How steps grow and shrink between the instants of the list (METHODE='AUTO').
struct StepAdaptation {
  std::string event = "SEUIL";           ///< SEUIL, TOUT_INST, AUCUN: when the step is changed
  int easy_steps = 2;                    ///< SEUIL: after so many steps in a row
  int easy_iterations = 5;               ///< of at most so many iterations
  std::string rule = "FIXE";             ///< FIXE, ITER_NEWTON: how
  double percent = 100;                  ///< FIXE: the step grows by it
  int reference = 5;                     ///< ITER_NEWTON: the step is multiplied by sqrt(reference / (iterations + 1))
  double smallest = 1e-12, largest = 0;  ///< of steps; largest 0: no limit
  std::int64_t most = 1000000;           ///< number of steps
};

struct TimeSteps {
  std::vector<double> values;
  StepCut action;                    ///< where the solution fails
  std::int64_t more_iterations = 0;  ///< PCENT_ITER_PLUS: percent of ITER_GLOB_MAXI that are allowed before that
  std::vector<StepEvent> events;
  std::optional<StepAdaptation> adaptation;
};

struct ResultLoad {
  std::string load;
  std::string function;  ///< may be empty
  std::string type;      ///< TYPE_CHARGE: FIXE_CSTE, SUIV
  bool operator==(const ResultLoad&) const = default;
};

/// What the instants of a result are computed with, from one of them on.
struct ResultStage {
  std::int64_t first = 0;  ///< order
  std::string contact;     ///< id, may be empty
  std::vector<ResultLoad> loads;
  std::string behaviour = "[]";  ///< JSON
};

/// The index of a result: which fields it has at which instants.
struct Result {
  std::string label;                        ///< when it was written
  std::string model, mesh, material_field;  ///< ids
  std::vector<ResultStage> stages{1};       ///< by increasing orders, one at least
  std::vector<std::int64_t> orders;
  std::vector<double> instants;
  /// name -> order -> file, relative to the base folder
  std::map<std::string, std::map<std::int64_t, std::string>> fields;
  /// name -> one value for each of `orders`
  std::map<std::string, std::vector<double>> parameters;
  std::map<std::string, Table> tables;  ///< "OBSERVATION"
  bool complete = true;                 ///< the computation came to its end
  std::int64_t version = 0;             ///< with which the index is stored, where it grows; 0: the one after that in the base

  const ResultStage& stage(std::int64_t order) const;  ///< the one that an order belongs to
};

}  // namespace lacon
