#include "lacon/assembly/saddle_point_solver.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "lacon/assembly/any_signs.hpp"
#include "lacon/assembly/gmres.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

using Eigen::Map, Eigen::MatrixXd, Eigen::VectorXd;

// What an operation on low-rank blocks costs, in operations of a factorisation of whole ones: small products are slow.
constexpr double operations_of_low_rank = 3;
// What an entry of the factor costs, in operations of a factorisation: in the substitutions of one right side, at memory's
// speed, and in those of a block of sparse ones, at arithmetic's. Measured (docs/performance.md).
constexpr double operations_of_a_solution = 40, operations_in_a_block = 2.5;
/// Likewise in the iterations of an engine that keeps no factor: two products by an entry in each, with the matrix and with
/// what makes it easy.
constexpr double operations_of_iterations = 200, digits_of_columns = 1e-7;
constexpr int block_size = 128;
/// Unknowns to which all columns are added while they are at hand.
constexpr std::size_t rows_together = 2048;
/// Errors of a Schur complement over that of its factor.
constexpr double blur = 2;
/// Of a motion that is looked for in a right side of any directions: what is left of it where its direction is unlucky.
constexpr double least_share = 1e-2;
constexpr int least_iterations = 8;

class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds), start_(clock::now()) {}
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using clock = std::chrono::steady_clock;
  double& seconds_;
  clock::time_point start_;
};

/// The part of a multiplier's row before its diagonal, and the diagonal; of a symmetric matrix.
struct Row {
  std::span<const std::int32_t> columns;
  std::span<const double> values;
  double diagonal;

  Row(const SparseMatrix& matrix, std::int64_t row) : diagonal(matrix.diagonal(row)) {
    const std::int64_t first = matrix.rows()[row], size = matrix.rows()[row + 1] - first - 1;
    columns = matrix.columns().subspan(first, size);
    values = matrix.values().subspan(first, size);
  }
  bool is_on() const {
    return std::any_of(values.begin(), values.end(), [](double v) { return v != 0; });
  }
  bool meets_multipliers(std::int64_t first_multiplier) const {
    for (std::size_t k = columns.size(); k-- > 0 && columns[k] >= first_multiplier;)
      if (values[k] != 0) return true;
    return false;
  }
};

template <class Number>
double dot(std::span<const std::int32_t> index, std::span<const double> coefficient, std::span<const Number> x) {
  double sum = 0;
  for (std::size_t k = 0; k < index.size(); ++k) sum += coefficient[k] * x[index[k]];
  return sum;
}

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

/// The largest change of the stiffness from `base` on, of a row's and a column's diagonal; infinite where the patterns differ.
double stiffness_change(const SparseMatrix& matrix, const SparseMatrix& base, std::int64_t first_multiplier) {
  if (matrix.size() != base.size() || matrix.rows()[first_multiplier] != base.rows()[first_multiplier]) return INFINITY;
  double largest = matrix.elsewhere() ? matrix.elsewhere()->change() : 0;  // squared
  const std::vector<double> diagonal = base.diagonals();
  for (std::int64_t row = 0; row < first_multiplier; ++row)
    for (std::int64_t k = matrix.rows()[row]; k < matrix.rows()[row + 1]; ++k) {
      const double difference = matrix.values()[k] - base.values()[k];
      if (difference != 0)
        largest = std::max(largest, difference * difference / std::abs(diagonal[row] * diagonal[matrix.columns()[k]]));
    }
  return std::sqrt(largest);
}

bool same_pattern(const SparseMatrix& a, const SparseMatrix& b) {
  return a.is_symmetric() == b.is_symmetric() &&
         std::equal(a.rows().begin(), a.rows().end(), b.rows().begin(), b.rows().end()) &&
         std::equal(a.columns().begin(), a.columns().end(), b.columns().begin(), b.columns().end());
}

}  // namespace

SaddlePointSolver::SaddlePointSolver(std::unique_ptr<Engine> engine, const SaddlePointOptions& options)
    : options_(options), engine_(std::move(engine)), substitution_(dynamic_cast<FactorEngine*>(engine_.get())) {}

double SaddlePointSolver::factorisation_cost() const { return (factor_.low_rank ? operations_of_low_rank : 1) * factor_.flops; }
double SaddlePointSolver::solution_cost() const { return operations_of_a_solution * static_cast<double>(factor_.entries); }
double SaddlePointSolver::column_cost() const { return operations_in_a_block * static_cast<double>(factor_.entries); }
int SaddlePointSolver::most_iterations() const {
  return std::max(least_iterations,
                  static_cast<int>(std::min(1e3, options_.work_limit * factorisation_cost() / solution_cost())));
}

/// The inverse of the base matrix with the switched rows put right.
///
/// With the columns q of the base's inverse (Column) and unknowns y, one for each switched row: x = x0 - sum q y, where y is
/// the multiplier of a row switched on, whose equation is c.x_u + d y = b, and the reaction of one switched off, whose
/// multiplier must vanish in the base's equations; it is b / d.
class SaddlePointSolver::Preconditioner {
 public:
  Preconditioner(SaddlePointSolver& solver, const SparseMatrix& matrix, const Switched& switched)
      : solver_(solver), matrix_(matrix), rows_(switched.on), n_on_(rows_.size()), scaled_(switched.scaled) {
    rows_.insert(rows_.end(), switched.off.begin(), switched.off.end());
    for (const std::int64_t row : rows_) columns_.push_back(&solver.columns_.at(row));
    const auto size = static_cast<Eigen::Index>(rows_.size());
    MatrixXd schur(size, size);
    for (Eigen::Index s = 0; s < size; ++s) {
      for (Eigen::Index t = 0; t < size; ++t) schur(t, s) = seen_by(t, std::span<const float>(columns_[s]->inverse));
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

  /// The same of sparse right sides, (sides, size).
  std::vector<float> columns(const SparseSides& sides) const {
    SparseSides others;
    MatrixXd own = MatrixXd::Zero(static_cast<Eigen::Index>(rows_.size()), static_cast<Eigen::Index>(sides.size()));
    for (std::size_t c = 0; c < sides.size(); ++c, others.end_side())
      for (auto k = static_cast<std::size_t>(sides.offset[c]); k < static_cast<std::size_t>(sides.offset[c + 1]); ++k) {
        const std::int64_t row = sides.index[k];
        const auto switched = std::find(rows_.begin(), rows_.end(), row);
        const bool is_scaled = std::binary_search(scaled_.begin(), scaled_.end(), row);
        if (switched != rows_.end())
          own(switched - rows_.begin(), static_cast<Eigen::Index>(c)) += sides.value[k];
        else
          others.add_entry(row, sides.value[k] * (is_scaled ? solver_.base_->diagonal(row) / matrix_.diagonal(row) : 1));
      }
    const auto n = static_cast<std::size_t>(matrix_.size());
    std::vector<float> x = others.index.empty() ? std::vector<float>(sides.size() * n)
                                                : solver_.substitution_->substitute(others.offset, others.index, others.value);
    for (std::size_t c = 0; c < sides.size(); ++c)
      finish(own.col(static_cast<Eigen::Index>(c)), std::span(x).subspan(c * n, n));
    return x;
  }

  /// A motion in which those have a share that the complement all but lets go, each the larger the less holds it, (n).
  std::vector<double> weak_motion() const {
    const auto size = static_cast<Eigen::Index>(rows_.size());
    const std::vector<double> signs = any_signs(rows_.size());
    std::vector<double> x(static_cast<std::size_t>(matrix_.size()), 0.0);
    if (size) add(factor_.solve(Map<const VectorXd>(signs.data(), size)), std::span(x));
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
  /// To x what unknowns y of the scaled complement stand for.
  template <class Number>
  void add(const VectorXd& y, std::span<Number> x) const {
    const VectorXd side = scale_.asDiagonal() * y;
    parallel_for(x.size(), rows_together, [&](const LoopBlock& block) {
      const auto size = static_cast<Eigen::Index>(block.last - block.first);
      Map<Eigen::VectorX<Number>> solution(x.data() + block.first, size);
      for (Eigen::Index s = 0; s < side.size(); ++s)
        solution -= (side[s] * Map<const Eigen::VectorXf>(columns_[s]->inverse.data() + block.first, size).cast<double>())
                        .template cast<Number>();
    });
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

SolutionReport SaddlePointSolver::solve(const SparseMatrix& matrix, std::int64_t first_multiplier, std::span<double> right_side,
                                        const Accuracy& accuracy) {
  SolutionReport report;
  if (matrix.size() == 0) return report;  // every displacement is imposed
  first_multiplier_ = first_multiplier;
  ready_ = false;
  if (options_.reuse && substitution_ && kept_ == Kept::factor && matrix.is_symmetric() && base_->is_symmetric() &&
      stiffness_change(matrix, *base_, first_multiplier) <= options_.stiffness_drift &&
      corrected(matrix, right_side, accuracy.rough, report))
    return report;

  // what is thrown from here on leaves a solver that keeps nothing
  const bool analysed = kept_ != Kept::nothing && same_pattern(matrix, *base_);
  kept_ = Kept::nothing;
  columns_.clear();
  blocks_.clear();
  if (substitution_) base_ = matrix;
  if (substitution_ && matrix.elsewhere()) matrix.elsewhere()->remember();
  const SparseMatrix& now = substitution_ ? *base_ : matrix;  // nothing is kept without a factor
  if (!analysed) {
    const Stopwatch watch(report.analysis_seconds);
    engine_->analyse(now);
  }
  {
    const Stopwatch watch(report.factorisation_seconds);
    factor_ = report.factorisation = engine_->factorise_to_solve(now);
    report.factorised = true;
    ++factorisations_;
  }
  kept_ = kept_behind(factor_);
  if (factor_.null_pivots.empty()) solve_with_factor(matrix, right_side, accuracy, report);
  ready_ = factor_.null_pivots.empty();
  return report;
}

SolutionReport SaddlePointSolver::solve_again(const SparseMatrix& matrix, std::span<double> right_side,
                                              const Accuracy& accuracy) {
  if (!ready_) return solve(matrix, first_multiplier_, right_side, accuracy);
  SolutionReport report;
  solve_with_factor(matrix, right_side, accuracy, report);
  return report;
}

void SaddlePointSolver::solve_with_factor(const SparseMatrix& matrix, std::span<double> right_side, const Accuracy& accuracy,
                                          SolutionReport& report) {
  const Stopwatch watch(report.solution_seconds);
  if (substitution_ && matrix.is_symmetric()) {
    const std::vector<double> scale = scales(matrix);
    const auto n = static_cast<Eigen::Index>(scale.size());
    reference_ =
        std::max(reference_, Map<const VectorXd>(scale.data(), n).cwiseProduct(Map<VectorXd>(right_side.data(), n)).norm());
  }
  kept_ = Kept::nothing;  // while a solution may take another factorisation
  const Solution solution = engine_->solve_to(accuracy.share, right_side);
  report.rough = accuracy.rough && factor_.is_iterative && !solution.again;
  report.iterations = solution.iterations;
  if (solution.again) {
    const double wasted = factor_.flops + factor_.wasted_flops;
    factor_ = *solution.again;
    factor_.wasted_flops += wasted;
    report.factorisation = factor_;
  }
  if (solution.error) factor_.error = report.factorisation.error = *solution.error;
  kept_ = kept_behind(factor_);
}

SaddlePointSolver::Kept SaddlePointSolver::kept_behind(const Factorisation& factor) const {
  return !substitution_ ? Kept::nothing : factor.null_pivots.empty() ? Kept::factor : Kept::analysis;
}

std::vector<double> SaddlePointSolver::scales(const SparseMatrix& matrix) {
  const std::vector<double> diagonal = matrix.diagonals();
  std::vector<double> scale(matrix.size());
  for (std::int64_t i = 0; i < first_multiplier_; ++i) scale[i] = 1 / std::sqrt(std::abs(diagonal[i]));
  for (std::int64_t i = first_multiplier_; i < matrix.size(); ++i) {
    const Row row(matrix, i);
    double flexibility = 0;
    for (std::size_t k = 0; k < row.columns.size(); ++k)
      flexibility += row.values[k] * row.values[k] / std::abs(diagonal[row.columns[k]]);
    // a row that is off is solved exactly: any weight does where it never had coefficients
    double& known = multiplier_scale_.try_emplace(i, 1 / std::abs(diagonal[0])).first->second;
    if (flexibility > 0) known = flexibility;
    scale[i] = flexibility > 0 ? 1 / std::sqrt(known) : std::sqrt(known) / std::abs(row.diagonal);
  }
  return scale;
}

bool SaddlePointSolver::make_columns(const SparseMatrix& matrix, const Switched& switched, SolutionReport& report) {
  std::vector<std::int64_t> wanted;
  for (const std::int64_t i : switched.on) {
    const auto known = columns_.find(i);
    const Row row(matrix, i);
    const double size = std::inner_product(row.values.begin(), row.values.end(), row.values.begin(), 0.0);
    if (known == columns_.end() || distance_squared(row.columns, row.values, known->second.index, known->second.coefficient) >
                                       options_.drift * options_.drift * size)
      wanted.push_back(i);
  }
  for (const std::int64_t i : switched.off)
    if (!columns_.contains(i)) wanted.push_back(i);
  const double cost = static_cast<double>(wanted.size()) * column_cost() + expected_iterations_ * solution_cost();
  const double memory = 0.5 * static_cast<double>((columns_.size() + wanted.size()) * matrix.size());  // in doubles
  if (cost > options_.work_limit * factorisation_cost() ||
      memory > options_.column_memory * static_cast<double>(factor_.whole_entries))
    return false;

  for (std::size_t first = 0; first < wanted.size(); first += block_size) {
    Block block;
    for (std::size_t c = first; c < std::min(first + block_size, wanted.size()); ++c) {
      block.rows.push_back(wanted[c]);
      block.on.push_back(std::binary_search(switched.on.begin(), switched.on.end(), wanted[c]));
      if (block.on.back()) {
        const Row row(matrix, wanted[c]);
        for (std::size_t k = 0; k < row.columns.size(); ++k)
          if (row.values[k] != 0) block.add_entry(row.columns[k], row.values[k]);
      } else {
        block.add_entry(wanted[c], 1);
      }
      block.end_side();
    }
    compute(std::move(block));
  }
  report.columns = static_cast<int>(wanted.size());
  return true;
}

void SaddlePointSolver::compute(Block block) {
  const std::vector<float> inverse = substitution_->substitute(block.offset, block.index, block.value);
  const std::int64_t number = blocks_.empty() ? 0 : blocks_.rbegin()->first + 1;
  const auto n = static_cast<std::ptrdiff_t>(base_->size());
  for (std::size_t c = 0; c < block.rows.size(); ++c) {
    const auto at = static_cast<std::ptrdiff_t>(c);
    Column column{.index = {}, .coefficient = {}, .inverse = {}, .block = number};
    column.inverse.assign(inverse.begin() + at * n, inverse.begin() + (at + 1) * n);
    if (block.on[c]) {
      column.index.assign(block.index.begin() + block.offset[c], block.index.begin() + block.offset[c + 1]);
      column.coefficient.assign(block.value.begin() + block.offset[c], block.value.begin() + block.offset[c + 1]);
    }
    columns_.insert_or_assign(block.rows[c], std::move(column));
  }
  blocks_.emplace(number, std::move(block));
  std::erase_if(blocks_, [&](const auto& entry) {
    return std::none_of(entry.second.rows.begin(), entry.second.rows.end(),
                        [&](std::int64_t row) { return columns_.at(row).block == entry.first; });
  });
}

bool SaddlePointSolver::holds_all(const SparseMatrix& matrix, const Preconditioner& preconditioner,
                                  std::span<const double> scale, SolutionReport& report) const {
  const auto norm = [&](std::span<const double> x, bool is_force) {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += std::pow(is_force ? x[i] * scale[i] : x[i] / scale[i], 2);
    return std::sqrt(sum);
  };
  // pulled along its weak motions a matrix that lets one go has no solution, and GMRES leaves at least that one's share
  std::vector<double> force = preconditioner.weak_motion();
  for (std::size_t i = 0; i < force.size(); ++i) force[i] /= scale[i] * scale[i];
  const double share = std::min(1.0, preconditioner.condition() / (blur * factor_.error));
  const double goal = least_share * share * norm(force, true);
  const GmresResult found = gmres([&](std::span<const double> x, std::span<double> y) { matrix.multiply(x, y); },
                                  [&](std::span<double> x) { preconditioner.apply(x); }, scale, force,
                                  {.goal = goal, .iterations = most_iterations()});
  report.iterations += found.iterations;
  if (!(found.residual <= goal)) return false;
  // it moves further than the blurred complement says where less holds it
  preconditioner.apply(force);
  return preconditioner.condition() * norm(force, false) > options_.singular * norm(found.x, false);
}

std::optional<SaddlePointSolver::Switched> SaddlePointSolver::switched_rows(const SparseMatrix& matrix) const {
  Switched switched;
  for (std::int64_t i = first_multiplier_; i < matrix.size(); ++i) {
    const Row row(matrix, i), before(*base_, i);
    if (row.meets_multipliers(first_multiplier_)) return std::nullopt;
    const bool is_on = row.is_on(), was_on = before.is_on();
    if (is_on != was_on)
      (is_on ? switched.on : switched.off).push_back(i);
    else if (!is_on && row.diagonal != before.diagonal)
      switched.scaled.push_back(i);
  }
  return switched;
}

std::size_t SaddlePointSolver::affordable_columns(const SparseMatrix& matrix) const {
  // other processes may have most of the entries
  const std::int64_t entries = std::max(matrix.rows()[matrix.size()], 20 * matrix.size());
  double most = options_.least_columns, one = operations_of_iterations * static_cast<double>(entries);
  if (kept_ == Kept::factor)
    most = std::max(most, options_.more_columns * factorisation_cost()), one = column_cost();
  else if (!ready_)
    return 0;
  return static_cast<std::size_t>(std::min(most / std::max(one, 1.0), 1e6));
}

std::vector<float> SaddlePointSolver::columns(const SparseMatrix& matrix, const SparseSides& sides) {
  if (sides.size() == 0) return {};
  if (kept_ != Kept::factor) {
    std::vector<float> all;
    for (std::size_t c = 0; c < sides.size(); ++c) {
      std::vector<double> side(static_cast<std::size_t>(matrix.size()), 0.0);
      for (auto k = static_cast<std::size_t>(sides.offset[c]); k < static_cast<std::size_t>(sides.offset[c + 1]); ++k)
        side[static_cast<std::size_t>(sides.index[k])] += sides.value[k];
      solve_again(matrix, side, {.share = digits_of_columns});
      all.insert(all.end(), side.begin(), side.end());
    }
    return all;
  }
  if (!matrix.is_symmetric()) return substitution_->substitute(sides.offset, sides.index, sides.value);
  const std::optional<Switched> switched = switched_rows(matrix);  // their columns are there: it was solved with
  return switched ? Preconditioner(*this, matrix, *switched).columns(sides) : std::vector<float>{};
}

bool SaddlePointSolver::corrected(const SparseMatrix& matrix, std::span<double> right_side, bool rough,
                                  SolutionReport& report) {
  const Stopwatch watch(report.solution_seconds);
  const std::optional<Switched> switched = switched_rows(matrix);
  if (!switched || !make_columns(matrix, *switched, report)) return false;
  const std::vector<double> scales_of_rows = scales(matrix);
  const Preconditioner preconditioner(*this, matrix, *switched);
  if (!(preconditioner.condition() > options_.singular)) return false;
  // an inexact factor blurs what is singular: the matrix itself is asked
  if (!(preconditioner.condition() > blur * factor_.error) && !holds_all(matrix, preconditioner, scales_of_rows, report))
    return false;

  const auto n = static_cast<Eigen::Index>(matrix.size());
  const VectorXd scaled = Map<const VectorXd>(scales_of_rows.data(), n).cwiseProduct(Map<VectorXd>(right_side.data(), n));
  const double size = scaled.norm();
  reference_ = std::max(reference_, size);
  const double full = std::min(options_.tolerance * reference_, options_.least_gain * size);
  const double goal = rough ? std::max(full, options_.rough_gain * size) : full;
  const GmresResult found = gmres([&](std::span<const double> x, std::span<double> y) { matrix.multiply(x, y); },
                                  [&](std::span<double> x) { preconditioner.apply(x); }, scales_of_rows, right_side,
                                  {.goal = goal, .iterations = most_iterations()});
  report.iterations += found.iterations;
  if (!(found.residual <= goal)) return false;
  expected_iterations_ = found.iterations;
  report.rough = found.residual > full;
  std::copy(found.x.begin(), found.x.end(), right_side.begin());
  return true;
}

}  // namespace lacon
