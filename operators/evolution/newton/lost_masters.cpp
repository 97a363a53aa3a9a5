#include "lacon/operators/evolution/newton/lost_masters.hpp"

namespace lacon {

std::vector<std::size_t> LostMasters::note(const std::vector<Status>& before, const std::vector<Status>& wanted,
                                           std::span<const double> lambda, bool waits,
                                           const std::function<bool(std::size_t patch)>& is_covered) {
  std::vector<std::size_t> again;
  for (std::size_t p = 0; p < before.size(); ++p) {
    if (is_covered(p)) {
      bare_.erase(p);
      continue;
    }
    // an edge that slides off loses its master once
    if (before[p] != Status::active || wanted[p] == Status::active) continue;
    const bool pulls_bare = !(lambda[p] < 0) && (!waits || bare_.contains(p));
    bare_.insert(p);
    if (!pulls_bare && ++times_[p] > 1) again.push_back(p);
  }
  return again;
}

}  // namespace lacon
