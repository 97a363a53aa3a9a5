#pragma once
// MODI_MAILLAGE: changes of a mesh in place.
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// TRANSLATION, ROTATION, ECHELLE, SYMETRIE (transform.hpp), or ORIE_PEAU: every group of every occurrence; prints how many
/// cells were turned. Errors: MESH_1, MESH_2 (unknown, empty group) and those of operators/meshing/orientation.hpp.
void modi_maillage(Mesh& mesh, const Keywords& keywords);

}  // namespace lacon
