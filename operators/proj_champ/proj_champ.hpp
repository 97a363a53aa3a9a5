#pragma once
// PROJ_CHAMP by collocation: nodal fields at the nodes of another mesh, by the shape functions of the cells that hold them.
#include "lacon/structures/base.hpp"

namespace lacon {

/// Throws PROJCHAMP_1 (a field that is not nodal), PROJCHAMP_2 (no node gets a value), CREACHAMP_5 (MAILLAGE_1 or MODELE_1 of
/// another mesh); PROJCHAMP_3 (A) tells nodes outside.
void proj_champ(const Order& order, const Base& base);

}  // namespace lacon
