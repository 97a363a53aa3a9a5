#pragma once
// What straight edges leave of a curved skin.
#include <vector>

#include "lacon/pairing/surface.hpp"

namespace lacon {

/// Of an edge of a cell, or of a diagonal of a quadrangle.
struct Bulge {
  double missing = 0;    ///< that it would have if it followed the nodal normals, less the one that it has; positive: outward
  double curvature = 0;  ///< of the arc that it stands for, positive where the skin is convex
  double turn = 0;       ///< radians: the largest angle between the cell and the nodal normals at its vertices
};

/// Of each cell of a skin the edge or diagonal that lacks most. Between two ends with the normals m and n a bulge is
/// (n - m) . (b - a) / 8, that of an arc to third order. In the plane the cells of a patch have the edge that they cut.
std::vector<Bulge> missing_bulge(const Surface& skin);

}  // namespace lacon
