#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/operators/evolution/problem/system.hpp"

namespace lacon {
namespace {

// Solving with imposed displacements eliminated is solving the full system with their rows replaced by u = value: symmetric,
// and general with elements of both kinds.
class Elimination : public testing::TestWithParam<Symmetry> {};

TEST_P(Elimination, IsThatOfTheFullSystem) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::vector<std::uint8_t> free{1, 0, 1, 1, 0, 1};  // three nodes, two displacements
  const Numbering numbering = number_equations(3, 2, free, 1);
  Ragged<std::int32_t> elements;
  elements.push_back(std::vector<std::int32_t>{0, 1});
  elements.push_back(std::vector<std::int32_t>{1, 2});
  System system(numbering, elements, GetParam());
  system.start(std::vector<Coupling>{{3, 0}, {3, 2}, {0, 2}});

  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(7, 7);
  Eigen::VectorXd internal = Eigen::VectorXd::Zero(7);
  const auto add = [&](const std::vector<std::int64_t>& unknowns, bool symmetric) {
    const std::size_t n = unknowns.size();
    std::vector<double> values, force(n);
    for (double& v : force) v = uniform(random);
    for (std::size_t i = 0; i < n; ++i) {
      internal(unknowns[i]) += force[i];
      for (std::size_t j = 0; j < (symmetric ? i + 1 : n); ++j) {
        values.push_back(uniform(random) + (i == j ? 5 : 0));
        full(unknowns[i], unknowns[j]) += values.back();
        if (symmetric && i != j) full(unknowns[j], unknowns[i]) += values.back();
      }
    }
    symmetric ? system.add(unknowns, values, force) : system.add_unsymmetric(unknowns, values, force);
  };
  const bool symmetric = GetParam() == Symmetry::symmetric;
  add({0, 1, 2, 3}, true);
  add({2, 3, 4, 5}, symmetric);
  add({0, 1, 4, 5, 6}, symmetric);  // a contact row: node 0, node 2, the multiplier

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

INSTANTIATE_TEST_SUITE_P(System, Elimination, testing::Values(Symmetry::symmetric, Symmetry::general));

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
  const std::int64_t bare = entries_with({});
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

// The same where what comes and goes couples displacements too (a consistent tangent of contact), and is not symmetric
// (friction): the stiffness stays what it is, in any pattern.
TEST(System, KeepsItsStiffnessUnderCouplesOfNodes) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Numbering numbering = number_equations(4, 1, std::vector<std::uint8_t>{0, 1, 1, 1}, 2);
  Ragged<std::int32_t> elements;
  elements.push_back(std::vector<std::int32_t>{0, 1});
  elements.push_back(std::vector<std::int32_t>{2, 3});
  const std::vector<double> stiffness{4, -1, 5}, force{0.1, 0.2};
  for (const Symmetry symmetry : {Symmetry::symmetric, Symmetry::general}) {
    const bool symmetric = symmetry == Symmetry::symmetric;
    System kept(numbering, elements, symmetry), anew(numbering, elements, symmetry);
    for (int round = 0; round < 12; ++round) {
      std::vector<std::int64_t> unknowns;  // of a contact cell: two or more displacements, a multiplier
      for (std::int64_t node = 0; node < 4; ++node)
        if (random() % 2) unknowns.push_back(node);
      unknowns.push_back(4 + round % 2);
      std::vector<Coupling> couplings;
      for (const std::int64_t a : unknowns)
        for (const std::int64_t b : unknowns)
          if (a > b) couplings.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
      const std::size_t n = unknowns.size();
      std::vector<double> matrix(symmetric ? n * (n + 1) / 2 : n * n), residual(n);
      for (double& v : matrix) v = uniform(random);
      for (double& v : residual) v = uniform(random);
      for (System* system : {&kept, &anew}) {
        const bool keep = system == &kept && round > 0;
        system->start(couplings, keep);
        for (std::size_t c = 0; c < elements.size(); ++c)
          system->add(std::vector<std::int64_t>(elements[c].begin(), elements[c].end()),
                      keep ? std::span<const double>() : stiffness, force);
        if (!keep) system->stiffness_is_complete();
        if (round % 3 == 2) continue;  // open
        symmetric ? system->add(unknowns, matrix, residual) : system->add_unsymmetric(unknowns, matrix, residual);
      }
      ASSERT_EQ(kept.matrix().n_entries(), anew.matrix().n_entries());
      EXPECT_TRUE(std::equal(kept.matrix().values().begin(), kept.matrix().values().end(), anew.matrix().values().begin()))
          << "round " << round;
      const std::vector<double> external{1, 2, 3, 4}, step{0.5, 0, 0, 0};
      EXPECT_EQ(kept.right_side(external, step), anew.right_side(external, step));
    }
  }
}

}  // namespace
}  // namespace lacon
