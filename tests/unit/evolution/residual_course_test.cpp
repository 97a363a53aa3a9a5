#include "lacon/operators/evolution/newton/residual_course.hpp"

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

TEST(ResidualCourse, FallsOrIsRoundOff) {
  EXPECT_TRUE(course({1e-3, 1e-6, 1e-12}).falls());
  EXPECT_TRUE(course({1, 1e-1, 1e-2, 1e-3}).falls());
  EXPECT_FALSE(course({2e-13, 1e-13, 2e-13, 1e-13}).falls());
  EXPECT_FALSE(course({1e-13, 0.95e-13, 0.4e-13}).falls());  // which has an order, but means nothing by it
  EXPECT_FALSE(course({1e-13}).falls());
}

// A ratio stays what it is, an order takes it to its power again and again.
TEST(ResidualCourse, KnowsHowManyIterationsAreLeft) {
  EXPECT_EQ(course({8, 4, 2, 1}).iterations_to(0.3), 2);
  EXPECT_EQ(course({8, 4, 2, 1}).iterations_to(0.2), 3);
  EXPECT_EQ(course({1e-1, 1e-2, 1e-4}).iterations_to(1e-3), 1);
  EXPECT_EQ(course({1e-1, 1e-2, 1e-4}).iterations_to(1e-11), 2);
  EXPECT_EQ(course({1e-1, 1e-2, 1e-4}).iterations_to(1e-13), 3);
  EXPECT_EQ(course({1, 8, 1e-1, 1e-2, 1e-4}).iterations_to(1e-11), 2);  // it jumped on the way
  EXPECT_EQ(course({8, 4, 2, 1}).iterations_to(2), 1);                  // there is another criterion
  EXPECT_FALSE(course({1, 0.99, 0.98, 0.97}).iterations_to(0.9));
  EXPECT_FALSE(course({1, 2, 4}).iterations_to(0.1));
  EXPECT_FALSE(course({8, 1, 16, 8, 4, 2}).iterations_to(0.1));  // it was smaller before
  EXPECT_EQ(course({1e-9, 16, 8, 4, 2}).iterations_to(0.3), 2);  // before bodies met
  EXPECT_FALSE(course({2, 1, 2, 1}).iterations_to(0.1));
  EXPECT_FALSE(course({}).iterations_to(0.1));
  EXPECT_FALSE(course({4, 2, 1}).iterations_to(0));
}

TEST(ResidualCourse, SaysBothInWords) {
  EXPECT_EQ(course({1}).words(), "");
  EXPECT_EQ(course({8, 4, 2, 1}).words(), "the residual changes by the factor 0.5 an iteration (order 1)");
  EXPECT_EQ(course({1, 2}).words(), "the residual changes by the factor 2 an iteration");
  EXPECT_EQ(course({1, std::nan("")}).words(), "the residual has left the range of numbers");
}

// A residual that falls behind a jump promises nothing: it may jump again before it comes to its end.
TEST(ResidualCourse, KnowsThatItWasSmallerBefore) {
  EXPECT_FALSE(course({}).smaller_before());
  EXPECT_FALSE(course({8, 4, 2, 1}).smaller_before());
  EXPECT_EQ(course({8, 1, 16, 8, 4, 2}).smaller_before(), 4U);
  EXPECT_FALSE(course({1e-9, 16, 8, 4, 2}).smaller_before());
  EXPECT_EQ(course({1e-9, 16, 1, 4, 2}).smaller_before(), 2U);
  EXPECT_EQ(course({8, 1, 16, 8, 4, 2}).words(),
            "the residual falls by the factor 0.5 an iteration, but 4 iteration(s) before it was 2 times smaller");
  EXPECT_EQ(course({1, 1.06, 1.05, 1.04, 1.03}).words(), "the residual changes by the factor 0.99 an iteration (order 1)");
}

TEST(ResidualCourse, KnowsWhatComesBack) {
  EXPECT_EQ(course({9, 1, 2, 1, 2}).period(), 2U);
  EXPECT_EQ(course({9, 1, 2, 3, 1.001, 2, 3}).period(), 3U);
  EXPECT_FALSE(course({1, 2, 1}).period());        // not twice yet
  EXPECT_FALSE(course({1, 1, 1, 1, 1}).period());  // it stands
  EXPECT_FALSE(course({8, 4, 2, 1}).period());
  EXPECT_EQ(course({9, 4.279, 4.056, 4.279, 4.056}).period(), 2U);  // at the end of a skin that passes the end of the other
  EXPECT_FALSE(course({9, 1.03, 1.02, 1.01, 1}).period());          // it crawls
  EXPECT_FALSE(course({9, 1, 1.0001, 1, 1.0001}).period());         // it stands, but for round-off
  EXPECT_EQ(course({9, 1, 2, 1, 2}).words(), "the residual goes round with a period of 2 iterations");
}

TEST(ResidualCourse, KnowsThatItGetsNowhere) {
  EXPECT_TRUE(course({1, 2, 3, 7, 2, 5, 3, 4, 6}).wanders(9));
  EXPECT_FALSE(course({2, 3, 7, 2, 5, 3, 4, 6}).wanders(9));         // not for long enough
  EXPECT_FALSE(course({2, 2, 3, 7, 2, 1, 3, 4, 6}).wanders(9));      // the last four have been less
  EXPECT_FALSE(course({1, 2, 3, 7, 2, 5, 4, 3, 2}).wanders(9));      // behind a leap it falls
  EXPECT_FALSE(course({1, 2, 3, 1e-8, 2, 5, 3, 4, 6}).wanders(9));   // statuses have changed in equilibrium
  EXPECT_FALSE(course({1e-9, 13, 8, 7, 4, 2, 2, 9, 3}).wanders(9));  // what flows was elastic in the first iteration
}

TEST(ResidualCourse, KnowsThatItDrags) {
  EXPECT_TRUE(course({9, 1, 0.9, 0.8, 0.7, 0.6}).drags(4));
  EXPECT_FALSE(course({9, 1, 0.9, 0.8, 0.7, 0.5}).drags(4));
  EXPECT_FALSE(course({1, 0.9, 0.8, 0.7}).drags(4));  // not for long enough
}

TEST(ResidualCourse, KnowsThatItStands) {
  EXPECT_TRUE(course({9, 1, 1.001, 1, 1.001, 1, 1.001}).stands());
  EXPECT_FALSE(course({9, 1, 1.001, 1, 1.001, 1}).stands());  // not for long enough
  EXPECT_FALSE(course({1, 0.99, 0.98, 0.97, 0.96, 0.95, 0.94}).stands());
}

TEST(ResidualCourse, CountsForHowLongItIsLargestAtOnePlace) {
  ResidualCourse course;
  for (const std::int64_t place : {7, 3, 3, 3}) course.add(1, place);
  EXPECT_EQ(course.stays(), 3);
  course.start();
  course.add(1, 3);
  EXPECT_EQ(course.stays(), 1);
}

}  // namespace
}  // namespace lacon
