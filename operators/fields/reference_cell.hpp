#pragma once
// Reference cells as convex bodies: their middle, and the half-spaces of their facets.
#include <Eigen/Core>
#include <utility>
#include <vector>

#include "lacon/catalog/cells.hpp"

namespace lacon {

/// A point or a direction of a reference cell, (dimension).
using ReferenceVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;

/// A half-space normal . xi <= offset that holds the reference cell; the normal is of length 1.
struct HalfSpace {
  ReferenceVector normal;
  double offset;
};

struct ReferenceCell {
  ReferenceVector middle;
  std::vector<HalfSpace> sides;

  /// Whether xi is beyond no side by more than the margin, in reference coordinates.
  bool holds(const ReferenceVector& xi, double margin) const;
};

/// Of a kind of cell of dimension 1 to 3, made once.
const ReferenceCell& reference_cell(CellType type);

}  // namespace lacon
