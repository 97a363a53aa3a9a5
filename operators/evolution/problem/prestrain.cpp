#include "lacon/operators/evolution/problem/prestrain.hpp"

#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/problem/behaviours.hpp"

namespace lacon {

void check_laws(const Registry& registry, const InitialStrains& strains, const std::vector<ElementSet>& solids) {
  const auto concerned = [&](std::int32_t cell) { return strains.concerns(cell); };
  for (const ElementSet& set : solids)
    if (const auto cell = std::ranges::find_if(set.cells, concerned); cell != set.cells.end())
      if (!starts_elastically(registry, set)) fail("BEHAVIOUR_6", {{"behaviour", set.option}, {"cell", cell_name(*cell)}});
}

void Prestrain::move_to(double instant, std::vector<PointValues>& points) const {
  for (std::size_t s = 0; s < points.size(); ++s) {
    const ElementSet& set = problem_.solids[s];
    const InitialStrains& strains = problem_.initial_strains;
    points[s].initial = strains.empty() ? std::vector<double>() : strains.at(instant, set.cells, set.tabulation.n_points);
  }
}

bool Prestrain::acts(const StaticState& state) const {
  if (!problem_.initial_strains.empty()) return true;
  for (std::size_t s = 0; s < state.n_sets(); ++s)
    if (holds(state, s, PointQuantity::initial)) return true;
  return false;
}

}  // namespace lacon
