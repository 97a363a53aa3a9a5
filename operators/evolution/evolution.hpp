#pragma once
// A computation from instant to instant: what solves one, who looks on, and the driver that calls them.
#include <cstdint>
#include <functional>
#include <span>

#include "lacon/operators/evolution/convergence.hpp"
#include "lacon/structures/concepts.hpp"

namespace lacon {

struct SolvedInstant {
  double instant = 0;
  std::int64_t step = 0;  ///< how many instants of the list are solved, with it
  bool last = false;      ///< of the list
  int iterations = 0;
};

/// What solves one instant: a quasi-static equilibrium, or later a step of a motion.
class InstantSolver {
 public:
  virtual ~InstantSolver() = default;
  /// @param report called for each iteration; what it throws ends the instant
  /// @return number of iterations. Throws an Error of severity S where it fails.
  virtual int solve(double instant, const std::function<void(const IterationReport&)>& report) = 0;
  /// From now on go_back() leads to the instant that was solved last.
  virtual void accept() = 0;
  virtual void go_back() = 0;
};

/// Who looks at a computation: tables, archives, limits. Observers are called in their order. One that throws an Error of
/// severity S in iterate() or judge() lets the step fail, so that it may be cut.
class EvolutionObserver {
 public:
  virtual ~EvolutionObserver() = default;
  virtual void start(double /*instant*/) {}                            ///< at the initial state
  virtual void begin(double /*instant*/) {}                            ///< an instant is tried
  virtual void iterate(double /*instant*/, const IterationReport&) {}  ///< after each iteration
  virtual void judge(double /*instant*/) {}                            ///< solved, but not yet accepted
  virtual void accept(const SolvedInstant&) {}
  virtual void end(bool /*completed*/) {}  ///< always, whatever ends the computation
};

/// Solve every instant of `steps` behind the first, cutting and adapting steps as time_stepping.hpp says. A failure that no cut
/// helps is thrown on, after end(false).
void evolve(const TimeSteps& steps, InstantSolver& solver, std::span<EvolutionObserver* const> observers);

}  // namespace lacon
