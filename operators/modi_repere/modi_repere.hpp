#pragma once
#include "lacon/structures/base.hpp"

namespace lacon {

/// MODI_REPERE: a new result with the fields of MODI_CHAM in other axes, the components keeping their names.
///   UTILISATEUR  axes of the nautical angles ANGL_NAUT, or along VECT_X and in its plane with VECT_Y
///   CYLINDRIQUE  about the line through ORIGINE along AXE_Z: in space X is radial, Y along the line, Z tangential (r, z,
///   theta);
///                in the plane X is radial, Y tangential, Z the plane's normal
/// Places are nodes and integration points of the mesh; MODIREPERE_6 tells where displacements have moved them since. Of two
/// AFFE for one place the later counts; elsewhere fields are as they were. Components beside those of MODI_CHAM (LAGS_C) stay.
/// Throws MODIREPERE_1 to MODIREPERE_5, FIELDS_1 to FIELDS_3, RESULT_1, CREACHAMP_7, CREACHAMP_14, MESH_1, MESH_2.
void modi_repere(const Order& order, const Base& base);

}  // namespace lacon
