#pragma once
// LINE_QUAD, QUAD_LINE and HEXA20_27: cells become quadratic, linear or complete, in place.
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// These linear cells become quadratic (QUAD8, HEXA20 and so on): mid nodes half-way on straight edges, one for each edge. A
/// quadratic cell that has the edge already gives its mid node. New nodes are appended and belong to no group.
/// @return how many cells changed
std::int64_t make_quadratic(Mesh& mesh, std::span<const std::int32_t> cells);

/// These quadratic cells get nodes in the middle of faces and in the centre: HEXA20 becomes HEXA27, QUAD8 becomes QUAD9. The
/// new nodes lie where the cell's own geometry has these points; a face's node is one for all cells that have the face, and a
/// cell that has it already gives it. New nodes are appended and belong to no group.
/// @return how many cells changed
std::int64_t make_complete(Mesh& mesh, std::span<const std::int32_t> cells);

/// These quadratic cells become linear. Mid nodes that no cell uses any more are removed (the others keep their order), also
/// from groups of nodes; a group that held nothing else goes (ORDRE_1, ORDRE_2).
/// @return how many cells changed
std::int64_t make_linear(Mesh& mesh, std::span<const std::int32_t> cells);

/// Inform (ORDRE_3) of edges and faces that have a node in their middle in one body or skin cell and none in another: the mesh
/// does not conform there.
void tell_what_hangs(const Mesh& mesh);

}  // namespace lacon
