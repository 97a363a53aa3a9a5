#include "lacon/operators/evolution/origin.hpp"

#include <algorithm>

#include "lacon/operators/fields/selection.hpp"

namespace lacon {

std::optional<Origin> origin_of(const Keywords& keywords, const Base& base) {
  if (!keywords.has("ETAT_INIT") || !keywords.factor("ETAT_INIT").has("EVOL_NOLI")) return std::nullopt;
  const Keywords from = keywords.factor("ETAT_INIT");
  Origin origin{base.result(from.concept_id("EVOL_NOLI")), 0, 0};
  origin.order = selected_orders(base, origin.result, from).back();
  const std::vector<std::int64_t>& all = origin.result.orders;
  origin.instant = origin.result.instants[std::find(all.begin(), all.end(), origin.order) - all.begin()];
  if (from.has("INST_ETAT_INIT")) origin.instant = from.real("INST_ETAT_INIT");
  return origin;
}

}  // namespace lacon
