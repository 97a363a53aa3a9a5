#include "lacon/operators/evolution/line_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lacon {
namespace {

TEST(LineSearch, AnIncrementThatDoesNotOvershootStaysWhole) {
  int calls = 0;
  EXPECT_EQ(part_of_increment(1.0, [&](double) { return ++calls, -0.4; }), 1.0);
  EXPECT_EQ(calls, 1);
}

TEST(LineSearch, WorkAgainstTheForcesFromTheStartIsNoReasonToGoBack) {
  EXPECT_EQ(part_of_increment(-1.0, [](double) { return -2.0; }), 1.0);
}

TEST(LineSearch, AnIncrementThatOvershootsEndsWhereItsPowerIsAtMostHalf) {
  for (const double zero : {0.7, 0.3, 0.05}) {  // flow: forces that stay what they are
    const auto power = [&](double part) { return std::tanh(5 * (1 - part / zero)) / std::tanh(5.0); };
    const double part = part_of_increment(1.0, power);
    EXPECT_GE(power(part), -0.5) << zero;
    EXPECT_LE(part, zero * 1.2) << zero;
    EXPECT_GT(part, 0) << zero;
  }
}

TEST(LineSearch, TheLastCallIsAtThePartThatIsReturned) {
  double last = 0;
  const double part = part_of_increment(1.0, [&](double at) { return last = at, -1e6; });
  EXPECT_EQ(part, last);
}

}  // namespace
}  // namespace lacon
