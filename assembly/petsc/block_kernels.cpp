#include "lacon/assembly/petsc/block_kernels.hpp"

#include <cstddef>
#include <cstring>

#include "lacon/elements/lanes.hpp"

namespace lacon {
namespace {

/// A column of a block in a register; what is behind it there counts for nothing.
template <class Real, bool is_short>
struct Stored;
template <>
struct Stored<float, true> {
  using Lanes = float __attribute__((vector_size(16)));
};
template <>
struct Stored<float, false> {
  using Lanes = float __attribute__((vector_size(32)));
};
template <>
struct Stored<double, true> {
  using Lanes = double __attribute__((vector_size(32)));
};
/// The same in double precision, in which sums are made: a product is linear to the last digits then, and a preconditioner as
/// well.
template <bool is_short>
struct Summed {
  using Lanes = double __attribute__((vector_size(32)));
};
template <>
struct Summed<false> {
  using Lanes = double __attribute__((vector_size(64)));
};

/// Where a product is to be added.
enum class Start { zero, there };

template <class Real, int rows, int columns, Start start>
LACON_INLINE void product(const BlockEntries<Real>& a, const double* x, double* y) {
  using Lanes = typename Summed<rows <= 4>::Lanes;
  const std::size_t n = a.offset.size() - 1;
  const std::int32_t* const offset = a.offset.data();
  const std::int32_t* const column = a.column.data();
  const Real* value = a.value.data();
  for (std::size_t i = 0; i < n; ++i) {
    Lanes sum[columns] = {};
    for (std::int32_t k = offset[i]; k < offset[i + 1]; ++k, value += rows * columns) {
      const double* const from = x + static_cast<std::ptrdiff_t>(column[k]) * columns;
      for (int c = 0; c < columns; ++c) {
        typename Stored<Real, rows <= 4>::Lanes entries;
        std::memcpy(&entries, value + c * rows, sizeof entries);
        sum[c] += __builtin_convertvector(entries, Lanes) * from[c];
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
      double* const to = y + static_cast<std::ptrdiff_t>(a.column[k]) * columns;
      for (int c = 0; c < columns; ++c) {
        double sum = 0;
        for (int r = 0; r < rows; ++r) sum += static_cast<double>(value[c * rows + r]) * from[r];
        to[c] += sum;
      }
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
#define ROW_OF_KERNELS(Real, rows, columns) \
  { rows, columns, Real##_##rows##_##columns, Real##_##rows##_##columns##_add, Real##_##rows##_##columns##_transposed }

// displacements in the plane and in space, and rigid motions of aggregates there
BLOCK_KERNELS(float, 2, 2)
BLOCK_KERNELS(float, 2, 3)
BLOCK_KERNELS(float, 3, 3)
BLOCK_KERNELS(float, 3, 6)
BLOCK_KERNELS(float, 6, 6)
BLOCK_KERNELS(double, 2, 2)
BLOCK_KERNELS(double, 3, 3)

constexpr BlockKernels<float> of_single[] = {ROW_OF_KERNELS(float, 2, 2), ROW_OF_KERNELS(float, 2, 3),
                                             ROW_OF_KERNELS(float, 3, 3), ROW_OF_KERNELS(float, 3, 6),
                                             ROW_OF_KERNELS(float, 6, 6)};
constexpr BlockKernels<double> of_double[] = {ROW_OF_KERNELS(double, 2, 2), ROW_OF_KERNELS(double, 3, 3)};

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
