#pragma once
#include "lacon/structures/base.hpp"

namespace lacon {

/// MACR_LIGN_COUPE: a table of the values of a nodal field along lines (lines.hpp), for each LIGN_COUPE and each instant.
///   EXTRACTION  a row a point: ABSC_CURV, COOR_X, COOR_Y, COOR_Z and the components; one that a node of its cell lacks is
///               missing
///   MOYENNE     six rows, QUANTITE and the components, with f linear between points and s from 0 to l along the line:
///               MOMENT_0 = 1/l int f ds, MOMENT_1 = 12/l^2 int f (s - l/2) ds, MINIMUM, MAXIMUM,
///               MOYE_INT, MOYE_EXT = MOMENT_0 -+ MOMENT_1/2 (as POST_RELEVE_T); pieces that end where there is no gap (JEU
///               without a master) are left out: sums.hpp
/// Throws LIGNCOUPE_1, LIGNCOUPE_3 to LIGNCOUPE_9, CREACHAMP_12, CREACHAMP_14, RESULT_1, FIELDS_1 to FIELDS_3, MESH_1, MESH_2,
/// CREACHAMP_5 (MODELE or MAILLAGE of another mesh).
void macr_lign_coupe(const Order& order, const Base& base);

}  // namespace lacon
