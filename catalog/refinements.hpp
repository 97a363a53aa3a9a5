#pragma once
// Uniform refinement: rows of refinements.toml, completed by the generator. Local numbers are 0-based.
#include <span>

#include "lacon/catalog/cell_type.hpp"
#include "lacon/catalog/cuts.hpp"

namespace lacon::catalog {

/// One way to cut the inside of a cell: the sub-cells that complete RefinementRow::cells where this diagonal is drawn.
struct RefinementChoice {
  int first, second;  ///< the points that the diagonal joins
  std::span<const SubCell> cells;
};

/// The sub-cells of one cell. Their nodes are points of the row: first the cell's own nodes, then the new ones. A point is a
/// weighted mean of the cell's vertices, and its weights say which points of two neighbours are one node.
struct RefinementRow {
  CellType cell;
  std::span<const std::int8_t> weights;  ///< (points, vertices of the cell), in units of 1 / refinement_scale
  std::span<const double> points;        ///< reference coordinates, (points, dimension)
  std::span<const SubCell> cells;
  std::span<const RefinementChoice> choices;  ///< empty: `cells` are all; otherwise one of them completes `cells`
};

inline constexpr int refinement_scale = 64;

std::span<const RefinementRow> refinements();

/// The row of this cell, or nullptr (POI1).
const RefinementRow* find_refinement(CellType cell);

}  // namespace lacon::catalog
