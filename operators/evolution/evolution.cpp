#include "lacon/operators/evolution/evolution.hpp"

#include "lacon/operators/evolution/time_stepping.hpp"

namespace lacon {

void evolve(const TimeSteps& steps, InstantSolver& solver, std::span<EvolutionObserver* const> observers) {
  const auto tell = [&](const auto& what) {
    for (EvolutionObserver* const observer : observers) what(*observer);
  };
  int iterations = 0;
  std::int64_t step = 0;
  const auto solve = [&](double instant) {
    tell([&](EvolutionObserver& o) { o.begin(instant); });
    iterations = solver.solve(
        instant, [&](const IterationReport& report) { tell([&](EvolutionObserver& o) { o.iterate(instant, report); }); });
    tell([&](EvolutionObserver& o) { o.judge(instant); });
  };
  const auto go_back = [&] { solver.go_back(); };
  const auto solved = [&](double instant, bool asked) {
    solver.accept();
    step += asked;
    const SolvedInstant now{.instant = instant, .step = step, .last = instant == steps.values.back(), .iterations = iterations};
    tell([&](EvolutionObserver& o) { o.accept(now); });
  };
  try {
    tell([&](EvolutionObserver& o) { o.start(steps.values.front()); });
    step_through(steps, solve, go_back, solved, [&] { return iterations; });
  } catch (...) {
    tell([&](EvolutionObserver& o) { o.end(false); });
    throw;
  }
  tell([&](EvolutionObserver& o) { o.end(true); });
}

}  // namespace lacon
