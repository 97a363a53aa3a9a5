#pragma once
// Parts of an elimination that do not wait for each other: subtrees of the elimination tree, each for one process. What is
// above them is the top.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

struct Subtrees {
  std::vector<std::int32_t> of;  ///< subtree of each equation; -1: of the top
  std::vector<int> process;      ///< of each subtree
  double flops = 0;              ///< of the whole elimination, about
  double entries = 0;            ///< of its factor
  double longest = 0;            ///< of them, those that one process after the other has to do: its subtrees, and the top
};

/// Those with which the work ends first, when each process takes its own and the top comes behind them. Flops are those of
/// symmetric fronts without pivoting: they compare, no more.
/// @param order place of each equation in the order of elimination; equations of a vertex stand together
Subtrees independent_subtrees(const VertexGraph& graph, std::span<const std::int32_t> order, int n_processes);

}  // namespace lacon
