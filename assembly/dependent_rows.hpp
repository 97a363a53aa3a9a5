#pragma once
// Constraints that say what others say already.
#include <cstdint>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// How many of the rows from first_multiplier on are combinations of others of them: what their number is above the rank of
/// their part before first_multiplier. Rows that a diagonal alone decides (open patches) do not count. 0 where there are
/// more than `most` rows: of so many the rank would take longer than what made them.
std::int64_t count_dependent_rows(const SparseMatrix& matrix, std::int64_t first_multiplier, std::int64_t most = 5000);

}  // namespace lacon
