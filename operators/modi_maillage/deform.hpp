#pragma once
// DEFORME of MODI_MAILLAGE: each node moves by a field.
#include <string>

#include "lacon/structures/base.hpp"
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The nodes move by a field of displacements on this mesh, or on another with the same nodes at the same places (COPIER). The
/// mesh knows from then on that they are not where they were (Mesh::first_place), until another field has brought them back.
/// Throws CREACHAMP_5 (another mesh), CREACHAMP_9 (no displacements).
void deform(Mesh& mesh, const Keywords& factor, const Base& base, const std::string& mesh_id);

}  // namespace lacon
