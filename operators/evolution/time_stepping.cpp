#include "lacon/operators/evolution/time_stepping.hpp"

#include <fmt/format.h>

#include <cmath>

namespace lacon {
namespace {

struct Stepper {
  const TimeSteps& steps;
  const SolveInstant& solve;
  const GoBack& go_back;
  const Solved& solved;

  void advance(double from, double to, int level, bool asked) const {
    try {
      solve(to);
    } catch (const Error& error) {
      const double part = (to - from) / steps.cut_into;
      if (error.message().severity != 'S' || !steps.cut || level >= steps.cut_levels || part < steps.smallest) throw;
      inform("EVOLUTION_7", {{"instant", fmt::format("{:.9g}", to)},
                             {"parts", std::to_string(steps.cut_into)},
                             {"level", std::to_string(level + 1)},
                             {"reason", error.message().text}});
      go_back();
      for (int i = 1; i <= steps.cut_into; ++i) {
        const bool last = i == steps.cut_into;
        advance(from + (i - 1) * part, last ? to : from + i * part, level + 1, last && asked);
      }
      return;
    }
    solved(to, asked);
  }
};

/// Position of an instant in the list, to a relative precision.
std::size_t find_instant(const TimeSteps& steps, double instant, double precision) {
  for (std::size_t i = 0; i < steps.values.size(); ++i)
    if (std::abs(steps.values[i] - instant) <= precision * std::max(std::abs(instant), precision)) return i;
  fail("EVOLUTION_5", {{"what", fmt::format("the instant {:.15g} is not in the list", instant)}});
}

std::size_t check_number(const TimeSteps& steps, std::int64_t number) {
  if (number >= 0 && static_cast<std::size_t>(number) < steps.values.size()) return static_cast<std::size_t>(number);
  fail("EVOLUTION_5", {{"what", fmt::format("there is no number {} in a list of {} instants", number, steps.values.size())}});
}

}  // namespace

void step_through(const TimeSteps& steps, const SolveInstant& solve, const GoBack& go_back, const Solved& solved) {
  const Stepper stepper{steps, solve, go_back, solved};
  for (std::size_t i = 1; i < steps.values.size(); ++i) stepper.advance(steps.values[i - 1], steps.values[i], 0, true);
}

TimeSteps restrict(const TimeSteps& steps, const Interval& interval) {
  std::size_t first = 0, last = steps.values.size() - 1;
  if (interval.first_instant) first = find_instant(steps, *interval.first_instant, interval.precision);
  if (interval.first_number) first = check_number(steps, *interval.first_number);
  if (interval.last_instant) last = find_instant(steps, *interval.last_instant, interval.precision);
  if (interval.last_number) last = check_number(steps, *interval.last_number);
  if (steps.values.size() < 2 || last <= first) fail("EVOLUTION_5", {{"what", "there is no step to compute"}});
  TimeSteps part = steps;
  part.values.assign(steps.values.begin() + static_cast<std::ptrdiff_t>(first),
                     steps.values.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  return part;
}

}  // namespace lacon
