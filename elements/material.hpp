#pragma once
// What materials say: parameters of cells by path, "ELAS/E", and the hardening curve that plastic kernels take.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lacon/structures/concepts.hpp"

namespace lacon {

/// What a material says about a cell's parameter "ELAS/E"; throws ELEMENT_3.
class MaterialTable {
 public:
  /// @param functions those that materials name, by id
  MaterialTable(const MaterialField& field, std::vector<Material> materials, std::vector<std::string> labels,
                std::map<std::string, Function> functions = {})
      : field_(&field), materials_(std::move(materials)), labels_(std::move(labels)), functions_(std::move(functions)) {}
  bool has(std::int32_t cell) const { return field_->material[cell] >= 0; }
  std::int32_t of(std::int32_t cell) const { return field_->material[cell]; }                    ///< number of its material
  const std::string& label(std::int32_t cell) const { return labels_[field_->material[cell]]; }  ///< of its material
  /// Whether its material has a keyword of DEFI_MATERIAU, "ECRO_LINE".
  bool has_law(std::int32_t cell, const std::string& keyword) const {
    return has(cell) && materials_[of(cell)].laws.contains(keyword);
  }
  double parameter(std::int32_t cell, std::string_view path, std::string_view element) const;
  /// The parameter, or nothing where the cell's material lacks it.
  std::optional<double> find(std::int32_t cell, std::string_view path) const;
  /// The parameter that is a function; throws ELEMENT_3.
  const Function& function(std::int32_t cell, std::string_view path, std::string_view element) const;

 private:
  const std::variant<double, std::string>* look_up(std::int32_t cell, std::string_view path) const;
  [[noreturn]] void missing(std::int32_t cell, std::string_view path, std::string_view element) const;

  const MaterialField* field_;
  std::vector<Material> materials_;
  std::vector<std::string> labels_;
  std::map<std::string, Function> functions_;
};

/// The hardening curve of a cell's material, (points, 3): plastic strain from 0 on, yield stress, slope behind it
/// (lacon_solid_batch::curve). Where E is a function, a tension test has its own, and ECRO_LINE's slope is that at the
/// reference temperature. @param keyword of DEFI_MATERIAU that says it: ECRO_LINE, TRACTION Throws ELEMENT_3 (a parameter is
/// missing), BEHAVIOUR_2 (it makes no sense).
std::vector<double> hardening_curve(const MaterialTable& materials, std::int32_t cell, std::string_view keyword,
                                    std::string_view element);
/// That the curve of a cell whose E is a function goes with the E that it has at an instant. Throws BEHAVIOUR_2.
void check_modulus(const MaterialTable& materials, std::int32_t cell, std::string_view keyword, std::string_view element,
                   double young, double instant);

}  // namespace lacon
