#include "lacon/assembly/twice_the_digits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dense.hpp"

namespace lacon {
namespace {

using test::Chain;

// Residuals are those of arithmetic with more digits, also where all those of a double cancel; of symmetric matrices and
// others.
TEST(TwiceTheDigits, ResidualsHaveAllTheirDigits) {
  const Chain chain(20);
  std::mt19937 random(5);
  SparseMatrix general(chain.numbering, chain.cliques, {}, Symmetry::general), symmetric(chain.numbering, chain.cliques, {});
  test::fill_unsymmetric(general, chain, {}, random);
  symmetric.set_zero();
  test::add_springs(symmetric, chain, 1.0 / 3);
  for (const SparseMatrix* matrix : {&general, &symmetric}) {
    const auto n = static_cast<std::size_t>(matrix->size());
    const std::vector<double> x = test::random_values(n, random), small = test::random_values(n, random);
    TwiceTheDigits sum(n);
    sum.add(x);
    std::vector<double> rest(small);
    for (double& value : rest) value *= 1e-20;
    sum.add(rest);
    using Digits = Eigen::Matrix<__float128, Eigen::Dynamic, Eigen::Dynamic>;
    const Digits exact = test::dense(*matrix).cast<__float128>();
    std::vector<double> side(n);
    matrix->multiply(x, side);  // what is left of it is its round-off
    const std::vector<double> left = sum.residual(*matrix, side);
    for (std::size_t i = 0; i < n; ++i) {
      __float128 wanted = side[i];
      for (std::size_t j = 0; j < n; ++j) wanted -= exact(i, j) * (__float128(x[j]) + __float128(rest[j]));
      EXPECT_NEAR(left[i], static_cast<double>(wanted), 1e-29);
    }
  }
}

// What differs by less than a multiple is the same when rounded.
TEST(TwiceTheDigits, RoundsToMultiples) {
  TwiceTheDigits one(3), other(3);
  one.add(std::vector<double>{1.0 / 3, -1e-25, 5});
  other.add(std::vector<double>{1.0 / 3 + 0x1p-54, 1e-25, 5});
  const std::vector<double> multiple{0.7 * 0x1p-50, 0.7 * 0x1p-50, 0};
  std::vector<double> x(3), y(3);
  one.round(x, multiple);
  other.round(y, multiple);
  EXPECT_EQ(x, y);
  EXPECT_NEAR(x[0], 1.0 / 3, 0x1p-50);
  EXPECT_EQ(x[1], 0);
  EXPECT_EQ(std::signbit(x[1]), std::signbit(y[1]));
}

}  // namespace
}  // namespace lacon
