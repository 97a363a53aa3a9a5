#pragma once
#include "lacon/structures/base.hpp"

namespace lacon {

/// CALC_PRESSION: adds PRES_NOEU to RESULTAT (reuse), or stores it as a new result of the instants that are meant; on the nodes
/// of GROUP_MA that have a stress. With n the mean unit normal of GROUP_MA at the node (LISSAGE's normals, METHOD.md 3.5),
/// sigma the stress at the node (SIEF_NOEU or SIGM_NOEU of the result, else computed from SIEF_ELGA) and t = sigma n:
/// PRES = n . t, negative in compression; VX, VY (VZ) the tangential traction t - PRES n, CISA its magnitude. GEOMETRIE says
/// whether n is of the current geometry (DEFORMEE) or of the initial one. Throws CALCCHAMP_1, CALCPRES_1 to CALCPRES_3,
/// FIELDS_1 to FIELDS_3, MESH_1, MESH_2.
void calc_pression(const Order& order, const Base& base);

}  // namespace lacon
