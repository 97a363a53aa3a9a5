#pragma once
// Nodes that keywords give by name, or leave out.
#include <string>
#include <vector>

#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The nodes N1, N2, ... of a keyword, if it is there. Throws CHARGE_1.
std::vector<std::int32_t> nodes_by_name(const Mesh& mesh, const Keywords& factor, const std::string& keyword);

/// One entry a node of the mesh: not 0 where SANS_GROUP_MA, SANS_GROUP_NO, SANS_MAILLE or SANS_NOEUD leaves it out; of cells
/// all nodes are left out. Throws MESH_1, MESH_2, CHARGE_1, GROUPE_2.
std::vector<char> nodes_left_out(const Mesh& mesh, const Keywords& factor);

}  // namespace lacon
