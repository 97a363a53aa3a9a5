#include "lacon/operators/evolution/newton/line_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lacon {
namespace {

TEST(LineSearch, AnIncrementThatDoesNotOvershootStaysWhole) {
  int calls = 0;
  EXPECT_EQ(part_of_increment(1.0, [&](double) { return ++calls, -0.09; }), 1.0);
  EXPECT_EQ(calls, 1);
}

TEST(LineSearch, WorkAgainstTheForcesFromTheStartIsNoReasonToGoBack) {
  EXPECT_EQ(part_of_increment(-1.0, [](double) { return -2.0; }), 1.0);
}

TEST(LineSearch, AnIncrementThatOvershootsEndsWhereItsPowerIsAtMostATenth) {
  for (const double zero : {0.7, 0.3, 0.05}) {  // flow: forces that stay what they are
    const auto power = [&](double part) { return std::tanh(5 * (1 - part / zero)) / std::tanh(5.0); };
    const double part = part_of_increment(1.0, power);
    EXPECT_GE(power(part), -0.1) << zero;
    EXPECT_LE(part, zero * 1.2) << zero;
    EXPECT_GT(part, 0) << zero;
  }
}

// RECH_LINEAIRE on powers that vanish at a part beyond the whole or before it.
TEST(LineSearch, TheUsersFindsWherePowerVanishes) {
  for (const bool bracket : {false, true})
    for (const double zero : {0.2, 0.7, 1.0, 3.0, 20.0}) {
      double last = 0;
      const auto power = [&](double part) { return last = part, std::tanh(1 - part / zero); };
      const double part = part_without_power({.keeps_bracket = bracket, .accepted = 1e-6, .iterations = 30}, power(0), power);
      EXPECT_NEAR(part, std::min(zero, 10.0), 1e-4) << bracket;
      EXPECT_EQ(part, last);
    }
}

TEST(LineSearch, TheUsersKeepsToItsLimits) {
  int calls = 0;
  const auto vanishes_at_once = [&](double part) { return ++calls, part > 0 ? -1.0 : 1.0; };
  EXPECT_GE(part_without_power({.keeps_bracket = true, .iterations = 30, .least = 0.05}, 1.0, vanishes_at_once), 0.05);
  calls = 0;
  part_without_power({.iterations = 2}, 1.0, [&](double part) { return ++calls, 1 + part; });
  EXPECT_LE(calls, 4);                                               // the whole, two more, and the best again
  const auto negative = [](double part) { return 1 + 100 * part; };  // vanishes at -0.01
  EXPECT_EQ(part_without_power({.accepted = 1e-9, .iterations = 5, .least = -1, .excluded = 0.02}, 1.0, negative), -0.02);
}

// A secant that leaves the two parts between which the power changes its sign: METHODE='MIXTE' halves them, 'CORDE' goes there.
TEST(LineSearch, OnlyABracketKeepsASecantFromLeavingIt) {
  for (const bool bracket : {false, true}) {
    double farthest = 0;
    const auto power = [&](double part) {
      farthest = std::max(farthest, part);
      return part < 0.5 ? 1.0 : part < 0.95 ? -5.0 : -0.5;
    };
    part_without_power({.keeps_bracket = bracket, .accepted = 1e-6, .iterations = 2}, 1.0, power);
    EXPECT_EQ(farthest > 1, !bracket) << farthest;
  }
}

TEST(LineSearch, TheLastCallIsAtThePartThatIsReturned) {
  double last = 0;
  const double part = part_of_increment(1.0, [&](double at) { return last = at, -1e6; });
  EXPECT_EQ(part, last);
}

}  // namespace
}  // namespace lacon
