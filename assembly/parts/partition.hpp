#pragma once
// Which process has which cells, and which nodes: METIS on the cells and their common faces.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

struct Partition {
  int n_parts = 1;
  std::vector<std::int32_t> of_cell;  ///< of each cell that was asked for
  std::vector<std::int32_t> of_node;  ///< (n_nodes): that of most of its cells, the lowest of several; 0 of none
};

/// Parts of about the same weight and with few common nodes; the same in every run. Cells that bear the slave cells of one
/// patch stay together. A part is not heavier than its share by more than 5 % and the heaviest such group, where METIS
/// finds that.
/// @param cells of the mesh, of its dimension  @param weight of each, at least 1
Partition partition(const Mesh& mesh, std::span<const std::int32_t> cells, std::span<const std::int32_t> weight, int n_parts);

}  // namespace lacon
