#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>

#include "lacon/operators/evolution/newton/instant_failure.hpp"
#include "lacon/operators/evolution/time_stepping.hpp"

namespace lacon {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

/// Solves every step that is not longer than `longest`.
struct Instants {
  double longest;
  double at = 0;
  int returns = 0;
  std::vector<double> solved;
  std::vector<bool> asked;
  int iterations = 0;

  void run(const TimeSteps& steps) {
    at = steps.values.front();
    step_through(
        steps,
        [&](double to) {
          if (to - at > longest * (1 + 1e-12))
            fail("EVOLUTION_4", {{"instant", ""}, {"iterations", ""}, {"unmet", ""}, {"remedy", ""}});
        },
        [&] { ++returns; },
        [&](double to, bool was_asked) {
          at = to;
          solved.push_back(to);
          asked.push_back(was_asked);
        },
        [&] { return iterations; });
  }
};

TEST(TimeStepping, SolvesEveryInstantOfTheList) {
  Instants solver{.longest = 1};
  solver.run({.values = {0, 0.5, 1.5}});
  EXPECT_THAT(solver.solved, ElementsAre(0.5, 1.5));
  EXPECT_THAT(solver.asked, ElementsAre(true, true));
  EXPECT_EQ(solver.returns, 0);
}

// A failing step is cut, its parts again where they fail; the instants that were asked for are met to the bit.
TEST(TimeStepping, CutsWhatFailsAgainAndAgain) {
  Instants solver{.longest = 0.25};
  solver.run({.values = {0, 1}, .action = {.cut = true, .cut_into = 2, .cut_levels = 3}});
  EXPECT_THAT(solver.solved, ElementsAre(DoubleEq(0.25), DoubleEq(0.5), DoubleEq(0.75), 1.0));
  EXPECT_THAT(solver.asked, ElementsAre(false, false, false, true));
  EXPECT_EQ(solver.returns, 3);  // the whole and both halves
}

TEST(TimeStepping, GivesUpBelowTheLastLevel) {
  Instants solver{.longest = 0.1};
  EXPECT_THROW(solver.run({.values = {0, 1}, .action = {.cut = true, .cut_into = 2, .cut_levels = 3}}), Error);
  EXPECT_TRUE(solver.solved.empty());
}

TEST(TimeStepping, GivesUpBelowTheSmallestStep) {
  Instants solver{.longest = 0.1};
  EXPECT_THROW(solver.run({.values = {0, 1}, .action = {.cut = true, .cut_into = 2, .cut_levels = 9, .smallest = 0.3}}), Error);
  EXPECT_EQ(solver.returns, 1);
}

TEST(TimeStepping, DoesNotCutWhereTheUserDidNotAskForIt) {
  Instants solver{.longest = 0.5};
  EXPECT_THROW(solver.run({.values = {0, 1}}), Error);
  EXPECT_EQ(solver.returns, 0);
}

/// How often a step of length 1 is cut, into 4 and 3 times over at most, whose failures at level 0, 1, 2, 3 these are.
int cuts(const std::vector<FailureNature>& failures) {
  int returns = 0;
  EXPECT_THROW(step_through(
                   {.values = {0, 1}, .action = {.cut = true, .cut_into = 4, .cut_levels = 3}},
                   [&](double) {
                     throw InstantFailure({.severity = 'S', .id = "EVOLUTION_4", .text = "", .advice = ""},
                                          failures.at(returns));
                   },
                   [&] { ++returns; }, [](double, bool) {}),
               Error);
  return returns;
}

// A singular matrix, statuses that no set satisfies; a residual that falls by the same ratio, and would need more cuts than are
// left.
TEST(TimeStepping, CutsNothingInVain) {
  const FailureNature unknown{}, of_any_step{.depends_on_step = false}, slow{.ratio = 0.74, .excess = 1e3},
      nearly{.ratio = 0.73, .excess = 15};
  EXPECT_EQ(cuts({unknown, unknown, unknown, unknown}), 3);
  EXPECT_EQ(cuts({of_any_step}), 0);
  EXPECT_EQ(cuts({unknown, of_any_step}), 1);
  EXPECT_EQ(cuts({slow, slow}), 1);
  EXPECT_EQ(cuts({unknown, slow, slow}), 2);
  EXPECT_EQ(cuts({slow, {.ratio = 0.5, .excess = 1e3}, {.ratio = 0.2, .excess = 1e3}, unknown}), 3);  // shorter steps do better
  EXPECT_EQ(cuts({slow, nearly, unknown, unknown}), 3);  // two more cuts leave 15 / 4^2 of it
}

// It began elsewhere than at the last state: there it is tried before anything is cut.
TEST(TimeStepping, BeginsAnInstantAgainThatWasLedAstray) {
  TimeSteps steps{.values = {0, 1}, .action = {.cut = true, .cut_into = 2, .cut_levels = 3}};
  for (const bool adaptive : {false, true}) {
    if (adaptive) steps.adaptation.emplace();
    for (const bool fails_again : {false, true}) {
      std::vector<double> tried, solved;
      int returns = 0;
      step_through(
          steps,
          [&](double to) {
            tried.push_back(to);
            if (tried.size() == 1 || (tried.size() == 2 && fails_again))
              throw InstantFailure({.severity = 'S', .id = "EVOLUTION_4", .text = "", .advice = ""},
                                   {.led_astray = tried.size() == 1});
          },
          [&] { ++returns; }, [&](double to, bool) { solved.push_back(to); }, [] { return 9; });
      EXPECT_EQ(returns, fails_again ? 2 : 1);
      EXPECT_EQ(tried, fails_again ? std::vector({1.0, 1.0, 0.5, 1.0}) : std::vector({1.0, 1.0}));
      EXPECT_EQ(solved, fails_again ? std::vector({0.5, 1.0}) : std::vector({1.0}));
    }
  }
}

// Where iterations left an equilibrium that is not stable the instant is solved once more; what fails again is the first
// failure.
TEST(TimeStepping, BeginsAnInstantAgainThatLeftAnUnstableEquilibrium) {
  const auto failure = [](const char* text, FailureNature nature) {
    return InstantFailure({.severity = 'S', .id = "EVOLUTION_4", .text = text, .advice = ""}, nature);
  };
  for (const bool fails_again : {false, true}) {
    int tried = 0, returns = 0, solved = 0;
    std::string told;
    try {
      step_through(
          {.values = {0, 1}, .action = {.cut = false}},
          [&](double) {
            if (++tried == 1) throw failure("astray", {.led_astray = true});
            if (tried == 2) throw failure("left", {.ratio = 1.1, .left_unstable = true});
            if (fails_again) throw failure("stayed", {});
          },
          [&] { ++returns; }, [&](double, bool) { ++solved; });
    } catch (const Error& error) {
      told = error.message().text;
      EXPECT_EQ(nature_of(error).ratio, 1.1);
    }
    EXPECT_EQ(tried, 3);
    EXPECT_EQ(returns, 2);
    EXPECT_EQ(solved, fails_again ? 0 : 1);
    EXPECT_EQ(told, fails_again ? "left" : "");
  }
}

// Where it followed one at once, the next attempt looks for another one: that is the attempt whose failure counts.
TEST(TimeStepping, BeginsAnInstantAgainThatStayedAtAnUnstableEquilibrium) {
  int tried = 0, returns = 0;
  try {
    step_through(
        {.values = {0, 1}, .action = {.cut = false}},
        [&](double) {
          const bool first = ++tried == 1;
          throw InstantFailure({.severity = 'S', .id = "EVOLUTION_4", .text = first ? "stayed" : "looked", .advice = ""},
                               {.stayed_unstable = first});
        },
        [&] { ++returns; }, [](double, bool) {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.message().text, "looked");
  }
  EXPECT_EQ(tried, 2);
  EXPECT_EQ(returns, 1);
}

/// What a driver is asked for, in its order: instants, and how hard they are tried from now on: S (increments are searched), L
/// (many iterations), C (iterations creep), or u (as usual).
struct Tried {
  std::vector<double> fails;  ///< instants, in their order
  std::string id = "EVOLUTION_4";
  bool has_search = true;  ///< false: increments are searched anyhow
  bool has_patience = false, has_creep = false;
  std::size_t failed = 0;
  std::string course;
  Effort effort = Effort::usual;

  void run(const TimeSteps& steps) {
    step_through(
        steps,
        [&](double to) {
          course += fmt::format("{} ", to);
          if (failed < fails.size() && to == fails[failed] && ++failed)
            throw Error({.severity = 'S', .id = id, .text = effort == Effort::usual ? "" : "once more", .advice = ""});
        },
        [&] { course += "< "; }, [&](double, bool) { course += "= "; }, [] { return 9; },
        [&](Effort now) {
          if ((now == Effort::searches && !has_search) || (now == Effort::lasts && !has_patience) ||
              (now == Effort::creeps && !has_creep))
            return false;
          if (std::exchange(effort, now) == now) return false;
          course += now == Effort::searches ? "S " : now == Effort::lasts ? "L " : now == Effort::creeps ? "C " : "u ";
          return true;
        },
        [&](const Message& told) {
          for (const char* number : {"71", "73", "76"})
            if (told.id == std::string("EVOLUTION_") + number) course += number + std::string(" ");
        });
  }
};

// A step that no cut helps is solved once more with increments that are searched, and so is what follows up to the next instant
// of the list; parts that fail are cut as before.
TEST(TimeStepping, SearchesIncrementsBeforeItGivesUp) {
  const TimeSteps uncut{.values = {0, 1, 2}}, cut{.values = {0, 1, 2}, .action = {.cut = true, .cut_into = 2, .cut_levels = 1}};
  Tried once{.fails = {1}};
  once.run(uncut);
  EXPECT_EQ(once.course, "1 S 71 < 1 = u 2 = ");
  Tried in_parts{.fails = {1, 0.5}};
  in_parts.run(cut);
  EXPECT_EQ(in_parts.course, "1 < 0.5 S 71 < 0.5 = 1 = u 2 = ");
  TimeSteps adaptive = cut;
  adaptive.adaptation.emplace();
  adaptive.adaptation->event = "AUCUN";
  Tried grown{.fails = {1, 0.5}};
  grown.run(adaptive);
  EXPECT_EQ(grown.course, "1 < 0.5 S 71 < 0.5 = 1 = u 1.5 = 2 = ");
}

TEST(TimeStepping, GivesUpWhereASearchIsNoUse) {
  const TimeSteps steps{.values = {0, 1}};
  Tried in_vain{.fails = {1, 1}};
  try {
    in_vain.run(steps);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.message().text, "");  // the first failure counts
  }
  EXPECT_EQ(in_vain.course, "1 S 71 < 1 ");
  Tried anyhow{.fails = {1}, .has_search = false};
  EXPECT_THROW(anyhow.run(steps), Error);
  EXPECT_EQ(anyhow.course, "1 ");
  for (const char* other : {"STEP_1", "STEP_2", "STEP_4", "EVOLUTION_42", "EVOLUTION_15", "SOLVER_3", "SOLVER_8"}) {
    Tried of_another_kind{.fails = {1}, .id = other};
    EXPECT_THROW(of_another_kind.run(steps), Error);
    EXPECT_EQ(of_another_kind.course, "1 ") << other;
  }
}

// Where parts of a step fail as well, what is left of it is solved at once.
TEST(TimeStepping, SolvesTheRestOfAStepAtOnceBeforeItGivesUp) {
  const TimeSteps cut{.values = {0, 1, 2}, .action = {.cut = true, .cut_into = 2, .cut_levels = 1}};
  Tried in_parts{.fails = {1, 1, 1}, .has_patience = true};
  in_parts.run(cut);
  EXPECT_EQ(in_parts.course, "1 < 0.5 = 1 S 71 < 1 L 73 < 1 = u 2 = ");
  TimeSteps adaptive = cut;
  adaptive.adaptation.emplace();
  adaptive.adaptation->event = "AUCUN";
  // steps behind it are as long as before it, however short they had become
  Tried grown{.fails = {1, 1, 0.75, 0.75, 2}, .has_patience = true};
  grown.run(adaptive);
  EXPECT_EQ(grown.course, "1 < 0.5 = 1 < 0.75 S 71 < 0.75 L 73 < 1 = u 2 < 1.5 = 2 = ");
  Tried in_vain{.fails = {1, 1, 1, 1}, .has_patience = true};
  try {
    in_vain.run(cut);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.message().text, "");  // the first failure counts
  }
  EXPECT_EQ(in_vain.course, "1 < 0.5 = 1 S 71 < 1 L 73 < 1 ");
  Tried at_last{.fails = {1, 1, 1, 1}, .has_patience = true, .has_creep = true};
  at_last.run(cut);
  EXPECT_EQ(at_last.course, "1 < 0.5 = 1 S 71 < 1 L 73 < 1 C 76 < 1 = u 2 = ");
  // not where the user wants it to stop
  Tried stops{.fails = {1, 1}, .has_patience = true, .has_creep = true};
  EXPECT_THROW(stops.run({.values = {0, 1}}), Error);
  EXPECT_EQ(stops.course, "1 S 71 < 1 ");
  Tried of_another_kind{.fails = {1}, .id = "EVOLUTION_15", .has_patience = true};
  EXPECT_THROW(of_another_kind.run({.values = {0, 1}, .action = {.cut = true, .cut_into = 2, .cut_levels = 0}}), Error);
  EXPECT_EQ(of_another_kind.course, "1 ");
}

// An error of the user is no reason to try smaller steps, and neither are a process that was killed and memory that ended.
TEST(TimeStepping, CutsOnlyFailuresOfTheSolution) {
  const TimeSteps steps{.values = {0, 1}, .action = {.cut = true}};
  for (const auto& [severity, id] : {std::pair{'F', "ORDER_5"}, {'S', "SOLVER_8"}, {'S', "SOLVER_2"}}) {
    int returns = 0;
    EXPECT_THROW(step_through(
                     steps, [&](double) { throw Error({.severity = severity, .id = id, .text = "", .advice = ""}); },
                     [&] { ++returns; }, [](double, bool) {}),
                 Error);
    EXPECT_EQ(returns, 0) << id;
  }
}

// Each event has its own action: the residual's cuts into five where a failed solution would stop.
TEST(TimeStepping, ActsByTheEvent) {
  TimeSteps steps{.values = {0, 1}, .action = {.cut = false}};
  steps.events = {{.event = "RESI_MAXI", .action = {.cut = true, .cut_into = 5}},
                  {.event = "DELTA_GRANDEUR", .action = {.cut = true, .cut_into = 2}},
                  {.event = "DIVE_RESI", .action = {.cut = true, .cut_into = 3}}};
  for (const auto& [event, parts] :
       {std::pair("STEP_1", 5), std::pair("STEP_2", 2), std::pair("STEP_4", 3), std::pair("EVOLUTION_4", 0)}) {
    int solved = 0;
    double at = 0;
    const auto run = [&] {
      step_through(
          steps,
          [&](double to) {
            if (to - at > 0.9)
              fail(event, {{"instant", ""},
                           {"iterations", ""},
                           {"unmet", ""},
                           {"remedy", ""},
                           {"residual", ""},
                           {"limit", ""},
                           {"component", ""},
                           {"node", ""},
                           {"place", ""},
                           {"change", ""},
                           {"before", ""}});
          },
          [] {},
          [&](double to, bool) {
            at = to;
            ++solved;
          });
    };
    if (parts)
      run();
    else
      EXPECT_THROW(run(), Error);
    EXPECT_EQ(solved, parts) << event;
  }
}

/// METHODE='AUTO' from 0 to 16 by way of 1, every step solved in `iterations` if it is not longer than `longest`.
Instants adapt(StepAdaptation adaptation, int iterations, double longest = 100) {
  Instants solver{.longest = longest};
  solver.iterations = iterations;
  solver.run({.values = {0, 1, 16}, .action = {.cut = true, .cut_into = 2}, .events = {}, .adaptation = adaptation});
  return solver;
}

TEST(AdaptiveStepping, DoublesEasySteps) {
  const Instants solver = adapt({.easy_steps = 1}, 5);
  EXPECT_THAT(solver.solved, ElementsAre(1.0, 3.0, 7.0, 15.0, 16.0));
  EXPECT_THAT(solver.asked, ElementsAre(true, false, false, false, true));
  EXPECT_THAT(adapt({.easy_steps = 2}, 5).solved, ElementsAre(1.0, 2.0, 4.0, 6.0, 10.0, 14.0, 16.0));
  EXPECT_THAT(adapt({.easy_steps = 2}, 6).solved.size(), 16);  // not easy
  EXPECT_THAT(adapt({.event = "AUCUN"}, 1).solved.size(), 16);
}

TEST(AdaptiveStepping, KeepsToItsLimits) {
  EXPECT_THAT(adapt({.easy_steps = 1, .largest = 2.5}, 1).solved, ElementsAre(1.0, 3.0, 5.5, 8.0, 10.5, 13.0, 15.5, 16.0));
  EXPECT_THROW(adapt({.event = "AUCUN", .most = 15}, 1), Error);
  EXPECT_THROW(adapt({.event = "AUCUN", .smallest = 0.3}, 1, 0.25), Error);
}

TEST(AdaptiveStepping, AimsAtANumberOfIterations) {
  EXPECT_THAT(adapt({.event = "TOUT_INST", .rule = "ITER_NEWTON", .reference = 4}, 3).solved.size(), 16);  // sqrt(4 / 4)
  EXPECT_THAT(adapt({.event = "TOUT_INST", .rule = "ITER_NEWTON", .reference = 4}, 0).solved,
              ElementsAre(1.0, 3.0, 7.0, 15.0, 16.0));  // sqrt(4 / 1)
}

/// The message that steps from 0 to 16 by way of 1 end with.
std::string end_of(const StepAdaptation& adaptation, int iterations, std::size_t& solved) {
  Instants solver{.longest = 100};
  solver.iterations = iterations;
  try {
    solver.run({.values = {0, 1, 16}, .action = {.cut = true, .cut_into = 2}, .events = {}, .adaptation = adaptation});
  } catch (const Error& error) {
    solved = solver.solved.size();
    return error.message().id;
  }
  return {};
}

// Halved behind every instant, steps come to 2 at most: they went on at PAS_MINI, a million of them.
TEST(AdaptiveStepping, StepsThatShrinkEnd) {
  std::size_t solved = 0;
  EXPECT_EQ(end_of({.event = "TOUT_INST", .percent = -50}, 1, solved), "STEP_6");
  EXPECT_EQ(solved, 0u);  // before anything is computed
  EXPECT_EQ(end_of({.easy_steps = 1, .percent = -50, .smallest = 0.1}, 1, solved), "STEP_5");
  EXPECT_EQ(solved, 4u);  // 1, 0.5, 0.25, 0.125
  EXPECT_EQ(end_of({.easy_steps = 1, .percent = -50, .smallest = 1e-300}, 1, solved), "STEP_5");
  EXPECT_LT(solved, 60u);  // at 2 numbers lie 2^-52 apart
  EXPECT_EQ(end_of({.event = "TOUT_INST", .rule = "ITER_NEWTON", .reference = 1, .smallest = 0.1}, 3, solved), "STEP_5");
  EXPECT_EQ(solved, 4u);
  EXPECT_EQ(adapt({.event = "TOUT_INST", .percent = -5}, 1).solved.size(), 32u);  // (1 - 0.95^n) / 0.05 = 16 at n = 31.4
}

// A step that fails is cut, and the computation goes on with the shorter one until steps are easy again.
TEST(AdaptiveStepping, GoesOnWithTheShorterStep) {
  const Instants solver = adapt({.event = "AUCUN"}, 1, 0.6);
  EXPECT_EQ(solver.returns, 1);
  EXPECT_EQ(solver.solved.size(), 32u);
  EXPECT_DOUBLE_EQ(solver.solved.front(), 0.5);
  EXPECT_EQ(std::count(solver.asked.begin(), solver.asked.end(), true), 2);
}

TEST(TimeStepping, RestrictsTheListToAnInterval) {
  const TimeSteps steps{.values = {0, 1, 2, 3}, .action = {.cut = true}};
  EXPECT_THAT(restrict(steps, {.first_instant = 1.0 + 1e-9, .last_number = 2}).values, ElementsAre(1.0, 2.0));
  EXPECT_TRUE(restrict(steps, {}).action.cut);
  EXPECT_THROW(restrict(steps, {.first_instant = 1.5}), Error);
  EXPECT_THROW(restrict(steps, {.first_number = 4}), Error);
  EXPECT_THROW(restrict(steps, {.first_number = 2, .last_number = 2}), Error);
  EXPECT_THROW(restrict({.values = {0}}, {}), Error);
}

// No shorter step has more memory, more room on the disk, or processes that run again.
TEST(InstantFailure, MayBeOfTheMachine) {
  for (const auto& [id, of_it] :
       {std::pair("SOLVER_2", true), {"SOLVER_5", true}, {"SOLVER_8", true}, {"SOLVER_9", false}, {"EVOLUTION_4", false}})
    EXPECT_EQ(is_of_the_machine({.severity = 'S', .id = id, .text = "", .advice = ""}), of_it) << id;
}

}  // namespace
}  // namespace lacon
