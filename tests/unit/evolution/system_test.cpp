#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "lacon/assembly/mumps_engine.hpp"
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

  MumpsEngine engine;
  engine.analyse(system.matrix());
  engine.factorise(system.matrix());
  std::vector<double> solution = system.right_side(external, step);
  engine.solve(solution);
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
  const auto entries_with = [&](const std::vector<Coupling>& couplings) {
    system.start(couplings);
    return system.matrix().n_entries();
  };
  const std::int64_t bare = system.matrix().n_entries();
  EXPECT_EQ(entries_with({{3, 0}}), bare + 1);
  EXPECT_EQ(entries_with({}), bare + 1);
  EXPECT_EQ(entries_with({{3, 0}}), bare + 1);
  EXPECT_EQ(entries_with({{3, 2}}), bare + 2);
  EXPECT_EQ(entries_with({{3, 0}, {3, 2}}), bare + 2);
}

// A stiffness that is kept, with rows of a multiplier that change and outgrow the pattern, gives the matrix and the right side
// of a stiffness that is added anew.
TEST(System, KeepsItsStiffness) {
  const Numbering numbering = number_equations(3, 1, std::vector<std::uint8_t>{0, 1, 1}, 1);
  Ragged<std::int32_t> elements;
  elements.push_back(std::vector<std::int32_t>{0, 1, 2});
  const std::vector<std::int64_t> solid{0, 1, 2}, row{0, 2, 3};
  const std::vector<double> stiffness{4, -1, 5, -2, -3, 6}, force{0.1, 0.2, 0.3}, contact{0, 0, 0, 7, 8, 0}, gap{0.4, 0.5, 0.6};
  const std::vector<Coupling> first{{3, 1}}, later{{3, 0}, {3, 2}};
  System kept(numbering, elements), anew(numbering, elements);
  for (const bool again : {false, true}) {
    kept.start(again ? later : first, again);
    anew.start(again ? later : first);
    kept.add(solid, again ? std::span<const double>() : stiffness, force);
    anew.add(solid, stiffness, force);
    kept.stiffness_is_complete();
    if (again) kept.add(row, contact, gap);
    if (again) anew.add(row, contact, gap);
  }
  ASSERT_EQ(kept.matrix().n_entries(), anew.matrix().n_entries());
  EXPECT_TRUE(std::equal(kept.matrix().values().begin(), kept.matrix().values().end(), anew.matrix().values().begin()));
  const std::vector<double> external{1, 2, 3}, step{0.5, 0, 0};
  EXPECT_EQ(kept.right_side(external, step), anew.right_side(external, step));
}

}  // namespace
}  // namespace lacon
