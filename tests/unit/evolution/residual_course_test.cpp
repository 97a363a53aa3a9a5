#include "lacon/operators/evolution/residual_course.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lacon {
namespace {

ResidualCourse course(const std::vector<double>& residuals) {
  ResidualCourse course;
  for (const double residual : residuals) course.add(residual);
  return course;
}

TEST(ResidualCourse, HasTheRatioAndTheOrderOfItsEnd) {
  EXPECT_FALSE(course({}).ratio());
  EXPECT_FALSE(course({1}).ratio());
  EXPECT_DOUBLE_EQ(*course({8, 4, 2, 1}).ratio(), 0.5);
  EXPECT_DOUBLE_EQ(*course({1, 8, 4, 2, 1}).ratio(), 0.5);  // the last three alone
  EXPECT_DOUBLE_EQ(*course({8, 4, 2, 1}).order(), 1);
  EXPECT_DOUBLE_EQ(*course({1e-1, 1e-2, 1e-4}).order(), 2);
  EXPECT_FALSE(course({1, 2, 1}).order());
}

TEST(ResidualCourse, SaysBothInWords) {
  EXPECT_EQ(course({1}).words(), "");
  EXPECT_EQ(course({8, 4, 2, 1}).words(), "; the residual changes by the factor 0.5 an iteration (order 1)");
  EXPECT_EQ(course({1, 2}).words(), "; the residual changes by the factor 2 an iteration");
  EXPECT_EQ(course({1, std::nan("")}).words(), "; the residual has left the range of numbers");
}

}  // namespace
}  // namespace lacon
