#pragma once
// How far the edge of a contact moves when patches at it are pulled open.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacon {

/// Patches behind those that are pulled open and will be pulled next, so that a contact that is too large by n patches finds
/// its edge in about log n iterations instead of n. Pressures there are those at the tip of a crack, -K / sqrt(s) + B sqrt(s)
/// at a distance s from the edge: patches of s < K / B are pulled, and yet the edge of the contact, where K vanishes, is at
/// twice that, where the pull summed up from the edge has fallen to 1 / sqrt(2) of its largest value. So patches open from the
/// edge on while the sum is above that; for Hertz' sphere this is Newton's method for the radius, from too large ones.
/// @param neighbours of each patch  @param force of each patch: positive where it is pulled
/// @param pulled patches that open because they are  @param pressed patches that may open as well
std::vector<std::size_t> behind_the_edge(const std::vector<std::vector<std::int32_t>>& neighbours,
                                         const std::vector<double>& force, const std::vector<bool>& pulled,
                                         const std::vector<bool>& pressed);

}  // namespace lacon
