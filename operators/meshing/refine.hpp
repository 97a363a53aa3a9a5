#pragma once
// Uniform refinement: every edge of the cells is cut in two (rows of catalog/refinements.toml).
#include <string>

#include "lacon/structures/mesh.hpp"

namespace lacon {

struct RefinementReport {
  std::int64_t refined = 0;                ///< cells that were cut
  std::int64_t attached = 0;               ///< of them: facets and edges of listed cells, not listed themselves
  std::vector<std::string> node_groups{};  ///< groups of nodes that hold nodes of refined cells
};

/// Refine the cells of these groups (none: every cell), and the cells that are facets or edges of theirs. Sub-cells take the
/// place of their cell, in the list of cells and in every group; new nodes are appended and belong to no group of nodes.
///
/// New nodes are images of reference points: on straight edges with centred mid nodes the middles and quarters; curved
/// quadratic cells keep their shape. A tetrahedron's inside is cut along the shortest of its three diagonals.
/// @param keyword path of the keyword that names the groups
/// Throws MESH1_12 (mesh cut for LAC), MESH_1, MESH_2 (unknown, empty group), RAFFINE_1 (an edge that is cut belongs to a cell
/// that is not refined), RAFFINE_2 (a sub-cell of negative or mixed Jacobian).
Mesh refine(const Mesh& mesh, std::span<const std::string> groups, std::string_view keyword, RefinementReport& report);

}  // namespace lacon
