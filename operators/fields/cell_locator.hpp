#pragma once
// Which cell a point of space lies in, and where: the inverse of the isoparametric map.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacon/pairing/box_tree.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// A point as the cell's shape functions see it.
struct PointInCell {
  std::int32_t cell = -1;
  std::vector<double> weights;  ///< of the cell's nodes: a nodal field's value is their combination
  double distance = 0;          ///< from the point to where the weights put it; 0 inside, to round-off
  bool outside = false;         ///< no cell holds the point: the nearest one
};

/// Finds points in cells of the mesh's dimension, straight or curved. Refers to the mesh.
class CellLocator {
 public:
  /// @param cells the cells that are searched; those of another dimension are left out
  CellLocator(const Mesh& mesh, std::span<const std::int32_t> cells);

  /// The first cell that holds the point. Where none does, the cell that has the point nearest in space to it, by
  /// `distance_max` at most (without it by `near` of that cell's diagonal), and the weights there.
  std::optional<PointInCell> find(const std::array<double, 3>& point, std::optional<double> distance_max) const;

  static constexpr double near = 0.1;     ///< code_aster's limit beyond which it warns
  static constexpr double margin = 1e-8;  ///< in reference coordinates: inside, but for round-off

 private:
  /// The weights of a cell's nodes at a point, by Newton's method; empty where it finds none, or none in the cell.
  std::optional<PointInCell> within(std::int32_t cell, const std::array<double, 3>& point) const;
  std::optional<PointInCell> nearest(const std::array<double, 3>& point, std::optional<double> distance_max) const;

  const Mesh& mesh_;
  std::vector<std::int32_t> cells_;
  std::vector<double> size_;  ///< diagonal of each cell's box
  double largest_ = 0;
  std::optional<BoxTree<3>> tree_;
};

}  // namespace lacon
