#pragma once
// States of integration points that other processes keep (solid_parts.hpp).
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace lacon {

class SolidParts;

/// Values at the integration points that can be asked for, and given.
enum class PointQuantity { stress, variable };

/// A state that the processes keep as long as this is there.
class KeptPoints {
 public:
  KeptPoints(std::shared_ptr<const SolidParts> parts, std::int64_t number) : parts_(std::move(parts)), number_(number) {}
  ~KeptPoints();
  KeptPoints(const KeptPoints&) = delete;
  KeptPoints& operator=(const KeptPoints&) = delete;

  std::int64_t number() const { return number_; }
  std::size_t n_sets() const;
  /// Of all cells of a set. Throws SOLVER_8.
  std::vector<double> values(std::size_t set, PointQuantity quantity) const;

 private:
  std::shared_ptr<const SolidParts> parts_;
  std::int64_t number_;
};
using KeptState = std::shared_ptr<const KeptPoints>;

}  // namespace lacon
