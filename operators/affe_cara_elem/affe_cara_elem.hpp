#pragma once
// AFFE_CARA_ELEM: springs on discrete elements.
#include "lacon/elements/registry.hpp"
#include "lacon/structures/concepts.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The springs of every occurrence of DISCRET and DISCRET_2D, without the model's id; a later one wins over an earlier one of
/// the same cell. Throws DISCRET_1 (a cell without discrete element of this dimension), DISCRET_2 (CARA that does not fit the
/// cell), DISCRET_3 (as many values as CARA has directions), DISCRET_4 (REPERE='LOCAL' that leaves directions open), MESH_1,
/// MESH_2.
ElementCharacteristics affe_cara_elem(const Mesh& mesh, const Model& model, const Registry& registry, const Keywords& keywords);

}  // namespace lacon
