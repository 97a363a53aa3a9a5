#pragma once
// Where a skin ends, or leaves what faces it.
#include <cstdint>
#include <vector>

#include "lacon/pairing/surface.hpp"

namespace lacon {

/// Surface::free_ends: of each cell the ends (in the plane) or edges (in space) beyond which there is no other cell of the
/// skin, or one that is turned by more than 60 degrees, at the present coordinates.
std::vector<std::uint8_t> free_ends(const Surface& skin);

}  // namespace lacon
