#pragma once
// Solutions refined beyond the digits of a double: what is left of them does not depend any more on the order in which a factor
// was summed up, so that they are the same bits whichever that was.
#include <span>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// Numbers in two parts, the second one smaller than the round-off of the first.
class TwiceTheDigits {
 public:
  explicit TwiceTheDigits(std::size_t n) : high_(n, 0.0), low_(n, 0.0) {}
  void add(std::span<const double> x);
  /// b - A x, of which each product and sum has all its digits.
  std::vector<double> residual(const SparseMatrix& matrix, std::span<const double> right_side) const;
  /// The nearest multiples of numbers; 0 of none.
  void round(std::span<double> x, std::span<const double> multiple) const;
  const std::vector<double>& leading() const { return high_; }

 private:
  std::vector<double> high_, low_;
};

}  // namespace lacon
