#pragma once
// Meshes and fields in MED files (HDF5), read and written without libmed. README.md beside says what is where.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Names of the meshes of a MED file, sorted. Throws MED_1 (no such file), MED_2 (not MED), MED_3 (version).
std::vector<std::string> med_mesh_names(const std::filesystem::path& file);

/// Read a mesh of a MED file of version 3.0 to 4.1: the one of this name, or the first where `name` is empty.
/// Cells are numbered by type in the order of CellType, in file order within a type; nodes in file order. A group is the union
/// of the families that name it. A mesh whose file says 3 coordinates, but which has no 3D cell and z = 0 everywhere, is 2D.
/// Throws MED_1 to MED_10.
Mesh read_med_mesh(const std::filesystem::path& file, std::string_view name = {});

}  // namespace lacon
