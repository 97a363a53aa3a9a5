#pragma once
// CREA_MAILLAGE: a mesh from another.
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The mesh that the keywords DECOUPE_LAC, LINE_QUAD or QUAD_LINE ask for; prints a summary on stdout. Errors: see
/// operators/meshing/cut.hpp and order_change.hpp, and ORDER_2 where none of the three is given.
Mesh crea_maillage(const Mesh& mesh, const Keywords& keywords);

}  // namespace lacon
