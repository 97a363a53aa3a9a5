#pragma once
// Convex polygons of a plane: cut by half-planes, subtracted, measured.
#include <cstdint>
#include <vector>

#include "lacon/structures/vector.hpp"

namespace lacon::space {

/// The points y with s = value + slope . (y - anchor) >= 0.
struct HalfPlane {
  Vec2 anchor{}, slope{};
  double value = 0;
  std::int32_t line = -1;  ///< of whoever asked for it: what bounds it

  double operator()(Vec2 y) const { return value + dot(slope, y - anchor); }
  HalfPlane opposite() const { return {anchor, -1.0 * slope, -value, line}; }
};

/// Vertices of a convex polygon, counter-clockwise.
using Polygon = std::vector<Vec2>;

/// The part of a convex polygon within a half-plane (Sutherland-Hodgman). It depends continuously on both: where an edge lies
/// on the border up to round-off, a new vertex is anywhere on that edge and the area is the same. @param[out] inside must be
/// another
void clip(const Polygon& polygon, const HalfPlane& half, Polygon& inside);

/// Twice the area.
double double_area(const Polygon& polygon);

/// The mean of the vertices: a point inside.
Vec2 middle(const Polygon& polygon);

/// A part of a convex polygon and the half-planes that cut it out. Short edges that round-off left between two vertices have
/// any direction, so that what cuts another polygon is the half-planes, never the edges.
struct Region {
  Polygon polygon;
  std::vector<HalfPlane> halves;
};

/// Whether some half-plane of one has all of the other outside, or within a strip of `width`. Both are parts of the same
/// polygon.
bool separated(const Region& a, const Region& b, double width);

/// The common part.
Region intersection(const Region& a, const Region& b);

/// Append convex parts of `a` that `b` does not cover to `rest`, but for those whose double area is at most `sliver`.
void subtract(const Region& a, const Region& b, double sliver, std::vector<Region>& rest);

}  // namespace lacon::space
