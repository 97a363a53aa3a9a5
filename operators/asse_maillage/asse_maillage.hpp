#pragma once
#include "lacon/structures/base.hpp"

namespace lacon {

/// ASSE_MAILLAGE, OPERATION='SUPERPOSE': nodes and cells of MAILLAGE_1, then those of MAILLAGE_2, with the groups of both;
/// nodes at one place stay two. Throws ASSEMAIL_1 where both have a group of one name, MESH1_12 for a mesh that is cut for LAC.
void asse_maillage(const Order& order, const Base& base);

}  // namespace lacon
