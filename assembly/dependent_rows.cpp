#include "lacon/assembly/dependent_rows.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>
#include <cmath>
#include <vector>

namespace lacon {

std::int64_t count_dependent_rows(const SparseMatrix& matrix, std::int64_t first_multiplier, std::int64_t most) {
  if (matrix.size() - first_multiplier > most) return 0;
  std::vector<Eigen::Triplet<double>> entries;  // of a column for each row, of length 1: sizes of rows have nothing to say
  int n_rows = 0;
  for (std::int64_t row = first_multiplier; row < matrix.size(); ++row) {
    const auto values = matrix.row_values(row);
    const std::size_t begin = entries.size();
    double squares = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::int32_t column = matrix.columns()[matrix.rows()[row] + static_cast<std::int64_t>(k)];
      if (column >= first_multiplier || values[k] == 0) continue;
      entries.emplace_back(column, n_rows, values[k]);
      squares += values[k] * values[k];
    }
    if (squares == 0) continue;
    for (std::size_t k = begin; k < entries.size(); ++k)
      entries[k] = {entries[k].row(), entries[k].col(), entries[k].value() / std::sqrt(squares)};
    ++n_rows;
  }
  if (n_rows < 2) return 0;
  Eigen::SparseMatrix<double> columns(static_cast<int>(first_multiplier), n_rows);
  columns.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseQR<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> qr;
  qr.setPivotThreshold(1e-10);
  qr.compute(columns);
  return qr.info() == Eigen::Success ? n_rows - qr.rank() : 0;
}

}  // namespace lacon
