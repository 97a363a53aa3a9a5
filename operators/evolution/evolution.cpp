#include "lacon/operators/evolution/evolution.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/time_stepping.hpp"

namespace lacon {

double reached(const Course& course, double begins) {
  const auto solved = std::find_if(course.rbegin(), course.rend(), [](const Attempt& a) { return !a.failure; });
  return solved == course.rend() ? begins : solved->instant;
}

void evolve(const TimeSteps& steps, InstantSolver& solver, std::span<EvolutionObserver* const> observers, const Course& past) {
  const auto tell = [&](const auto& what) {
    for (EvolutionObserver* const observer : observers) what(*observer);
  };
  Course course;
  std::int64_t step = 0;
  const auto is_past = [&] { return course.size() <= past.size(); };
  // the steps are chosen again from what became of them
  const auto repeat = [&](double instant) {
    course.push_back(past[course.size()]);
    const Attempt& attempt = course.back();
    if (attempt.instant != instant)
      fail("EVOLUTION_31", {{"reason", part("steps_are_others", {{"found", fmt::format("{:.9g}", attempt.instant)},
                                                                 {"expected", fmt::format("{:.9g}", instant)}})}});
    if (attempt.failure) throw *attempt.failure;
  };
  const auto attempt = [&](double instant) {
    course.push_back({.instant = instant, .iterations = 0, .failure = {}});
    tell([&](EvolutionObserver& o) { o.begin(instant); });
    try {
      course.back().iterations = solver.solve(
          instant, [&](const IterationReport& report) { tell([&](EvolutionObserver& o) { o.iterate(instant, report); }); });
      tell([&](EvolutionObserver& o) { o.judge(instant); });
    } catch (const Error& error) {
      course.back().failure.emplace(error.message(), nature_of(error));
      tell([&](EvolutionObserver& o) { o.failed(instant, error); });
      throw;
    }
  };
  const auto solve = [&](double instant) { course.size() < past.size() ? repeat(instant) : attempt(instant); };
  const auto go_back = [&] {
    if (!is_past()) solver.go_back();
  };
  const auto solved = [&](double instant, bool asked) {
    step += asked;
    if (is_past()) return;
    solver.accept();
    const SolvedInstant now{.instant = instant,
                            .step = step,
                            .last = instant == steps.values.back(),
                            .iterations = course.back().iterations,
                            .course = &course};
    tell([&](EvolutionObserver& o) { o.accept(now); });
  };
  try {
    if (past.empty()) tell([&](EvolutionObserver& o) { o.start(steps.values.front()); });
    step_through(
        steps, solve, go_back, solved, [&] { return course.back().iterations; },
        [&](Effort effort) { return solver.take(effort); },
        [&](const Message& told) {
          if (!is_past()) inform(told);
        });
  } catch (...) {
    tell([&](EvolutionObserver& o) { o.end(false); });
    throw;
  }
  tell([&](EvolutionObserver& o) { o.end(true); });
}

}  // namespace lacon
