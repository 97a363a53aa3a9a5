#pragma once
// AFFE_MODELE: a finite element for each cell that the modelisation has a row for.
#include "lacon/elements/registry.hpp"
#include "lacon/structures/concepts.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The model without its mesh's id. A cell whose type has no row under the modelisation gets no element (segments of a mesh in
/// space); a later occurrence of AFFE wins over an earlier one. Prints what was given. Throws MODELE_1 (unknown modelisation),
/// MODELE_2 (an occurrence that gives no element), MODELE_3 (nodes out of the plane), MODELE_4 (elements of the plane and of
/// space), MODELE_6 (another phenomenon), MODELE_8 (a body cell without element), MODELE_9 (beyond the axis), MESH_1, MESH_2.
Model affe_modele(const Mesh& mesh, const Registry& registry, const Keywords& keywords);

}  // namespace lacon
