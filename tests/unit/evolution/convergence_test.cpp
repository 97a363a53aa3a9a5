// When an instant is solved: figures in, verdict out.
#include "lacon/operators/evolution/newton/convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lacon {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

IterationReport judged(const ConvergenceCriteria& criteria, const ForceFigures& forces) {
  IterationReport report;
  judge_forces(criteria, forces, report);
  return report;
}

TEST(Convergence, TheRelativeResidualIsThatOfThePresentReference) {
  const ConvergenceCriteria criteria{.resi_glob_rela = 1e-6, .resi_glob_maxi = {}};
  const IterationReport met = judged(criteria, {.unbalanced = 2e-5, .worst_dof = 7, .significant = 2e-5, .reference = 40});
  EXPECT_DOUBLE_EQ(met.rela, 5e-7);
  EXPECT_DOUBLE_EQ(met.maxi, 2e-5);
  EXPECT_EQ(met.worst_dof, 7);
  EXPECT_TRUE(met.converged());
  EXPECT_FALSE(judged(criteria, {.unbalanced = 2e-5, .significant = 2e-5, .reference = 10}).converged());
}

TEST(Convergence, RoundOffIsNoRelativeResidual) {
  const ConvergenceCriteria criteria{.resi_glob_rela = 1e-6, .resi_glob_maxi = {}};
  EXPECT_TRUE(judged(criteria, {.unbalanced = 1e-20, .significant = 0, .reference = 0}).converged());
  EXPECT_TRUE(judged(criteria, {.unbalanced = 1e-20, .significant = 0, .reference = 1e-20}).converged());
  // but what is more than round-off, against nothing, is infinitely large
  const IterationReport left = judged(criteria, {.unbalanced = 1e-3, .significant = 1e-3, .reference = 0});
  EXPECT_TRUE(std::isinf(left.rela));
  EXPECT_FALSE(left.converged());
}

// Of a body that is far stiffer than its neighbour round-off is as large as the forces between them.
TEST(Convergence, RoundOffBesideForcesIsToldAndNotAllOfThem) {
  const ConvergenceCriteria criteria{.resi_glob_rela = 1e-6, .resi_glob_maxi = {}};
  const auto left = [&](double unbalanced, double felt) {
    return judged(criteria, {.unbalanced = unbalanced, .significant = 0, .felt = felt, .reference = 20});
  };
  EXPECT_FALSE(left(1e-6, 10).round_off);
  EXPECT_TRUE(left(1e-6, 10).converged());
  EXPECT_TRUE(left(1e-2, 10).round_off);
  EXPECT_TRUE(left(1e-2, 10).converged());
  EXPECT_TRUE(left(1, 10).round_off);
  EXPECT_FALSE(left(1, 10).converged());
  EXPECT_FALSE(left(1, 0).round_off);
  EXPECT_TRUE(left(1, 0).converged());
}

TEST(Convergence, TheAbsoluteResidualCountsRoundOffToo) {
  const ConvergenceCriteria criteria{.resi_glob_rela = {}, .resi_glob_maxi = 1e-12};
  EXPECT_FALSE(judged(criteria, {.unbalanced = 1e-11, .significant = 0, .reference = 1}).converged());
  EXPECT_TRUE(judged(criteria, {.unbalanced = 1e-13, .significant = 1e-13, .reference = 0}).converged());
}

TEST(Convergence, TheLargestResidualOverItsOwnReferenceIsJudged) {
  const ConvergenceCriteria criteria{.resi_glob_rela = {}, .resi_glob_maxi = {}, .resi_refe_rela = 1e-3};
  IterationReport report;
  judge_forces(criteria, {.unbalanced = 5, .significant = 5, .reference = 1, .over_own = 9e-4}, report);
  EXPECT_TRUE(report.converged());
  judge_forces(criteria, {.unbalanced = 5, .significant = 5, .reference = 1, .over_own = 2e-3}, report);
  EXPECT_FALSE(report.converged());
}

TEST(Convergence, CellsThatAreCutAnewHaveAnotherEquilibrium) {
  IterationReport report = judged({.resi_glob_rela = 1e-6, .resi_glob_maxi = {}}, {.unbalanced = 1e-9, .reference = 1});
  EXPECT_TRUE(report.converged());
  report.pairs_anew = true;
  EXPECT_TRUE(report.in_equilibrium());
  EXPECT_FALSE(report.converged());
}

TEST(Convergence, WhatIsNotANumberMeetsNothing) {
  for (const ConvergenceCriteria& criteria : {ConvergenceCriteria{.resi_glob_rela = 1e-6, .resi_glob_maxi = {}},
                                              ConvergenceCriteria{.resi_glob_rela = {}, .resi_glob_maxi = 1e-6}})
    for (const double bad : {nan, std::numeric_limits<double>::infinity()})
      EXPECT_FALSE(judged(criteria, {.unbalanced = bad, .significant = bad, .reference = 1}).converged());
}

TEST(Convergence, ContactNeedsStatusesGeometryAndGaps) {
  const ConvergenceCriteria criteria{.resi_glob_rela = {}, .resi_glob_maxi = {}, .resi_geom = 1e-6, .constraint = 1e-8};
  const auto judge = [&](const MotionFigures& motion, double gap) {
    IterationReport report;
    judge_contact(criteria, motion, gap, report);
    return report;
  };
  EXPECT_TRUE(judge({.increment = 1e-7, .whole = 1, .vanishing = 1e-9}, 1e-9).converged());
  EXPECT_FALSE(judge({.increment = 1e-5, .whole = 1, .vanishing = 1e-9}, 1e-9).converged());
  EXPECT_FALSE(judge({.increment = 1e-7, .whole = 1, .vanishing = 1e-9}, 1e-7).converged());
  EXPECT_TRUE(judge({.increment = 1e-16, .whole = 1e-16, .vanishing = 1e-9}, 0).converged());  // displacements that vanish
  EXPECT_TRUE(judge({.increment = 0, .whole = 0, .vanishing = 0}, 0).converged());
  IterationReport changing = judge({.increment = 0, .whole = 0, .vanishing = 0}, 0);
  changing.status_changes = 1;
  EXPECT_FALSE(changing.converged());
  IterationReport rough = judge({.increment = 0, .whole = 0, .vanishing = 0}, 0);
  rough.solution.rough = true;
  EXPECT_FALSE(rough.converged());
}

}  // namespace
}  // namespace lacon
