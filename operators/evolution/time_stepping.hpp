#pragma once
// From instant to instant, cutting a step that does not converge.
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/newton/effort.hpp"
#include "lacon/structures/concepts.hpp"

namespace lacon {

/// What solves one instant; throws an Error of severity S where it fails.
using SolveInstant = std::function<void(double instant)>;
/// Go back to the last instant that was solved.
using GoBack = std::function<void()>;
/// Called when an instant is solved. @param asked whether the user asked for it (or a cut made it)
using Solved = std::function<void(double instant, bool asked)>;

/// Number of iterations that the instant solved last took.
using Iterations = std::function<int()>;
/// Have so much done for every instant from now on. @return whether that is new
using Take = std::function<bool(Effort effort)>;
/// What is told of steps.
using Tell = std::function<void(const Message& message)>;

/// Solve every instant of `steps` behind the first. A step that fails is cut into `cut_into` equal ones, at most `cut_levels`
/// times over (DEFI_LIST_INST, ECHEC/ACTION='DECOUPE'); the failure that no cut can help (InstantFailure) is thrown on, and
/// EVOLUTION_19 says why. Which action holds is
/// said by the event: STEP_1 (RESI_MAXI), STEP_2 (DELTA_GRANDEUR), STEP_4 (DIVE_RESI), any other failure of the solution.
/// An instant that was led astray, or left an equilibrium that is not stable (FailureNature), is solved once more behind
/// go_back(), before anything is cut. Where the latter fails again, its first failure is what counts. A step whose iterations
/// fail, and which is not to be cut, is solved once more with increments that are searched, and so is what follows up to the
/// next instant of the list; where that fails as well its first failure counts. Where parts of a step to an instant of the list
/// fail so, what is left of it is solved at once, with many more iterations, before the failure of the part is thrown on. With
/// `steps.adaptation` (METHODE='AUTO') steps also grow and shrink between the instants of the list, beginning with its first
/// interval; a step that fails is then cut once, and the shorter one goes on. Throws STEP_3 after too many steps, STEP_5 where
/// they have become shorter than `smallest`, STEP_6 where it is known that they will not come to the end.
void step_through(
    const TimeSteps& steps, const SolveInstant& solve, const GoBack& go_back, const Solved& solved,
    const Iterations& iterations = {}, const Take& take = [](Effort) { return false; },
    const Tell& tell = [](const Message& told) { inform(told); });

/// The instants that INCREMENT asks for, the initial one first: from INST_INIT or NUME_INST_INIT to INST_FIN or NUME_INST_FIN;
/// without the former from the instant of the initial state, which need not be in the list.
struct Interval {
  std::optional<double> initial_state;
  std::optional<double> first_instant, last_instant;
  std::optional<std::int64_t> first_number, last_number;
  double precision = 1e-6;
};
TimeSteps restrict(const TimeSteps& steps, const Interval& interval);

}  // namespace lacon
