#pragma once
// What DECOUPE_LAC and refinement share: sub-cells that stand in the place of a cell.
#include <array>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Nodes of a cell and those that a cut adds to it: few (the catalogue numbers them by bytes), and needed for very many cells,
/// so that they have no memory of their own.
class CellNodes {
 public:
  CellNodes() {}
  explicit CellNodes(std::span<const std::int32_t> nodes) { append(nodes); }
  void push_back(std::int32_t node) { nodes_.at(size_++) = node; }
  void append(std::span<const std::int32_t> nodes) {
    for (const std::int32_t node : nodes) push_back(node);
  }
  std::size_t size() const { return size_; }
  std::int32_t operator[](std::size_t i) const { return nodes_[i]; }
  std::int32_t* begin() { return nodes_.data(); }
  std::int32_t* end() { return nodes_.data() + size_; }
  const std::int32_t* begin() const { return nodes_.data(); }
  const std::int32_t* end() const { return nodes_.data() + size_; }
  operator std::span<const std::int32_t>() const { return {nodes_.data(), size_}; }

 private:
  std::array<std::int32_t, 128> nodes_;
  std::size_t size_ = 0;
};

/// The image of a reference point of a cell (isoparametric, METHOD.md 1.2-3). @param coordinates (n, 3)
std::array<double, 3> image(CellType type, std::span<const std::int32_t> nodes, std::span<const double> xi,
                            std::span<const double> coordinates);

/// These of the nodes.
CellNodes pick(std::span<const std::int32_t> from, std::span<const std::int8_t> which);

/// Which cells of the new mesh have taken the place of a cell of the old one, where some cells were replaced by several.
class Heirs {
 public:
  /// A cell behind all that were entered before is replaced by `count` cells, one at least.
  void enter(std::int32_t cell, std::int32_t count) {
    replaced_.push_back(cell);
    shift_.push_back(shift_.back() + count - 1);
  }
  struct Range {
    std::int32_t first, count;
  };
  Range of(std::int32_t cell) const;
  /// Put into groups of cells, in place of each cell, what replaces it.
  void inherit(std::span<Group> groups) const;

 private:
  /// The cells between two replaced ones, with the second of these at the end.
  struct Gap {
    std::size_t index;        ///< of its end in `replaced_`; its size: behind them all
    std::int32_t below, end;  ///< replaced cells
    bool has_inside(std::int32_t cell) const { return below < cell && cell < end; }
  };
  /// @param guess index of the gap that is looked at first
  Gap gap_of(std::int32_t cell, std::size_t guess) const;
  std::int32_t added_at_end(const Gap& gap) const { return shift_[gap.index + 1] - shift_[gap.index]; }

  std::vector<std::int32_t> replaced_;  ///< ascending
  std::vector<std::int32_t> shift_{0};  ///< of the numbers in each gap
};

}  // namespace lacon
