#include "lacon/assembly/block_numbering.hpp"

#include <algorithm>

namespace lacon {

BlockNumbering::BlockNumbering(const Numbering& numbering, int space, int n_parts)
    : BlockNumbering(numbering, space, 1, std::vector<std::int32_t>(static_cast<std::size_t>(numbering.n_nodes), 0)) {
  const auto n_blocks = std::ssize(node);
  first_block.clear();
  for (int part = 0; part <= n_parts; ++part) first_block.push_back(n_blocks * part / n_parts);
}

BlockNumbering::BlockNumbering(const Numbering& numbering, int space, int n_parts, std::span<const std::int32_t> part)
    : dimension(space), place(static_cast<std::size_t>(numbering.n_equations()), -1), first_block{0} {
  for (int p = 0; p < n_parts; ++p) {
    for (std::int64_t n = 0; n < numbering.n_nodes; ++n) {
      if (part[static_cast<std::size_t>(n)] != p) continue;
      bool is_free = false;
      for (int i = 0; i < dimension; ++i)
        if (const std::int64_t e = numbering.of(n, i); e >= 0) {
          is_free = true;
          place[e] = static_cast<std::int32_t>(static_cast<int>(node.size()) * dimension + i);
        }
      if (is_free) node.push_back(static_cast<std::int32_t>(n));
    }
    first_block.push_back(std::ssize(node));
  }
  for (std::int32_t& at : place)
    if (at < 0) at = static_cast<std::int32_t>(-1 - n_multipliers++);
}

}  // namespace lacon
