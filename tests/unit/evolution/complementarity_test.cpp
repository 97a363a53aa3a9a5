// Small linear complementarity problems: against all choices of pairs, with pairs that change one by one, and without a
// solution.
#include "lacon/operators/evolution/newton/complementarity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

namespace lacon {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

VectorXd normal_vector(Eigen::Index n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return VectorXd::NullaryExpr(n, [&] { return normal(random); });
}

/// Positive definite; principal pivots of it are P-matrices that are not symmetric, as those of active and open patches
/// together.
MatrixXd random_p_matrix(Eigen::Index n, Eigen::Index pivots, std::mt19937& random) {
  const MatrixXd root = normal_vector(n * n, random).reshaped(n, n),
                 h = root * root.transpose() + 1e-3 * MatrixXd::Identity(n, n);
  MatrixXd turned = h;
  const auto a = Eigen::seqN(0, pivots), b = Eigen::seqN(pivots, n - pivots);
  const MatrixXd inverse = h(a, a).inverse();
  turned(a, a) = inverse, turned(a, b) = -inverse * h(a, b), turned(b, a) = h(b, a) * inverse;
  turned(b, b) = h(b, b) - h(b, a) * inverse * h(a, b);
  return turned;
}

/// By trying all choices.
VectorXd by_brute_force(const MatrixXd& h, const VectorXd& q) {
  const Eigen::Index n = q.size();
  for (std::uint32_t choice = 0; choice < 1U << n; ++choice) {
    std::vector<Eigen::Index> pairs;
    for (Eigen::Index i = 0; i < n; ++i)
      if (choice >> i & 1) pairs.push_back(i);
    VectorXd z = VectorXd::Zero(n);
    if (!pairs.empty()) {
      const VectorXd side = -q(pairs), found = MatrixXd(h(pairs, pairs)).lu().solve(side);
      z(pairs) = found;
    }
    if (z.minCoeff() >= 0 && (q + h * z).minCoeff() >= -1e-9) return z;
  }
  ADD_FAILURE() << "a P-matrix has a solution";
  return VectorXd::Zero(n);
}

TEST(Complementarity, IsSolvedAsByTryingAllChoices) {
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    const Eigen::Index n = 1 + round % 9;
    const MatrixXd h = random_p_matrix(n, round % (n + 1), random);
    const VectorXd q = normal_vector(n, random);
    const auto z = solve_complementarity(h, q, 1e-12);
    ASSERT_TRUE(z) << round;
    EXPECT_LE((*z - by_brute_force(h, q)).norm(), 1e-8 * (1 + z->norm())) << round;
  }
}

/// Beams that touch along their length: changing all wrong pairs goes round for ever, one by one it ends.
TEST(Complementarity, EndsWhereAllAtOnceGoRound) {
  MatrixXd h(3, 3);  // Murty's example of a P-matrix
  h << 1, 2, 0, 0, 1, 2, 2, 0, 1;
  const VectorXd q = VectorXd::Constant(3, -1), z = VectorXd::Constant(3, 1.0 / 3);
  const auto found = solve_complementarity(h, q, 1e-12);
  ASSERT_TRUE(found);
  EXPECT_LE((*found - z).norm(), 1e-12);
  std::mt19937 random(8);
  for (int round = 0; round < 50; ++round) {
    const Eigen::Index n = 60;
    const MatrixXd many = random_p_matrix(n, round % n, random);
    const VectorXd side = normal_vector(n, random);
    const auto all = solve_complementarity(many, side, 1e-12);
    ASSERT_TRUE(all) << round;
    const VectorXd w = side + many * *all;
    EXPECT_GE(all->minCoeff(), -1e-6);
    EXPECT_GE(w.minCoeff(), -1e-6);
    EXPECT_LE(w.cwiseProduct(*all).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(Complementarity, HasNoSolutionWhereNothingResists) {
  MatrixXd h = MatrixXd::Identity(3, 3);
  const VectorXd q = -VectorXd::Ones(3);
  h(1, 1) = 0;
  EXPECT_FALSE(solve_complementarity(h, q, 1e-9));
  h(1, 1) = -1;
  EXPECT_FALSE(solve_complementarity(h, q, 1e-9));
  h = MatrixXd::Ones(3, 3);  // one body, and three supports of it
  EXPECT_FALSE(solve_complementarity(h, q, 1e-9));
  // what is wrong by no more than the digits is right
  const VectorXd nearly = VectorXd::Constant(3, -1e-10);
  const auto z = solve_complementarity(MatrixXd::Identity(3, 3), VectorXd(VectorXd::Unit(3, 0) + nearly), 1e-9);
  EXPECT_TRUE(z);
}

}  // namespace
}  // namespace lacon
