#pragma once
#include "lacon/structures/base.hpp"

namespace lacon {

/// CALC_CHAMP: adds the fields of CONTRAINTE to RESULTAT (reuse), or stores them as a new result of the instants that are
/// meant. What a field is computed from is computed on the way, and stored only where it is asked for. Throws CALCCHAMP_1,
/// CALCCHAMP_2, FIELDS_1 to FIELDS_3, MESH_1, MESH_2.
void calc_champ(const Order& order, const Base& base);

}  // namespace lacon
