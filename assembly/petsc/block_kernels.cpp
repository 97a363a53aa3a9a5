#include "lacon/assembly/petsc/block_kernels.hpp"

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "lacon/assembly/petsc/registers.hpp"

namespace lacon {
namespace {

/// A column of a block in a register; what is behind it there counts for nothing. Sums are made in double precision: a product
/// is linear to the last digits then, and a preconditioner as well.
template <int rows>
using Column = std::conditional_t<rows <= 4, FourDoubles, EightDoubles>;

/// Blocks come one after the other, and processors do not read ahead far enough by themselves: products of 30 MB take half the
/// time with this.
template <class Real>
LACON_INLINE void read_ahead(const Real* block) {
  constexpr std::uintptr_t bytes = 4096;
  __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(block) + bytes));
}

/// Where a product is to be added.
enum class Start { zero, there };

template <class Real, int rows, int columns, Start start>
LACON_INLINE void product(const BlockEntries<Real>& a, const double* x, double* y) {
  using Lanes = Column<rows>;
  const std::size_t n = a.offset.size() - 1;
  const std::int32_t* const offset = a.offset.data();
  const std::int32_t* const column = a.column.data();
  const Real* value = a.value.data();
  for (std::size_t i = 0; i < n; ++i) {
    Lanes sum[columns] = {};
    for (std::int32_t k = offset[i]; k < offset[i + 1]; ++k, value += rows * columns) {
      const double* const from = x + static_cast<std::ptrdiff_t>(column[k]) * columns;
      read_ahead(value);
      for (int c = 0; c < columns; ++c) {
        Lanes entries;
        load(value + c * rows, entries);
        sum[c] += entries * from[c];
      }
    }
    for (int c = 1; c < columns; ++c) sum[0] += sum[c];
    double* const to = y + i * rows;
    for (int r = 0; r < rows; ++r) to[r] = sum[0][r] + (start == Start::there ? to[r] : 0);
  }
}

template <class Real, int rows, int columns>
LACON_INLINE void transposed(const BlockEntries<Real>& a, const double* x, double* y) {
  const std::size_t n = a.offset.size() - 1;
  const Real* value = a.value.data();
  for (std::size_t i = 0; i < n; ++i) {
    const double* const from = x + i * rows;
    for (std::int32_t k = a.offset[i]; k < a.offset[i + 1]; ++k, value += rows * columns) {
      read_ahead(value);
      double* const to = y + static_cast<std::ptrdiff_t>(a.column[k]) * columns;
      for (int c = 0; c < columns; ++c) {
        double sum = 0;
        for (int r = 0; r < rows; ++r) sum += static_cast<double>(value[c * rows + r]) * from[r];
        to[c] += sum;
      }
    }
  }
}

/// What is left out of a symmetric matrix is what is there, transposed: y of the column gets its part with that of the row. The
/// first block of a row is that of the diagonal.
template <class Real, int size>
LACON_INLINE void half_product(const BlockEntries<Real>& a, const double* x, double* y) {
  using Lanes = FourDoubles;
  static_assert(sizeof(Lanes) == padded_size * sizeof(double));
  const std::size_t n = a.offset.size() - 1;
  const std::int32_t* const offset = a.offset.data();
  const std::int32_t* const column = a.column.data();
  const Real* value = a.value.data();
  for (std::size_t i = 0; i < n; ++i) {
    const double* const of_row = x + i * padded_size;
    Lanes sum[size], factor[size], row, of_column;
    load(of_row, of_column);
    for (int r = 0; r < size; ++r) {
      load(value + r * size, row);
      sum[r] = row * of_column;
      factor[r] = Lanes{} + of_row[r];
    }
    value += size * size;
    for (std::int32_t k = offset[i] + 1; k < offset[i + 1]; ++k, value += size * size) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(column[k]) * padded_size;
      read_ahead(value);
      Lanes transposed;
      load(x + at, of_column);
      load(y + at, transposed);
      for (int r = 0; r < size; ++r) {
        load(value + r * size, row);
        sum[r] += row * of_column;
        transposed += row * factor[r];
      }
      std::memcpy(y + at, &transposed, sizeof transposed);
    }
    double* const to = y + i * padded_size;
    for (int r = 0; r < size; ++r) {
      double all = 0;
      for (int c = 0; c < size; ++c) all += sum[r][c];
      to[r] += all;
    }
  }
}

#define BLOCK_KERNELS(Real, rows, columns)                                                                            \
  LACON_KERNEL void Real##_##rows##_##columns(const BlockEntries<Real>& a, const double* x, double* y) {              \
    product<Real, rows, columns, Start::zero>(a, x, y);                                                               \
  }                                                                                                                   \
  LACON_KERNEL void Real##_##rows##_##columns##_add(const BlockEntries<Real>& a, const double* x, double* y) {        \
    product<Real, rows, columns, Start::there>(a, x, y);                                                              \
  }                                                                                                                   \
  LACON_KERNEL void Real##_##rows##_##columns##_transposed(const BlockEntries<Real>& a, const double* x, double* y) { \
    transposed<Real, rows, columns>(a, x, y);                                                                         \
  }
#define HALF_KERNEL(Real, size)                                                                   \
  LACON_KERNEL void Real##_half_##size(const BlockEntries<Real>& a, const double* x, double* y) { \
    half_product<Real, size>(a, x, y);                                                            \
  }
#define ROW_OF_KERNELS(Real, rows, columns, half) \
  { rows, columns, Real##_##rows##_##columns, Real##_##rows##_##columns##_add, Real##_##rows##_##columns##_transposed, half }

// displacements in the plane and in space, and rigid motions of aggregates there
BLOCK_KERNELS(float, 2, 2)
BLOCK_KERNELS(float, 2, 3)
BLOCK_KERNELS(float, 3, 3)
BLOCK_KERNELS(float, 3, 6)
BLOCK_KERNELS(float, 6, 6)
BLOCK_KERNELS(double, 2, 2)
BLOCK_KERNELS(double, 3, 3)
HALF_KERNEL(float, 2)
HALF_KERNEL(float, 3)
HALF_KERNEL(double, 2)
HALF_KERNEL(double, 3)

constexpr BlockKernels<float> of_single[] = {ROW_OF_KERNELS(float, 2, 2, float_half_2), ROW_OF_KERNELS(float, 2, 3, nullptr),
                                             ROW_OF_KERNELS(float, 3, 3, float_half_3), ROW_OF_KERNELS(float, 3, 6, nullptr),
                                             ROW_OF_KERNELS(float, 6, 6, nullptr)};
constexpr BlockKernels<double> of_double[] = {ROW_OF_KERNELS(double, 2, 2, double_half_2),
                                              ROW_OF_KERNELS(double, 3, 3, double_half_3)};

template <class Kernels>
auto found(const Kernels& kernels, int rows, int columns) -> decltype(&kernels[0]) {
  for (const auto& kernel : kernels)
    if (kernel.rows == rows && kernel.columns == columns) return &kernel;
  return nullptr;
}

}  // namespace

const BlockKernels<float>* single_kernels(int rows, int columns) { return found(of_single, rows, columns); }
const BlockKernels<double>* double_kernels(int rows, int columns) { return found(of_double, rows, columns); }

}  // namespace lacon
