#pragma once
// States of integration points that other processes keep (solid_parts.hpp).
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "lacon/assembly/point_values.hpp"

namespace lacon {

class SolidParts;

/// Some cells of a solid set, one behind the other.
struct CellRange {
  std::size_t first = 0, count = 0;
};

/// Which quantities the points of each set hold.
using Holdings = std::vector<std::array<bool, point_quantities.size()>>;

/// A state that the processes keep as long as this is there.
class KeptPoints {
 public:
  KeptPoints(std::shared_ptr<const SolidParts> parts, std::int64_t number, Holdings holdings)
      : parts_(std::move(parts)), number_(number), holdings_(std::move(holdings)) {}
  ~KeptPoints();
  KeptPoints(const KeptPoints&) = delete;
  KeptPoints& operator=(const KeptPoints&) = delete;

  std::int64_t number() const { return number_; }
  std::size_t n_sets() const;
  std::size_t n_cells(std::size_t set) const;
  const Holdings& holdings() const { return holdings_; }
  bool holds(std::size_t set, PointQuantity quantity) const { return holdings_[set][static_cast<std::size_t>(quantity)]; }
  /// Numbers of a quantity that a cell of a set has.
  std::size_t width(std::size_t set, PointQuantity quantity) const;
  /// Of all cells of a set. Throws SOLVER_8.
  std::vector<double> values(std::size_t set, PointQuantity quantity) const;
  /// Of some cells of each set. Throws likewise.
  std::vector<std::vector<double>> values(PointQuantity quantity, std::span<const CellRange> cells) const;

 private:
  std::shared_ptr<const SolidParts> parts_;
  std::int64_t number_;
  Holdings holdings_;
};
using KeptState = std::shared_ptr<const KeptPoints>;

}  // namespace lacon
