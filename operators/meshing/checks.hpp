#pragma once
// Checks of a mesh as it comes from a file.
#include <cstdint>
#include <string>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Reverse the body cells (of the mesh's dimension) whose Jacobian is negative, with the catalogue's mirror order; skins keep
/// theirs, whatever it is. Informs LIRE_1 of their number; throws LIRE_2 where the Jacobian changes sign inside a cell.
/// @return the cells that were reversed
std::vector<std::int32_t> orient_body_cells(Mesh& mesh);

/// The same by the sign at the centre alone, for who does not compute with the cells: a cell whose Jacobian changes sign inside
/// is no error.
void turn_body_cells(Mesh& mesh);

/// The groups that a cell is in, for messages: "BODY, ALL"; empty for none.
std::string groups_with(const Mesh& mesh, std::int32_t cell);

/// Refuse places and sizes whose volumes, or the squares of these, no number holds: a node beyond 1e50 from the origin or at no
/// number (LIRE_8), a mesh smaller than 1e-50 (LIRE_9).
void check_places(const Mesh& mesh);

/// What VERI_MAIL looks at, each told once with LIRE_3 to LIRE_6: nodes of no cell, cells with the same nodes, flat cells,
/// whose least distance between two vertices is under `flatness` times the greatest, a place far from the origin.
void inspect(const Mesh& mesh, double flatness);

}  // namespace lacon
