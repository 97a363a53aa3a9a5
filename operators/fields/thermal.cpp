#include "lacon/operators/fields/thermal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/fields/course.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {
namespace {

constexpr const char* functions_of_temperature = "ELAS_FO";
constexpr double same_instant = 1e-12;  // of the larger of two

using Parameters = std::map<std::string, std::variant<double, std::string>>;

std::optional<double> number(const Parameters& parameters, const std::string& name) {
  const auto found = parameters.find(name);
  if (found == parameters.end() || !std::holds_alternative<double>(found->second)) return std::nullopt;
  return std::get<double>(found->second);
}

/// The reference temperature of the first cell of a material that has one.
double reference_of(const MaterialField& field, std::size_t material, const MaterialTemperatures& temperatures) {
  for (std::size_t cell = 0; cell < temperatures.of_cell.size(); ++cell)
    if (field.material[cell] == static_cast<std::int32_t>(material) && temperatures.of_cell[cell] >= 0)
      if (const auto& reference = temperatures.rows[static_cast<std::size_t>(temperatures.of_cell[cell])].reference)
        return *reference;
  return 0;
}

}  // namespace

MaterialTemperatures read_temperatures(const Base& base, const std::string& material_field, const Mesh& mesh) {
  const Keywords keywords(nlohmann::json::parse(hdf5::Reader(base.file(material_field)).text("keywords")), "");
  MaterialTemperatures temperatures;
  for (const Keywords& factor : keywords.factors("AFFE_VARC")) {
    const bool evolves = factor.has("EVOL");
    const auto text = [&](const char* name) { return evolves ? factor.text(name) : std::string(); };
    temperatures.of_cell.resize(mesh.n_cells(), -1);
    const auto index = static_cast<std::int32_t>(temperatures.rows.size());
    temperatures.rows.push_back({.field = factor.optional_concept("CHAM_GD").value_or(""),
                                 .result = factor.optional_concept("EVOL").value_or(""),
                                 .name = text("NOM_CHAM"),
                                 .instants = factor.optional_concept("FONC_INST").value_or(""),
                                 .before = text("PROL_GAUCHE"),
                                 .behind = text("PROL_DROITE"),
                                 .reference = factor.optional_real("VALE_REF")});
    if (!factor.has("GROUP_MA")) std::fill(temperatures.of_cell.begin(), temperatures.of_cell.end(), index);
    for (const std::string& group : factor.texts("GROUP_MA"))
      for (const std::int32_t cell : cells_of_group(mesh, group, factor.path("GROUP_MA")))
        temperatures.of_cell[static_cast<std::size_t>(cell)] = index;
  }
  return temperatures;
}

MaterialTable read_materials(const Base& base, const MaterialField& field, const MaterialTemperatures& temperatures) {
  std::vector<Material> materials;
  std::vector<std::string> labels;
  std::map<std::string, Function> functions;
  for (const std::string& id : field.materials) {
    Material material = base.material(id);
    labels.push_back(base.label(id));
    for (const auto& [law, parameters] : material.laws)
      for (const auto& [name, value] : parameters)
        if (const auto* function = std::get_if<std::string>(&value); function && law != functions_of_temperature)
          functions.emplace(*function, base.function(*function));
    if (const auto law = material.laws.find(functions_of_temperature); law != material.laws.end()) {
      const double reference = reference_of(field, materials.size(), temperatures), start = 0;
      const ParameterValues known[] = {{"TEMP", {&reference, 1}}, {"INST", {&start, 1}}};
      Parameters numbers;
      for (const auto& [name, value] : law->second)
        numbers[name] = std::holds_alternative<double>(value)
                            ? std::get<double>(value)
                            : StudyFunction(base, std::get<std::string>(value)).values(1, known).front();
      material.laws["ELAS"] = std::move(numbers);
    }
    materials.push_back(std::move(material));
  }
  return {field, std::move(materials), std::move(labels), std::move(functions)};
}

ThermalMaterials::ThermalMaterials(const Base& base, const MaterialField& field, MaterialTemperatures temperatures)
    : base_(base), field_(field), temperatures_(std::move(temperatures)), rules_(1), rule_(field.material.size(), 0) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> known;
  for (std::size_t cell = 0; cell < rule_.size(); ++cell) {
    if (field.material[cell] < 0) continue;
    const std::pair kind(field.material[cell], temperatures_.rows.empty() ? -1 : temperatures_.of_cell[cell]);
    const auto [at, is_new] = known.emplace(kind, static_cast<std::int32_t>(rules_.size()));
    if (is_new) rules_.push_back(make_rule(kind.first, kind.second));
    rule_[cell] = at->second;
  }
}

ThermalMaterials::Rule ThermalMaterials::make_rule(std::int32_t material, std::int32_t temperature) const {
  const std::string& id = field_.materials[static_cast<std::size_t>(material)];
  const Material read = base_.material(id);
  Rule rule{.material = base_.label(id), .temperature = temperature};
  const auto value_of = [&](const std::variant<double, std::string>& value) {
    if (std::holds_alternative<double>(value)) return Value{std::get<double>(value), nullptr};
    return Value{0, std::make_shared<StudyFunction>(base_, std::get<std::string>(value))};
  };
  if (const auto law = read.laws.find(functions_of_temperature); law != read.laws.end()) {
    for (const auto& [name, value] : law->second) {
      if (name == "E" || name == "NU") rule.functions.emplace(name, value_of(value));
      if (name == "ALPHA") rule.expansion = value_of(value);
    }
    rule.expansion_origin = number(law->second, "TEMP_DEF_ALPHA");
  } else if (const auto elastic = read.laws.find("ELAS"); elastic != read.laws.end()) {
    if (const auto expansion = number(elastic->second, "ALPHA"); expansion && *expansion != 0)
      rule.expansion = Value{*expansion, nullptr};
  }
  rule.has_expansion = std::ranges::any_of(read.laws, [](const auto& law) { return law.second.contains("ALPHA"); });
  if (rule.expansion && temperature >= 0 && !temperatures_.rows[static_cast<std::size_t>(temperature)].reference)
    fail("THERMAL_1", {{"material", rule.material}});
  return rule;
}

bool ThermalMaterials::has_functions(std::span<const std::int32_t> cells) const {
  return std::any_of(cells.begin(), cells.end(), [&](std::int32_t cell) { return !rule_of(cell).functions.empty(); });
}

template <class Use>
void ThermalMaterials::each_rule(const Ground& ground, double instant, std::span<const std::int32_t> cells, int n_points,
                                 const Use& use) {
  std::vector<std::vector<std::size_t>> places(rules_.size());
  std::vector<std::vector<double>> temperatures(rules_.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Rule& rule = rule_of(cells[i]);
    if (!rule.matters()) continue;
    const auto r = static_cast<std::size_t>(&rule - rules_.data());
    std::size_t first = 0;
    const Field* field = nullptr;
    if (rule.temperature >= 0) {
      field = &at_points(ground, rule.temperature, instant);
      const std::int64_t place = evaluated_.at(rule.temperature).place[static_cast<std::size_t>(cells[i])];
      const auto refuse = [&] {
        fail("THERMAL_2", {{"cell", cell_name(cells[i])}, {"instant", fmt::format("{:.9g}", instant)}});
      };
      if (place < 0) refuse();
      first = field->first_row(static_cast<std::size_t>(place));
      if (field->first_row(static_cast<std::size_t>(place) + 1) - first != static_cast<std::size_t>(n_points)) refuse();
      for (std::size_t p = 0; p < static_cast<std::size_t>(n_points); ++p)
        if (!field->has(first + p, 0)) refuse();
    }
    for (std::size_t p = 0; p < static_cast<std::size_t>(n_points); ++p) {
      places[r].push_back(i * static_cast<std::size_t>(n_points) + p);
      temperatures[r].push_back(field ? field->at(first + p, 0) : NAN);
    }
  }
  for (std::size_t r = 0; r < rules_.size(); ++r)
    if (!places[r].empty()) use(rules_[r], std::span<const double>(temperatures[r]), std::span<const std::size_t>(places[r]));
}

std::vector<double> ThermalMaterials::strains(const Ground& ground, double instant, std::span<const std::int32_t> cells,
                                              int n_points) {
  std::vector<double> strain(cells.size() * static_cast<std::size_t>(n_points), 0.0);
  each_rule(ground, instant, cells, n_points,
            [&](const Rule& rule, std::span<const double> temperature, std::span<const std::size_t> places) {
              if (!rule.expansion || rule.temperature < 0) return;
              const double reference = *temperatures_.rows[static_cast<std::size_t>(rule.temperature)].reference,
                           origin = rule.expansion_origin.value_or(reference);
              const std::vector<double> now = values(rule, *rule.expansion, instant, temperature);
              const double then = values(rule, *rule.expansion, instant, {&reference, 1}).front() * (reference - origin);
              for (std::size_t k = 0; k < places.size(); ++k) strain[places[k]] = now[k] * (temperature[k] - origin) - then;
            });
  return strain;
}

std::vector<double> ThermalMaterials::parameters(const Ground& ground, double instant, std::span<const std::int32_t> cells,
                                                 int n_points, std::span<const std::string> paths,
                                                 std::span<const double> constant) {
  std::vector<double> found(constant.begin(), constant.end());
  const auto points = static_cast<std::size_t>(n_points);
  each_rule(ground, instant, cells, n_points,
            [&](const Rule& rule, std::span<const double> temperature, std::span<const std::size_t> places) {
              std::vector<double> mean(temperature.size() / points, 0.0);
              for (std::size_t i = 0; i < temperature.size(); ++i)
                mean[i / points] += temperature[i] / static_cast<double>(n_points);
              for (std::size_t k = 0; k < paths.size(); ++k) {
                const auto value = rule.functions.find(paths[k].substr(paths[k].find('/') + 1));
                if (value == rule.functions.end() || !paths[k].starts_with("ELAS/")) continue;
                const std::vector<double> at = values(rule, value->second, instant, mean);
                for (std::size_t i = 0; i < mean.size(); ++i) found[places[i * points] / points * paths.size() + k] = at[i];
              }
            });
  return found;
}

std::vector<double> ThermalMaterials::values(const Rule& rule, const Value& value, double instant,
                                             std::span<const double> temperature) const {
  if (!value.function) return std::vector<double>(temperature.size(), value.number);
  if (value.function->depends_on("TEMP") && std::isnan(temperature.front()))
    fail("THERMAL_3", {{"material", rule.material}, {"function", value.function->label()}});
  const ParameterValues known[] = {{"TEMP", temperature}, {"INST", {&instant, 1}}};
  return value.function->values(temperature.size(), known);
}

const Field& ThermalMaterials::at_points(const Ground& ground, std::int32_t temperature, double instant) {
  const auto found = evaluated_.find(temperature);
  if (found != evaluated_.end() && found->second.instant == instant) return found->second.field;
  const MaterialTemperature& from = temperatures_.rows[static_cast<std::size_t>(temperature)];
  if (found != evaluated_.end() && !from.field.empty()) {  // the same at all instants
    found->second.instant = instant;
    return found->second.field;
  }
  Field field = moved_to(ground, at_instant(from, instant), field_type("ELGA_TEMP_R"), false);
  std::vector<std::int64_t> place = places(field, ground.mesh().n_cells());
  return evaluated_.insert_or_assign(temperature, Evaluated{instant, std::move(field), std::move(place)}).first->second.field;
}

Field ThermalMaterials::at_instant(const MaterialTemperature& from, double instant) const {
  const auto checked = [&](Field field, const std::string& label) {
    if (field.mesh != field_.mesh || field.component("TEMP") != 0 || field.n_components() != 1)
      fail("THERMAL_4", {{"field", label}, {"quantity", field.quantity}});
    return field;
  };
  if (!from.field.empty()) return checked(base_.field(from.field), base_.label(from.field));
  const Result result = base_.result(from.result);
  const double wanted = from.instants.empty() ? instant : StudyFunction(base_, from.instants).value("INST", instant);
  const std::vector<FieldInstant> there = course_of(result, from.name);
  if (there.empty()) fail("THERMAL_5", {{"label", result.label}, {"field", from.name}});
  const auto read = [&](std::size_t k) { return checked(base_.field(result, from.name, there[k].order), result.label); };
  const auto near = [&](double a) { return std::abs(a - wanted) <= same_instant * std::max(std::abs(a), std::abs(wanted)); };
  for (std::size_t k = 0; k < there.size(); ++k)
    if (near(there[k].instant)) return read(k);
  const std::string* outside = wanted < there.front().instant  ? &from.before
                               : wanted > there.back().instant ? &from.behind
                                                               : nullptr;
  if (outside && *outside == "CONSTANT") return read(outside == &from.before ? 0 : there.size() - 1);
  if ((outside && *outside == "EXCLU") || there.size() < 2)
    fail("THERMAL_6", {{"label", result.label},
                       {"instant", fmt::format("{:.9g}", wanted)},
                       {"first", fmt::format("{:.9g}", there.front().instant)},
                       {"last", fmt::format("{:.9g}", there.back().instant)}});
  std::size_t after = 1;
  while (after + 1 < there.size() && there[after].instant < wanted) ++after;
  Field first = read(after - 1);
  const Field second = read(after);
  if (!on_the_same_places(first, second) || first.present != second.present)
    fail("THERMAL_7", {{"label", result.label},
                       {"field", from.name},
                       {"first", fmt::format("{:.9g}", there[after - 1].instant)},
                       {"second", fmt::format("{:.9g}", there[after].instant)}});
  const double share = (wanted - there[after - 1].instant) / (there[after].instant - there[after - 1].instant);
  return between(std::move(first), second, share);  // outside by PROL='LINEAIRE' as well
}

}  // namespace lacon
