#pragma once
// For kernels of axisymmetry, where x is the radius r: what touches the axis of revolution, and what reaches over it.
#include <cmath>

namespace lacon {

/// A node of the mesh may be this far beyond the axis, as a share of its cell's largest coordinate: round-off of a file in
/// single precision.
constexpr double mesh_over_axis = 1e-6;

/// A node that is displaced may be this far beyond the axis, as a share of its cell's size: where no load holds the axis it
/// moves by the error of the discretisation. Points there count as points of the axis: what integrals lose is the share's
/// square.
constexpr double displaced_over_axis = 0.1;

/// Whether a cell of the mesh reaches over the axis. @param coordinate(i): number i of its (n_nodes, 2) coordinates
template <class Coordinate>
bool reaches_over_axis(int n_nodes, const Coordinate& coordinate) {
  double largest = 0, least = coordinate(0);
  for (int i = 0; i < 2 * n_nodes; ++i) largest = std::fmax(largest, std::abs(coordinate(i)));
  for (int a = 1; a < n_nodes; ++a) least = std::fmin(least, coordinate(2 * a));
  return least < -mesh_over_axis * largest;
}

/// Whether a displaced cell reaches over the axis by more than the error of the discretisation.
template <class Coordinate>
bool displaced_reaches_over_axis(int n_nodes, const Coordinate& coordinate) {
  double size = 0, least = coordinate(0);
  for (int i = 2; i < 2 * n_nodes; ++i) size = std::fmax(size, std::abs(coordinate(i) - coordinate(i % 2)));
  for (int a = 1; a < n_nodes; ++a) least = std::fmin(least, coordinate(2 * a));
  return least < -displaced_over_axis * size;
}

}  // namespace lacon
