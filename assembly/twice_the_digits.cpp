#include "lacon/assembly/twice_the_digits.hpp"

#include <cmath>

namespace lacon {
namespace {

/// A sum and what rounding took from it (Knuth).
struct Sum {
  double value, error;
  Sum(double a, double b) : value(a + b) {
    const double part = value - a;
    error = (a - (value - part)) + (b - part);
  }
};

}  // namespace

void TwiceTheDigits::add(std::span<const double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Sum sum(high_[i], x[i]), whole(sum.value, sum.error + low_[i]);
    high_[i] = whole.value;
    low_[i] = whole.error;
  }
}

std::vector<double> TwiceTheDigits::residual(const SparseMatrix& matrix, std::span<const double> right_side) const {
  std::vector<double> left(right_side.begin(), right_side.end()), rest(left.size(), 0.0);
  const auto subtract = [&](std::int64_t row, double value, std::int64_t column) {
    const double product = value * high_[column], error = std::fma(value, high_[column], -product);
    const Sum sum(left[row], -product);
    left[row] = sum.value;
    rest[row] += sum.error - error - value * low_[column];
  };
  for (std::int64_t row = 0; row < matrix.size(); ++row)
    for (std::int64_t k = matrix.rows()[row]; k < matrix.rows()[row + 1]; ++k) {
      const std::int64_t column = matrix.columns()[k];
      subtract(row, matrix.values()[k], column);
      if (matrix.is_symmetric() && column != row) subtract(column, matrix.values()[k], row);
    }
  for (std::size_t i = 0; i < left.size(); ++i) left[i] += rest[i];
  return left;
}

void TwiceTheDigits::round(std::span<double> x, std::span<const double> multiple) const {
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = multiple[i] > 0 ? multiple[i] * std::nearbyint(high_[i] / multiple[i]) + 0.0 : 0.0;  // no -0
}

}  // namespace lacon
