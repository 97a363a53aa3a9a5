#pragma once
#include <vector>

#include "lacon/assembly/saddle_point_solver.hpp"

namespace lacon::test {

/// All columns at once, (sides, size).
inline SolutionReport columns(SaddlePointSolver& solver, const SparseMatrix& matrix, const SparseSides& sides,
                              std::vector<float>& found) {
  found.clear();
  return solver.columns(matrix, sides,
                        [&](std::span<const float> column) { found.insert(found.end(), column.begin(), column.end()); });
}

}  // namespace lacon::test
