#pragma once
// Rows of multipliers in a symmetric matrix.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// The part of a multiplier's row before its diagonal, and the diagonal; of a symmetric matrix.
struct MultiplierRow {
  std::span<const std::int32_t> columns;
  std::span<const double> values;
  double diagonal;

  MultiplierRow(const SparseMatrix& matrix, std::int64_t row) : diagonal(matrix.diagonal(row)) {
    const std::int64_t first = matrix.rows()[row], size = matrix.rows()[row + 1] - first - 1;
    columns = matrix.columns().subspan(first, size);
    values = matrix.values().subspan(first, size);
  }
  bool is_on() const {
    return std::any_of(values.begin(), values.end(), [](double v) { return v != 0; });
  }
  bool meets_multipliers(std::int64_t first_multiplier) const {
    for (std::size_t k = columns.size(); k-- > 0 && columns[k] >= first_multiplier;)
      if (values[k] != 0) return true;
    return false;
  }
};

}  // namespace lacon
