#pragma once
// In what order slave cells are cut.
#include <span>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// A slave cell, its body cell before any cut, and the zone it belongs to.
struct Slave {
  std::int32_t cell;
  std::int32_t body;
  std::size_t zone;
};

/// Where two slave cells have one body cell, which of them is cut first changes the sub-cells. It goes by what no number, no
/// turn and no mirror changes: the larger one first, then the one farther from the middle of all slave cells. Only where those
/// are equal up to 1e-6 (what is left of a file with seven digits) the axes decide.
/// @return numbers of `slaves` in that order; those that share their body cell with none stay in their places
std::vector<std::size_t> order_of_cuts(const Mesh& mesh, std::span<const Slave> slaves);

}  // namespace lacon
