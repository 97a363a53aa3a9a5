#pragma once
// Is a cell the right way round?
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// The least and the greatest determinant of the map from the reference cell, over its vertices, the other nodes and the centre
/// (of a pyramid: drawn a little from the apex, where the map degenerates). For cells of the space's dimension: TRIA and QUAD
/// use x and y.
/// @param nodes of the cell @param coordinates (n, 3)
struct JacobianRange {
  double least;
  double greatest;
};
JacobianRange jacobian_range(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates);

/// Positive everywhere, but for corners that are flat (zero to round-off), as those of a quadrangle drawn as a triangle.
bool is_sound(const JacobianRange& range);

/// The determinant at the centre: its sign says on which side the cell's facets have their outside.
double central_jacobian(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates);

}  // namespace lacon
