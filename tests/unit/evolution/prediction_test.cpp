#include "lacon/operators/evolution/newton/prediction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace lacon {
namespace {

/// A displacement that is imposed, and one that follows in its own way.
class Path {
 public:
  explicit Path(std::function<double(double)> imposed, std::function<double(double)> follows)
      : imposed_(std::move(imposed)), follows_(std::move(follows)) {}

  KnownState at(double t) const { return {t, {imposed_(t), follows_(t)}, {-t}, {0, 0}}; }
  void solve(double before, double now) { prediction.note(before, at(before), at(now)); }
  bool serves(double last, double now) const {
    return prediction.serves(now, at(last).displacement, std::vector<double>{imposed_(now) - imposed_(last), 0}, at(now).force);
  }

  Prediction prediction{{1, 0}};

 private:
  std::function<double(double)> imposed_, follows_;
};

TEST(Prediction, AMotionThatGoesOnIsFollowedAfterTwoInstants) {
  Path path([](double t) { return t; }, [](double t) { return 2 * t; });
  path.solve(0, 1);
  EXPECT_FALSE(path.serves(1, 2));  // one motion, of which nobody knows whether it goes on
  path.solve(1, 2);
  ASSERT_TRUE(path.serves(2, 2.5));
  const KnownState found = path.prediction.at(2.5);
  EXPECT_NEAR(found.displacement[1], 5, 1e-14);
  EXPECT_NEAR(found.pressure[0], -2.5, 1e-14);
}

// Down, then along: in turned axes the product of both is round-off of either sign.
TEST(Prediction, AMotionThatTurnsByARightAngleDoesNotGoOnInAnyAxes) {
  for (const double angle : {0.0, 0.3, 0.9, 1.1, 2.0, 4.5}) {
    const double c = std::cos(angle), s = std::sin(angle);
    std::vector<double> before, last, next, aside;
    for (int node = 0; node < 7; ++node) {
      before.insert(before.end(), {0.1 * c, 0.1 * s});
      last.insert(last.end(), {0.1 * c + 0.3 * s, 0.1 * s - 0.3 * c});
      next.insert(next.end(), {0.1 * c + 0.3 * s + 0.7 * c, 0.1 * s - 0.3 * c + 0.7 * s});
      aside.insert(aside.end(), {0.1 * c + 0.4 * s + 0.7 * c, 0.1 * s - 0.4 * c + 0.7 * s});
    }
    EXPECT_EQ(goes_on(before, last, next), 0) << angle;
    EXPECT_NEAR(goes_on(before, last, aside), 7 * 0.3 * 0.1, 1e-13) << angle;
    EXPECT_NEAR(goes_on(before, last, before), -7 * 0.3 * 0.3, 1e-13) << angle;
  }
}

TEST(Prediction, AMotionThatTurnsBackIsNotFollowed) {
  Path path([](double t) { return t; }, [](double t) { return t < 3 ? t : 6 - t; });
  for (int t = 1; t <= 4; ++t) path.solve(t - 1, t);  // the last extrapolation would have missed twice the motion
  EXPECT_FALSE(path.serves(4, 5));
}

TEST(Prediction, ALoadThatTurnsBackIsKnownBefore) {
  Path path([](double t) { return t < 3 ? t : 6 - t; }, [](double t) { return t; });
  for (int t = 1; t <= 3; ++t) path.solve(t - 1, t);
  EXPECT_FALSE(path.serves(3, 4));
}

TEST(Prediction, WithoutALoadNothingMoves) {
  Path path([](double) { return 1.0; }, [](double t) { return t; });
  for (int t = 1; t <= 3; ++t) path.solve(t - 1, t);
  EXPECT_FALSE(path.serves(3, 4));
}

TEST(Prediction, AFailureAndOtherDisplacementsAreNoStart) {
  Path path([](double t) { return t; }, [](double t) { return t; });
  for (int t = 1; t <= 3; ++t) path.solve(t - 1, t);
  EXPECT_FALSE(path.prediction.serves(4, std::vector<double>{3, 3.1}, std::vector<double>{1, 0}, std::vector<double>{0, 0}));
  EXPECT_TRUE(path.serves(3, 4));
  path.prediction.distrust();
  EXPECT_FALSE(path.serves(3, 4));
}

TEST(Prediction, WhatHasLedAstrayRestsTwiceAsLongEachTimeInARow) {
  Path path([](double t) { return t; }, [](double t) { return t; });
  int t = 0;
  const auto instants_until_it_serves = [&](bool led) {
    path.prediction.mislead();
    path.prediction.distrust();
    int rests = -1;  // the instant that begins again
    while (!path.serves(t, t + 1)) {
      path.solve(t, t + 1);
      ++t, ++rests;
    }
    if (led) path.prediction.note(0, path.at(t), path.at(t + 1), true);
    t += led;
    return rests;
  };
  while (!path.serves(t, t + 1)) path.solve(t, t + 1), ++t;
  EXPECT_EQ(instants_until_it_serves(false), 2);
  EXPECT_EQ(instants_until_it_serves(false), 4);
  EXPECT_EQ(instants_until_it_serves(true), 8);
  EXPECT_EQ(instants_until_it_serves(false), 2);  // it has led well meanwhile
}

TEST(Prediction, AnInstantThatWasGivenBackIsForgotten) {
  Path path([](double t) { return t; }, [](double t) { return t; });
  for (int t = 1; t <= 3; ++t) path.solve(t - 1, t);
  path.solve(2, 2.5);  // 3 was not accepted
  EXPECT_EQ(path.prediction.last_motion(), std::pair(2.0, 2.5));
  EXPECT_FALSE(path.serves(2.5, 3));
  path.solve(2.5, 3);
  EXPECT_TRUE(path.serves(3, 4));
}

// Forces that are no smaller behind three iterations, or that hardly fall behind fifteen: near a limit point they fall by half.
TEST(Prediction, IterationsThatGetNowhereAreBegunAgain) {
  EXPECT_FALSE(Prediction::leads_astray(2, 2.0, 1.0, 1.0));
  EXPECT_TRUE(Prediction::leads_astray(3, 1.2, 1.5, 1.0));
  EXPECT_FALSE(Prediction::leads_astray(3, 1.1, 1.5, 1.0));
  EXPECT_FALSE(Prediction::leads_astray(3, 0.9, 1.5, 1.0));
  EXPECT_TRUE(Prediction::leads_astray(15, 8e-5, 1e-4, 1.0));
  EXPECT_FALSE(Prediction::leads_astray(15, 5e-5, 1e-4, 1.0));
}

}  // namespace
}  // namespace lacon
