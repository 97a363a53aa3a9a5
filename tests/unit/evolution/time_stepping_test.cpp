#include <gmock/gmock.h>

#include "lacon/operators/evolution/time_stepping.hpp"

namespace lacon {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

/// Solves every step that is not longer than `longest`.
struct Solver {
  double longest;
  double at = 0;
  int returns = 0;
  std::vector<double> solved;
  std::vector<bool> asked;

  void run(const TimeSteps& steps) {
    at = steps.values.front();
    step_through(
        steps,
        [&](double to) {
          if (to - at > longest * (1 + 1e-12)) fail("EVOLUTION_4", {{"instant", ""}, {"iterations", ""}, {"unmet", ""}});
        },
        [&] { ++returns; },
        [&](double to, bool was_asked) {
          at = to;
          solved.push_back(to);
          asked.push_back(was_asked);
        });
  }
};

TEST(TimeStepping, SolvesEveryInstantOfTheList) {
  Solver solver{.longest = 1};
  solver.run({.values = {0, 0.5, 1.5}});
  EXPECT_THAT(solver.solved, ElementsAre(0.5, 1.5));
  EXPECT_THAT(solver.asked, ElementsAre(true, true));
  EXPECT_EQ(solver.returns, 0);
}

// A failing step is cut, its parts again where they fail; the instants that were asked for are met to the bit.
TEST(TimeStepping, CutsWhatFailsAgainAndAgain) {
  Solver solver{.longest = 0.25};
  solver.run({.values = {0, 1}, .cut = true, .cut_into = 2, .cut_levels = 3});
  EXPECT_THAT(solver.solved, ElementsAre(DoubleEq(0.25), DoubleEq(0.5), DoubleEq(0.75), 1.0));
  EXPECT_THAT(solver.asked, ElementsAre(false, false, false, true));
  EXPECT_EQ(solver.returns, 3);  // the whole and both halves
}

TEST(TimeStepping, GivesUpBelowTheLastLevel) {
  Solver solver{.longest = 0.1};
  EXPECT_THROW(solver.run({.values = {0, 1}, .cut = true, .cut_into = 2, .cut_levels = 3}), Error);
  EXPECT_TRUE(solver.solved.empty());
}

TEST(TimeStepping, GivesUpBelowTheSmallestStep) {
  Solver solver{.longest = 0.1};
  EXPECT_THROW(solver.run({.values = {0, 1}, .cut = true, .cut_into = 2, .cut_levels = 9, .smallest = 0.3}), Error);
  EXPECT_EQ(solver.returns, 1);
}

TEST(TimeStepping, DoesNotCutWhereTheUserDidNotAskForIt) {
  Solver solver{.longest = 0.5};
  EXPECT_THROW(solver.run({.values = {0, 1}}), Error);
  EXPECT_EQ(solver.returns, 0);
}

// An error of the user is no reason to try smaller steps.
TEST(TimeStepping, CutsOnlyFailuresOfTheSolution) {
  const TimeSteps steps{.values = {0, 1}, .cut = true};
  int returns = 0;
  EXPECT_THROW(step_through(
                   steps,
                   [](double) {
                     fail("ORDER_5", {{"unit", "20"}});
                   },
                   [&] { ++returns; }, [](double, bool) {}),
               Error);
  EXPECT_EQ(returns, 0);
}

TEST(TimeStepping, RestrictsTheListToAnInterval) {
  const TimeSteps steps{.values = {0, 1, 2, 3}, .cut = true};
  EXPECT_THAT(restrict(steps, {.first_instant = 1.0 + 1e-9, .last_number = 2}).values, ElementsAre(1.0, 2.0));
  EXPECT_TRUE(restrict(steps, {}).cut);
  EXPECT_THROW(restrict(steps, {.first_instant = 1.5}), Error);
  EXPECT_THROW(restrict(steps, {.first_number = 4}), Error);
  EXPECT_THROW(restrict(steps, {.first_number = 2, .last_number = 2}), Error);
  EXPECT_THROW(restrict({.values = {0}}, {}), Error);
}

}  // namespace
}  // namespace lacon
