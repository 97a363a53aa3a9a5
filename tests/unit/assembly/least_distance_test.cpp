#include "lacon/assembly/least_distance.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lacon {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(LeastDistance, IsTheProjectionOnAWedge) {
  MatrixXd rows(2, 2);
  rows << 1, 0, 0, 1;
  const VectorXd bounds = VectorXd::Zero(2);
  const auto to = [&](double x, double y) { return *least_distance(rows, bounds, Eigen::Vector2d(x, y)); };
  EXPECT_EQ(to(3, 4).point, Eigen::Vector2d(3, 4));
  EXPECT_TRUE(to(3, 4).forces.isZero());
  EXPECT_TRUE(to(-2, 5).point.isApprox(Eigen::Vector2d(0, 5), 1e-14));
  EXPECT_TRUE(to(-2, 5).forces.isApprox(Eigen::Vector2d(2, 0), 1e-14));
  EXPECT_LT(to(-2, -1e4).point.norm(), 1e-10);
  EXPECT_TRUE(to(-2, -1e4).forces.isApprox(Eigen::Vector2d(2, 1e4), 1e-12));
}

/// What the nearest point is known by (Karush, Kuhn and Tucker): it is allowed, forces push, and only from sides that it lies
/// on.
TEST(LeastDistance, MeetsTheConditionsOfTheNearestPoint) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Index n = 1 + trial % 7, m = 1 + 7 * (trial % 30);
    const VectorXd inside = VectorXd::NullaryExpr(n, [&] { return normal(random); });
    MatrixXd rows = MatrixXd::NullaryExpr(m, n, [&] { return normal(random); });
    for (Eigen::Index i = 1; i < m; i += 3) rows.row(i) = rows.row(i - 1);  // many patches of one wall
    VectorXd bounds = rows * inside;
    for (Eigen::Index i = 0; i < m; ++i) bounds[i] -= i % 4 == 0 ? 0.0 : std::abs(normal(random));
    const double far = trial % 2 == 0 ? 1 : 1e3;
    const VectorXd aim = inside + far * VectorXd::NullaryExpr(n, [&] { return normal(random); });
    const auto found = least_distance(rows, bounds, aim);
    ASSERT_TRUE(found) << trial;
    const VectorXd slack = rows * found->point - bounds;
    EXPECT_GT(slack.minCoeff(), -1e-9 * far) << trial;
    EXPECT_GE(found->forces.minCoeff(), 0) << trial;
    EXPECT_LT(found->forces.dot(slack), 1e-9 * far * far) << trial;
    EXPECT_TRUE((aim + rows.transpose() * found->forces - found->point).isZero(1e-9 * far)) << trial;
  }
}

TEST(LeastDistance, IsNothingWhereNoPointIsAllowed) {
  MatrixXd rows(2, 1);
  rows << 1, -1;
  EXPECT_FALSE(least_distance(rows, Eigen::Vector2d(1, 1), VectorXd::Zero(1)));  // x >= 1 and x <= -1
  EXPECT_TRUE(least_distance(rows, Eigen::Vector2d(1, -1), VectorXd::Zero(1)));
}

}  // namespace
}  // namespace lacon
