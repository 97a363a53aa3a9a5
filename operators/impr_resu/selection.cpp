// Which fields, instants, components, nodes and cells an occurrence of RESU means.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/impr_resu/impr_resu.hpp"

namespace lacon {
namespace {

/// The nodes that GROUP_NO and the cells of GROUP_MA mean: one entry a node; all without these keywords.
std::vector<char> selected_nodes(const Mesh& mesh, const Keywords& keywords, const std::vector<char>& cells) {
  if (!keywords.has("GROUP_NO") && !keywords.has("GROUP_MA")) return std::vector<char>(mesh.n_nodes(), 1);
  std::vector<char> wanted(mesh.n_nodes(), 0);
  for (const std::string& group : keywords.texts("GROUP_NO"))
    for (const std::int32_t node : nodes_of_group(mesh, group, keywords.path("GROUP_NO")))
      wanted[static_cast<std::size_t>(node)] = 1;
  if (keywords.has("GROUP_MA")) {
    const std::vector<char> of_cells = nodes_of_marked_cells(mesh, cells);
    for (std::size_t n = 0; n < wanted.size(); ++n) wanted[n] = wanted[n] || of_cells[n];
  }
  return wanted;
}

}  // namespace

std::string med_field_name(const std::string& label, const std::string& field) {
  std::string name = label;
  if (name.size() > 8) name += "_";
  name.resize(std::max<std::size_t>(name.size(), 8), '_');
  return name + field;
}

void each_field(const Base& base, const Result& result, const Mesh& mesh, const Keywords& keywords,
                const std::function<void(PrintedField&&)>& visit) {
  std::vector<std::string> known, names = keywords.texts("NOM_CHAM");
  for (const auto& [name, files] : result.fields) known.push_back(name);
  const bool named = !names.empty();
  if (!named) names = known;
  for (const std::string& name : names)
    if (!result.fields.contains(name))
      fail("IMPR_1", {{"keyword", keywords.path("NOM_CHAM")},
                      {"label", result.label},
                      {"field", name},
                      {"known", known.empty() ? part("none") : fmt::format("{}", fmt::join(known, ", "))}});
  const std::vector<std::string> med_names = keywords.texts("NOM_CHAM_MED");
  if (!med_names.empty() && med_names.size() != names.size())
    fail("IMPR_4", {{"keyword", keywords.path("NOM_CHAM_MED")},
                    {"names", std::to_string(med_names.size())},
                    {"fields", std::to_string(names.size())}});

  const std::vector<std::int64_t> orders = selected_orders(base, result, keywords);
  const std::vector<char> cells = selected_cells(mesh, keywords);
  const std::vector<char> nodes = selected_nodes(mesh, keywords, cells);
  const bool only_nodes = keywords.has("GROUP_NO") && !keywords.has("GROUP_MA");
  const bool parts = only_nodes || keywords.has("GROUP_MA");
  const std::vector<std::string> wanted = keywords.texts("NOM_CMP");
  std::set<std::string> all_components, found_components;
  std::map<std::string, const char*> left_out;  // fields that come with no value so far: why
  for (const std::int64_t order : orders) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto [why, is_new] = left_out.try_emplace(names[i], "not_at_instants");
      const auto& files = result.fields.at(names[i]);
      if (!files.contains(order) && !(named && names_instants(keywords))) continue;  // base.field() refuses the rest
      Field field = base.field(result, names[i], order);
      const auto leave_out = [&, reason = why](const char* part) {
        if (reason->second != nullptr) reason->second = part;
      };
      if (field.location != Location::nodes && only_nodes) {
        if (named) fail("IMPR_3", {{"keyword", keywords.path("GROUP_NO")}, {"field", names[i]}});
        leave_out("not_on_nodes");
        continue;
      }
      all_components.insert(field.components.begin(), field.components.end());
      if (!wanted.empty()) field = restrict_to_components(field, wanted);
      found_components.insert(field.components.begin(), field.components.end());
      if (field.components.empty()) {
        leave_out("not_with_components");
        continue;
      }
      if (parts) field = field.location == Location::nodes ? restrict_to_nodes(field, nodes) : restrict_to_cells(field, cells);
      if (field.support.empty()) {
        leave_out("not_on_part");
        continue;
      }
      why->second = nullptr;
      const std::string& root = keywords.has("NOM_RESU_MED") ? keywords.text("NOM_RESU_MED") : result.label;
      const std::string own = keywords.has("CHAM_GD") ? names[i] : med_field_name(root, names[i]);
      visit({med_names.empty() ? own : med_names[i], std::move(field)});
    }
  }
  for (const std::string& component : wanted)
    if (!found_components.contains(component))
      fail("IMPR_2", {{"keyword", keywords.path("NOM_CMP")},
                      {"component", component},
                      {"label", result.label},
                      {"known", fmt::format("{}", fmt::join(all_components, ", "))}});
  std::map<std::string, std::vector<std::string>> fields_of;
  for (const auto& [name, why] : left_out)
    if (why != nullptr) fields_of[why].push_back(name);
  for (const auto& [why, fields] : fields_of)
    inform("IMPR_5", {{"label", result.label}, {"fields", fmt::format("{}", fmt::join(fields, ", "))}, {"why", part(why)}});
}

}  // namespace lacon
