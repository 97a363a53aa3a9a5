#include "lacon/assembly/tree/dense_factor.hpp"

#include <cblas.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

/// Columns that are eliminated together, and rows and columns of what a thread changes at a time.
constexpr std::size_t tile = 256;
/// Columns that a thread makes at a time.
constexpr std::size_t columns_together = 64;
/// Right sides that a thread takes at a time.
constexpr std::size_t sides_together = 32;

int whole(std::size_t n) { return static_cast<int>(n); }

/// X = X L^-T with the unit lower triangle L, of a panel.
void solve_panel(std::size_t rows, std::size_t n, const float* l, float* x, std::size_t stride) {
  cblas_strsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasUnit, whole(rows), whole(n), 1, l, whole(stride), x,
              whole(stride));
}
void solve_panel(std::size_t rows, std::size_t n, const double* l, double* x, std::size_t stride) {
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasUnit, whole(rows), whole(n), 1, l, whole(stride), x,
              whole(stride));
}
/// C = C - A B^T of (rows, columns), with n columns of A and B.
void subtract(std::size_t rows, std::size_t columns, std::size_t n, const float* a, std::size_t stride_a, const float* b,
              float* c, std::size_t stride) {
  cblas_sgemm(CblasColMajor, CblasNoTrans, CblasTrans, whole(rows), whole(columns), whole(n), -1, a, whole(stride_a), b,
              whole(stride), 1, c, whole(stride));
}
void subtract(std::size_t rows, std::size_t columns, std::size_t n, const double* a, std::size_t stride_a, const double* b,
              double* c, std::size_t stride) {
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, whole(rows), whole(columns), whole(n), -1, a, whole(stride_a), b,
              whole(stride), 1, c, whole(stride));
}
/// X = L^-1 X, or L^-T X.
void solve(CBLAS_TRANSPOSE transposed, std::size_t n, std::size_t count, const float* l, float* x) {
  if (count == 1) return cblas_strsv(CblasColMajor, CblasLower, transposed, CblasUnit, whole(n), l, whole(n), x, 1);
  cblas_strsm(CblasColMajor, CblasLeft, CblasLower, transposed, CblasUnit, whole(n), whole(count), 1, l, whole(n), x, whole(n));
}
void solve(CBLAS_TRANSPOSE transposed, std::size_t n, std::size_t count, const double* l, double* x) {
  if (count == 1) return cblas_dtrsv(CblasColMajor, CblasLower, transposed, CblasUnit, whole(n), l, whole(n), x, 1);
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, transposed, CblasUnit, whole(n), whole(count), 1, l, whole(n), x, whole(n));
}

}  // namespace

template <class Real>
DenseFactor<Real>::DenseFactor(std::vector<int> place)
    : place_(std::move(place)),
      size_(place_.size()),
      values_(static_cast<Real*>(std::malloc(size_ * size_ * sizeof(Real)))),
      pivot_(size_) {
  if (size_ > 0 && !values_) throw std::bad_alloc();
  parallel_for(size_, columns_together, [&](const LoopBlock& columns) {  // whose memory threads have twice as fast
    for (std::size_t k = columns.first; k < columns.last; ++k) std::fill(&at(k, k), &at(k, k) + (size_ - k), Real{});
  });
}

template <class Real>
double DenseFactor<Real>::flops() const {
  return std::pow(static_cast<double>(size_), 3) / 3;
}

template <class Real>
void DenseFactor<Real>::add(std::span<const std::int32_t> equations, std::span<const Real> values) {
  constexpr std::size_t rows_together = 64;
  parallel_for(equations.size(), rows_together, [&](const LoopBlock& rows) {
    for (std::size_t a = rows.first; a < rows.last; ++a)
      for (std::size_t b = 0; b <= a; ++b) entry(equations[a], equations[b]) += values[a * equations.size() + b];
  });
}

template <class Real>
bool DenseFactor<Real>::eliminate_diagonal(std::size_t first, std::size_t last, double least) {
  for (std::size_t k = first; k < last; ++k) {
    Real* const column = &at(0, k);
    const Real pivot = pivot_[k] = column[k];
    if (!(std::abs(static_cast<double>(pivot)) >= least) || !std::isfinite(pivot)) return false;
    for (std::size_t j = k + 1; j < last; ++j) {
      const Real factor = column[j] / pivot;
      Real* const other = &at(0, j);
      for (std::size_t i = j; i < last; ++i) other[i] -= factor * column[i];
    }
    for (std::size_t i = k + 1; i < last; ++i) column[i] /= pivot;
  }
  return true;
}

template <class Real>
bool DenseFactor<Real>::eliminate(double least) {
  std::vector<Real> scaled;  // L D of the rows below
  for (std::size_t first = 0; first < size_; first += tile) {
    const std::size_t last = std::min(first + tile, size_), n = last - first, below = size_ - last;
    if (!eliminate_diagonal(first, last, least)) return false;
    scaled.resize(below * n);
    parallel_for(below, tile, [&](const LoopBlock& rows) {
      const std::size_t row = last + rows.first;
      solve_panel(rows.last - rows.first, n, &at(first, first), &at(row, first), size_);
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = rows.first; i < rows.last; ++i) {
          Real& value = at(last + i, first + k);
          scaled[k * below + i] = value;
          value /= pivot_[first + k];
        }
    });
    struct Place {
      std::size_t row, column;
    };
    std::vector<Place> tiles;
    for (std::size_t column = last; column < size_; column += tile)
      for (std::size_t row = column; row < size_; row += tile) tiles.push_back({row, column});
    parallel_for(tiles.size(), 1, [&](const LoopBlock& one) {
      const auto [row, column] = tiles[one.first];
      subtract(std::min(tile, size_ - row), std::min(tile, size_ - column), n, &scaled[row - last], below, &at(column, first),
               &at(row, column), size_);
    });
  }
  return true;
}

template <class Real>
std::int64_t DenseFactor<Real>::negative_pivots() const {
  return std::count_if(pivot_.begin(), pivot_.end(), [](Real p) { return p < 0; });
}

template <class Real>
void DenseFactor<Real>::substitute(std::span<Real> sides) const {
  if (size_ == 0) return;
  parallel_for(sides.size() / size_, sides_together, [&](const LoopBlock& block) {
    const std::size_t count = block.last - block.first;
    const std::span<Real> own = sides.subspan(block.first * size_, count * size_);
    std::vector<Real> ordered(own.size());
    const auto for_each = [&](const auto& use) {
      for (std::size_t first = 0; first < own.size(); first += size_)
        for (std::size_t i = 0; i < size_; ++i) {
          const auto place = static_cast<std::size_t>(place_[i] - 1);
          use(own[first + i], ordered[first + place], pivot_[place]);
        }
    };
    for_each([](Real side, Real& to, Real) { to = side; });
    solve(CblasNoTrans, size_, count, values_.get(), ordered.data());
    for_each([](Real, Real& x, Real pivot) { x /= pivot; });
    solve(CblasTrans, size_, count, values_.get(), ordered.data());
    for_each([](Real& solution, Real x, Real) { solution = x; });
  });
}

template class DenseFactor<double>;
template class DenseFactor<float>;

}  // namespace lacon
