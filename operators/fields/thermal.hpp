#pragma once
// AFFE_VARC: temperatures at integration points, and what materials make of them there: thermal strains, and parameters of
// ELAS_FO. Evaluated for many points at once, for functions may be formulae.
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacon/elements/material.hpp"
#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/program/study_function.hpp"

namespace lacon {

/// AFFE_VARC: where the temperature of cells comes from. Ids and texts may be empty.
struct MaterialTemperature {
  std::string field;                ///< CHAM_GD: one field for all instants
  std::string result, name;         ///< EVOL: the fields of a result, NOM_CHAM
  std::string instants;             ///< FONC_INST: the instant of the result as a function of that of the computation
  std::string before, behind;       ///< PROL_GAUCHE, PROL_DROITE: outside the instants of the result
  std::optional<double> reference;  ///< VALE_REF: the temperature without thermal strain
};

struct MaterialTemperatures {
  std::vector<MaterialTemperature> rows;
  std::vector<std::int32_t> of_cell;  ///< -1 for none; empty without any
};

/// What AFFE_MATERIAU, which made this material field, says of temperatures. A later occurrence wins over an earlier one.
MaterialTemperatures read_temperatures(const Base& base, const std::string& material_field, const Mesh& mesh);

/// The materials of a field. What ELAS_FO says stands under ELAS too, at the reference temperature, for what takes one number
/// whatever the temperature is.
MaterialTable read_materials(const Base& base, const MaterialField& field, const MaterialTemperatures& temperatures);

/// Materials whose cells have a temperature, or parameters that are functions. Refers to all that it is made of.
class ThermalMaterials {
 public:
  ThermalMaterials(const Base& base, const MaterialField& field, MaterialTemperatures temperatures);

  /// Whether a cell is one of those.
  bool concerns(std::int32_t cell) const { return rule_of(cell).matters(); }
  /// Whether its temperature does nothing, for its material has no ALPHA and no functions; the material's label.
  std::optional<std::string> idle(std::int32_t cell) const {
    const Rule& rule = rule_of(cell);
    return rule.temperature >= 0 && rule.functions.empty() && !rule.has_expansion ? std::optional(rule.material) : std::nullopt;
  }
  /// Whether the parameters of one of these cells are functions.
  bool has_functions(std::span<const std::int32_t> cells) const;

  /// At the points of cells that have the same number of them: (cells, n_points). Throws THERMAL_1 to THERMAL_6.
  std::vector<double> strains(const Ground& ground, double instant, std::span<const std::int32_t> cells, int n_points);
  /// Parameters "ELAS/E" at the mean temperature of each cell's points, (cells, paths). @param constant the same of materials
  /// whose parameters are numbers
  std::vector<double> parameters(const Ground& ground, double instant, std::span<const std::int32_t> cells, int n_points,
                                 std::span<const std::string> paths, std::span<const double> constant);

 private:
  /// A number or a function of TEMP and INST.
  struct Value {
    double number = 0;
    std::shared_ptr<const StudyFunction> function;
  };
  /// A material under one temperature.
  struct Rule {
    std::string material;                    ///< label
    std::map<std::string, Value> functions;  ///< of ELAS_FO: "E", "NU"
    bool has_expansion = false;              ///< ALPHA is given
    std::optional<Value> expansion;          ///< where it is not 0
    std::optional<double> expansion_origin;  ///< TEMP_DEF_ALPHA
    std::int32_t temperature = -1;           ///< row
    bool matters() const { return !functions.empty() || (expansion && temperature >= 0); }
  };
  const Rule& rule_of(std::int32_t cell) const {
    return rules_[static_cast<std::size_t>(rule_[static_cast<std::size_t>(cell)])];
  }
  Rule make_rule(std::int32_t material, std::int32_t temperature) const;
  /// Call use(rule, temperatures, places) for the points of each rule, places being indices into (cells, n_points).
  template <class Use>
  void each_rule(const Ground& ground, double instant, std::span<const std::int32_t> cells, int n_points, const Use& use);
  std::vector<double> values(const Rule& rule, const Value& value, double instant, std::span<const double> temperature) const;
  /// The field of a temperature at integration points.
  const Field& at_points(const Ground& ground, std::int32_t temperature, double instant);
  Field at_instant(const MaterialTemperature& from, double instant) const;

  struct Evaluated {
    double instant;
    Field field;
    std::vector<std::int64_t> place;  ///< of each cell of the mesh in the field
  };

  const Base& base_;
  const MaterialField& field_;
  MaterialTemperatures temperatures_;
  std::vector<Rule> rules_;         ///< the first for cells without material
  std::vector<std::int32_t> rule_;  ///< of each cell
  std::map<std::int32_t, Evaluated> evaluated_;
};

}  // namespace lacon
