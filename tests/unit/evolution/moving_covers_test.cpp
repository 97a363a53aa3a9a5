// A symmetric matrix and what it lacks of ends that move: the sum is solved by solutions of the former.
#include "lacon/operators/evolution/newton/moving_covers.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace lacon {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
constexpr int n = 47;

MovingCover cover(const VectorXd& column, const VectorXd& row) {
  MovingCover cover;
  for (int i = 0; i < n; ++i) {
    if (column[i] != 0) cover.column.emplace_back(i, column[i]);
    if (row[i] != 0) cover.row.emplace_back(i, row[i]);
  }
  return cover;
}

struct Sum {
  MatrixXd a = VectorXd::LinSpaced(n, 1, 4).asDiagonal(), whole;
  std::vector<MovingCover> covers;
  VectorXd b = VectorXd::LinSpaced(n, -3, 2);
  double largest = 0;  ///< entry of a right side
  int solutions = 0;

  /// @param size of what is lacking  @param terms of it
  explicit Sum(double size, int terms = 2) {
    a(0, n - 1) = a(n - 1, 0) = 1, a(n - 1, n - 1) = 0;
    whole = a;
    for (int k = 0; k < terms; ++k) {
      VectorXd column(n), row = VectorXd::Zero(n);
      for (int i = 0; i < n; ++i) column[i] = size * std::cos(3 * i + k);
      row[k] = 0.5, row[k + 2] = -1;
      covers.push_back(cover(column, row));
      whole += column * row.transpose();
    }
  }
  VectorXd solve(std::int64_t* turned = nullptr) {
    const VectorXd first = a.lu().solve(b);
    std::vector<double> x(first.begin(), first.end());
    const std::int64_t count = follow_covers(
        covers, b.cwiseAbs().maxCoeff(),
        [&](std::vector<double>& side) {
          const VectorXd given = Eigen::Map<VectorXd>(side.data(), n), found = a.lu().solve(given);
          ++solutions;
          largest = std::max(largest, given.cwiseAbs().maxCoeff());
          std::copy(found.begin(), found.end(), side.begin());
        },
        x);
    if (turned) *turned = count;
    return Eigen::Map<VectorXd>(x.data(), n);
  }
};

TEST(MovingCovers, AreSolvedWithWhatTheMatrixLacks) {
  for (const double size : {1e-3, 0.3, 5.0, 1e3}) {
    Sum sum(size);
    const VectorXd expected = sum.whole.lu().solve(sum.b);
    EXPECT_NEAR((sum.solve() - expected).norm() / expected.norm(), 0, 1e-11) << size;
    EXPECT_NEAR(sum.largest, 3, 1e-14);  // right sides are as large as what is solved, whatever the covers are
    EXPECT_EQ(sum.solutions, 2);
  }
}

// A line of a cover is three terms, and a patch has many: fewer solutions than terms leave a thousandth of what A alone leaves.
TEST(MovingCovers, OfManyTermsAreSolvedByIterations) {
  constexpr int terms = 40;
  for (const double size : {1e-3, 0.03}) {
    Sum sum(size, terms);
    const VectorXd expected = sum.whole.lu().solve(sum.b), alone = sum.a.lu().solve(sum.b);
    EXPECT_LT((sum.solve() - expected).norm(), 1e-3 * (alone - expected).norm()) << size;
    EXPECT_NEAR(sum.largest, 3, 1e-14);
    EXPECT_LT(sum.solutions, 17);
  }
}

// Where iterations get nowhere, as those of a shift do, the solution of A alone stays, to its last bit.
TEST(MovingCovers, ThatIterationsDoNotFindAreLeftOut) {
  Sum sum(0, 0);
  sum.a = VectorXd::Ones(n).asDiagonal();
  for (int k = 0; k < 40; ++k)
    sum.covers.push_back(cover(VectorXd::Unit(n, k), VectorXd::Unit(n, (k + 1) % 40) - VectorXd::Unit(n, k)));
  sum.b = VectorXd::Unit(n, 0);
  EXPECT_EQ(sum.solve(), sum.b);
}

// Where a rank-one term turns a positive eigenvalue of the sum to the negative one of A, its pivots count one more.
TEST(MovingCovers, TellHowManyNegativePivotsTheyTurn) {
  Sum sum(0);
  sum.a = VectorXd::Ones(n).asDiagonal();
  sum.a(2, 2) = -1;
  const VectorXd e = VectorXd::Unit(n, 2);
  for (const auto& [size, expected] : {std::pair(3.0, 1), std::pair(0.5, 0), std::pair(-3.0, 0)}) {
    sum.covers = {cover(size * e, e)};
    std::int64_t turned = -1;
    sum.solve(&turned);
    EXPECT_EQ(turned, expected) << size;
  }
}

TEST(MovingCovers, OfASumThatIsSingularAreLeftOut) {
  Sum sum(0);
  sum.a = VectorXd::Ones(n).asDiagonal();
  sum.covers = {cover(-VectorXd::Unit(n, 1), VectorXd::Unit(n, 1))};
  EXPECT_EQ(sum.solve(), sum.b);
}

}  // namespace
}  // namespace lacon
