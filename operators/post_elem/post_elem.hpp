#pragma once
#include "lacon/structures/base.hpp"

namespace lacon {

/// POST_ELEM: a table with a row for each field that RESULTAT and the instants, or CHAM_GD, mean.
///   NORME      VALE_NORM = sqrt(sum over cells and their integration points of measure times sum over components of c v^2),
///   with
///              c = 1 (L2), 2 for the components XY, XZ, YZ of tensors (FROBENIUS), or COEF_MULT. All groups together
///   INTEGRALE  VOL, and INTE_<component>, MOYE_<component> (mean over where the component is), a row for each group
///   MINMAX     MIN_, MAX_<component> with the place where it is, a row for each group
/// Integration is a quadrature by each element's own rule, that of its stresses or loads; in axisymmetry over one radian. A
/// field that lives elsewhere is taken to the integration points first (moved_to()). TOUT means the body cells. Throws
/// POSTELEM_1 to POSTELEM_3, RESULT_1, FIELDS_1 to FIELDS_4, MESH_1, MESH_2.
void post_elem(const Order& order, const Base& base);

}  // namespace lacon
