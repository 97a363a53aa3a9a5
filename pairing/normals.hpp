#pragma once
// Normals at the nodes of a surface, and its smallest edge.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/pairing/surface.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

/// Outward unit normals at the nodes (METHOD.md 3.5, LISSAGE): the mean of the unit normals of the adjacent cells at the node,
/// renormalised; zero where they cancel and at nodes off the surface. @return (n_nodes, 3)
std::vector<double> nodal_normals(const Surface& surface);

/// Corners of cells at which the cell's own normal is more than an angle away from the node's.
struct TurnedNormals {
  std::int64_t count = 0;
  std::int32_t first = -1;  ///< node of the first one
};
/// @param normals of nodal_normals() @param angle radians
TurnedNormals turned_normals(const Surface& surface, std::span<const double> normals, double angle);

/// Outward normal of a skin cell at a reference point, as long as the Jacobian there. @param points (n_nodes, 3) of the cell
Vec3 cell_normal(CellType type, std::span<const double> points, std::span<const double> xi);

/// The shortest distance between the ends of an edge; 0 for a surface without cells.
double smallest_edge(const Surface& surface);

}  // namespace lacon
