#pragma once
// Nodal normals (LISSAGE) as functions of the nodes around: what derivatives of gaps by them become by nodes.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/operators/contact/variation/gap_variation.hpp"
#include "lacon/pairing/surface.hpp"

namespace lacon {

class NormalVariation {
 public:
  NormalVariation() = default;
  /// Which cells meet at which node of a skin.
  explicit NormalVariation(const Surface& skin);

  /// Append the nodes on which the normals of some nodes depend, but for those that are there.
  void append_nodes_around(const Surface& skin, std::span<const std::int32_t> nodes, std::vector<std::int32_t>& all) const;

  /// From derivatives by the coordinates of `nodes` and, behind them, by the normals of the first n_normals of these, to
  /// derivatives by the coordinates of `all`.
  /// @param skin at the present geometry  @param[in,out] variation (nodes and normals, dimension), then (all, dimension)
  void apply(const Surface& skin, std::span<const std::int32_t> nodes, int n_normals, std::span<const std::int32_t> all,
             GapVariation& variation) const;

 private:
  struct Corner {
    std::int32_t cell, place;  ///< of the skin; of the node in the cell
  };
  template <int D>
  void apply_in(const Surface& skin, std::span<const std::int32_t> nodes, int n_normals, std::span<const std::int32_t> all,
                GapVariation& variation) const;

  std::vector<std::int32_t> first_;  ///< of each node, in corners_
  std::vector<Corner> corners_;
};

}  // namespace lacon
