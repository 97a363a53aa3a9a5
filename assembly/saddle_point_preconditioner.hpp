#pragma once
// What an earlier factor makes of a matrix in which rows of multipliers were switched.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "lacon/assembly/any_signs.hpp"
#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {

/// The inverse of the base matrix with the switched rows put right.
///
/// With the columns q of the base's inverse (Column) and unknowns y, one for each switched row: x = x0 - sum q y, where y is
/// the multiplier of a row switched on, whose equation is c.x_u + d y = b, and the reaction of one switched off, whose
/// multiplier must vanish in the base's equations; it is b / d.
class SaddlePointSolver::Preconditioner {
  using VectorXd = Eigen::VectorXd;
  using MatrixXd = Eigen::MatrixXd;
  /// Unknowns to which all columns are added while they are at hand.
  static constexpr std::size_t rows_together = 2048;

 public:
  Preconditioner(SaddlePointSolver& solver, const SparseMatrix& matrix, const Switched& switched)
      : solver_(solver), matrix_(matrix), rows_(switched.on), n_on_(rows_.size()), scaled_(switched.scaled) {
    rows_.insert(rows_.end(), switched.off.begin(), switched.off.end());
    for (const std::int64_t row : rows_) columns_.push_back(&solver.columns_.at(row));
    const auto size = static_cast<Eigen::Index>(rows_.size());
    MatrixXd schur(size, size);
    const bool on_interface = std::ranges::all_of(
        columns_, [&](const Column* column) { return std::ranges::includes(solver.interface_, column->index); });
    std::vector<float> room(static_cast<std::size_t>(matrix.size()));
    for (Eigen::Index s = 0; s < size; ++s) {
      const std::vector<float>& seen = columns_[s]->seen;
      std::span<const float> column = room;
      if (!on_interface || seen.empty())
        column = solver.unpacked(*columns_[s], room);
      else
        for (std::size_t k = 0; k < seen.size(); ++k) room[solver.interface_[k]] = seen[k];
      for (Eigen::Index t = 0; t < size; ++t) schur(t, s) = seen_by(t, column);
      if (is_on(s)) schur(s, s) -= matrix.diagonal(rows_[s]);
    }
    if (size == 0) return;
    // scaled by what the diagonal would be, not by what it is: where a body came loose it vanishes
    scale_.resize(size);
    for (Eigen::Index s = 0; s < size; ++s) {
      const double flexibility = solver.multiplier_scale_.at(rows_[s]);
      scale_[s] = is_on(s) ? 1 / std::sqrt(flexibility) : std::sqrt(flexibility);
    }
    schur = (scale_.asDiagonal() * schur * scale_.asDiagonal()).eval();
    factor_.compute(schur);
    condition_ = factor_.rcond() * std::min(1.0, schur.cwiseAbs().colwise().sum().maxCoeff());
  }
  /// Reciprocal condition number of the Schur complement; 0 where it vanishes.
  double condition() const { return condition_; }

  /// x = P^-1 b in place
  void apply(std::span<double> x) const {
    const auto size = static_cast<Eigen::Index>(rows_.size());
    VectorXd own(size);
    for (const std::int64_t row : scaled_) x[row] *= solver_.base_->diagonal(row) / matrix_.diagonal(row);
    for (Eigen::Index s = 0; s < size; ++s) own[s] = std::exchange(x[rows_[s]], 0.0);
    solver_.substitution_->substitute(x);
    finish(own, x);
  }

  /// The same of sparse right sides, one by one, (size). @param with_base of some of them, what the base's inverse makes of
  /// them
  void columns(const SparseSides& sides, std::span<const Column* const> with_base,
               const std::function<void(std::span<const float>)>& use) const {
    SparseSides others;
    MatrixXd own = MatrixXd::Zero(static_cast<Eigen::Index>(rows_.size()), static_cast<Eigen::Index>(sides.size()));
    for (std::size_t c = 0; c < sides.size(); ++c) {
      if (with_base[c]) continue;
      for (auto k = static_cast<std::size_t>(sides.offset[c]); k < static_cast<std::size_t>(sides.offset[c + 1]); ++k) {
        const std::int64_t row = sides.index[k];
        const auto switched = std::find(rows_.begin(), rows_.end(), row);
        const bool is_scaled = std::binary_search(scaled_.begin(), scaled_.end(), row);
        if (switched != rows_.end())
          own(switched - rows_.begin(), static_cast<Eigen::Index>(c)) += sides.value[k];
        else
          others.add_entry(row, sides.value[k] * (is_scaled ? solver_.base_->diagonal(row) / matrix_.diagonal(row) : 1));
      }
      others.end_side();
    }
    const auto n = static_cast<std::size_t>(matrix_.size());
    std::vector<float> rest, column(n);
    if (!others.index.empty()) rest = solver_.substitution_->substitute(others.offset, others.index, others.value);
    for (std::size_t c = 0, r = 0; c < sides.size(); ++c) {
      std::span<const float> found = column;
      if (with_base[c])
        found = solver_.unpacked(*with_base[c], column);
      else if (!rest.empty())
        found = std::span(rest).subspan(r++ * n, n);
      else
        std::ranges::fill(column, 0.0F);
      if (!rows_.empty()) {
        if (found.data() != column.data()) std::ranges::copy(found, column.begin());
        finish(own.col(static_cast<Eigen::Index>(c)), std::span(column));
        found = column;
      }
      use(found);
    }
  }

  /// A motion in which those have a share that the complement all but lets go, each the larger the less holds it, (n).
  std::vector<double> weak_motion() const {
    const auto size = static_cast<Eigen::Index>(rows_.size());
    const std::vector<double> signs = any_signs(rows_.size());
    std::vector<double> x(static_cast<std::size_t>(matrix_.size()), 0.0);
    if (size) add(factor_.solve(Eigen::Map<const VectorXd>(signs.data(), size)), std::span(x));
    return x;
  }

 private:
  bool is_on(Eigen::Index s) const { return static_cast<std::size_t>(s) < n_on_; }
  /// From a solution with the base to that of the matrix. @param own right sides of the switched rows
  template <class Number>
  void finish(const VectorXd& own, std::span<Number> x) const {
    const auto size = static_cast<Eigen::Index>(rows_.size());
    VectorXd side(size);
    for (Eigen::Index s = 0; s < size; ++s)
      side[s] = scale_[s] * (seen_by(s, std::span<const Number>(x)) - (is_on(s) ? own[s] : 0.0));
    if (size) add(factor_.solve(side), x);
    for (Eigen::Index s = 0; s < size; ++s)
      if (!is_on(s)) x[rows_[s]] = static_cast<Number>(own[s] / matrix_.diagonal(rows_[s]));
  }
  template <class Number>
  static double dot(std::span<const std::int32_t> index, std::span<const double> coefficient, std::span<const Number> x) {
    double sum = 0;
    for (std::size_t k = 0; k < index.size(); ++k) sum += coefficient[k] * x[index[k]];
    return sum;
  }
  /// To x what unknowns y of the scaled complement stand for.
  template <class Number>
  void add(const VectorXd& y, std::span<Number> x) const {
    const VectorXd side = scale_.asDiagonal() * y;
    parallel_for(x.size(), rows_together, [&](const LoopBlock& block) {
      const auto size = static_cast<Eigen::Index>(block.last - block.first);
      Eigen::Map<Eigen::VectorX<Number>> solution(x.data() + block.first, size);
      Eigen::VectorXf motion = Eigen::VectorXf::Zero(size);  // of those that are packed
      for (Eigen::Index s = 0; s < side.size(); ++s) {
        const Column& column = *columns_[s];
        if (!column.whole.empty())
          solution -= (side[s] * Eigen::Map<const Eigen::VectorXf>(column.whole.data() + block.first, size).cast<double>())
                          .template cast<Number>();
        else if (!column.packed.empty())
          column.packed.add_to({motion.data(), static_cast<std::size_t>(size)}, block.first, static_cast<float>(side[s]));
      }
      solution -= motion.cast<Number>();
    });
    if (std::ranges::any_of(columns_, &Column::is_bare)) {
      std::vector<double> motion(x.size(), 0.0);
      for (Eigen::Index s = 0; s < side.size(); ++s) {
        const Column& column = *columns_[s];
        if (!column.is_bare()) continue;
        if (!is_on(s)) motion[rows_[s]] = side[s];
        for (std::size_t k = 0; k < column.index.size(); ++k) motion[column.index[k]] += side[s] * column.coefficient[k];
      }
      solver_.substitution_->substitute(motion);
      for (std::size_t i = 0; i < x.size(); ++i) x[i] -= static_cast<Number>(motion[i]);
    }
    for (Eigen::Index s = 0; s < side.size(); ++s) x[rows_[s]] = static_cast<Number>(is_on(s) ? side[s] : 0.0);
  }
  /// What the equation of a switched row sees of x.
  template <class Number>
  double seen_by(Eigen::Index s, std::span<const Number> x) const {
    return is_on(s) ? dot(columns_[s]->index, columns_[s]->coefficient, x) : static_cast<double>(x[rows_[s]]);
  }

  SaddlePointSolver& solver_;
  const SparseMatrix& matrix_;
  std::vector<std::int64_t> rows_;  ///< switched on, then switched off
  std::size_t n_on_;
  std::vector<std::int64_t> scaled_;
  std::vector<const Column*> columns_;
  VectorXd scale_;
  Eigen::PartialPivLU<MatrixXd> factor_;
  double condition_ = 1;
};

}  // namespace lacon
