#pragma once
// Products with a sparse matrix in whole blocks.
#include <cstdint>
#include <vector>

namespace lacon {

template <class Real>
struct BlockEntries {
  int rows = 0, columns = 0;  ///< of a block
  /// Of a symmetric matrix: columns before that of the diagonal are left out, and those behind it are there row by row.
  bool is_half = false;
  std::vector<std::int32_t> offset{0};  ///< of rows of blocks
  std::vector<std::int32_t> column;     ///< of blocks
  std::vector<Real> value;              ///< blocks column by column, and room for a vector register behind them
};

/// Rows that a process has: columns of its own, numbered from 0, and those of others.
template <class Real>
struct SplitBlocks {
  BlockEntries<Real> own, others;
  std::vector<std::int32_t> column_of_others;  ///< which columns of blocks, among all, `others` has; ascending
};

/// y = A x, or y += A x, or y += A^T x; sums in the order of the blocks.
template <class Real>
using BlockProduct = void (*)(const BlockEntries<Real>& a, const double* x, double* y);
template <class Real>
struct BlockKernels {
  int rows = 0, columns = 0;
  BlockProduct<Real> multiply = nullptr, add = nullptr, add_transposed = nullptr;
  /// Of half a symmetric matrix, whose blocks are square; null where they are not. A block of x and y has `padded_size` values
  /// there, of which the last ones are 0 in x and of no use in y.
  BlockProduct<Real> add_half = nullptr;
};
/// Null where there are none for blocks of this size.
const BlockKernels<float>* single_kernels(int rows, int columns);
const BlockKernels<double>* double_kernels(int rows, int columns);

/// So that one register is loaded and stored for each block, and no store overlaps the next one.
constexpr int padded_size = 4;
/// Values behind the last block that a kernel may read.
constexpr int read_behind = 8;

}  // namespace lacon
