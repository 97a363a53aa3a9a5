#include "lacon/elements/material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

// E of ELAS and the slope of the tension curve's elastic part may differ by this share.
constexpr double modulus_tolerance = 1e-2;

struct Source {
  const MaterialTable& materials;
  std::int32_t cell;
  std::string_view element;

  double parameter(std::string_view path) const { return materials.parameter(cell, path, element); }
  /// Whether E is a function, so that no single one is that of the curve.
  bool modulus_varies() const { return materials.has_law(cell, "ELAS_FO"); }
  [[noreturn]] void refuse(const std::string& reason) const {
    fail("BEHAVIOUR_2", {{"material", materials.label(cell)}, {"cell", cell_name(cell)}, {"reason", reason}});
  }
};

/// ECRO_LINE: the slope of the tension curve behind SY, hence of R(p): E ET / (E - ET). Kernels make it of the present E, where
/// that is a function.
std::vector<double> linear(const Source& source) {
  const double young = source.parameter("ELAS/E"), slope = source.parameter("ECRO_LINE/D_SIGM_EPSI"),
               yield = source.parameter("ECRO_LINE/SY");
  if (!source.modulus_varies() && !(slope < young))
    source.refuse(
        part("hardening_too_stiff", {{"slope", fmt::format("{:g}", slope)}, {"modulus", fmt::format("{:g}", young)}}));
  return {0.0, yield, young * slope / (young - slope)};
}

/// The first point of a tension test.
double initial_modulus(const Function& test) {
  const std::size_t first = test.x.front() == 0 && test.y.front() == 0 ? 1 : 0;
  return test.y[first] / test.x[first];
}

/// TRACTION: points (strain, stress) of a tension test, the first of them the elastic limit.
std::vector<double> tabulated(const Source& source) {
  const Function& test = source.materials.function(source.cell, "TRACTION/SIGM", source.element);
  if (test.parameter != "EPSI") source.refuse(part("curve_of_another", {{"parameter", test.parameter}}));
  for (const std::string& rule : test.interpolation)
    if (rule != "LIN") source.refuse(part("curve_not_straight", {{"rule", rule}}));
  std::vector<double> strain = test.x, stress = test.y;
  if (strain.front() == 0 && stress.front() == 0) {
    strain.erase(strain.begin());
    stress.erase(stress.begin());
  }
  if (strain.empty() || !(strain.front() > 0 && stress.front() > 0)) source.refuse(part("curve_without_limit"));
  const double initial = stress.front() / strain.front(),
               young = source.modulus_varies() ? initial : source.parameter("ELAS/E");
  if (std::abs(initial - young) > modulus_tolerance * young)
    source.refuse(
        part("curve_of_other_modulus", {{"found", fmt::format("{:g}", initial)}, {"modulus", fmt::format("{:g}", young)}}));
  std::vector<double> curve;
  const std::size_t n = strain.size();
  const auto plastic = [&](std::size_t i) {
    return i == 0 ? 0.0 : strain[i] - stress[i] / young - (strain[0] - stress[0] / young);
  };
  for (std::size_t i = 0; i < n; ++i) {
    double slope = NAN;  // behind the last point: the curve ends there
    if (i + 1 < n) {
      const double step = plastic(i + 1) - plastic(i);
      if (!(step > 0))
        source.refuse(part("curve_too_stiff",
                           {{"first", fmt::format("{:g}", strain[i])}, {"second", fmt::format("{:g}", strain[i + 1])}}));
      slope = (stress[i + 1] - stress[i]) / step;
    } else if (test.extension_right == "CONSTANT") {
      slope = 0;
    } else if (test.extension_right == "LINEAIRE" && n > 1) {
      slope = curve.back();
    }
    curve.insert(curve.end(), {plastic(i), stress[i], slope});
  }
  return curve;
}

void check_linear(const Source& source, double young, const std::string& instant) {
  if (const double slope = source.parameter("ECRO_LINE/D_SIGM_EPSI"); !(slope < young))
    source.refuse(part("modulus_below_hardening",
                       {{"instant", instant}, {"slope", fmt::format("{:g}", slope)}, {"modulus", fmt::format("{:g}", young)}}));
}

void check_tabulated(const Source& source, double young, const std::string& instant) {
  const double found = initial_modulus(source.materials.function(source.cell, "TRACTION/SIGM", source.element));
  if (!(std::abs(found - young) <= modulus_tolerance * young))
    source.refuse(part("curve_of_one_modulus",
                       {{"instant", instant}, {"found", fmt::format("{:g}", found)}, {"modulus", fmt::format("{:g}", young)}}));
}

struct Row {
  std::string_view keyword;
  std::vector<double> (*curve)(const Source&);
  void (*check)(const Source&, double young, const std::string& instant);
};
constexpr Row rows[] = {{"ECRO_LINE", linear, check_linear}, {"TRACTION", tabulated, check_tabulated}};

const Row& row_of(const Source& source, std::string_view keyword) {
  const auto row = std::find_if(std::begin(rows), std::end(rows), [&](const Row& r) { return r.keyword == keyword; });
  if (row == std::end(rows)) source.refuse(part("no_curve", {{"keyword", std::string(keyword)}}));
  return *row;
}

}  // namespace

const std::variant<double, std::string>* MaterialTable::look_up(std::int32_t cell, std::string_view path) const {
  const auto slash = path.find('/');
  const Material& material = materials_[field_->material[cell]];
  const auto law = material.laws.find(std::string(path.substr(0, slash)));
  if (law == material.laws.end()) return nullptr;
  const auto value = law->second.find(std::string(path.substr(slash + 1)));
  return value == law->second.end() ? nullptr : &value->second;
}

void MaterialTable::missing(std::int32_t cell, std::string_view path, std::string_view element) const {
  fail("ELEMENT_3", {{"material", label(cell)},
                     {"cell", cell_name(cell)},
                     {"parameter", std::string(path)},
                     {"element", std::string(element)}});
}

std::optional<double> MaterialTable::find(std::int32_t cell, std::string_view path) const {
  const auto* value = look_up(cell, path);
  if (!value || !std::holds_alternative<double>(*value)) return std::nullopt;
  return std::get<double>(*value);
}

double MaterialTable::parameter(std::int32_t cell, std::string_view path, std::string_view element) const {
  if (const auto value = find(cell, path)) return *value;
  missing(cell, path, element);
}

const Function& MaterialTable::function(std::int32_t cell, std::string_view path, std::string_view element) const {
  const auto* value = look_up(cell, path);
  const auto* id = value ? std::get_if<std::string>(value) : nullptr;
  const auto at = id ? functions_.find(*id) : functions_.end();
  if (at == functions_.end()) missing(cell, path, element);
  return at->second;
}

std::vector<double> hardening_curve(const MaterialTable& materials, std::int32_t cell, std::string_view keyword,
                                    std::string_view element) {
  const Source source{materials, cell, element};
  return row_of(source, keyword).curve(source);
}

void check_modulus(const MaterialTable& materials, std::int32_t cell, std::string_view keyword, std::string_view element,
                   double young, double instant) {
  const Source source{materials, cell, element};
  row_of(source, keyword).check(source, young, fmt::format("{:.9g}", instant));
}

}  // namespace lacon
