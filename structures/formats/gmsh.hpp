#pragma once
// Meshes in gmsh's .msh files: versions 1 (ASCII), 2, 4.0 and 4.1, ASCII and binary.
#include <filesystem>
#include <string>

#include "lacon/structures/field.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Read a mesh from a .msh file. README.md beside says what becomes of physical groups. Cells are numbered by type in the order
/// of CellType, in file order within a type; nodes in file order. A mesh without 3D cells and with z = 0 everywhere is 2D.
/// Throws MED_1 (the file cannot be read), GMSH_1 (not a .msh file), GMSH_2 (version), GMSH_3 (damaged), GMSH_4 (a type of cell
/// that no element uses), GMSH_5 (a cell names a node that is not there), GMSH_6 (partitioned).
Mesh read_gmsh_mesh(const std::filesystem::path& file);

/// The text of a .msh file of version 2.2: groups of cells are physical groups, groups of nodes are not written.
std::string gmsh_mesh_text(const Mesh& mesh);

/// Whether a text of that version has the nodes and cells of this mesh under the same numbers, so that fields may come behind
/// it; groups do not matter.
bool is_gmsh_text_of(const std::string& text, const Mesh& mesh);

/// What views of a field are called behind this text: `name`, or `<name>_2`, and so on, where a field of another owner has it,
/// which FORMAT_2 tells. A comment in the text keeps whose the name is.
std::string gmsh_view_name(std::string& text, const std::string& name, const std::string& owner,
                           const std::filesystem::path& file);

/// Sections to put behind that text: a view of the vector DX, DY, DZ where there is one, and of each other component,
/// `<name>_<component>`. Values at integration points become their mean in the cell, `<name>_<component>_MEAN`.
std::string gmsh_field_text(const Mesh& mesh, const Field& field, const std::string& name);

}  // namespace lacon
