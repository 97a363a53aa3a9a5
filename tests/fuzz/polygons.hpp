#pragma once
// The oracle for polygons: common parts by brute force, from the definition.
#include "lacon/pairing/polygon.hpp"

namespace lacon::fuzz {

/// The area of a convex polygon, counter-clockwise.
double area(const space::Polygon& polygon);

/// The area that two convex polygons with coordinates of a few hundreds have in common, to 1e-8: the corners of each in the
/// other and all crossings of their edges, in order around their mean.
double common_area(const space::Polygon& a, const space::Polygon& b);

}  // namespace lacon::fuzz
