#include "lacon/operators/evolution/newton/status_rule.hpp"

#include <algorithm>
#include <limits>

namespace lacon {
namespace {

std::vector<bool> active(const std::vector<Status>& statuses) {
  std::vector<bool> set;
  for (const Status status : statuses) set.push_back(status == Status::active);
  return set;
}

using Sets = std::vector<std::vector<bool>>;

/// The sets behind the last one that was the same as that at the end.
std::optional<StatusCycle> cycle(const Sets& sets) {
  const auto before = std::find(sets.rbegin() + 1, sets.rend(), sets.back());
  if (before == sets.rend()) return std::nullopt;
  StatusCycle cycle{.patches = {}, .period = static_cast<std::size_t>(before - sets.rbegin())};
  for (std::size_t p = 0; p < sets.back().size(); ++p)
    if (std::any_of(sets.rbegin(), before, [&](const std::vector<bool>& set) { return set[p] != sets.back()[p]; }))
      cycle.patches.push_back(p);
  if (cycle.patches.empty()) return std::nullopt;  // one that lost its master has opened: no other set
  return cycle;
}

}  // namespace

void StatusRule::start_instant() { *this = {}; }

std::vector<Status> StatusRule::next(const std::vector<Status>& now, const std::vector<Status>& wanted) {
  if (!keeps_) {
    // what an iteration went on with, which may not be what was wanted (LinearStatuses)
    if (active_.empty() || active(now) != active_.back()) active_.push_back(active(now));
    std::vector<bool> set = active(wanted);
    if (set == active_.back()) return wanted;
    keeps_ = std::count(active_.begin(), active_.end(), set) >= 2;
    active_.push_back(std::move(set));
    if (!keeps_) return wanted;
    round_ = cycle(active_);
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
  endless_ = cycle(single_);
  std::vector<Status> changed = now;
  changed[changing.back()] = wanted[changing.back()];
  return changed;
}

}  // namespace lacon
