// Iterations that will not come to their end are given up.
#include "lacon/assembly/petsc/pace.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

namespace lacon {
namespace {

constexpr double goal = 1e-8;

/// The iteration at which it is said that 500 are not enough for a residual of 1e-8; nothing where they end before that.
std::optional<int> given_up(const std::function<double(int)>& residual) {
  Pace pace(500, goal);
  for (int done = 0; done <= 500 && residual(done) > goal * residual(0); ++done)
    if (pace.is_too_slow(done, residual(done))) return done;
  return std::nullopt;
}

std::function<double(int)> falling(int iterations) {
  return [=](int done) { return 3 * std::pow(goal, static_cast<double>(done) / iterations); };
}

TEST(Pace, IsThatOfTheLastIterations) {
  EXPECT_FALSE(given_up(falling(30)));
  EXPECT_FALSE(given_up(falling(500)));
  EXPECT_FALSE(given_up(falling(590)));  // which may become faster
  EXPECT_EQ(given_up(falling(610)), Pace::least);
  EXPECT_EQ(given_up(falling(100'000)), Pace::least);
  EXPECT_EQ(given_up([](int) { return 1.0; }), Pace::least);
  // slow at first, and fast once the slow parts are there; and the other way round, where it shows in the window
  EXPECT_FALSE(given_up([](int done) { return done < 100 ? 1.0 : falling(200)(done - 100); }));
  const std::optional<int> late = given_up([](int done) { return falling(400)(std::min(done, 300)); });
  ASSERT_TRUE(late);
  EXPECT_GT(*late, 300);
  EXPECT_LE(*late, 300 + Pace::window);
}

}  // namespace
}  // namespace lacon
