#pragma once
#include "lacon/structures/base.hpp"

namespace lacon {

/// CREA_CHAMP: makes a field of TYPE_CHAM.
///   EXTR     a field of a result at an instant (without INST and NUME_ORDRE: the result has one), or the coordinates of a
///   mesh;
///            with TYPE_MAXI the extreme of each value over the instants, or the instant of it
///   AFFE     values or functions of components on groups; the later of two counts
///   EVAL     the functions of CHAM_F with the components of CHAM_PARA at the same places as parameters
///   ASSE     components of fields on groups, renamed, with factors, one after the other; CUMUL adds to what is there. Fields
///   of
///            cells (ELEM, CART) may go into ELGA and ELNO, other locations must be the same
///   DISC     a field elsewhere: moved_to()
///   COMB     a sum of fields with factors, where all of them exist
///   NORMALE  mean unit normals at the nodes of GROUP_MA (LISSAGE's, METHOD.md 3.5)
/// With PROL_ZERO='OUI' a field of cells (not of functions) exists on all cells of MODELE, 0 where nothing is said.
/// Throws CREACHAMP_1 to CREACHAMP_16, RESULT_1, FIELDS_1 to FIELDS_3, MESH_1, MESH_2, and what StudyFunction::values() throws.
void crea_champ(const Order& order, const Base& base);

}  // namespace lacon
