// Forces and matrix at a state; relations and following loads in them.
#include "lacon/operators/evolution/newton/equilibrium.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../assembly/dense.hpp"
#include "lacon/catalog/messages.hpp"
#include "two_squares.hpp"

namespace lacon {
namespace {

using namespace test;

/// Residual minus external forces of the equations at a state, and the matrix there.
struct Evaluation {
  Eigen::VectorXd unbalanced;
  Eigen::MatrixXd matrix;
};
Evaluation evaluate(Equilibrium& equilibrium, const StaticProblem& problem, const StaticState& state) {
  equilibrium.pair(state.displacement);
  equilibrium.assemble(state, state, {});
  const std::vector<double> none(problem.n_dofs(), 0.0), side = equilibrium.right_side(none);
  return {-Eigen::Map<const Eigen::VectorXd>(side.data(), static_cast<Eigen::Index>(side.size())),
          dense(equilibrium.system().matrix())};
}

/// The matrix against central differences of the residual, over all unknowns that have an equation.
void expect_matrix_is_the_derivative(const StaticProblem& problem, bool symmetric_part) {
  Equilibrium equilibrium(problem);
  StaticState state = equilibrium.natural_state();
  state.displacement = random_vector(problem.n_dofs(), 0.05, 3);
  for (std::size_t r = 0; r < state.relations.size(); ++r) state.relations[r] = 0.7;
  equilibrium.load(1.0, state);
  const Eigen::MatrixXd matrix = evaluate(equilibrium, problem, state).matrix;
  Eigen::MatrixXd differences = Eigen::MatrixXd::Zero(matrix.rows(), matrix.cols());
  constexpr double step = 1e-6;
  const auto derive = [&](double& unknown, std::int64_t equation) {
    if (equation < 0) return;
    const double there = unknown;
    unknown = there + step;
    const Eigen::VectorXd ahead = evaluate(equilibrium, problem, state).unbalanced;
    unknown = there - step;
    const Eigen::VectorXd behind = evaluate(equilibrium, problem, state).unbalanced;
    unknown = there;
    differences.col(equation) = (ahead - behind) / (2 * step);
  };
  for (std::size_t dof = 0; dof < problem.n_dofs(); ++dof) derive(state.displacement[dof], problem.numbering.equation[dof]);
  for (std::size_t r = 0; r < state.relations.size(); ++r)
    derive(state.relations[r], equilibrium.system().first_multiplier() + static_cast<std::int64_t>(r));
  if (symmetric_part) differences = (differences + differences.transpose().eval()) / 2;
  // central differences: step^2 of truncation and eps / step of round-off
  EXPECT_LT((matrix - differences).cwiseAbs().maxCoeff(), 1e-8 * matrix.cwiseAbs().maxCoeff());
}

TEST(Equilibrium, TheTangentIsTheDerivativeOfTheForces) {
  StaticProblem problem = two_squares("ELAS/GREEN_LAGRANGE", false);
  problem.loads.push_back(hold(bottom, 1));
  number(problem);
  expect_matrix_is_the_derivative(problem, false);
}

TEST(Equilibrium, AFollowingPressureBringsTheSymmetricPartOfItsDerivative) {
  StaticProblem problem = two_squares("ELAS/PETIT", false);
  problem.loads.push_back(press(problem, 300.0, true));
  number(problem);
  expect_matrix_is_the_derivative(problem, true);
}

TEST(Equilibrium, ARelationHasAMultiplierWhoseRowIsItsDerivative) {
  StaticProblem problem = two_squares("ELAS/PETIT", false);
  problem.loads.push_back(hold(bottom, 1));
  TimedLoad& load = problem.loads.emplace_back();
  load.label = "TIE";
  load.relations = {{"LIAISON_DDL", {5, 21}, {1.0, -2.0}}, {"LIAISON_DDL", {4, 20, 22}, {1.0, 0.5, 0.25}}};
  load.relation_values = TimedValues(2);
  load.relation_values.set(0, 0.125);
  number(problem);
  expect_matrix_is_the_derivative(problem, false);
  // its row asks for the given value: residual sum c u, right side the value
  Equilibrium equilibrium(problem);
  StaticState state = equilibrium.natural_state();
  const std::vector<double> step = equilibrium.load(1.0, state);
  equilibrium.assemble(state, state, {});
  EXPECT_DOUBLE_EQ(equilibrium.right_side(step)[equilibrium.system().first_multiplier()], 0.125);
}

TEST(Equilibrium, ARelationOfImposedDisplacementsAloneIsOnlyChecked) {
  StaticProblem problem = two_squares("ELAS/PETIT", false);
  problem.loads.push_back(hold(bottom, 1, 0.5));
  TimedLoad& load = problem.loads.emplace_back();
  load.label = "TIE";
  load.relations = {{"LIAISON_DDL", {1, 3}, {1.0, -1.0}}};
  load.relation_values = TimedValues(1);
  number(problem);
  Equilibrium equilibrium(problem);
  const StaticState state = equilibrium.natural_state();
  EXPECT_NO_THROW(equilibrium.load(1.0, state));
  EXPECT_EQ(equilibrium.n_constraints(state), 0);
  problem.loads.back().relation_values.set(0, 0.1);
  try {
    equilibrium.load(1.0, state);
    FAIL() << "0.5 - 0.5 is not 0.1";
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "LOAD_6");
  }
}

TEST(Equilibrium, ImposedDisplacementsComeAsAStepAndContradictionsAreTold) {
  StaticProblem problem = two_squares("ELAS/PETIT", false);
  problem.loads.push_back(hold(bottom, 1, 0.5));
  number(problem);
  Equilibrium equilibrium(problem);
  StaticState state = equilibrium.natural_state();
  state.displacement[1] = 0.2;
  const std::vector<double> step = equilibrium.load(1.0, state);
  EXPECT_DOUBLE_EQ(step[1], 0.3);
  EXPECT_DOUBLE_EQ(step[3], 0.5);
  EXPECT_DOUBLE_EQ(step[0], 0.0);
  problem.loads.push_back(hold({0}, 1, 0.25));
  try {
    equilibrium.load(1.0, state);
    FAIL() << "two loads contradict each other";
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "LOAD_1");
  }
}

TEST(Equilibrium, DeadAndFollowingPressuresAreTheSameOnTheInitialGeometry) {
  StaticProblem problem = two_squares("ELAS/PETIT", false);
  problem.loads.push_back(press(problem, pressure, false));
  const std::vector<double> rest(problem.n_dofs(), 0.0), dead = problem.external_force(1.0, rest);
  problem.loads.clear();
  problem.loads.push_back(press(problem, pressure, true));
  const std::vector<double> following = problem.external_force(1.0, rest);
  double sum = 0;
  for (std::size_t dof = 0; dof < dead.size(); ++dof) {
    EXPECT_NEAR(dead[dof], following[dof], 1e-13 * pressure);
    sum += dof % 2 ? dead[dof] : 0;
  }
  EXPECT_NEAR(sum, -pressure, 1e-13 * pressure);  // on a length of 1
}

TEST(Equilibrium, TheReferenceCountsLoadsReactionsAndContact) {
  StaticProblem problem = pressed_squares();
  Equilibrium equilibrium(problem);
  StaticState state = equilibrium.natural_state();
  equilibrium.pair(state.displacement);
  state.patches = equilibrium.contact()->initial();
  ASSERT_EQ(state.patches.status[0], Status::active);
  state.patches.lambda[0] = -1000 * pressure;
  equilibrium.load(1.0, state);
  equilibrium.assemble(state, state, {});
  const ForceFigures figures = equilibrium.forces(state, state);
  // Simpson's rule: two thirds of a uniform pressure are the middle node's
  EXPECT_NEAR(figures.reference, 2.0 / 3 * 1000 * pressure, 1e-9 * pressure);
  EXPECT_NEAR(figures.unbalanced, 2.0 / 3 * 1000 * pressure, 1e-9 * pressure);
  EXPECT_EQ(figures.significant, figures.unbalanced);
}

TEST(Equilibrium, TheVectorsOfForcesAreThoseOfWhateverAxes) {
  const auto turned = [](std::span<double> values, std::size_t width, double angle) {
    for (std::size_t node = 0; node < values.size(); node += width) {
      const double x = values[node], y = values[node + 1];
      values[node] = std::cos(angle) * x - std::sin(angle) * y;
      values[node + 1] = std::sin(angle) * x + std::cos(angle) * y;
    }
  };
  const auto figures = [&](double angle, double lambda) {
    StaticProblem problem = two_squares("ELAS/GREEN_LAGRANGE", true);
    turned(problem.mesh.coordinates, 3, angle);
    problem.loads.push_back(press(problem, pressure, false));
    number(problem);
    Equilibrium equilibrium(problem);
    StaticState state = equilibrium.natural_state();
    state.displacement = random_vector(problem.n_dofs(), 0.05, 3);
    turned(state.displacement, 2, angle);
    equilibrium.pair(state.displacement);
    state.patches = equilibrium.contact()->initial();
    state.patches.status[0] = Status::active;
    state.patches.lambda[0] = lambda * pressure;
    equilibrium.load(1.0, state);
    equilibrium.assemble(state, state, {});
    return equilibrium.forces(state, state);
  };
  for (const double lambda : {0.0, -1000.0}) {  // the reference is the load's, and that of contact
    const ForceFigures straight = figures(0, lambda), askew = figures(0.7, lambda);
    EXPECT_NEAR(askew.unbalanced_vector, straight.unbalanced_vector, 1e-12 * straight.unbalanced_vector) << lambda;
    EXPECT_NEAR(askew.reference_vector, straight.reference_vector, 1e-12 * straight.reference_vector) << lambda;
    EXPECT_GT(std::abs(askew.unbalanced - straight.unbalanced), 0.01 * straight.unbalanced) << lambda;
    EXPECT_GT(std::abs(askew.reference - straight.reference), 0.01 * straight.reference) << lambda;
  }
}

TEST(Equilibrium, WhatRoundOffLeavesIsNotSignificant) {
  StaticProblem problem = two_squares("ELAS/PETIT", false);
  problem.loads.push_back(hold(bottom, 1));
  number(problem);
  Equilibrium equilibrium(problem);
  StaticState state = equilibrium.natural_state();
  equilibrium.load(1.0, state);
  const StaticState before = [&] {
    StaticState moved = state;
    for (std::size_t dof = 0; dof < moved.displacement.size(); dof += 2) moved.displacement[dof] = 100;  // a rigid motion
    return moved;
  }();
  state.displacement[10] = 1e-16;
  equilibrium.assemble(state, state, {});
  EXPECT_GT(equilibrium.forces(state, state).significant, 0);
  EXPECT_EQ(equilibrium.forces(state, before).significant, 0);  // the digits that a displacement of 100 leaves behind
  EXPECT_GT(equilibrium.forces(state, before).unbalanced, 0);
  StaticState overflowed = state;
  overflowed.displacement[0] = 1e200;  // its square is not finite
  EXPECT_GT(equilibrium.forces(state, overflowed).significant, 0);
}

}  // namespace
}  // namespace lacon
