#pragma once
// The order of elimination: METIS on the graph of vertices.
#include <cstdint>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// Two processes order a large graph in half of the time, and otherwise than one; this one must have no other threads.
enum class OrderIn { this_process, two_processes };

/// Of a large graph that two processes order: the smallest separator that is found, or the smallest of those that leave halves
/// of one size, for two that factorise them.
enum class Halves { any, even };

/// Place of each equation in the order of elimination, 0-based, (n_equations).
///
/// Nested dissection of the vertex graph; a multiplier is moved behind the last of its neighbours that are nodes, so that its
/// zero diagonal is filled before it becomes a pivot.
std::vector<std::int32_t> elimination_order(const VertexGraph& graph, OrderIn where = OrderIn::this_process,
                                            Halves halves = Halves::any);

}  // namespace lacon
