#pragma once
// What straight edges leave of a curved skin.
#include <vector>

#include "lacon/pairing/surface.hpp"

namespace lacon {

/// Of each cell of a skin: the largest bulge that its edges (and the diagonals of a quadrangle) would have if they followed the
/// nodal normals, less the one that they have. Between two ends with the normals m and n it is |(n - m) . (b - a)| / 8, that of
/// an arc to third order.
std::vector<double> missing_bulge(const Surface& skin);

}  // namespace lacon
