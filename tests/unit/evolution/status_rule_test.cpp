// Which statuses an iteration goes on with: plain changes, sets that come back, and where they cannot end.
#include "lacon/operators/evolution/newton/status_rule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "statuses.hpp"

namespace lacon {
namespace {

using Statuses = std::vector<Status>;

/// Bodies that give way linearly: gap = start + flexibility pressure, for pressures and gaps that exclude each other.
struct Convex {
  std::size_t n;
  std::vector<double> flexibility, start;

  explicit Convex(std::mt19937& random) : n(3 + random() % 5), flexibility(n * n, 0.0), start(n) {
    std::normal_distribution<double> normal;
    std::vector<double> root(n * n);
    for (double& entry : root) entry = normal(random);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < n; ++k) flexibility[i * n + j] += root[i * n + k] * root[j * n + k];
        if (i == j) flexibility[i * n + j] += 1e-3;
      }
    for (double& gap : start) gap = normal(random);
  }

  /// What pressures and gaps in equilibrium ask for, by elimination among active patches.
  Statuses wanted(const Statuses& now) const {
    std::vector<std::size_t> active;
    for (std::size_t p = 0; p < n; ++p)
      if (now[p] == A) active.push_back(p);
    const std::size_t m = active.size();
    std::vector<double> matrix(m * m), pressure(m);
    for (std::size_t i = 0; i < m; ++i) {
      pressure[i] = -start[active[i]];
      for (std::size_t j = 0; j < m; ++j) matrix[i * m + j] = flexibility[active[i] * n + active[j]];
    }
    for (std::size_t k = 0; k < m; ++k)
      for (std::size_t i = k + 1; i < m; ++i) {
        const double factor = matrix[i * m + k] / matrix[k * m + k];
        for (std::size_t j = k; j < m; ++j) matrix[i * m + j] -= factor * matrix[k * m + j];
        pressure[i] -= factor * pressure[k];
      }
    for (std::size_t k = m; k-- > 0;) {
      for (std::size_t j = k + 1; j < m; ++j) pressure[k] -= matrix[k * m + j] * pressure[j];
      pressure[k] /= matrix[k * m + k];
    }
    Statuses statuses(n, O);
    for (std::size_t p = 0; p < n; ++p) {
      double gap = start[p];
      for (std::size_t j = 0; j < m; ++j) gap += flexibility[p * n + active[j]] * pressure[j];
      const auto at = static_cast<std::size_t>(std::find(active.begin(), active.end(), p) - active.begin());
      if (at < m ? pressure[at] > 0 : gap < 0) statuses[p] = A;
    }
    return statuses;
  }
};

TEST(StatusRule, AConvexProblemEndsWherePlainChangesGoRound) {
  std::mt19937 random(4);
  int rounds = 0;
  for (int sample = 0; sample < 3000; ++sample) {
    const Convex bodies(random);
    StatusRule rule;
    rule.start_instant();
    Statuses now(bodies.n);
    for (Status& status : now) status = random() % 2 ? A : O;
    std::set<Statuses> seen;
    bool solved = false;
    for (int iteration = 0; iteration < 400 && !solved; ++iteration) {
      const Statuses wanted = bodies.wanted(now);
      solved = wanted == now;
      if (solved) break;
      const bool kept = rule.keeps();
      const Statuses next = rule.next(now, wanted);
      rounds += rule.keeps() && !kept;
      now = rule.keeps() ? rule.change(now, wanted) : next;
      ASSERT_FALSE(rule.endless()) << sample;
    }
    EXPECT_TRUE(solved) << sample;
  }
  EXPECT_GT(rounds, 0);  // there are such problems among them
}

TEST(StatusRule, StatusesThatComeBackWaitForTheEquilibrium) {
  StatusRule rule;
  EXPECT_EQ(rule.next({A, O, O}, {O, A, O}), (Statuses{O, A, O}));
  EXPECT_EQ(rule.next({O, A, O}, {O, A, O}), (Statuses{O, A, O}));
  EXPECT_FALSE(rule.keeps());  // it stands
  EXPECT_EQ(rule.next({O, A, O}, {A, O, O}), (Statuses{A, O, O}));
  EXPECT_EQ(rule.next({A, O, O}, {O, A, O}), (Statuses{O, A, O}));
  EXPECT_FALSE(rule.keeps());  // each came back once
  EXPECT_EQ(rule.next({O, A, O}, {A, O, O}), (Statuses{O, A, O}));
  EXPECT_TRUE(rule.keeps());
  ASSERT_TRUE(rule.round());
  EXPECT_EQ(rule.round()->patches, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(rule.round()->period, 2U);
  EXPECT_EQ(rule.next({O, A, O}, {U, A, A}), (Statuses{U, A, O}));  // without master there is no gap to be judged by
  EXPECT_EQ(rule.next({U, A, O}, {A, A, O}), (Statuses{O, A, O}));
  rule.start_instant();
  EXPECT_FALSE(rule.keeps());
}

TEST(StatusRule, PatchesThatNothingSatisfiesAreNamed) {
  StatusRule rule;
  Statuses now{A, O, A};
  const auto other = [](Statuses statuses) {
    statuses[1] = statuses[1] == A ? O : A;
    return statuses;
  };
  for (int iteration = 0; iteration < 4; ++iteration) now = rule.next(now, other(now));
  ASSERT_TRUE(rule.keeps());
  for (int equilibrium = 0; equilibrium < 4; ++equilibrium) {
    EXPECT_FALSE(rule.endless()) << equilibrium;
    now = rule.change(now, other(now));
  }
  ASSERT_TRUE(rule.endless());
  EXPECT_EQ(rule.endless()->patches, std::vector<std::size_t>{1});
  EXPECT_EQ(rule.endless()->period, 2U);
}

}  // namespace
}  // namespace lacon
