#pragma once
// Meshes and fields as text that a user reads.
#include <iosfwd>

#include "lacon/structures/field.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Counts of a mesh: nodes, cells by type, groups with their sizes. `full` adds the box around the mesh.
void list_mesh(std::ostream& out, const Mesh& mesh, bool full);

}  // namespace lacon
