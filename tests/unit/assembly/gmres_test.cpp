#include "lacon/assembly/gmres.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace lacon {
namespace {

using Eigen::Map, Eigen::MatrixXd, Eigen::VectorXd;

/// A dense matrix A, the inverse of a preconditioner, and the scales of the equations.
struct Problem {
  explicit Problem(MatrixXd matrix)
      : a(std::move(matrix)), inverse(MatrixXd::Identity(a.rows(), a.cols())), scale(VectorXd::Ones(a.rows())) {}

  GmresResult solve(const VectorXd& b, const GmresOptions& options) const {
    const auto span = [](const VectorXd& v) { return std::span(v.data(), static_cast<std::size_t>(v.size())); };
    return gmres([&](std::span<const double> x,
                     std::span<double> y) { Map<VectorXd>(y.data(), a.rows()) = a * Map<const VectorXd>(x.data(), a.cols()); },
                 [&](std::span<double> x) {
                   Map<VectorXd> in_place(x.data(), a.rows());
                   in_place = (inverse * in_place).eval();
                 },
                 span(scale), span(b), options);
  }
  /// Norm of the scaled residual.
  double residual(const VectorXd& b, const GmresResult& result) const {
    return scale.cwiseProduct(b - a * Map<const VectorXd>(result.x.data(), a.cols())).norm();
  }

  MatrixXd a, inverse;
  VectorXd scale;
};

MatrixXd random_matrix(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return MatrixXd::NullaryExpr(n, n, [&] { return uniform(random); });
}

// In exact arithmetic n iterations solve any regular system of n equations; the residual that is told is that of x.
TEST(Gmres, SolvesUnsymmetricSystems) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const int n = 25;
    const Problem problem(random_matrix(n, seed) + 4 * MatrixXd::Identity(n, n));
    const VectorXd b = VectorXd::LinSpaced(n, -1, 2);
    const GmresResult result = problem.solve(b, {.goal = 1e-12, .iterations = n});
    EXPECT_LE(result.residual, 1e-12);
    EXPECT_NEAR(result.residual, problem.residual(b, result), 1e-13);
    EXPECT_LE(result.iterations, n);
    EXPECT_LE((Map<const VectorXd>(result.x.data(), n) - problem.a.fullPivLu().solve(b)).norm(), 1e-11);
  }
}

// As many iterations as the preconditioned matrix has eigenvalues, where it has all eigenvectors.
TEST(Gmres, NeedsAnIterationForEachEigenvalue) {
  const int n = 30;
  const MatrixXd vectors = MatrixXd(random_matrix(n, 3).householderQr().householderQ());
  VectorXd values(n);
  for (int i = 0; i < n; ++i) values[i] = 1 + i % 3;
  Problem problem(vectors * values.asDiagonal() * vectors.transpose());
  const VectorXd b = VectorXd::Ones(n);
  EXPECT_EQ(problem.solve(b, {.goal = 1e-12, .iterations = n}).iterations, 3);
  problem.inverse = problem.a.inverse();
  EXPECT_EQ(problem.solve(b, {.goal = 1e-12, .iterations = n}).iterations, 1);
}

// The shift x_i -> x_(i+1) makes no progress before the last iteration: the result says how far it is, and x is no worse than
// zero.
TEST(Gmres, SaysThatItStagnates) {
  const int n = 12;
  MatrixXd shift = MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) shift((i + 1) % n, i) = 1;
  const Problem problem(shift);
  const VectorXd b = VectorXd::Unit(n, 0);
  const GmresResult few = problem.solve(b, {.goal = 1e-12, .iterations = n - 1});
  EXPECT_EQ(few.iterations, n - 1);
  EXPECT_NEAR(few.residual, 1, 1e-14);
  const GmresResult all = problem.solve(b, {.goal = 1e-12, .iterations = n});
  EXPECT_LE(all.residual, 1e-12);
}

// Scales are a norm of the residual: the goal holds in it, and equations may differ by any power of ten.
TEST(Gmres, MeasuresInTheScalesOfTheEquations) {
  const int n = 10;
  Problem problem(random_matrix(n, 8) + 4 * MatrixXd::Identity(n, n));
  VectorXd units(n);
  for (int i = 0; i < n; ++i) units[i] = std::pow(10.0, i - 5);
  problem.a = (units.asDiagonal() * problem.a).eval();
  problem.scale = units.cwiseInverse();
  problem.inverse = problem.scale.asDiagonal();
  const VectorXd b = units;
  const GmresResult result = problem.solve(b, {.goal = 1e-12, .iterations = n});
  EXPECT_LE(result.residual, 1e-12);
  EXPECT_LE(problem.residual(b, result), 2e-12);
}

// The residual that the recurrence promises is not the true one behind an inexact preconditioner; a second cycle starts from
// that.
TEST(Gmres, StartsAgainFromTheTrueResidual) {
  const int n = 20;
  Problem problem(random_matrix(n, 4) + 8 * MatrixXd::Identity(n, n));
  problem.inverse = problem.a.inverse().cast<float>().cast<double>();
  const VectorXd b = 1e8 * VectorXd::Ones(n);
  const GmresResult result = problem.solve(b, {.goal = 1e-7, .iterations = 20});
  EXPECT_LE(result.residual, 1e-7);
  EXPECT_LE(result.iterations, 4) << "single precision wins seven digits an iteration";
}

// Nothing to solve costs nothing; what overflows is told as an infinite residual.
TEST(Gmres, EndsAtOnceWhereThereIsNothingToWin) {
  const int n = 4;
  Problem problem(MatrixXd::Identity(n, n));
  const GmresResult nothing = problem.solve(VectorXd::Zero(n), {.goal = 0, .iterations = 10});
  EXPECT_EQ(nothing.iterations, 0);
  EXPECT_EQ(nothing.residual, 0);
  problem.inverse *= INFINITY;
  EXPECT_EQ(problem.solve(VectorXd::Ones(n), {.goal = 1e-10, .iterations = 10}).residual, INFINITY);
}

}  // namespace
}  // namespace lacon
