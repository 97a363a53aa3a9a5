#include "lacon/operators/evolution/time_stepping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/newton/instant_failure.hpp"

namespace lacon {
namespace {

/// What is done about this failure.
const StepCut& action_for(const TimeSteps& steps, const Error& error) {
  static const std::map<std::string, std::string, std::less<>> messages{
      {"RESI_MAXI", "STEP_1"}, {"DELTA_GRANDEUR", "STEP_2"}, {"DIVE_RESI", "STEP_4"}};
  for (const StepEvent& event : steps.events)
    if (error.message().id == messages.at(event.event)) return event.action;
  return steps.action;
}

constexpr double same_ratio = 0.05;  // of the logarithm of ratios

/// Why no cut helps, or nothing. Where a step and its parts have residuals that fall by the same ratio, a part of them has
/// 1 / cut_into of the whole's after as many iterations.
std::optional<std::string> in_vain(const FailureNature& now, const FailureNature& before, const StepCut& action, int level) {
  if (!now.depends_on_step) return part("fails_at_any_length");
  if (!now.ratio || !before.ratio || std::abs(std::log(*now.ratio / *before.ratio)) > same_ratio) return std::nullopt;
  if (now.excess <= std::pow(action.cut_into, action.cut_levels - level)) return std::nullopt;
  return part("same_ratio_as_before", {{"factor", fmt::format("{:.2g}", *now.ratio)}});
}

/// Failures of iterations, which may come to an end by other increments. Others are events of the user, bodies that nothing
/// holds, residuals that get no smaller, machines.
bool is_of_increments(const Error& error) {
  static const std::set<std::string, std::less<>> messages{"EVOLUTION_4", "EVOLUTION_18", "EVOLUTION_51"};
  return messages.contains(error.message().id) && nature_of(error).depends_on_step;
}

/// The length of the parts into which the step to `to` is cut, nothing where it is not to be cut any more.
/// @param before the failure of the step that it was cut from
std::optional<double> cut(const StepCut& action, const Error& error, const FailureNature& before, double length, double to,
                          int level, double smallest, const Tell& tell) {
  const double part = length / action.cut_into;
  if (error.message().severity != 'S' || is_of_the_machine(error.message()) || !action.cut || level >= action.cut_levels ||
      part < std::max(action.smallest, smallest))
    return std::nullopt;
  if (const auto reason = in_vain(nature_of(error), before, action, level)) {
    tell(message("EVOLUTION_19", {{"instant", fmt::format("{:.9g}", to)}, {"reason", *reason}}));
    return std::nullopt;
  }
  tell(message("EVOLUTION_7", {{"instant", fmt::format("{:.9g}", to)},
                               {"parts", std::to_string(action.cut_into)},
                               {"level", std::to_string(level + 1)},
                               {"reason", error.message().text}}));
  return part;
}

struct Stepper {
  const TimeSteps& steps;
  const SolveInstant& solve;
  const GoBack& go_back;
  const Solved& solved;
  const Take& take;
  const Tell& tell;

  /// Solve once more, with increments that are searched, a step that no cut helps. Called while `error` is handled: throws it
  /// on where that is no use, or fails as well.
  void solve_searched(double to, const Error& error) const {
    if (!is_of_increments(error) || !take(Effort::searches)) throw;
    tell(message("EVOLUTION_71", {{"instant", fmt::format("{:.9g}", to)}, {"reason", error.message().text}}));
    go_back();
    if (!solves(to)) throw;
  }

  /// Whether it does; throws what is no failure of the solution.
  bool solves(double to) const {
    try {
      solve(to);
      return true;
    } catch (const Error& again) {
      if (again.message().severity != 'S' || is_of_the_machine(again.message())) throw;
      return false;
    }
  }

  /// Advance to an instant of the list; where that fails, solve what is left of the way at once, by many more iterations, and
  /// at last by iterations that creep: the way by short steps may come to where an equilibrium ends, or splits, and others lie
  /// behind.
  void reach(double to, const std::function<void()>& advances) const {
    try {
      advances();
      return;
    } catch (const Error& error) {
      if (!is_of_increments(error) || !action_for(steps, error).cut || !solves_at_once(to, error)) throw;
    }
    solved(to, true);
  }

  bool solves_at_once(double to, const Error& error) const {
    for (const auto& [effort, told] : {std::pair(Effort::lasts, "EVOLUTION_73"), std::pair(Effort::creeps, "EVOLUTION_76")}) {
      if (!take(effort)) continue;
      tell(message(told, {{"instant", fmt::format("{:.9g}", to)}, {"reason", error.message().text}}));
      go_back();
      if (!solves(to)) continue;
      tell(message("EVOLUTION_79", {{"instant", fmt::format("{:.9g}", to)}}));
      return true;
    }
    return false;
  }

  /// @param before the failure of the step that this one is a part of
  void advance(double from, double to, int level, bool asked, const FailureNature& before) const {
    try {
      solve(to);
    } catch (const Error& error) {
      const StepCut& action = action_for(steps, error);
      if (const auto part = cut(action, error, before, to - from, to, level, 0, tell)) {
        const FailureNature failure = nature_of(error);
        go_back();
        for (int i = 1; i <= action.cut_into; ++i) {
          const bool last = i == action.cut_into;
          advance(from + (i - 1) * *part, last ? to : from + i * *part, level + 1, last && asked, failure);
        }
        return;
      }
      solve_searched(to, error);
    }
    solved(to, asked);
  }
};

/// Steps of METHODE='AUTO'.
class AdaptiveStepper {
 public:
  AdaptiveStepper(const TimeSteps& steps, const Stepper& stepper, const Iterations& iterations)
      : steps_(steps),
        rules_(*steps.adaptation),
        stepper_(stepper),
        iterations_(iterations),
        step_(steps.values[1] - steps.values[0]) {
    limit();
    step_ = std::max(step_, rules_.smallest);
    check_reach();
  }

  void advance(double from, double target) {
    if (!std::exchange(arrived_, false)) {  // the last instant was reached at once, however short its last steps had become
      step_ = began_with_;
      level_ = easy_ = 0;
    }
    began_with_ = step_;
    for (double at = from; at < target;) {
      const bool last = at + step_ * (1 + 1e-6) >= target;  // no sliver is left before an instant of the list
      const double to = last ? target : at + step_;
      check_length(at, to);
      if (++count_ > rules_.most)
        fail("STEP_3", {{"count", std::to_string(rules_.most)}, {"instant", fmt::format("{:.9g}", at)}});
      try {
        stepper_.solve(to);
      } catch (const Error& error) {
        const auto part = cut(action_for(steps_, error), error, level_ > 0 ? failure_ : FailureNature{}, to - at, to, level_,
                              rules_.smallest, stepper_.tell);
        if (part) {
          step_ = *part;
          failure_ = nature_of(error);
          ++level_;
          easy_ = 0;
          stepper_.go_back();
          continue;
        }
        stepper_.solve_searched(to, error);
      }
      stepper_.solved(to, last);
      at = to;
      level_ = 0;
      change();
    }
    arrived_ = true;
  }

 private:
  /// The length of the next step, after an instant that was solved.
  void change() {
    const int iterations = iterations_();
    easy_ = iterations <= rules_.easy_iterations ? easy_ + 1 : 0;
    if (rules_.event == "AUCUN" || (rules_.event == "SEUIL" && easy_ < rules_.easy_steps)) return;
    easy_ = 0;
    step_ *= rules_.rule == "FIXE" ? 1 + rules_.percent / 100 : std::sqrt(rules_.reference / (iterations + 1.0));
    limit();
  }
  void limit() {
    if (rules_.largest > 0) step_ = std::min(step_, rules_.largest);
  }
  /// Steps that shrink behind every instant come to an end, however well all goes: a geometric series.
  void check_reach() const {
    if (rules_.event != "TOUT_INST" || rules_.rule != "FIXE" || rules_.percent >= 0) return;
    const double ratio = 1 + rules_.percent / 100, from = steps_.values.front(), last = steps_.values.back();
    const double reach = (step_ - ratio * rules_.smallest) / (1 - ratio);
    if (reach * (1 + 1e-6) >= last - from) return;
    fail("STEP_6", {{"percent", fmt::format("{:.6g}", rules_.percent)},
                    {"step", fmt::format("{:.6g}", step_)},
                    {"smallest", fmt::format("{:.6g}", rules_.smallest)},
                    {"from", fmt::format("{:.9g}", from)},
                    {"instant", fmt::format("{:.9g}", from + reach)},
                    {"last", fmt::format("{:.9g}", last)}});
  }
  /// Steps that were made shorter than PAS_MINI, or than what numbers of this size tell apart, end nowhere.
  void check_length(double at, double to) const {
    if (step_ >= rules_.smallest && to > at) return;
    const bool by_percent = rules_.rule == "FIXE";
    const std::string value = by_percent ? fmt::format("{:.6g}", rules_.percent) : std::to_string(rules_.reference);
    fail("STEP_5", {{"instant", fmt::format("{:.9g}", at)},
                    {"step", fmt::format("{:.6g}", step_)},
                    {"smallest", fmt::format("{:.6g}", rules_.smallest)},
                    {"rule", part(by_percent ? "shorter_by_percent" : "shorter_by_iterations", {{"value", value}})},
                    {"remedy", part(by_percent ? "positive_percent" : "more_iterations_to_aim_at")}});
  }

  const TimeSteps& steps_;
  const StepAdaptation& rules_;
  const Stepper& stepper_;
  const Iterations& iterations_;
  double step_;
  bool arrived_ = true;    ///< by its own steps, at the last instant of the list
  double began_with_ = 0;  ///< the step behind the instant of the list before it
  int level_ = 0, easy_ = 0;
  FailureNature failure_;  ///< of the step that was cut last
  std::int64_t count_ = 0;
};

/// Position of an instant in the list, to a relative precision.
std::size_t find_instant(const TimeSteps& steps, double instant, double precision) {
  for (std::size_t i = 0; i < steps.values.size(); ++i)
    if (std::abs(steps.values[i] - instant) <= precision * std::max(std::abs(instant), precision)) return i;
  fail("EVOLUTION_5", {{"what", part("instant_not_in_list", {{"instant", fmt::format("{:.15g}", instant)}})},
                       {"remedy", part("give_from_list")}});
}

std::size_t check_number(const TimeSteps& steps, std::int64_t number) {
  if (number >= 0 && static_cast<std::size_t>(number) < steps.values.size()) return static_cast<std::size_t>(number);
  fail("EVOLUTION_5", {{"what", part("number_not_in_list",
                                     {{"number", std::to_string(number)}, {"count", std::to_string(steps.values.size())}})},
                       {"remedy", part("give_from_list")}});
}

}  // namespace

void step_through(const TimeSteps& steps, const SolveInstant& solve, const GoBack& go_back, const Solved& solved,
                  const Iterations& iterations, const Take& take, const Tell& tell) {
  const SolveInstant in_any_way = [&](double to) {
    for (std::optional<InstantFailure> unstable;;) {
      try {
        solve(to);
        return;
      } catch (const Error& error) {
        const FailureNature nature = nature_of(error);
        if (!nature.begins_again()) {
          if (error.message().severity == 'S' && unstable && !is_of_the_machine(error.message()))
            throw InstantFailure(*unstable);
          throw;
        }
        if (nature.left_unstable) unstable.emplace(error.message(), nature);
        tell(message(nature.led_astray      ? "EVOLUTION_48"
                     : nature.left_unstable ? "EVOLUTION_53"
                                            : "EVOLUTION_55",
                     {{"instant", fmt::format("{:.9g}", to)}, {"reason", error.message().text}}));
      }
      go_back();
    }
  };
  const Stepper stepper{steps, in_any_way, go_back, solved, take, tell};
  std::optional<AdaptiveStepper> adaptive;
  if (steps.adaptation) adaptive.emplace(steps, stepper, iterations);
  for (std::size_t i = 1; i < steps.values.size(); ++i) {
    const double from = steps.values[i - 1], to = steps.values[i];
    stepper.reach(to, [&] { adaptive ? adaptive->advance(from, to) : stepper.advance(from, to, 0, true, {}); });
    take(Effort::usual);
  }
}

TimeSteps restrict(const TimeSteps& steps, const Interval& interval) {
  std::size_t first = 0, last = steps.values.size() - 1;
  if (interval.first_instant) first = find_instant(steps, *interval.first_instant, interval.precision);
  if (interval.first_number) first = check_number(steps, *interval.first_number);
  const bool from_state = interval.initial_state && !interval.first_instant && !interval.first_number;
  if (from_state) {  // the instants behind it
    const double initial = *interval.initial_state, least = initial + interval.precision * std::abs(initial);
    first = static_cast<std::size_t>(std::upper_bound(steps.values.begin(), steps.values.end(), least) - steps.values.begin());
  }
  if (interval.last_instant) last = find_instant(steps, *interval.last_instant, interval.precision);
  if (interval.last_number) last = check_number(steps, *interval.last_number);
  if (from_state && last + 1 <= first)
    fail("EVOLUTION_5",
         {{"what", part("no_instant_behind_state", {{"instant", fmt::format("{:.15g}", *interval.initial_state)}})},
          {"remedy", part("result_at_its_end")}});
  if (!from_state && (steps.values.size() < 2 || last <= first))
    fail("EVOLUTION_5", {{"what", part("no_step_to_compute")}, {"remedy", part("give_from_list")}});
  TimeSteps kept = steps;
  kept.values.assign(steps.values.begin() + static_cast<std::ptrdiff_t>(first),
                     steps.values.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  if (from_state) kept.values.insert(kept.values.begin(), *interval.initial_state);
  return kept;
}

}  // namespace lacon
