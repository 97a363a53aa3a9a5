#include "lacon/operators/calc_champ/calc_champ.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/selection.hpp"

namespace lacon {
namespace {

bool has_field(const Result& result, const std::string& name, std::int64_t order) {
  const auto named = result.fields.find(name);
  return named != result.fields.end() && named->second.contains(order);
}

/// The index of a new result: the same calculation, only these orders, no fields yet.
Result part_of(const Result& result, const std::vector<std::int64_t>& orders) {
  Result part = result;
  part.fields.clear();
  part.orders.clear();
  part.instants.clear();
  for (auto& [name, values] : part.parameters) values.clear();
  for (std::size_t k = 0; k < result.orders.size(); ++k) {
    if (std::find(orders.begin(), orders.end(), result.orders[k]) == orders.end()) continue;
    part.orders.push_back(result.orders[k]);
    part.instants.push_back(result.instants[k]);
    for (auto& [name, values] : part.parameters) values.push_back(result.parameters.at(name)[k]);
  }
  return part;
}

}  // namespace

void calc_champ(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const Result from = base.result(keywords.concept_id("RESULTAT"));
  const Mesh mesh = base.mesh(from.mesh);
  const std::vector<std::string> asked = keywords.texts("CONTRAINTE");
  std::vector<std::int64_t> orders = selected_orders(base, from, keywords);
  // without a choice of instants, those without stresses are left alone as long as others have them
  if (!names_instants(keywords) && from.fields.contains("SIEF_ELGA"))
    std::erase_if(orders, [&](std::int64_t o) { return !has_field(from, "SIEF_ELGA", o); });
  const std::vector<char> wanted = selected_cells(mesh, keywords);
  const auto asks = [&](const char* field) { return std::find(asked.begin(), asked.end(), field) != asked.end(); };

  Result to = order.reuse ? from : part_of(from, orders);
  for (const std::int64_t o : orders) {
    if (!has_field(from, "SIEF_ELGA", o))
      fail("CALCCHAMP_1", {{"label", from.label}, {"order", std::to_string(o)}, {"field", asked.front()}});
    const Field points = restrict_to_cells(base.field(from, "SIEF_ELGA", o), wanted);
    if (points.support.empty())
      fail("CALCCHAMP_2", {{"groups", fmt::format("{}", fmt::join(keywords.texts("GROUP_MA"), ", "))}, {"label", from.label}});
    // in a result that is enriched the stresses at integration points are there already, on all cells
    if (asks("SIEF_ELGA") && !order.reuse) base.add_field(to, points);
    if (!asks("SIEF_ELNO") && !asks("SIEF_NOEU")) continue;
    const Field cell_nodes = gauss_points_to_cell_nodes(mesh, points, "SIEF_ELNO");
    if (asks("SIEF_ELNO")) base.add_field(to, cell_nodes);
    if (asks("SIEF_NOEU")) base.add_field(to, cell_nodes_to_nodes(mesh, cell_nodes, "SIEF_NOEU"));
  }
  base.store(to);
}

}  // namespace lacon
