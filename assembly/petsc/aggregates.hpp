#pragma once
// Nodes put together, so that each aggregate becomes one node of a coarser level (Vanek, Mandel, Brezina, "Algebraic multigrid
// by smoothed aggregation for second and fourth order elliptic problems", 1996, algorithm 5.1).
#include <cstdint>
#include <span>
#include <vector>

namespace lacon {

/// Which nodes are next to a node: `node[offset[i]]` to `node[offset[i + 1] - 1]`.
struct NodeGraph {
  std::vector<std::int64_t> offset{0};
  std::vector<std::int32_t> node;

  std::span<const std::int32_t> of(std::int64_t i) const {
    return {node.data() + offset[i], static_cast<std::size_t>(offset[i + 1] - offset[i])};
  }
};

struct Aggregates {
  std::int32_t count = 0;
  std::vector<std::int32_t> of_node;  ///< from 0; -1: in none
};

/// A node with all next to it makes an aggregate where none of them is in one yet; what is left joins the aggregate that most
/// nodes next to it are in, or makes one with others that are left.
/// @param takes_part  of each node: 0 where it stays in none
Aggregates aggregated(const NodeGraph& graph, std::span<const std::uint8_t> takes_part);

}  // namespace lacon
