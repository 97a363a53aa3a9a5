#pragma once
// Patches that lose their master wherever they press.
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "lacon/operators/contact/patches.hpp"

// A gap is integrated over what a master covers of a patch. Where the master ends on the patch, and points at that end lie
// inside it although the average is closed, the force lambda dG/du drives the end off the patch: so the gap closes as well. A
// patch may then lose its master in contact, and lie deep inside it without: no status satisfies it, and the cause is the cover
// alone. What the pressure does along normals is enough there: the end keeps its place in the force
// (ContactState::keep_cover), which is then that of a gap with another domain: balanced as before, but of no potential.

namespace lacon {

class LostMasters {
 public:
  void start_instant() { *this = {}; }
  /// An iteration ends. @param before statuses in it  @param wanted those that follow  @param lambda pressures, negative
  /// @param waits statuses wait for their equilibrium: on the way there an active patch may pull, and is in contact all the
  /// same
  /// @param is_covered whether a master still covers enough of a patch
  /// @return patches that have lost their master in contact, not for the first time in this instant
  std::vector<std::size_t> note(const std::vector<Status>& before, const std::vector<Status>& wanted,
                                std::span<const double> lambda, bool waits,
                                const std::function<bool(std::size_t patch)>& is_covered);
  /// From now on losses of a patch count anew.
  void forget(std::size_t patch) { times_.erase(patch); }

 private:
  std::map<std::size_t, int> times_;  ///< in this instant, of each patch that has
  std::set<std::size_t> bare_;        ///< those that have found none since
};

}  // namespace lacon
