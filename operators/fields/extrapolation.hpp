#pragma once
// From integration points to nodes, as the peer's users know it (SIEF_ELGA -> SIEF_ELNO -> SIEF_NOEU).
#include <string>
#include <vector>

#include "lacon/catalog/cells.hpp"
#include "lacon/structures/field.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// A field that differs from `from` only in its name and in where it lives: no support and no values yet.
Field field_like(const Field& from, std::string name, Location location);

/// The matrix that takes values at the points of a cell's integration rule to values at its nodes, (n_nodes, n_points): the
/// least-squares fit, all points alike, by the shape functions of the linear cell, evaluated at the nodes. A middle node so has
/// the mean of its edge's (face's, cell's) vertices. With fewer points than vertices: the mean of the points everywhere. Throws
/// std::logic_error where the family has no rule of `n_points` points.
std::vector<double> extrapolation_matrix(CellType type, int n_points);

/// Values at the nodes of each cell (ELNO) from values at its integration points (ELGA): the same cells, components, instant.
Field gauss_points_to_cell_nodes(const Mesh& mesh, const Field& points, std::string name);

/// Values at nodes (NOEU) from values at the nodes of cells (ELNO) or of cells (ELEM): the arithmetic mean over the cells of
/// the field that share the node and have the component there. Nodes by number.
Field cell_nodes_to_nodes(const Mesh& mesh, const Field& cells, std::string name);

/// The part of a field of cells (ELGA, ELNO, ELEM) on those of its cells that `wanted` marks; wanted has one entry a cell of
/// the mesh.
Field restrict_to_cells(const Field& field, const std::vector<char>& wanted);

/// The part of a field of nodes on those of its nodes that `wanted` marks; wanted has one entry a node of the mesh.
Field restrict_to_nodes(const Field& field, const std::vector<char>& wanted);

/// The components of this list that the field has, in the field's order.
Field restrict_to_components(const Field& field, const std::vector<std::string>& wanted);

}  // namespace lacon
