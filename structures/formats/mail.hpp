#pragma once
// Meshes in code_aster's own text files (.mail), read and written.
#include <filesystem>
#include <string>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Read a mesh from a .mail file. Nodes and cells by the numbers of their names, where these are N1, N2, ... (NO1, ...) and M1,
/// M2, ... (MA1, ...) in some order; otherwise in file order, and what has another name is also a group of this name, of one
/// member (MAIL_5), unless there are too many such names (alarm MAIL_4). COOR_2D makes a mesh of the plane, COOR_3D as
/// least_dimension() says. Throws MED_1 (the file cannot be read), MAIL_1 (damaged, with the line), MAIL_2 (a type of cell that
/// no element uses), MAIL_3 (a cell or a group names what is not there).
Mesh read_mail_mesh(const std::filesystem::path& file);

/// The text of a .mail file of a mesh, with the names N1, N2, ... and M1, M2, ...; in names of groups, which are
/// one word there, '_' stands for blanks, '%' and '='; what two of them would share, and FINSF, gets `_2`. MAIL_6 tells what
/// has another name there. @param title one line
std::string mail_text(const Mesh& mesh, const std::string& title);

}  // namespace lacon
