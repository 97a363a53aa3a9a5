#pragma once
// The order of elimination: METIS on the graph of vertices.
#include <cstdint>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// Place of each equation in the order of elimination, 0-based, (n_equations).
///
/// Nested dissection of the vertex graph; a multiplier is moved behind the last of its neighbours that are nodes, so that its
/// zero diagonal is filled before it becomes a pivot.
std::vector<std::int32_t> elimination_order(const VertexGraph& graph);

}  // namespace lacon
