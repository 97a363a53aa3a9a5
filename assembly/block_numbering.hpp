#pragma once
// How equations stand in a BlockSystem: nodes in blocks, those of one process behind each other.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/assembly/numbering.hpp"

namespace lacon {

struct BlockNumbering {
  int dimension = 3;
  std::vector<std::int32_t> place;        ///< of each equation: row among the displacements; -1 - k: multiplier k
  std::vector<std::int32_t> node;         ///< of each block
  std::vector<std::int64_t> first_block;  ///< of each process, and behind the last one (n_parts + 1)
  std::int64_t n_multipliers = 0;

  /// Equal runs of nodes. Equations of unknowns behind the displacements are multipliers here.
  BlockNumbering(const Numbering& numbering, int dimension, int n_parts);
  /// @param part of each node
  BlockNumbering(const Numbering& numbering, int dimension, int n_parts, std::span<const std::int32_t> part);
};

}  // namespace lacon
