#pragma once
// CREA_MAILLAGE/RESTREINT: a part of a mesh.
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The cells of GROUP_MA and their nodes, in the order and with the orientation they had. Kept are the groups of GROUP_MA and
/// of GROUP_NO, with TOUT_GROUP_MA='OUI' and TOUT_GROUP_NO='OUI' all that have a member left; of a group, the members left.
/// Throws MESH_1, MESH_2.
Mesh restricted(const Mesh& mesh, const Keywords& factor);

}  // namespace lacon
