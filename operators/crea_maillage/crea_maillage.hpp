#pragma once
// CREA_MAILLAGE: a mesh from another.
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The mesh that the keywords DECOUPE_LAC, LINE_QUAD, QUAD_LINE or HEXA20_27 ask for; prints a summary on stdout. Errors: see
/// operators/meshing/cut.hpp and order_change.hpp, and ORDER_2 where none of them is given.
Mesh crea_maillage(const Mesh& mesh, const Keywords& keywords);

}  // namespace lacon
