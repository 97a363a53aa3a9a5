#pragma once
// Whole rows of a matrix of which half may be stored.
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "lacon/assembly/petsc/aggregates.hpp"
#include "lacon/assembly/petsc/block_kernels.hpp"
#include "lacon/elements/lanes.hpp"

namespace lacon {

/// Own rows of a matrix, of which half may be stored, and where their blocks are.
class WholeRows {
 public:
  explicit WholeRows(const BlockEntries<double>& own) : own_(own) {
    const auto n = static_cast<std::int32_t>(own.offset.size() - 1);
    std::vector<std::int64_t>& offset = graph_.offset;
    offset.assign(n + 1, 0);
    for_each_block([&](std::int32_t i, std::int32_t, std::int32_t) { ++offset[i + 1]; });
    std::partial_sum(offset.begin(), offset.end(), offset.begin());
    graph_.node.resize(offset.back());
    block_.resize(offset.back());
    std::vector<std::int64_t> next(offset.begin(), offset.end() - 1);
    for_each_block([&](std::int32_t i, std::int32_t j, std::int32_t block) {
      graph_.node[next[i]] = j;
      block_[next[i]++] = block;
    });
  }
  std::int64_t n() const { return std::ssize(graph_.offset) - 1; }
  /// Nodes whose blocks are links. @param is_link  of each stored block
  NodeGraph graph(std::span<const std::uint8_t> is_link) const {
    NodeGraph links;
    links.offset.reserve(n() + 1), links.node.reserve(graph_.node.size());
    for (std::int64_t i = 0; i < n(); ++i) {
      for (std::int64_t k = graph_.offset[i]; k < graph_.offset[i + 1]; ++k)
        if (is_link[block_[k] < 0 ? ~block_[k] : block_[k]]) links.node.push_back(graph_.node[k]);
      links.offset.push_back(std::ssize(links.node));
    }
    return links;
  }
  /// @param use  gets the other node and the block of its displacements: (dim, dim), column by column
  template <int dim, class Use>
  LACON_INLINE void for_each_in_row(std::int64_t i, const Use& use) const {
    for (std::int64_t k = graph_.offset[i]; k < graph_.offset[i + 1]; ++k) {
      const std::int32_t at = block_[k];
      const double* const value = own_.value.data() + static_cast<std::int64_t>(at < 0 ? ~at : at) * dim * dim;
      double block[dim * dim];
      for (int c = 0; c < dim; ++c)
        for (int r = 0; r < dim; ++r) block[c * dim + r] = at < 0 ? value[r * dim + c] : value[c * dim + r];
      use(graph_.node[k], block);
    }
  }

 private:
  /// Rows, columns, and blocks; of those that are there row by row the complement.
  template <class Use>
  void for_each_block(const Use& use) const {
    const auto n = static_cast<std::int32_t>(own_.offset.size() - 1);
    for (std::int32_t i = 0; i < n; ++i)
      for (std::int32_t k = own_.offset[i]; k < own_.offset[i + 1]; ++k) {
        const std::int32_t j = own_.column[k];
        use(i, j, own_.is_half ? ~k : k);
        if (own_.is_half && j != i) use(j, i, k);
      }
  }

  const BlockEntries<double>& own_;
  NodeGraph graph_;
  std::vector<std::int32_t> block_;
};

}  // namespace lacon
