#pragma once
// Is a cell the right way round, and how good is its shape?
#include <array>
#include <utility>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// The least and the greatest determinant of the map from the reference cell, over its vertices, the other nodes and the centre
/// (of a pyramid: drawn a little from the apex, where the map degenerates). For cells of the space's dimension: TRIA and QUAD
/// use x and y.
/// @param nodes of the cell @param coordinates (n, 3)
struct JacobianRange {
  double least;
  double greatest;
  double central;
};
JacobianRange jacobian_range(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates);

/// Positive everywhere, but for corners that are flat (zero to round-off), as those of a quadrangle drawn as a triangle. At the
/// centre zero is none: that is a hexahedron whose one face is turned by 180 degrees, with all corners the right way round.
bool is_sound(const JacobianRange& range);

/// The determinant at the centre: its sign says on which side the cell's facets have their outside.
double central_jacobian(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates);

/// The cells of the space's dimension whose determinant at the centre is negative, ascending.
std::vector<std::int32_t> inverted_cells(const Mesh& mesh);

/// The scaled Jacobian: at each corner of three edges (two in the plane) the determinant of the edges' unit tangents, over the
/// one of the ideal cell, whose edges are all equal; the least of all corners. 1 for the ideal cell, less for others with
/// straight edges, 0 for a flat corner, negative for a corner turned inside out. Mid nodes bend the tangents of quadratic
/// cells. At the apex of a pyramid every three of the four edges count. For cells of the space's dimension.
double scaled_jacobian(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates);

/// A cell with its scaled Jacobian.
using CellQuality = std::pair<double, std::int32_t>;

/// The scaled Jacobians of some cells.
struct Quality {
  std::size_t n_cells = 0;
  double mean = 0;
  static constexpr std::array<double, 6> fractions{0, 0.01, 0.1, 0.5, 0.9, 1};
  std::array<double, fractions.size()> quantiles{};  ///< the value below which this fraction of the cells lies
  static constexpr std::size_t n_worst = 5;
  std::vector<CellQuality> worst;  ///< the least first

  double least() const { return quantiles.front(); }
};

/// @param cells each once
Quality quality_of(std::vector<CellQuality> cells);

}  // namespace lacon
