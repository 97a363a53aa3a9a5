#include <gtest/gtest.h>

#include <random>

#include "dense.hpp"
#include "lacon/assembly/ordering.hpp"

namespace lacon {
namespace {

using test::Chain;
using test::dense;

// Imposed displacements have no equation; the others are numbered node by node, multipliers last.
TEST(Numbering, LeavesOutWhatIsImposed) {
  const Chain chain(3, 2, {1, 0, 0, 0, 1, 1});
  EXPECT_EQ(chain.numbering.n_equations(), 5);
  EXPECT_EQ(chain.numbering.of(0, 0), 0);
  EXPECT_EQ(chain.numbering.of(0, 1), -1);
  EXPECT_EQ(chain.numbering.of(1, 0), -1);
  EXPECT_EQ(chain.numbering.of(2, 1), 2);
  EXPECT_EQ(chain.numbering.of_patch(1), 4);
}

// The sum of element matrices is what dense addition gives, with equations left out and in any order.
TEST(SymmetricMatrix, AssemblesAsDenseAdditionDoes) {
  std::mt19937 random(7);
  const Chain chain(6, 0, {1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 1, 1});
  SymmetricMatrix matrix(chain.numbering, chain.cliques, {});
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(matrix.size(), matrix.size());
  for (std::size_t c = 0; c < chain.cliques.size(); ++c) {
    std::vector<std::int64_t> equations;
    for (const int k : {1, 0})
      for (int d = 0; d < 2; ++d) equations.push_back(chain.numbering.of(chain.cliques[c][k], d));
    const std::vector<double> lower = test::random_lower(4, random);
    matrix.add(equations, lower);
    for (int i = 0, at = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j, ++at) {
        if (equations[i] < 0 || equations[j] < 0) continue;
        expected(equations[i], equations[j]) += lower[at];
        if (i != j) expected(equations[j], equations[i]) += lower[at];
      }
  }
  EXPECT_EQ((dense(matrix) - expected).cwiseAbs().maxCoeff(), 0.0);
}

// Two degrees of freedom with one equation (tied multipliers): R^T A R with the identification R.
TEST(SymmetricMatrix, AddsUpTiedDegreesOfFreedom) {
  std::mt19937 random(3);
  const Chain chain(2, 1);
  const std::vector<Coupling> couplings{{2, 0}, {2, 1}};
  SymmetricMatrix matrix(chain.numbering, chain.cliques, couplings);
  const std::vector<std::int64_t> equations{0, 4, 1, 4};
  const std::vector<double> lower = test::random_lower(4, random);
  matrix.add(equations, lower);
  Eigen::MatrixXd element = Eigen::MatrixXd::Zero(4, 4), identification = Eigen::MatrixXd::Zero(4, 5);
  for (int i = 0, at = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j, ++at) element(i, j) = element(j, i) = lower[at];
  for (int i = 0; i < 4; ++i) identification(i, equations[i]) = 1;
  const Eigen::MatrixXd expected = identification.transpose() * element * identification;
  EXPECT_LE((dense(matrix) - expected).cwiseAbs().maxCoeff(), 4e-16);
}

TEST(SymmetricMatrix, MultipliesBySymmetry) {
  std::mt19937 random(5);
  const Chain chain(5);
  SymmetricMatrix matrix(chain.numbering, chain.cliques, {});
  test::add_springs(matrix, chain);
  Eigen::VectorXd x = Eigen::VectorXd::Random(matrix.size()), y(matrix.size());
  matrix.multiply({x.data(), static_cast<std::size_t>(x.size())}, {y.data(), static_cast<std::size_t>(y.size())});
  EXPECT_LE((y - dense(matrix) * x).cwiseAbs().maxCoeff(), 1e-14);
}

// A pattern knows what fits into it: the analysis may stand exactly then.
TEST(SymmetricMatrix, KnowsItsRoom) {
  const Chain chain(4, 1);
  const std::vector<Coupling> couplings{{4, 0}};
  const SymmetricMatrix matrix(chain.numbering, chain.cliques, couplings);
  EXPECT_TRUE(matrix.has_room_for(couplings));
  EXPECT_TRUE(matrix.has_room_for(std::vector<Coupling>{{1, 2}, {0, 4}}));
  EXPECT_FALSE(matrix.has_room_for(std::vector<Coupling>{{4, 3}}));
}

// An element that does not fit is a defect of the caller, never a wrong entry.
TEST(SymmetricMatrix, RefusesWhatItHasNoRoomFor) {
  const Chain chain(4);
  SymmetricMatrix matrix(chain.numbering, chain.cliques, {});
  EXPECT_THROW(matrix.add(std::vector<std::int64_t>{0, 7}, std::vector<double>{1, 1, 1}), std::logic_error);
}

// Every equation has one place, and a multiplier comes behind all nodes of its row.
TEST(Ordering, PutsMultipliersBehindTheirNodes) {
  const Chain chain(40, 3);
  std::vector<Coupling> couplings;
  for (std::int32_t p = 0; p < 3; ++p)
    for (std::int32_t k = 0; k < 5; ++k) couplings.push_back({40 + p, 12 * p + k});
  const SymmetricMatrix matrix(chain.numbering, chain.cliques, couplings);
  const std::vector<std::int32_t> order = elimination_order(matrix);
  std::vector<std::int32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], static_cast<std::int32_t>(i));
  for (const Coupling& c : couplings)
    for (int d = 0; d < 2; ++d) EXPECT_GT(order[chain.numbering.of_patch(c.a - 40)], order[chain.numbering.of(c.b, d)]);
}

}  // namespace
}  // namespace lacon
