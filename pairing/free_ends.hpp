#pragma once
// Where a skin ends, or leaves what faces it.
#include <cstdint>
#include <vector>

#include "lacon/pairing/surface.hpp"

namespace lacon {

/// Surface::free_ends: of each cell the ends (in the plane) or edges (in space) beyond which there is no other cell of the
/// skin, or one that is turned by 60 degrees or more (wall_cosine), at the present coordinates.
std::vector<std::uint8_t> free_ends(const Surface& skin);

/// The faces of a skin: of each cell the first cell of its face. A face ends where the skin does, and at convex edges (in
/// space; in the plane at nodes) where it turns by 60 degrees or more, at the present coordinates. The floor and the walls of
/// a pocket are one face: what lies in its corner has both in front of it.
std::vector<std::int32_t> faces(const Surface& skin);

}  // namespace lacon
