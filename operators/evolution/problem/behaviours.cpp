#include "lacon/operators/evolution/problem/behaviours.hpp"

#include <algorithm>

#include "lacon/assembly/solid_step.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {

Behaviours read_behaviours(const Mesh& mesh, const std::vector<Keywords>& occurrences) {
  Behaviours behaviours{{"ELAS/PETIT"}, std::vector<std::int32_t>(mesh.n_cells(), 0)};
  for (const Keywords& factor : occurrences) {
    const std::string option = factor.text("RELATION") + "/" + factor.text("DEFORMATION");
    const auto at = std::find(behaviours.options.begin(), behaviours.options.end(), option);
    const auto index = static_cast<std::int32_t>(at - behaviours.options.begin());
    if (at == behaviours.options.end()) behaviours.options.push_back(option);
    if (!factor.has("GROUP_MA")) std::fill(behaviours.of_cell.begin(), behaviours.of_cell.end(), index);
    for (const std::string& group : factor.texts("GROUP_MA"))
      for (const std::int32_t cell : cells_of_group(mesh, group, factor.path("GROUP_MA")))
        behaviours.of_cell[static_cast<std::size_t>(cell)] = index;
  }
  return behaviours;
}

std::vector<bool> named_cells(const Mesh& mesh, const std::vector<Keywords>& occurrences) {
  const bool all =
      occurrences.empty() || std::ranges::any_of(occurrences, [](const Keywords& factor) { return !factor.has("GROUP_MA"); });
  std::vector<bool> named(mesh.n_cells(), all);
  for (const Keywords& factor : occurrences)
    for (const std::string& group : factor.texts("GROUP_MA"))
      for (const std::int32_t cell : cells_of_group(mesh, group, factor.path("GROUP_MA")))
        named[static_cast<std::size_t>(cell)] = true;
  return named;
}

BehaviourRows behaviour_rows(const Registry& registry, std::string_view option) {
  const std::size_t slash = option.find('/');
  const catalog::RelationRow* relation = registry.find_relation(option.substr(0, slash));
  const catalog::DeformationRow* deformation = registry.find_deformation(option.substr(slash + 1));
  if (!relation || !deformation) fail("BEHAVIOUR_3", {{"behaviour", std::string(option)}});
  return {*relation, *deformation};
}

bool starts_elastically(const Registry& registry, const ElementSet& set) {
  const BehaviourRows rows = behaviour_rows(registry, set.option);
  if (!rows.relation.starts_elastically || !rows.deformation.adds_stress) return false;
  if (!elastic_parameters(set)) fail("BEHAVIOUR_9", {{"behaviour", set.option}, {"kernel", set.kernel->name}});
  return true;
}

}  // namespace lacon
