#pragma once
// How far the edge of a contact moves when patches at it are pulled open.
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace lacon {

/// Edges that recede from iteration to iteration. Where the bodies bend, the pull at the edge is the moment there over the size
/// of a patch, held by the next patch alone: nothing in one iteration says how far the edge goes, and it would move by a patch
/// in each. Two iterations do: the pull vanishes where the secant through the last two of it does. In the plane: an edge in
/// space has other patches in each iteration, and would go too far.
class EdgeCourse {
 public:
  /// How many layers of patches open, the pulled ones among them. @param pulled together, with their force
  std::int32_t layers(const std::vector<std::vector<std::int32_t>>& neighbours, const std::vector<std::size_t>& pulled,
                      double force) const;
  /// An edge of this iteration. @param opened its patches, pulled and behind  @param layers of them
  void note(const std::vector<std::size_t>& opened, double force, std::int32_t layers);
  /// The iteration has ended: the edges noted in it are those of the last one.
  void next();

 private:
  struct Edge {
    double force = 0;
    std::int32_t layers = 0;
  };
  std::map<std::size_t, Edge> last_, now_;  ///< by patch that has opened
};

/// Patches behind those that are pulled open and will be pulled next, so that a contact that is too large by n patches finds
/// its edge in about log n iterations instead of n. Pressures there are those at the tip of a crack, -K / sqrt(s) + B sqrt(s)
/// at a distance s from the edge: patches of s < K / B are pulled, and yet the edge of the contact, where K vanishes, is at
/// twice that, where the pull summed up from the edge has fallen to 1 / sqrt(2) of its largest value. So patches open from the
/// edge on while the sum is above that; for Hertz' sphere this is Newton's method for the radius, from too large ones.
/// @param neighbours of each patch  @param force of each patch: positive where it is pulled
/// @param pulled patches that open because they are  @param pressed patches that may open as well
/// @param course where the edges of the last iteration were: they go at least as far as it says; this iteration's come into it
std::vector<std::size_t> behind_the_edge(const std::vector<std::vector<std::int32_t>>& neighbours,
                                         const std::vector<double>& force, const std::vector<bool>& pulled,
                                         const std::vector<bool>& pressed, EdgeCourse* course = nullptr);

}  // namespace lacon
