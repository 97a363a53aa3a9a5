#include "lacon/elements/plugin_rows.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <initializer_list>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "lacon/catalog/cells.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/quantities.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/elements/reference.hpp"

namespace lacon {

void bad_plugin(const std::filesystem::path& file, const std::string& reason) {
  fail("PLUGIN_1", {{"file", file.string()}, {"reason", reason}});
}

namespace {

std::string in_quotes(std::string_view text) { return "'" + std::string(text) + "'"; }

/// What a reader of one kind of table stands on.
class TableReader {
 public:
  /// @param kind "element" @param keys that such a table may have
  TableReader(const std::filesystem::path& file, const toml::table& table, const std::string& kind,
              std::initializer_list<std::string_view> keys)
      : file_(file), table_(table), kind_(kind), name_(part("in_line", {{"line", std::to_string(table.source().begin.line)}})) {
    for (const auto& [key, value] : table)
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
        fail_row(part("key_of_no_kind", {{"key", std::string(key.str())}, {"kind", kind}}));
  }

 protected:
  [[noreturn]] void fail_row(const std::string& reason) const {
    fail("PLUGIN_2", {{"file", file_.string()}, {"row", kind_ + " " + name_}, {"reason", reason}});
  }

  std::string text(std::string_view key) const {
    const std::optional<std::string> value = table_[key].value_exact<std::string>();
    if (!value || value->empty()) fail_row(part("lacks_the_text", {{"key", std::string(key)}}));
    return *value;
  }

  /// False where it is absent.
  bool flag(std::string_view key) const {
    if (!table_.contains(key)) return false;
    const std::optional<bool> value = table_[key].value_exact<bool>();
    if (!value) fail_row(part("no_true_or_false", {{"key", std::string(key)}}));
    return *value;
  }

  template <class Value>
  Value choice(std::string_view key, std::initializer_list<std::pair<std::string_view, Value>> choices) const {
    const std::string given = text(key);
    std::string known;
    for (const auto& [name, value] : choices) {
      if (name == given) return value;
      known += (known.empty() ? "" : ", ") + in_quotes(name);
    }
    fail_row(part("none_of", {{"key", std::string(key)}, {"given", given}, {"known", known}}));
  }

  /// The table 'kernels': what stands before the kernel (an option, a modelisation) -> "plug-in/kernel".
  std::vector<std::pair<std::string, std::string>> kernels(const std::string& what,
                                                           const std::vector<std::string>& plugins) const {
    const toml::table* table = table_["kernels"].as_table();
    if (!table) fail_row(part("lacks_the_kernels", {{"what", what}}));
    std::vector<std::pair<std::string, std::string>> found;
    for (const auto& [key, node] : *table) {
      const std::string value = node.value_exact<std::string>().value_or(""), name(key.str());
      const std::size_t slash = value.find('/');
      const std::string plugin = value.substr(0, slash);
      if (slash == std::string::npos || slash == 0 || slash + 1 == value.size())
        fail_row(part("kernel_of_another_form", {{"name", name}, {"value", value}}));
      if (std::find(plugins.begin(), plugins.end(), plugin) == plugins.end())
        fail_row(part("kernel_in_no_plugin", {{"name", name}, {"plugin", plugin}}));
      found.emplace_back(name, value);
    }
    return found;
  }

  const std::filesystem::path& file_;
  const toml::table& table_;
  std::string kind_, name_;
};

/// An [[element]] table.
class ElementReader : TableReader {
 public:
  ElementReader(const std::filesystem::path& file, const toml::table& table)
      : TableReader(file, table, "element",
                    {"modelisation", "phenomenon", "role", "geometry", "stress_state", "points", "dofs", "stress", "kernels"}) {
  }

  /// Rows for each cell that the table names in `points`.
  void read(const std::vector<std::string>& plugins, PluginRows& rows) {
    const std::string modelisation = name_ = text("modelisation");
    const catalog::Role role = choice<catalog::Role>("role", {{"solid", catalog::Role::solid}, {"skin", catalog::Role::skin}});
    const auto geometry = choice<catalog::Geometry>(
        "geometry",
        {{"plane", catalog::Geometry::plane}, {"axis", catalog::Geometry::axis}, {"space", catalog::Geometry::space}});
    const catalog::StressState state = stress_state(role, geometry);
    const toml::table* points = table_["points"].as_table();
    if (!points || points->empty()) fail_row(part("lacks_the_points"));
    for (const auto& [key, value] : *points) {
      const std::string cell_name(key.str());
      name_ = modelisation + "/" + cell_name;
      const std::optional<CellType> cell = catalog::find_cell(cell_name);
      if (!cell) fail_row(part("cell_does_not_exist", {{"cell", cell_name}}));
      if (catalog::cell(*cell).dimension + (role == catalog::Role::skin ? 1 : 0) != catalog::dimension_of(geometry))
        fail_row(part("cell_of_another_dimension", {{"role", text("role")}}));
      OwnedElement& owned = rows.elements.emplace_back();
      owned.file = file_.string();
      owned.dofs = components("dofs", "DEPL_R", rows);
      check_displacements(owned.dofs, geometry);
      owned.stress = components("stress", "SIEF_R", rows);
      for (auto& [option, kernel] : kernels("option", plugins))
        owned.kernels.push_back({rows.keep(std::move(option)), rows.keep(std::move(kernel))});
      owned.row = {.name = rows.keep(name_),
                   .modelisation = rows.keep(modelisation),
                   .phenomenon = rows.keep(text("phenomenon")),
                   .cell = *cell,
                   .role = role,
                   .geometry = geometry,
                   .stress_state = state,
                   .points = rule_size(*cell, value),
                   .dofs = owned.dofs,
                   .stress = owned.stress,
                   .kernels = owned.kernels};
    }
  }

 private:
  catalog::StressState stress_state(catalog::Role role, catalog::Geometry geometry) const {
    if (role == catalog::Role::solid && geometry == catalog::Geometry::plane)
      return choice<catalog::StressState>("stress_state", {{"plane_strain", catalog::StressState::plane_strain},
                                                           {"plane_stress", catalog::StressState::plane_stress}});
    if (table_.contains("stress_state")) fail_row(part("stress_state_elsewhere"));
    return catalog::StressState::full;
  }

  /// Kernels, loads and contact take the first unknowns of a node for its displacement. LAGS_C is no unknown of an element.
  void check_displacements(std::span<const std::string_view> dofs, catalog::Geometry geometry) const {
    constexpr std::string_view displacements[] = {"DX", "DY", "DZ"};
    const std::span wanted = std::span(displacements).first(static_cast<std::size_t>(catalog::dimension_of(geometry)));
    std::string names;
    for (const std::string_view name : wanted) names += (names.empty() ? "" : ", ") + in_quotes(name);
    if (dofs.size() < wanted.size() || !std::ranges::equal(dofs.first(wanted.size()), wanted))
      fail_row(part("dofs_without_displacements", {{"names", names}}));
    for (const std::string_view other : dofs.subspan(wanted.size()))
      if (other == "DZ" || other == "LAGS_C") fail_row(part("dofs_of_no_element", {{"name", std::string(other)}}));
  }

  int rule_size(CellType cell, const toml::node& node) const {
    const std::optional<std::int64_t> n = node.value_exact<std::int64_t>();
    try {
      if (n && *n > 0 && *n < 100000) return integration_rule(catalog::cell(cell).family, static_cast<int>(*n)).size();
    } catch (const std::logic_error&) {  // told below, with the file
    }
    fail_row(n ? part("no_rule_of_points", {{"count", std::to_string(*n)}}) : part("no_rule_of_this_number"));
  }

  std::vector<std::string_view> components(std::string_view key, std::string_view quantity, PluginRows& rows) const {
    const auto known = std::find_if(catalog::quantities().begin(), catalog::quantities().end(),
                                    [&](const auto& q) { return q.name == quantity; });
    const toml::array* array = table_[key].as_array();
    if (!array) fail_row(part("lacks_the_list", {{"key", std::string(key)}}));
    std::vector<std::string_view> names;
    for (const toml::node& node : *array) {
      const std::string name = node.value_exact<std::string>().value_or("");
      if (std::find(known->components.begin(), known->components.end(), name) == known->components.end())
        fail_row(part("no_component_of", {{"key", std::string(key)}, {"name", name}, {"quantity", std::string(quantity)}}));
      if (std::find(names.begin(), names.end(), name) != names.end())
        fail_row(part("names_twice", {{"key", std::string(key)}, {"name", name}}));
      names.push_back(rows.keep(name));
    }
    return names;
  }
};

/// [[relation]], [[deformation]] and [[law]] tables.
class BehaviourReader : TableReader {
 public:
  using TableReader::TableReader;

  void read_relation(PluginRows& rows) {
    name_ = text("name");
    text("help");
    catalog::RelationRow row{rows.keep(name_), "", catalog::TransverseStrain::unknown, flag("starts_elastically")};
    if (table_.contains("hardening")) row.hardening = rows.keep(text("hardening"));
    if (table_.contains("transverse_strain"))
      row.transverse_strain = choice<catalog::TransverseStrain>(
          "transverse_strain",
          {{"elastic", catalog::TransverseStrain::elastic}, {"isochoric", catalog::TransverseStrain::isochoric}});
    rows.relations.push_back(row);
  }
  void read_deformation(PluginRows& rows) {
    name_ = text("name");
    text("help");
    catalog::DeformationRow row{
        rows.keep(name_),
        choice<catalog::StressGeometry>("stress_geometry", {{"initial", catalog::StressGeometry::initial},
                                                            {"displaced", catalog::StressGeometry::displaced}}),
        choice<catalog::StrainMeasure>(
            "strain", {{"small", catalog::StrainMeasure::small}, {"green_lagrange", catalog::StrainMeasure::green_lagrange}}),
        catalog::PlasticStrain::unknown,
        flag("adds_stress"),
        flag("turns_stress")};
    if (row.stress_geometry == catalog::StressGeometry::initial) row.plastic_strain = catalog::PlasticStrain::small;
    if (table_.contains("plastic_strain"))
      row.plastic_strain =
          choice<catalog::PlasticStrain>("plastic_strain", {{"small", catalog::PlasticStrain::small},
                                                            {"green_lagrange", catalog::PlasticStrain::green_lagrange},
                                                            {"logarithmic", catalog::PlasticStrain::logarithmic},
                                                            {"stretches", catalog::PlasticStrain::stretches}});
    rows.deformations.push_back(row);
  }
  void read_law(const std::vector<std::string>& plugins, PluginRows& rows) {
    const std::string option = name_ = text("relation") + "/" + text("deformation");
    for (auto& [modelisation, kernel] : kernels("modelisation", plugins))
      rows.laws.push_back(
          {rows.keep(std::move(modelisation)), rows.keep(option), rows.keep(std::move(kernel)), file_.string()});
  }
};

}  // namespace

void read_plugin_rows(const std::filesystem::path& file, const std::vector<std::string>& plugins, PluginRows& rows) {
  toml::table content;
  try {
    content = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    bad_plugin(file, part("reason_in_line",
                          {{"reason", std::string(error.description())}, {"line", std::to_string(error.source().begin.line)}}));
  }
  for (const auto& [key, value] : content) {
    const std::string_view kind = key.str();
    if (kind == "material" && value.is_table()) continue;  // keywords of DEFI_MATERIAU: the launcher reads them
    if ((kind != "element" && kind != "relation" && kind != "deformation" && kind != "law") || !value.is_array_of_tables())
      bad_plugin(file, part("no_list_of_tables", {{"key", std::string(kind)}}));
    for (const toml::node& node : *value.as_array()) {
      const toml::table& table = *node.as_table();
      if (kind == "element")
        ElementReader(file, table).read(plugins, rows);
      else if (kind == "relation")
        BehaviourReader(file, table, "relation", {"name", "help", "hardening", "transverse_strain", "starts_elastically"})
            .read_relation(rows);
      else if (kind == "deformation")
        BehaviourReader(file, table, "deformation",
                        {"name", "help", "stress_geometry", "strain", "plastic_strain", "adds_stress", "turns_stress"})
            .read_deformation(rows);
      else
        BehaviourReader(file, table, "law", {"relation", "deformation", "kernels"}).read_law(plugins, rows);
    }
  }
}

}  // namespace lacon
