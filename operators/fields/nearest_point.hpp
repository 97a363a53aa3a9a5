#pragma once
// The point of a cell's border that is nearest in space to a point outside the cell.
#include <Eigen/Core>
#include <vector>

#include "lacon/catalog/cells.hpp"

namespace lacon {

/// A point of a cell's border, seen from the point that the nearest one is sought for.
struct NearestPoint {
  double distance;
  Eigen::Vector3d from_point;  ///< the vector to it, of this length
  std::vector<double>
      weights;  ///< of the cell's nodes, their shape functions there; 0 but on the facet, edge or vertex it is on
};

/// Whether a point at this distance and place is preferred to another: the nearer one; and of two that are as near, but for
/// round-off, and apart, the one with the smaller coordinates, so that nothing depends on how nodes and cells are numbered.
/// @param size of the cells, that round-off is relative to
bool preferred(double distance, const Eigen::Vector3d& from_point, const NearestPoint& other, double size);

/// The nearest point of the border of a cell, straight or curved: the least distance among the vertices, the stationary points
/// of edges and those of facets, which Newton's method finds from the middle and from the nodes of a quadratic one of that
/// kind.
/// @param type a cell of dimension 2 or 3 @param nodes (n_nodes, 3) its nodes, relative to the point @param size of the cells
NearestPoint nearest_on_border(CellType type, const Eigen::Matrix<double, Eigen::Dynamic, 3>& nodes, double size);

}  // namespace lacon
