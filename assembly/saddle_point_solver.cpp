#include "lacon/assembly/saddle_point_solver.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lacon/assembly/gmres.hpp"
#include "lacon/assembly/multiplier_row.hpp"
#include "lacon/assembly/saddle_point_preconditioner.hpp"
#include "lacon/assembly/stopwatch.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

using Eigen::Map, Eigen::MatrixXd, Eigen::VectorXd;

// What an operation on low-rank blocks costs, in operations of a factorisation of whole ones: small products are slow.
constexpr double operations_of_low_rank = 3;
// What an entry of the factor costs, in operations of a factorisation: in the substitutions of one right side, at memory's
// speed, and in those of a block of sparse ones, at arithmetic's. Measured (docs/performance.md).
constexpr double operations_of_a_solution = 40, operations_in_a_block = 2.5;
/// Errors of a Schur complement over that of its factor.
constexpr double blur = 2;
/// Of a motion that is looked for in a right side of any directions: what is left of it where its direction is unlucky.
constexpr double least_share = 1e-2;
constexpr int least_iterations = 8;
/// Rows that a thread compares at a time.
constexpr std::size_t rows_together = 8192;

/// The largest change of the stiffness from `base` on, of a row's and a column's diagonal; infinite where the equations differ.
/// Entries that either of the patterns lacks are zeros in it: bodies that slide take more couples in.
double stiffness_change(const SparseMatrix& matrix, const SparseMatrix& base, std::int64_t first_multiplier) {
  if (matrix.size() != base.size()) return INFINITY;
  const std::vector<double> diagonal = base.diagonals();
  std::vector<double> largest(n_loop_blocks(first_multiplier, rows_together), 0.0);  // of each block, squared
  parallel_for(first_multiplier, rows_together, [&](const LoopBlock& block) {
    for (std::size_t row = block.first; row < block.last; ++row) {
      std::int64_t k = matrix.rows()[row], j = base.rows()[row];
      const std::int64_t last_k = matrix.rows()[row + 1], last_j = base.rows()[row + 1];
      while (k < last_k || j < last_j) {
        const std::int32_t column =
            std::min(k < last_k ? matrix.columns()[k] : INT32_MAX, j < last_j ? base.columns()[j] : INT32_MAX);
        double difference = 0;
        if (k < last_k && matrix.columns()[k] == column) difference += matrix.values()[k++];
        if (j < last_j && base.columns()[j] == column) difference -= base.values()[j++];
        if (difference == 0) continue;
        largest[block.index] =
            std::max(largest[block.index], difference * difference / std::abs(diagonal[row] * diagonal[column]));
      }
    }
  });
  const double elsewhere = matrix.elsewhere() ? matrix.elsewhere()->change() : 0;
  return std::sqrt(
      std::accumulate(largest.begin(), largest.end(), elsewhere, [](double a, double b) { return std::max(a, b); }));
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

SolutionReport SaddlePointSolver::solve(const SparseMatrix& matrix, std::int64_t first_multiplier, std::span<double> right_side,
                                        const Accuracy& accuracy) {
  SolutionReport report;
  if (matrix.size() == 0) return report;  // every displacement is imposed
  first_multiplier_ = first_multiplier;
  ready_ = false;
  const Kept kept = std::exchange(kept_, Kept::nothing);  // what is thrown from here on leaves a solver that keeps nothing
  if (options_.reuse && substitution_ && kept == Kept::factor && matrix.is_symmetric() && base_->is_symmetric() &&
      stiffness_change(matrix, *base_, first_multiplier) <= options_.stiffness_drift &&
      corrected(matrix, right_side, accuracy.rough, report)) {
    kept_ = kept;
    return report;
  }
  const bool analysed = kept != Kept::nothing && same_pattern(matrix, *base_);
  columns_.clear();
  blocks_.clear();
  interface_.clear();
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
    const MultiplierRow row(matrix, i);
    double flexibility = 0;
    for (std::size_t k = 0; k < row.columns.size(); ++k)
      if (row.values[k] != 0) flexibility += row.values[k] * row.values[k] / std::abs(diagonal[row.columns[k]]);
    // a row that is off is solved exactly: any weight does where it never had coefficients
    double& known = multiplier_scale_.try_emplace(i, 1 / std::abs(diagonal[0])).first->second;
    if (flexibility > 0) known = flexibility;
    scale[i] = flexibility > 0 ? 1 / std::sqrt(known) : std::sqrt(known) / std::abs(row.diagonal);
  }
  return scale;
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
    const MultiplierRow row(matrix, i), before(*base_, i);
    if (row.meets_multipliers(first_multiplier_)) return std::nullopt;
    const bool is_on = row.is_on(), was_on = before.is_on();
    if (is_on != was_on)
      (is_on ? switched.on : switched.off).push_back(i);
    else if (!is_on && row.diagonal != before.diagonal)
      switched.scaled.push_back(i);
  }
  return switched;
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
  const double exact = options_.tolerance * reference_;
  const double full = std::min(exact, (size > exact ? options_.least_gain : options_.last_gain) * size);
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
