// Columns of the inverse: those that switched rows need, and those that others ask for.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lacon/assembly/multiplier_row.hpp"
#include "lacon/assembly/saddle_point_preconditioner.hpp"
#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/assembly/stopwatch.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

/// Likewise in the iterations of an engine that keeps no factor: two products by an entry in each, with the matrix and with
/// what makes it easy.
constexpr double operations_of_iterations = 200, digits_of_columns = 1e-7;
constexpr int block_size = 128;

/// |a - b|^2 of two sparse vectors with ascending indices.
double distance_squared(std::span<const std::int32_t> i, std::span<const double> a, std::span<const std::int32_t> j,
                        std::span<const double> b) {
  double sum = 0;
  std::size_t p = 0, q = 0;
  while (p < i.size() || q < j.size()) {
    const bool left = q == j.size() || (p < i.size() && i[p] <= j[q]), right = p == i.size() || (q < j.size() && j[q] <= i[p]);
    const double difference = (left ? a[p] : 0.0) - (right ? b[q] : 0.0);
    sum += difference * difference;
    p += left;
    q += right;
  }
  return sum;
}

}  // namespace

std::size_t SaddlePointSolver::affordable_columns(const SparseMatrix& matrix) const {
  // other processes may have most of the entries
  const std::int64_t entries = std::max(matrix.rows()[matrix.size()], 20 * matrix.size());
  double most = options_.least_columns, one = operations_of_iterations * static_cast<double>(entries);
  if (kept_ == Kept::factor)
    most = std::max(most, options_.more_columns * factorisation_cost()),
    one = column_cost() + (has_bare_columns() ? solution_cost() : 0);
  else if (!ready_)
    return 0;
  return static_cast<std::size_t>(std::min(most / std::max(one, 1.0), 1e6));
}

SolutionReport SaddlePointSolver::columns(const SparseMatrix& matrix, const SparseSides& sides,
                                          const std::function<void(std::span<const float>)>& use) {
  SolutionReport report;
  const Stopwatch watch(report.solution_seconds);
  report.columns = static_cast<int>(sides.size());
  const auto n = static_cast<std::size_t>(matrix.size());
  if (kept_ != Kept::factor) {
    for (std::size_t c = 0; c < sides.size(); ++c) {
      std::vector<double> side(n, 0.0);
      for (auto k = static_cast<std::size_t>(sides.offset[c]); k < static_cast<std::size_t>(sides.offset[c + 1]); ++k)
        side[static_cast<std::size_t>(sides.index[k])] += sides.value[k];
      solve_again(matrix, side, {.share = digits_of_columns});
      use(std::vector<float>(side.begin(), side.end()));
    }
  } else if (!matrix.is_symmetric()) {
    const std::vector<float> found = substitution_->substitute(sides.offset, sides.index, sides.value);
    for (std::size_t c = 0; c < sides.size(); ++c) use(std::span(found).subspan(c * n, n));
  } else if (const std::optional<Switched> switched = switched_rows(matrix)) {  // their columns are there: it was solved with
    const std::vector<const Column*> with_base = columns_ahead(*switched, sides, report);
    Preconditioner(*this, matrix, *switched).columns(sides, with_base, use);
    if (!has_room_for(0))
      for (const std::int64_t row : sides.rows)
        if (const auto column = columns_.find(row); column != columns_.end()) make_bare(column->second);
  }
  return report;
}

std::vector<const SaddlePointSolver::Column*> SaddlePointSolver::columns_ahead(const Switched& switched,
                                                                               const SparseSides& sides,
                                                                               SolutionReport& report) {
  std::vector<bool> as_it_was(sides.size());
  std::vector<std::size_t> wanted;
  for (std::size_t c = 0; c < sides.size(); ++c) {
    as_it_was[c] = sides.rows[c] >= 0 && !std::ranges::binary_search(switched.on, sides.rows[c]) &&
                   !std::ranges::binary_search(switched.off, sides.rows[c]);
    if (as_it_was[c] && known(sides, c))
      --report.columns;
    else if (as_it_was[c])
      wanted.push_back(c);
  }
  const bool bare = !has_room_for(wanted.size());
  SparseSides block;
  for (const std::size_t c : wanted)
    if (!bare ||
        std::ranges::includes(interface(), std::span(sides.index)
                                               .subspan(static_cast<std::size_t>(sides.offset[c]),
                                                        static_cast<std::size_t>(sides.offset[c + 1] - sides.offset[c]))))
      block.add_side(sides, c);
  if (block.size() > 0) compute(std::move(block));
  std::vector<const Column*> found(sides.size(), nullptr);
  for (std::size_t c = 0; c < sides.size(); ++c)
    if (as_it_was[c]) found[c] = known(sides, c);
  return found;
}

bool SaddlePointSolver::make_columns(const SparseMatrix& matrix, const Switched& switched, SolutionReport& report) {
  std::vector<std::int64_t> wanted;
  for (const std::int64_t i : switched.on) {
    const auto known = columns_.find(i);
    const MultiplierRow row(matrix, i);
    const double size = std::inner_product(row.values.begin(), row.values.end(), row.values.begin(), 0.0);
    if (known == columns_.end() || distance_squared(row.columns, row.values, known->second.index, known->second.coefficient) >
                                       options_.drift * options_.drift * size)
      wanted.push_back(i);
  }
  for (const std::int64_t i : switched.off)
    if (!columns_.contains(i)) wanted.push_back(i);
  const double cost = static_cast<double>(wanted.size()) * column_cost() +
                      expected_iterations_ * (has_bare_columns() ? 2 : 1) * solution_cost();
  if (cost > options_.work_limit * factorisation_cost()) return false;
  if (!has_room_for(wanted.size())) drop_columns_but(switched);
  const bool bare = !has_room_for(wanted.size());
  if (bare) {
    for (const std::int64_t i : switched.on)
      if (!std::ranges::includes(interface(), MultiplierRow(matrix, i).columns)) return false;
    for (auto& [row, column] : columns_) make_bare(column);
  }

  for (std::size_t first = 0; first < wanted.size(); first += block_size) {
    SparseSides block;
    for (std::size_t c = first; c < std::min(first + block_size, wanted.size()); ++c) {
      const bool on = std::ranges::binary_search(switched.on, wanted[c]);
      if (on) {
        const MultiplierRow row(matrix, wanted[c]);
        for (std::size_t k = 0; k < row.columns.size(); ++k)
          if (row.values[k] != 0) block.add_entry(row.columns[k], row.values[k]);
      } else {
        block.add_entry(wanted[c], 1);
      }
      block.end_side(wanted[c], on);
    }
    compute(std::move(block));
    if (bare)
      for (std::size_t c = first; c < std::min(first + block_size, wanted.size()); ++c) make_bare(columns_.at(wanted[c]));
  }
  report.columns = static_cast<int>(wanted.size());
  return true;
}

const std::vector<std::int32_t>& SaddlePointSolver::interface() {
  if (!interface_.empty()) return interface_;
  for (std::int64_t row = first_multiplier_; row < base_->size(); ++row) {
    const std::span<const std::int32_t> columns = MultiplierRow(*base_, row).columns;
    interface_.insert(interface_.end(), columns.begin(), columns.end());
    interface_.push_back(static_cast<std::int32_t>(row));
  }
  std::ranges::sort(interface_);
  interface_.erase(std::unique(interface_.begin(), interface_.end()), interface_.end());
  return interface_;
}

void SaddlePointSolver::make_bare(Column& column) {
  if (column.seen.empty())
    for (const std::int32_t equation : interface()) column.seen.push_back(column.whole[static_cast<std::size_t>(equation)]);
  column.whole = {};
  column.packed = {};
}

bool SaddlePointSolver::has_bare_columns() const {
  return std::ranges::any_of(columns_, [](const auto& column) { return column.second.is_bare(); });
}

bool SaddlePointSolver::has_room_for(std::size_t more) const {
  const auto n = static_cast<std::size_t>(base_->size());
  const auto whole =
      static_cast<std::size_t>(std::ranges::count_if(columns_, [](const auto& column) { return !column.second.is_bare(); }));
  const std::size_t bytes = (whole + more) * (packs() ? PackedVector::memory(n) : n * sizeof(float));
  return static_cast<double>(bytes) / sizeof(double) <=
         std::max(options_.least_memory, options_.column_memory * static_cast<double>(factor_.whole_entries));
}

void SaddlePointSolver::drop_columns_but(const Switched& switched) {
  std::erase_if(columns_, [&](const auto& column) {
    return !std::ranges::binary_search(switched.on, column.first) && !std::ranges::binary_search(switched.off, column.first);
  });
  for (auto& [number, block] : blocks_)
    for (std::int64_t& row : block.rows)
      if (!columns_.contains(row)) row = -1;
}

const SaddlePointSolver::Column* SaddlePointSolver::known(const SparseSides& sides, std::size_t side) const {
  const auto found = columns_.find(sides.rows[side]);
  if (found == columns_.end() || found->second.is_bare()) return nullptr;
  const auto first = sides.offset[side], last = sides.offset[side + 1];
  return !sides.on[side] || (std::ranges::equal(std::span(sides.index).subspan(first, last - first), found->second.index) &&
                             std::ranges::equal(std::span(sides.value).subspan(first, last - first), found->second.coefficient))
             ? &found->second
             : nullptr;
}

void SaddlePointSolver::compute(SparseSides block) {
  const std::vector<float> found = substitution_->substitute(block.offset, block.index, block.value);
  const std::int64_t number = blocks_.empty() ? 0 : blocks_.rbegin()->first + 1;
  const auto n = static_cast<std::size_t>(base_->size());
  if (packs()) interface();  // it is made once
  std::vector<Column> made(block.size());
  parallel_for(block.size(), 1, [&](const LoopBlock& one) {
    const std::size_t c = one.first;
    if (block.rows[c] < 0) return;  // it was dropped
    Column& column = made[c];
    column.block = number;
    if (block.on[c]) {
      column.index.assign(block.index.begin() + block.offset[c], block.index.begin() + block.offset[c + 1]);
      column.coefficient.assign(block.value.begin() + block.offset[c], block.value.begin() + block.offset[c + 1]);
    }
    const std::span<const float> inverse = std::span(found).subspan(c * n, n);
    if (packs()) {
      column.packed = PackedVector(inverse);
      for (const std::int32_t equation : interface_) column.seen.push_back(inverse[static_cast<std::size_t>(equation)]);
    } else {
      column.whole.assign(inverse.begin(), inverse.end());
    }
  });
  for (std::size_t c = 0; c < block.size(); ++c)
    if (block.rows[c] >= 0) columns_.insert_or_assign(block.rows[c], std::move(made[c]));
  blocks_.emplace(number, std::move(block));
  std::erase_if(blocks_, [&](const auto& entry) {
    return std::ranges::none_of(entry.second.rows, [&](std::int64_t row) {
      const auto column = columns_.find(row);
      return column != columns_.end() && column->second.block == entry.first;
    });
  });
}

std::span<const float> SaddlePointSolver::unpacked(const Column& column, std::vector<float>& room) const {
  if (!column.whole.empty()) return column.whole;
  room.assign(column.packed.size(), 0);
  column.packed.add_to(room, 0, 1);
  for (std::size_t k = 0; k < interface_.size(); ++k) room[static_cast<std::size_t>(interface_[k])] = column.seen[k];
  return room;
}

}  // namespace lacon
