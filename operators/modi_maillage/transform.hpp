#pragma once
// TRANSLATION, ROTATION, ECHELLE and SYMETRIE of MODI_MAILLAGE: nodes that move together.
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// Move the nodes as the one of these keywords that is there says; false where there is none. A mirror also turns every cell
/// inside out, so that volumes stay positive and skins outward, and patches with their sub-cells. A mesh without volumes that
/// ends in the plane z = 0 is one of the plane from then on, until vectors of three numbers move it out again. Throws
/// KEYWORD_18 (vectors of another dimension than the mesh's, directions that are zero or parallel).
bool transform(Mesh& mesh, const Keywords& keywords);

}  // namespace lacon
