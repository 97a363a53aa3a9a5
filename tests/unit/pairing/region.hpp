#pragma once
// A polygon as the region that it is, for what tests and fuzzes clipping.
#include "lacon/pairing/polygon.hpp"

namespace lacon::test {

/// @param polygon convex, counter-clockwise
inline space::Region region(const space::Polygon& polygon) {
  space::Region made{polygon, {}};
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 d = polygon[(i + 1) % polygon.size()] - polygon[i];
    made.halves.push_back({polygon[i], {-d.y, d.x}, 0});
  }
  return made;
}

}  // namespace lacon::test
