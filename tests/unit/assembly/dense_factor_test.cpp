#include "lacon/assembly/tree/dense_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <random>

#include "dense.hpp"

namespace lacon {
namespace {

template <class Real>
class DenseFactorTest : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(DenseFactorTest, Reals);

/// More columns than are eliminated together, twice, and no whole number of times.
constexpr int size = 600;
/// More than a thread takes at a time.
constexpr int n_sides = 40;

/// Entries below 1 and a diagonal of either sign that outweighs them: pivots stay away from zero in any order.
Eigen::MatrixXd any_matrix() {
  std::mt19937 random(3);
  const std::vector<double> values = test::random_values(size * size, random);
  Eigen::MatrixXd matrix(size, size);
  for (int i = 0; i < size; ++i)
    for (int j = 0; j <= i; ++j)
      matrix(i, j) = matrix(j, i) = i == j ? (i % 3 ? 2.0 * size : -2.0 * size) : values[i * size + j];
  return matrix;
}

std::vector<int> any_order() {
  std::vector<int> place(size);
  std::iota(place.begin(), place.end(), 1);
  std::shuffle(place.begin(), place.end(), std::mt19937(4));
  return place;
}

/// One part of the matrix comes as that of some of its equations, as a Schur complement does, the rest entry by entry.
template <class Real>
DenseFactor<Real> filled(const Eigen::MatrixXd& matrix) {
  DenseFactor<Real> factor(any_order());
  std::vector<std::int32_t> some;
  for (std::int32_t i = 0; i < size; i += 2) some.push_back(i);
  std::vector<Real> part(some.size() * some.size(),
                         std::numeric_limits<Real>::quiet_NaN());  // above the diagonal nothing is read
  for (std::size_t a = 0; a < some.size(); ++a)
    for (std::size_t b = 0; b <= a; ++b) part[a * some.size() + b] = static_cast<Real>(matrix(some[a], some[b]) / 2);
  for (std::int32_t i = 0; i < size; ++i)
    for (std::int32_t j = 0; j <= i; ++j)
      factor.entry(j, i) = static_cast<Real>(i % 2 == 0 && j % 2 == 0 ? matrix(i, j) / 2 : matrix(i, j));
  factor.add(some, part);
  return factor;
}

// Solutions are those of the dense matrix, the inertia is that of its eigenvalues, and neither depends on the threads.
TYPED_TEST(DenseFactorTest, SolvesInAnyOrderWithTheSameBits) {
  const Eigen::MatrixXd matrix = any_matrix();
  const Eigen::MatrixXd sides = Eigen::MatrixXd::Random(size, n_sides), expected = matrix.fullPivLu().solve(sides);
  const auto negative = (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().array() < 0).count();
  std::vector<TypeParam> first;
  for (const char* threads : {"1", "2"}) {
    setenv("LACON_THREADS", threads, 1);
    DenseFactor<TypeParam> factor = filled<TypeParam>(matrix);
    ASSERT_TRUE(factor.eliminate(1e-6));
    EXPECT_EQ(factor.negative_pivots(), negative);
    std::vector<TypeParam> x(sides.data(), sides.data() + sides.size()), one(x.begin(), x.begin() + size);
    factor.substitute(x);
    factor.substitute(one);
    const double tolerance = 100 * std::numeric_limits<TypeParam>::epsilon() * expected.cwiseAbs().maxCoeff();
    for (int i = 0; i < n_sides * size; ++i) ASSERT_NEAR(x[i], expected.data()[i], tolerance);
    for (int i = 0; i < size; ++i) ASSERT_NEAR(one[i], expected.data()[i], tolerance);
    if (first.empty())
      first = x;
    else
      EXPECT_EQ(x, first);
  }
  unsetenv("LACON_THREADS");
}

// A pivot that is too small, or no number, is told, wherever it comes.
TYPED_TEST(DenseFactorTest, SaysThatAPivotIsTooSmall) {
  const std::vector<int> place = any_order();
  for (const int at : {1, 300, size})
    for (const double value : {0.0, 1e-7, std::nan("")}) {
      Eigen::MatrixXd matrix = 2 * Eigen::MatrixXd::Identity(size, size);
      const auto equation = std::find(place.begin(), place.end(), at) - place.begin();
      matrix(equation, equation) = value;
      EXPECT_FALSE(filled<TypeParam>(matrix).eliminate(1e-6));
    }
}

}  // namespace
}  // namespace lacon
