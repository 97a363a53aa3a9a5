#include "lacon/operators/evolution/status_rule.hpp"

#include <algorithm>
#include <limits>

namespace lacon {
namespace {

std::vector<bool> active(const std::vector<Status>& statuses) {
  std::vector<bool> set;
  for (const Status status : statuses) set.push_back(status == Status::active);
  return set;
}

}  // namespace

void StatusRule::start_instant() { *this = {}; }

std::vector<Status> StatusRule::next(const std::vector<Status>& now, const std::vector<Status>& wanted) {
  if (!keeps_) {
    if (active_.empty()) active_.push_back(active(now));
    std::vector<bool> set = active(wanted);
    if (set == active_.back()) return wanted;
    keeps_ = std::count(active_.begin(), active_.end(), set) >= 2;
    active_.push_back(std::move(set));
    if (!keeps_) return wanted;
    fewest_ = std::numeric_limits<std::size_t>::max();
  }
  // without master a patch has no gap to be judged by
  std::vector<Status> kept = now;
  for (std::size_t p = 0; p < kept.size(); ++p)
    if (wanted[p] == Status::unpaired)
      kept[p] = Status::unpaired;
    else if (kept[p] == Status::unpaired)
      kept[p] = Status::open;
  return kept;
}

std::vector<Status> StatusRule::change(const std::vector<Status>& now, const std::vector<Status>& wanted) {
  std::vector<std::size_t> changing;
  for (std::size_t p = 0; p < now.size(); ++p)
    if (wanted[p] != now[p]) changing.push_back(p);
  if (changing.size() < fewest_) {
    fewest_ = changing.size();
    single_.clear();
    return wanted;
  }
  single_.push_back(active(now));
  const std::vector<bool>& last = single_.back();
  for (std::size_t first = 0; first + 1 < single_.size(); ++first) {
    if (single_[first] != last) continue;
    period_ = single_.size() - 1 - first;
    for (std::size_t p = 0; p < last.size(); ++p)
      if (std::any_of(single_.begin() + static_cast<std::ptrdiff_t>(first), single_.end(),
                      [&](const std::vector<bool>& set) { return set[p] != last[p]; }))
        endless_.push_back(p);
    break;
  }
  std::vector<Status> changed = now;
  changed[changing.back()] = wanted[changing.back()];
  return changed;
}

}  // namespace lacon
