#pragma once
// Blocks of displacements, or of motions of an aggregate, against all motions of another aggregate: a row in a register.
#include <array>
#include <cstdint>
#include <vector>

#include "lacon/assembly/petsc/registers.hpp"

namespace lacon {

/// All rigid motions of a displacement in a register, behind which nothing counts.
template <int dim>
struct Motions;
template <>
struct Motions<2> {
  static constexpr int count = 3, width = 4;
  using Lanes = FourDoubles;
};
template <>
struct Motions<3> {
  static constexpr int count = 6, width = 8;
  using Lanes = EightDoubles;
};

/// Rows of motions; aligned, which they would not be as arguments of std::array.
template <int dim, int n>
struct alignas(lane_alignment) MotionBlock {
  using Lanes = typename Motions<dim>::Lanes;
  Lanes row[n];
  LACON_INLINE Lanes& operator[](int r) { return row[r]; }
  LACON_INLINE const Lanes& operator[](int r) const { return row[r]; }
};

/// Rows of motions, one of each displacement of a node, for some aggregates.
template <int dim>
struct MotionRows {
  using Lanes = typename Motions<dim>::Lanes;
  std::vector<std::int64_t> offset{0};
  std::vector<std::int32_t> aggregate;  ///< as AggregateNumbers has them
  std::vector<std::array<float, dim * Motions<dim>::width>> value;

  LACON_INLINE void get(std::int64_t k, MotionBlock<dim, dim>& rows) const {
    for (int r = 0; r < dim; ++r) load(value[k].data() + r * Motions<dim>::width, rows[r]);
  }
};

/// Blocks that are summed up, for the aggregates that come.
template <class Block>
class BlockSums {
 public:
  explicit BlockSums(std::int32_t n_aggregates) : place_(n_aggregates, none) {}
  LACON_INLINE Block& of(std::int32_t aggregate) {
    if (place_[aggregate] == none) begin(aggregate);
    return sums_[place_[aggregate]];
  }
  std::int32_t size() const { return size_; }
  std::int32_t aggregate(std::int32_t k) const { return aggregates_[k]; }
  const Block& sum(std::int32_t k) const { return sums_[k]; }
  void clear() {
    for (std::int32_t k = 0; k < size_; ++k) place_[aggregates_[k]] = none;
    size_ = 0;
  }

 private:
  static constexpr std::int32_t none = -1;
  void begin(std::int32_t aggregate) {
    if (size_ == static_cast<std::int32_t>(sums_.size())) sums_.resize(2 * size_ + 8), aggregates_.resize(2 * size_ + 8);
    sums_[size_] = {};
    aggregates_[size_] = aggregate;
    place_[aggregate] = size_++;
  }

  std::vector<std::int32_t> place_, aggregates_;
  std::vector<Block> sums_;
  std::int32_t size_ = 0;
};

/// y += A x, of displacements and their motions. @param block (dim, dim), column by column
template <int dim>
LACON_INLINE void add_product(const double* block, const MotionBlock<dim, dim>& x, MotionBlock<dim, dim>& y) {
  for (int c = 0; c < dim; ++c)
    for (int r = 0; r < dim; ++r) y[r] += block[c * dim + r] * x[c];
}

}  // namespace lacon
