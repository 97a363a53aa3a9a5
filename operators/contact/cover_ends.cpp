// What matrices lack of the ends of kept covers.
#include "lacon/operators/contact/contact_state.hpp"

namespace lacon {

std::vector<CoverEnd> ContactState::moving_ends(const Patchwise& patches) const {
  std::vector<CoverEnd> all;
  const auto d = static_cast<std::size_t>(mesh_.dimension);
  for (const ContactGeometry::Variation& variation : variations_) {
    const std::int32_t patch = contact_.slaves[variation.slave].patch;
    if (locked_[patch]) continue;
    for (const MovingEnd& end : variation.of_gap.ends) {
      CoverEnd& of = all.emplace_back();
      for (std::size_t i = 0; i < end.place.size(); ++i) {
        of.unknowns.push_back({variation.nodes[i / d], static_cast<int>(i % d)});
        of.column.push_back(patches.lambda[patch] * end.gradient[i]);
        of.row.push_back(end.place[i]);
      }
      of.unknowns.push_back({static_cast<std::int64_t>(mesh_.n_nodes()) + patch, 0});
      of.column.push_back(end.gap);
      of.row.push_back(0);
    }
  }
  return all;
}

}  // namespace lacon
