#include "lacon/assembly/petsc/smoothed_aggregation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "lacon/assembly/petsc/aggregates.hpp"
#include "lacon/assembly/petsc/aij_matrix.hpp"
#include "lacon/assembly/petsc/between_processes.hpp"
#include "lacon/assembly/petsc/motion_blocks.hpp"
#include "lacon/assembly/petsc/near_null_space.hpp"
#include "lacon/assembly/petsc/whole_rows.hpp"

namespace lacon {
namespace {

/// The step of Jacobi's iteration, over the inverse of the largest eigenvalue: of the interpolation that changes least in
/// energy.
constexpr double step_of_jacobi = 4.0 / 3;
/// What is left of a rigid motion of an aggregate beside the others, of the largest one, for it to count as one of its own.
constexpr double least_motion = 1e-6;

/// Numbers of aggregates as this process has them: its own from 0, those of others behind as they come.
class AggregateNumbers {
 public:
  AggregateNumbers(MPI_Comm processes, std::int32_t n_own) : n_own_(n_own), all_(Numbers::of(processes, n_own)) {
    int process = 0;
    MPI_Comm_rank(processes, &process);
    first_ = all_.first[process];
  }
  std::int32_t n_own() const { return n_own_; }
  std::int32_t count() const { return n_own_ + static_cast<std::int32_t>(others_.size()); }
  std::int32_t in_all(std::int32_t here) const { return here < n_own_ ? first_ + here : others_[here - n_own_]; }
  std::int32_t here(std::int32_t in_all) {
    if (in_all >= first_ && in_all < first_ + n_own_) return in_all - first_;
    const auto [at, is_new] = place_.try_emplace(in_all, count());
    if (is_new) others_.push_back(in_all);
    return at->second;
  }
  int owner_of(std::int32_t here) const { return all_.owner_of(in_all(here)); }
  int n_processes() const { return all_.n_processes(); }

 private:
  std::int32_t n_own_, first_ = 0;
  Numbers all_;
  std::vector<std::int32_t> others_;
  std::unordered_map<std::int32_t, std::int32_t> place_;
};

/// The matrix and its nodes, and what is made of them step by step.
template <int dim>
class Coarsening {
 public:
  using Lanes = typename Motions<dim>::Lanes;
  static constexpr int n_motions = Motions<dim>::count, width = Motions<dim>::width;
  using NodeBlock = MotionBlock<dim, dim>;
  using CoarseBlock = MotionBlock<dim, n_motions>;

  Coarsening(MPI_Comm processes, const SplitBlocks<double>& own_rows, std::span<const std::uint8_t> is_link,
             std::span<const std::uint8_t> is_free)
      : processes_(processes),
        blocks_(own_rows),
        is_free_(is_free),
        n_(static_cast<std::int32_t>(own_rows.own.offset.size() - 1)),
        rows_(own_rows.own),
        aggregates_(aggregated(rows_.graph(is_link), nodes_that_move())),
        numbers_(processes, aggregates_.count),
        halo_(processes, Numbers::of(processes, n_), own_rows.column_of_others) {}

  void find_motions(std::span<const double> coordinates);
  LACON_INLINE void smooth_rows(double factor);
  void know_rows_of_others();
  LACON_INLINE void multiply_rows();
  void put_rows_where_they_belong();
  SplitBlocks<float> take_interpolation();
  OwnedMat matrix(std::span<const OwnedVec> motions);

 private:
  struct CoarseRow {
    std::vector<std::int32_t> aggregate;
    std::vector<CoarseBlock> block;

    LACON_INLINE CoarseBlock& of(std::int32_t other) {
      const auto at = std::find(aggregate.begin(), aggregate.end(), other) - aggregate.begin();
      if (at == std::ssize(aggregate)) begin(other);
      return block[at];
    }
    void begin(std::int32_t other) {
      aggregate.push_back(other);
      block.push_back({});
    }
  };

  std::vector<std::uint8_t> nodes_that_move() const {
    std::vector<std::uint8_t> moves(n_);
    for (std::int32_t i = 0; i < n_; ++i)
      moves[i] = std::any_of(&is_free_[i * dim], &is_free_[i * dim] + dim, [](std::uint8_t is) { return is != 0; });
    return moves;
  }
  std::array<double, dim> inverse_diagonal(std::int32_t i) const;
  template <class Use>
  LACON_INLINE void for_each_in_row(std::int32_t i, const Use& use) const;

  MPI_Comm processes_;
  const SplitBlocks<double>& blocks_;
  std::span<const std::uint8_t> is_free_;
  std::int32_t n_;  ///< own nodes
  WholeRows rows_;
  Aggregates aggregates_;
  AggregateNumbers numbers_;
  Halo halo_;
  // of own nodes, and behind them those of others that are next to one:
  std::vector<std::int32_t> aggregate_of_;  ///< none: -1
  std::vector<NodeBlock> motions_;          ///< of its aggregate, orthonormal there
  MotionRows<dim> smoothed_;
  std::vector<CoarseRow> coarse_;
};

/// Nodes next to an own one, and blocks, column by column.
template <int dim>
template <class Use>
LACON_INLINE void Coarsening<dim>::for_each_in_row(std::int32_t i, const Use& use) const {
  rows_.template for_each_in_row<dim>(i, use);
  const BlockEntries<double>& others = blocks_.others;
  if (!blocks_.column_of_others.empty())
    for (std::int32_t k = others.offset[i]; k < others.offset[i + 1]; ++k)
      use(n_ + others.column[k], others.value.data() + static_cast<std::int64_t>(k) * dim * dim);
}

/// Translations and turns about the middle of each aggregate, orthonormal; those that it does not have are zero.
template <int dim>
void Coarsening<dim>::find_motions(std::span<const double> coordinates) {
  std::vector<std::vector<std::int32_t>> nodes(aggregates_.count);
  for (std::int32_t i = 0; i < n_; ++i)
    if (const std::int32_t a = aggregates_.of_node[i]; a >= 0) nodes[a].push_back(i);
  aggregate_of_ = aggregates_.of_node;
  motions_.assign(n_, {});
  for (const std::vector<std::int32_t>& own : nodes) {
    std::array<double, dim> middle{};
    for (const std::int32_t i : own)
      for (int r = 0; r < dim; ++r) middle[r] += coordinates[i * dim + r] / static_cast<double>(own.size());
    const auto size_of = [&](int motion) {
      double sum = 0;
      for (const std::int32_t i : own)
        for (int r = 0; r < dim; ++r) sum += motions_[i][r][motion] * motions_[i][r][motion];
      return std::sqrt(sum);
    };
    double largest[2] = {0, 0};  // of translations, and of turns
    for (int motion = 0; motion < n_motions; ++motion) {
      for (const std::int32_t i : own)
        for (int r = 0; r < dim; ++r)
          motions_[i][r][motion] = is_free_[i * dim + r] ? moved_by(motion, dim, r, &coordinates[i * dim], middle.data()) : 0;
      double& most = largest[motion >= dim];
      most = std::max(most, size_of(motion));
      for (int round = 0; round < 2; ++round)
        for (int other = 0; other < motion; ++other) {
          double product = 0;
          for (const std::int32_t i : own)
            for (int r = 0; r < dim; ++r) product += motions_[i][r][motion] * motions_[i][r][other];
          for (const std::int32_t i : own)
            for (int r = 0; r < dim; ++r) motions_[i][r][motion] -= product * motions_[i][r][other];
        }
      const double size = size_of(motion), factor = size > least_motion * most ? 1 / size : 0;
      for (const std::int32_t i : own)
        for (int r = 0; r < dim; ++r) motions_[i][r][motion] *= factor;
    }
  }
  const auto aggregates = halo_.ask<std::int32_t>([&](std::int32_t i, std::vector<std::int32_t>& told) {
    told.push_back(aggregate_of_[i] < 0 ? -1 : numbers_.in_all(aggregate_of_[i]));
  });
  for (const std::int32_t aggregate : aggregates) aggregate_of_.push_back(aggregate < 0 ? -1 : numbers_.here(aggregate));
  const auto of_others =
      halo_.ask<NodeBlock>([&](std::int32_t i, std::vector<NodeBlock>& told) { told.push_back(motions_[i]); });
  motions_.insert(motions_.end(), of_others.begin(), of_others.end());
}

template <int dim>
std::array<double, dim> Coarsening<dim>::inverse_diagonal(std::int32_t i) const {
  std::array<double, dim> inverse{};
  const BlockEntries<double>& own = blocks_.own;
  for (std::int32_t k = own.offset[i]; k < own.offset[i + 1]; ++k)
    if (own.column[k] == i)
      for (int r = 0; r < dim; ++r)
        if (const double d = own.value[static_cast<std::int64_t>(k) * dim * dim + r * (dim + 1)]; d != 0) inverse[r] = 1 / d;
  return inverse;
}

/// (1 - factor D^-1 K) of the motions of aggregates.
template <int dim>
LACON_INLINE void Coarsening<dim>::smooth_rows(double factor) {
  BlockSums<NodeBlock> forces(numbers_.count());
  smoothed_.offset.reserve(n_ + 1);
  for (std::int32_t i = 0; i < n_; ++i) {
    forces.clear();
    if (aggregate_of_[i] >= 0) forces.of(aggregate_of_[i]);
    for_each_in_row(i, [&](std::int32_t j, const double* block) LACON_INLINE_LAMBDA {
      if (aggregate_of_[j] >= 0) add_product<dim>(block, motions_[j], forces.of(aggregate_of_[j]));
    });
    const std::array<double, dim> inverse = inverse_diagonal(i);
    for (std::int32_t k = 0; k < forces.size(); ++k) {
      auto& value = smoothed_.value.emplace_back();
      for (int r = 0; r < dim; ++r) {
        Lanes row = (-factor * inverse[r]) * forces.sum(k)[r];
        if (forces.aggregate(k) == aggregate_of_[i]) row += motions_[i][r];
        for (int c = 0; c < width; ++c) value[r * width + c] = is_free_[i * dim + r] ? static_cast<float>(row[c]) : 0;
      }
      smoothed_.aggregate.push_back(forces.aggregate(k));
    }
    smoothed_.offset.push_back(std::ssize(smoothed_.aggregate));
  }
}

/// Rows of the interpolation of nodes of others.
template <int dim>
void Coarsening<dim>::know_rows_of_others() {
  const auto sizes = halo_.ask<std::int32_t>([&](std::int32_t i, std::vector<std::int32_t>& told) {
    told.push_back(static_cast<std::int32_t>(smoothed_.offset[i + 1] - smoothed_.offset[i]));
  });
  const auto aggregates = halo_.ask<std::int32_t>([&](std::int32_t i, std::vector<std::int32_t>& told) {
    for (std::int64_t k = smoothed_.offset[i]; k < smoothed_.offset[i + 1]; ++k)
      told.push_back(numbers_.in_all(smoothed_.aggregate[k]));
  });
  using Value = typename decltype(smoothed_.value)::value_type;
  const auto values = halo_.ask<Value>([&](std::int32_t i, std::vector<Value>& told) {
    told.insert(told.end(), smoothed_.value.begin() + smoothed_.offset[i], smoothed_.value.begin() + smoothed_.offset[i + 1]);
  });
  for (const std::int32_t size : sizes) smoothed_.offset.push_back(smoothed_.offset.back() + size);
  for (const std::int32_t aggregate : aggregates) smoothed_.aggregate.push_back(numbers_.here(aggregate));
  smoothed_.value.insert(smoothed_.value.end(), values.begin(), values.end());
}

/// P^T K P: what own rows of K add to it.
template <int dim>
LACON_INLINE void Coarsening<dim>::multiply_rows() {
  coarse_.assign(numbers_.count(), {});
  BlockSums<NodeBlock> forces(numbers_.count());
  for (std::int32_t i = 0; i < n_; ++i) {
    forces.clear();
    for_each_in_row(i, [&](std::int32_t j, const double* block) LACON_INLINE_LAMBDA {
      for (std::int64_t k = smoothed_.offset[j]; k < smoothed_.offset[j + 1]; ++k) {
        NodeBlock moved;
        smoothed_.get(k, moved);
        add_product<dim>(block, moved, forces.of(smoothed_.aggregate[k]));
      }
    });
    for (std::int64_t k = smoothed_.offset[i]; k < smoothed_.offset[i + 1]; ++k) {
      CoarseRow& row = coarse_[smoothed_.aggregate[k]];
      const auto& value = smoothed_.value[k];
      for (std::int32_t b = 0; b < forces.size(); ++b) {
        CoarseBlock& sum = row.of(forces.aggregate(b));
        for (int m = 0; m < n_motions; ++m)
          for (int r = 0; r < dim; ++r) sum[m] += static_cast<double>(value[r * width + m]) * forces.sum(b)[r];
      }
    }
  }
}

/// Rows of aggregates of others are theirs.
template <int dim>
void Coarsening<dim>::put_rows_where_they_belong() {
  const std::int32_t n_own = numbers_.n_own();
  std::vector<std::vector<std::int32_t>> places(numbers_.n_processes());  // row, how many blocks, their columns
  std::vector<std::vector<CoarseBlock>> blocks(numbers_.n_processes());
  for (std::int32_t a = n_own; a < numbers_.count(); ++a) {
    const CoarseRow& row = coarse_[a];
    if (row.aggregate.empty()) continue;
    const int owner = numbers_.owner_of(a);
    places[owner].insert(places[owner].end(), {numbers_.in_all(a), static_cast<std::int32_t>(row.aggregate.size())});
    for (const std::int32_t b : row.aggregate) places[owner].push_back(numbers_.in_all(b));
    blocks[owner].insert(blocks[owner].end(), row.block.begin(), row.block.end());
  }
  coarse_.resize(n_own);
  const auto places_of_others = exchanged(processes_, places);
  const auto blocks_of_others = exchanged(processes_, blocks);
  for (std::size_t p = 0; p < places_of_others.size(); ++p) {
    auto block = blocks_of_others[p].begin();
    for (auto at = places_of_others[p].begin(); at != places_of_others[p].end();) {
      CoarseRow& row = coarse_[numbers_.here(*at++)];
      for (std::int32_t n = *at++; n > 0; --n, ++block) {
        CoarseBlock& sum = row.of(numbers_.here(*at++));
        for (int m = 0; m < n_motions; ++m) sum[m] += (*block)[m];
      }
    }
  }
}

/// Own rows, of which nothing is left here.
template <int dim>
SplitBlocks<float> Coarsening<dim>::take_interpolation() {
  SplitBlocks<float> made;
  const std::int64_t n_blocks = smoothed_.offset[n_];
  std::vector<std::int32_t>& of_others = made.column_of_others;
  for (std::int64_t k = 0; k < n_blocks; ++k)
    if (smoothed_.aggregate[k] >= numbers_.n_own()) of_others.push_back(numbers_.in_all(smoothed_.aggregate[k]));
  std::ranges::sort(of_others);
  of_others.erase(std::unique(of_others.begin(), of_others.end()), of_others.end());
  for (BlockEntries<float>* const part : {&made.own, &made.others}) part->rows = dim, part->columns = n_motions;
  made.own.column.reserve(n_blocks);
  made.own.value.reserve(n_blocks * dim * n_motions + read_behind);
  for (std::int32_t i = 0; i < n_; ++i) {
    for (std::int64_t k = smoothed_.offset[i]; k < smoothed_.offset[i + 1]; ++k) {
      const std::int32_t aggregate = smoothed_.aggregate[k];
      const bool is_own = aggregate < numbers_.n_own();
      BlockEntries<float>& part = is_own ? made.own : made.others;
      part.column.push_back(is_own ? aggregate
                                   : static_cast<std::int32_t>(std::ranges::lower_bound(of_others, numbers_.in_all(aggregate)) -
                                                               of_others.begin()));
      for (int c = 0; c < n_motions; ++c)
        for (int r = 0; r < dim; ++r) part.value.push_back(smoothed_.value[k][r * width + c]);
    }
    for (BlockEntries<float>* const part : {&made.own, &made.others})
      part->offset.push_back(static_cast<std::int32_t>(part->column.size()));
  }
  for (BlockEntries<float>* const part : {&made.own, &made.others}) part->value.resize(part->value.size() + read_behind, 0);
  smoothed_ = {};
  return made;
}

/// Motions that an aggregate does not have get the mean diagonal.
template <int dim>
OwnedMat Coarsening<dim>::matrix(std::span<const OwnedVec> motions) {
  double diagonals[2] = {0, 0};  // sum, how many
  for (std::int32_t a = 0; a < numbers_.n_own(); ++a)
    for (int m = 0; m < n_motions; ++m)
      if (const double d = std::abs(coarse_[a].of(a)[m][m]); d > 0) diagonals[0] += d, diagonals[1] += 1;
  MPI_Allreduce(MPI_IN_PLACE, diagonals, 2, MPI_DOUBLE, MPI_SUM, processes_);
  const double mean = diagonals[1] > 0 ? diagonals[0] / diagonals[1] : 1;
  std::size_t n_entries = 0;
  for (const CoarseRow& row : coarse_) n_entries += row.aggregate.size() * n_motions * n_motions;
  if (n_entries > std::numeric_limits<PetscInt>::max()) throw std::length_error("PETSc: 2^31");
  std::vector<PetscInt> offset{0}, column;
  std::vector<double> value;
  column.reserve(n_entries), value.reserve(n_entries);
  for (std::int32_t a = 0; a < numbers_.n_own(); ++a) {
    const CoarseRow row = std::exchange(coarse_[a], {});
    std::vector<std::pair<std::int32_t, const CoarseBlock*>> sorted;
    for (std::size_t k = 0; k < row.aggregate.size(); ++k)
      sorted.emplace_back(numbers_.in_all(row.aggregate[k]), &row.block[k]);
    std::ranges::sort(sorted);
    for (int m = 0; m < n_motions; ++m) {
      for (const auto& [b, block] : sorted)
        for (int c = 0; c < n_motions; ++c) {
          const double entry = (*block)[m][c];
          column.push_back(b * n_motions + c);
          value.push_back(b == numbers_.in_all(a) && c == m && entry == 0 ? mean : entry);
        }
      offset.push_back(static_cast<PetscInt>(column.size()));
    }
  }
  OwnedMat made = aij_matrix(processes_, {offset, column, value}, numbers_.n_own() * n_motions, n_motions);

  std::vector<OwnedVec> of_aggregates;
  for (const OwnedVec& motion : motions) {
    const double* fine = nullptr;
    double* coarse = nullptr;
    OwnedVec& made_of_it = of_aggregates.emplace_back();
    checked(MatCreateVecs(made, made_of_it.out(), nullptr));
    checked(VecSet(made_of_it, 0));
    checked(VecGetArrayRead(motion, &fine));
    checked(VecGetArray(made_of_it, &coarse));
    for (std::int32_t i = 0; i < n_; ++i)
      if (const std::int32_t a = aggregates_.of_node[i]; a >= 0)
        for (int m = 0; m < n_motions; ++m)
          for (int r = 0; r < dim; ++r) coarse[a * n_motions + m] += motions_[i][r][m] * fine[i * dim + r];
    checked(VecRestoreArray(made_of_it, &coarse));
    checked(VecRestoreArrayRead(motion, &fine));
  }
  set_near_null_space(made, of_aggregates);
  return made;
}

LACON_KERNEL void smooth(Coarsening<2>& coarsening, double factor) { coarsening.smooth_rows(factor); }
LACON_KERNEL void smooth(Coarsening<3>& coarsening, double factor) { coarsening.smooth_rows(factor); }
LACON_KERNEL void multiply(Coarsening<2>& coarsening) { coarsening.multiply_rows(); }
LACON_KERNEL void multiply(Coarsening<3>& coarsening) { coarsening.multiply_rows(); }

template <int dim>
CoarseLevel made_level(Coarsening<dim> coarsening, std::span<const double> coordinates, std::span<const OwnedVec> motions,
                       double largest) {
  coarsening.find_motions(coordinates);
  smooth(coarsening, step_of_jacobi / largest);
  coarsening.know_rows_of_others();
  multiply(coarsening);
  coarsening.put_rows_where_they_belong();
  SplitBlocks<float> interpolation = coarsening.take_interpolation();
  return {std::move(interpolation), coarsening.matrix(motions)};
}

}  // namespace

CoarseLevel coarse_level(MPI_Comm processes, const SplitBlocks<double>& own_rows, std::span<const std::uint8_t> is_link,
                         std::span<const std::uint8_t> is_free, std::span<const double> coordinates,
                         std::span<const OwnedVec> motions, double largest) {
  if (own_rows.own.rows == 3)
    return made_level(Coarsening<3>(processes, own_rows, is_link, is_free), coordinates, motions, largest);
  return made_level(Coarsening<2>(processes, own_rows, is_link, is_free), coordinates, motions, largest);
}

}  // namespace lacon
