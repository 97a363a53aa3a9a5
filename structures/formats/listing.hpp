#pragma once
// Meshes and fields as text that a user reads.
#include <iosfwd>
#include <string_view>

#include "lacon/structures/field.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Counts of a mesh: nodes, cells by type, groups with their sizes. `full` adds the box around the mesh.
void list_mesh(std::ostream& out, const Mesh& mesh, bool full);

struct FieldListing {
  bool coordinates = false;  ///< of nodes, in a field on nodes
  bool values = true;        ///< the table
  bool least = false;        ///< the least value of each component and where it is
  bool greatest = false;
};

/// A field as a table: a row a node, cell, node of a cell or integration point, a column a component; "-" where it does not
/// exist.
/// @param title goes before it ("result U, field DEPL")
void list_field(std::ostream& out, const Mesh& mesh, const Field& field, std::string_view title, const FieldListing& what);

}  // namespace lacon
