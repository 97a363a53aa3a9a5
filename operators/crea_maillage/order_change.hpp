#pragma once
// LINE_QUAD and QUAD_LINE: cells become quadratic or linear, in place.
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// These linear cells become quadratic (QUAD8, HEXA20 and so on): mid nodes half-way on straight edges, one for each edge. A
/// quadratic cell that has the edge already gives its mid node. New nodes are appended and belong to no group.
/// @return how many cells changed
std::int64_t make_quadratic(Mesh& mesh, std::span<const std::int32_t> cells);

/// These quadratic cells become linear. Mid nodes that no cell uses any more are removed (the others keep their order), also
/// from groups of nodes; a group that held nothing else goes (ORDRE_1, ORDRE_2).
/// @return how many cells changed
std::int64_t make_linear(Mesh& mesh, std::span<const std::int32_t> cells);

}  // namespace lacon
