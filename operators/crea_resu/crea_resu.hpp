#pragma once
// CREA_RESU: a result out of fields at instants; fields of functions are evaluated there.
#include "lacon/structures/base.hpp"

namespace lacon {

/// Throws CREARESU_1 (no name, or no instant), CREARESU_2 (meshes differ), CREARESU_3 (functions elsewhere than at nodes),
/// FIELDS_6, FIELDS_7 (a field of another kind than its name says).
void crea_resu(const Order& order, const Base& base);

}  // namespace lacon
