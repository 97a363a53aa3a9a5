#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "lacon/operators/evolution/system.hpp"

namespace lacon {
namespace {

// Solving with imposed displacements eliminated is solving the full system with their rows replaced by u = value.
TEST(System, EliminatesImposedDisplacements) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::vector<std::uint8_t> free{1, 0, 1, 1, 0, 1};  // three nodes, two displacements
  const Numbering numbering = number_equations(3, 2, free, 1);
  Ragged<std::int32_t> elements;
  elements.push_back(std::vector<std::int32_t>{0, 1});
  elements.push_back(std::vector<std::int32_t>{1, 2});
  System system(numbering, elements);
  system.start(std::vector<Coupling>{{3, 0}, {3, 2}, {0, 2}});

  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(7, 7);
  Eigen::VectorXd internal = Eigen::VectorXd::Zero(7);
  const auto add = [&](const std::vector<std::int64_t>& unknowns) {
    const std::size_t n = unknowns.size();
    std::vector<double> lower(n * (n + 1) / 2), force(n);
    for (double& v : force) v = uniform(random);
    for (std::size_t i = 0, at = 0; i < n; ++i) {
      internal(unknowns[i]) += force[i];
      for (std::size_t j = 0; j <= i; ++j, ++at) {
        lower[at] = uniform(random) + (i == j ? 5 : 0);
        full(unknowns[i], unknowns[j]) += lower[at];
        if (i != j) full(unknowns[j], unknowns[i]) += lower[at];
      }
    }
    system.add(unknowns, lower, force);
  };
  add({0, 1, 2, 3});
  add({2, 3, 4, 5});
  add({0, 1, 4, 5, 6});  // a contact row: node 0, node 2, the multiplier

  std::vector<double> external(6), step(6, 0.0);
  for (double& v : external) v = uniform(random);
  step[1] = 0.3;
  step[4] = -0.7;
  Eigen::VectorXd b = -internal;
  for (int i = 0; i < 6; ++i) b(i) += external[i];
  for (const int imposed : {1, 4}) {
    full.row(imposed).setZero();
    full(imposed, imposed) = 1;
    b(imposed) = step[imposed];
  }
  const Eigen::VectorXd expected = full.fullPivLu().solve(b);

  EXPECT_TRUE(system.take_new_pattern());
  EXPECT_FALSE(system.take_new_pattern());
  DirectSolver solver;
  solver.analyse(system.matrix());
  solver.factorise();
  std::vector<double> solution = system.right_side(external, step);
  solver.solve(solution);
  for (std::int64_t unknown = 0; unknown < 7; ++unknown) {
    if (const std::int64_t e = system.equation(unknown); e >= 0) {
      EXPECT_NEAR(solution[e], expected(unknown), 1e-13);
    }
  }
}

// Couplings that come and go leave the pattern as it is; new ones make it grow.
TEST(System, KeepsItsPatternWhileItHasRoom) {
  const Numbering numbering = number_equations(3, 1, std::vector<std::uint8_t>{1, 1, 1}, 1);
  Ragged<std::int32_t> elements;
  elements.push_back(std::vector<std::int32_t>{0, 1, 2});
  System system(numbering, elements);
  system.take_new_pattern();
  system.start(std::vector<Coupling>{{3, 0}});
  EXPECT_TRUE(system.take_new_pattern());
  system.start({});
  system.start(std::vector<Coupling>{{3, 0}});
  EXPECT_FALSE(system.take_new_pattern());
  system.start(std::vector<Coupling>{{3, 2}});
  EXPECT_TRUE(system.take_new_pattern());
  system.start(std::vector<Coupling>{{3, 0}, {3, 2}});
  EXPECT_FALSE(system.take_new_pattern());
}

}  // namespace
}  // namespace lacon
