#pragma once
// States of integration points that other processes keep (solid_parts.hpp).
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "lacon/assembly/element_sets.hpp"

namespace lacon {

class SolidParts;

/// Values at the integration points that can be asked for, and given.
enum class PointQuantity { stress, variable };

/// Numbers that a cell of a set has.
inline std::size_t width_of(const ElementSet& set, PointQuantity quantity) {
  return quantity == PointQuantity::stress ? set.n_stress() : set.n_variables();
}

/// Some cells of a solid set, one behind the other.
struct CellRange {
  std::size_t first = 0, count = 0;
};

/// A state that the processes keep as long as this is there.
class KeptPoints {
 public:
  KeptPoints(std::shared_ptr<const SolidParts> parts, std::int64_t number) : parts_(std::move(parts)), number_(number) {}
  ~KeptPoints();
  KeptPoints(const KeptPoints&) = delete;
  KeptPoints& operator=(const KeptPoints&) = delete;

  std::int64_t number() const { return number_; }
  std::size_t n_sets() const;
  std::size_t n_cells(std::size_t set) const;
  /// Numbers of a quantity that a cell of a set has.
  std::size_t width(std::size_t set, PointQuantity quantity) const;
  /// Of all cells of a set. Throws SOLVER_8.
  std::vector<double> values(std::size_t set, PointQuantity quantity) const;
  /// Of some cells of each set. Throws likewise.
  std::vector<std::vector<double>> values(PointQuantity quantity, std::span<const CellRange> cells) const;

 private:
  std::shared_ptr<const SolidParts> parts_;
  std::int64_t number_;
};
using KeptState = std::shared_ptr<const KeptPoints>;

}  // namespace lacon
