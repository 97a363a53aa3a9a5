#pragma once
// A symmetric matrix that is full, eliminated as ordered: the top of a tree, once Schur complements have filled it. Of such a
// matrix MUMPS would analyse every entry first, in one thread.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

namespace lacon {

/// @tparam Real double or float
template <class Real>
class DenseFactor {
 public:
  /// A matrix of zeros. @param place of each equation in the order of elimination, from 1. Throws std::bad_alloc.
  explicit DenseFactor(std::vector<int> place);

  std::int64_t n_entries() const { return static_cast<std::int64_t>(size_ * (size_ + 1) / 2); }
  double flops() const;
  /// An entry and its mirror image, before the elimination.
  Real& entry(std::int32_t i, std::int32_t j) {
    const auto [column, row] = std::minmax(place_[i], place_[j]);
    return at(static_cast<std::size_t>(row - 1), static_cast<std::size_t>(column - 1));
  }
  /// Add the lower triangle of a matrix. @param values (n, n), by rows  @param equations (n), different ones
  void add(std::span<const std::int32_t> equations, std::span<const Real> values);
  /// L D L^T in place, in threads, with the same bits for any number of them.
  /// @param least magnitude of a pivot  @return whether all pivots have it
  bool eliminate(double least);
  std::int64_t negative_pivots() const;
  /// x = A^-1 b in place. @param sides (count, size)
  void substitute(std::span<Real> sides) const;

 private:
  Real& at(std::size_t row, std::size_t column) { return values_[column * size_ + row]; }
  bool eliminate_diagonal(std::size_t first, std::size_t last, double least);
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  std::vector<int> place_;
  std::size_t size_;
  std::unique_ptr<Real[], Free> values_;  ///< by columns; nothing above the diagonal is ever touched, nor has memory
  std::vector<Real> pivot_;
};

extern template class DenseFactor<double>;
extern template class DenseFactor<float>;

}  // namespace lacon
