// Relations that follow from others: as many as the rank lacks, each the sum that is said, whatever the order.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "lacon/operators/evolution/problem/dependent_relations.hpp"

namespace lacon {
namespace {

Eigen::MatrixXd matrix_of(const std::vector<FreeRow>& rows, Eigen::Index n_unknowns) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(std::ssize(rows), n_unknowns);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t i = 0; i < rows[r].unknowns.size(); ++i)
      matrix(static_cast<Eigen::Index>(r), rows[r].unknowns[i]) = rows[r].coefficients[i];
  return matrix;
}

/// As many as the rank lacks, each the sum of independent ones before it.
void expect_dependent(const std::vector<FreeRow>& rows, Eigen::Index n_unknowns) {
  const Eigen::MatrixXd matrix = matrix_of(rows, n_unknowns);
  const std::vector<DependentRelation> found = dependent_relations(rows);
  Eigen::FullPivLU<Eigen::MatrixXd> factors(matrix);
  factors.setThreshold(1e-9);
  EXPECT_EQ(std::ssize(found), std::ssize(rows) - factors.rank());
  std::set<std::size_t> dependent;
  for (const DependentRelation& follows : found) dependent.insert(follows.relation);
  for (const DependentRelation& follows : found) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(n_unknowns);
    for (const auto& [other, factor] : follows.sum_of) {
      EXPECT_LT(other, follows.relation);
      EXPECT_FALSE(dependent.contains(other));
      sum += factor * matrix.row(static_cast<Eigen::Index>(other));
    }
    const Eigen::RowVectorXd row = matrix.row(static_cast<Eigen::Index>(follows.relation));
    EXPECT_LE((sum - row).norm(), 1e-8 * (row.norm() + sum.norm()));
  }
}

TEST(DependentRelations, AreAsManyAsTheRankLacks) {
  std::mt19937 random(7);
  const auto number = [&](int n) { return static_cast<std::int64_t>(random() % static_cast<unsigned>(n)); };
  std::uniform_real_distribution<double> value(-1, 1);
  std::size_t with_some = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int n_unknowns = 3 + static_cast<int>(number(25));
    std::vector<FreeRow> rows;
    for (std::int64_t r = 0, n = 1 + number(20); r < n; ++r) {
      std::set<std::int64_t> unknowns;
      for (std::int64_t i = 0, terms = number(4); i < terms; ++i) unknowns.insert(number(n_unknowns));
      FreeRow& row = rows.emplace_back();
      for (const std::int64_t unknown : unknowns)
        row.unknowns.push_back(unknown), row.coefficients.push_back(trial % 2 ? value(random) : number(2) ? 1.0 : -1.0);
    }
    for (std::int64_t s = 0, n = number(4); s < n && rows.size() > 2; ++s) {  // sums of some
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(n_unknowns);
      const Eigen::MatrixXd matrix = matrix_of(rows, n_unknowns);
      for (int k = 0; k < 3; ++k) sum += value(random) * matrix.row(number(static_cast<int>(rows.size())));
      FreeRow& row = rows.emplace_back();
      for (std::int64_t u = 0; u < n_unknowns; ++u)
        if (sum[u] != 0) row.unknowns.push_back(u), row.coefficients.push_back(sum[u]);
    }
    std::ranges::shuffle(rows, random);
    expect_dependent(rows, n_unknowns);
    with_some += !dependent_relations(rows).empty();
  }
  EXPECT_GT(with_some, 50);
}

TEST(DependentRelations, AreNoneOfTiesWithAnUnknownEach) {
  // a chain and a star: every node is tied to the one before it, or all to the first
  for (const bool star : {false, true}) {
    std::vector<FreeRow> rows;
    for (std::int64_t i = 1; i < 50000; ++i) rows.push_back({{star ? 0 : i - 1, i}, {1.0, -1.0}});
    EXPECT_TRUE(dependent_relations(rows).empty());
    rows.push_back({{49999, 0}, {2.0, -2.0}});  // and the last one to the first
    const auto found = dependent_relations(rows);
    EXPECT_EQ(found.size(), 1);
    EXPECT_EQ(found.front().relation, rows.size() - 1);
    EXPECT_EQ(found.front().sum_of.size(), star ? 1 : rows.size() - 1);
  }
}

TEST(DependentRelations, HaveNothingLeftWhereAllIsImposed) {
  const std::vector<FreeRow> rows = {{{}, {}}, {{3}, {2.0}}, {{3}, {5.0}}};
  const auto found = dependent_relations(rows);
  ASSERT_EQ(found.size(), 2);
  EXPECT_EQ(found[0].relation, 0);
  EXPECT_TRUE(found[0].sum_of.empty());
  EXPECT_EQ(found[1].relation, 2);
  ASSERT_EQ(found[1].sum_of.size(), 1);
  EXPECT_DOUBLE_EQ(found[1].sum_of[0].second, 2.5);
}

}  // namespace
}  // namespace lacon
