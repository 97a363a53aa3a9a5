#pragma once
// Everything a quasi-static computation starts from: mesh, elements with materials, loads in time, contact.
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lacon/assembly/element_sets.hpp"
#include "lacon/assembly/numbering.hpp"
#include "lacon/elements/registry.hpp"
#include "lacon/operators/contact/offsets.hpp"
#include "lacon/operators/evolution/problem/loads.hpp"
#include "lacon/operators/fields/initial_strains.hpp"
#include "lacon/operators/fields/thermal.hpp"
#include "lacon/structures/base.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {

struct StaticProblem {
  Mesh mesh;
  Model model;
  int dimension = 2;                           ///< of the space
  std::vector<std::string> components;         ///< node_unknowns(): "DX", "DY", "TEMP"
  std::vector<std::filesystem::path> plugins;  ///< folders of the registry
  std::unique_ptr<Registry> registry;
  std::unique_ptr<MaterialField> material_field;
  std::unique_ptr<MaterialTable> materials;
  std::unique_ptr<ThermalMaterials> thermal;  ///< nothing where no temperature matters
  std::vector<ElementSet> solids;
  std::vector<Spring> springs;
  std::vector<TimedLoad> loads;
  InitialStrains initial_strains;  ///< of the loads
  std::optional<Contact> contact;
  std::optional<ContactOffsets> offsets;  ///< of its skins
  std::vector<std::uint8_t> exists;       ///< (n_nodes, n_components): the degree of freedom exists
  std::vector<std::uint8_t> imposed;      ///< (n_nodes, n_components): a load imposes it
  std::vector<HeldDirection> held;        ///< of nodes, by loads
  Numbering numbering;

  int n_components() const { return static_cast<int>(components.size()); }
  std::size_t n_dofs() const { return exists.size(); }
  /// Patches that have a multiplier.
  std::int64_t n_patches() const { return contact ? static_cast<std::int64_t>(mesh.patches->size()) : 0; }
  bool is_of_revolution() const;  ///< axisymmetric: forces and measures are those of one radian
  bool has_following_loads() const;
  /// Dead external forces at an instant, (n_nodes, n_components).
  std::vector<double> dead_force(double instant) const;
  /// Call use(degrees of freedom, force, symmetric part of its derivative by them or nothing) for each element under a
  /// following pressure, on the displaced geometry. @param displacement (n_nodes, dimension or more), displacements first
  void following_forces(
      double instant, std::span<const double> displacement, bool with_matrix,
      const std::function<void(std::span<const std::int64_t>, std::span<const double>, std::span<const double>)>& use) const;
  /// Dead and following forces, (n_nodes, n_components).
  std::vector<double> external_force(double instant, std::span<const double> displacement) const;
  /// Imposed displacements and other unknowns at an instant, (n_nodes, n_components), 0 where none is. Throws LOAD_1 where two
  /// loads contradict each other.
  std::vector<double> imposed_values(double instant) const;
  std::string dof_name(std::int64_t dof) const;  ///< "N12 DX"
};

/// What EXCIT, MODELE, CHAM_MATER, CARA_ELEM and CONTACT of an order name.
StaticProblem read_problem(const Order& order, const Base& base);

/// The model, materials and loads that a result was computed with, for external_force(): no contact or equations.
StaticProblem read_loads(const Order& order, const Base& base, const Result& result, const ResultStage& stage);

}  // namespace lacon
