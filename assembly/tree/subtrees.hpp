#pragma once
// What an elimination takes, and its parts that do not wait for each other: subtrees of the elimination tree, each for one
// process. What is above them is the top.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// Flops are those of symmetric fronts without pivoting: they compare, no more.
struct EliminationCounts {
  double flops = 0;
  double entries = 0;  ///< of the factor
};
/// @param order place of each equation in the order of elimination; equations of a vertex stand together
EliminationCounts elimination_counts(const VertexGraph& graph, std::span<const std::int32_t> order);

struct Subtrees {
  std::vector<std::int32_t> of;  ///< subtree of each equation; -1: of the top
  std::vector<int> process;      ///< of each subtree
  EliminationCounts whole;       ///< of the elimination
  double longest = 0;            ///< flops that one process after the other has to do: of its subtrees, and of the top
};

/// Those with which the work ends first, when each process takes its own and the top comes behind them.
/// @param order as in elimination_counts()
Subtrees independent_subtrees(const VertexGraph& graph, std::span<const std::int32_t> order, int n_processes);

}  // namespace lacon
