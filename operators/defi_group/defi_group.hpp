#pragma once
// DEFI_GROUP: groups of cells and nodes from others, or by name.
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// DETR_GROUP_MA, DETR_GROUP_NO, then CREA_GROUP_MA, then CREA_GROUP_NO, each in the order of its occurrences: a group may be
/// used by those after it. Prints the new groups. Errors: MESH_1, MESH_2 (unknown, empty group), GROUPE_1 (name exists),
/// GROUPE_2 (unknown cell or node), GROUPE_4 (one name, several groups), GROUPE_5 (unknown cell type), GROUPE_7,
/// GROUPE_8, LIGNCOUPE_4 (nodes in no such order).
void defi_group(Mesh& mesh, const Keywords& keywords);

}  // namespace lacon
