#pragma once
#include "lacon/structures/base.hpp"

namespace lacon {

/// CALC_CHAMP: adds fields to RESULTAT (reuse), or stores them as a new result of the instants that are meant. What a field is
/// computed from is computed on the way, and stored only where it is asked for. FORC_NODA and REAC_NODA take the geometry that
/// the stresses live on: the initial one with DEFORMATION='PETIT', else the current one; forces of contact are in neither the
/// stresses' nor the loads' part, so that REAC_NODA shows them. Throws CALCCHAMP_1 to CALCCHAMP_3,
/// CALCCHAMP_6 (EXCIT with other loads), FIELDS_1 to FIELDS_4,
/// MESH_1, MESH_2.
void calc_champ(const Order& order, const Base& base);

}  // namespace lacon
