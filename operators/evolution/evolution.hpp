#pragma once
// A computation from instant to instant: what solves one, who looks on, and the driver that calls them.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lacon/operators/evolution/newton/convergence.hpp"
#include "lacon/operators/evolution/newton/effort.hpp"
#include "lacon/operators/evolution/newton/instant_failure.hpp"
#include "lacon/structures/concepts.hpp"

namespace lacon {

namespace hdf5 {
class Group;
}

/// An instant that was tried. The steps that follow are known from those before: how many iterations they took, which failed.
struct Attempt {
  double instant = 0;
  int iterations = 0;
  std::optional<InstantFailure> failure;
};
using Course = std::vector<Attempt>;
/// The instant that the last attempt without failure has solved, or the one before all attempts.
double reached(const Course& course, double begins);

struct SolvedInstant {
  double instant = 0;
  std::int64_t step = 0;  ///< how many instants of the list are solved, with it
  bool last = false;      ///< of the list
  int iterations = 0;
  const Course* course = nullptr;  ///< attempts so far, with it
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
  /// What is done for an instant from now on. @return whether that is new
  virtual bool take(Effort) { return false; }
  /// What the instants behind the one that was accepted last depend on, for another process that goes on with the same bits.
  virtual void save(const hdf5::Group&) const {}
  /// The part of it that is large and seldom changes: when its number does. 0: there is none.
  virtual std::int64_t number_of_base() const { return 0; }
  virtual void save_base(const hdf5::Group&) const {}
  /// @param base what save_base() made, nullptr where its number was 0
  virtual void resume(const hdf5::Group& /*group*/, const hdf5::Group* /*base*/) {}
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
  virtual void failed(double /*instant*/, const Error&) {}             ///< the solver stands where it gave up
  virtual void accept(const SolvedInstant&) {}
  virtual void end(bool /*completed*/) {}  ///< always, whatever ends the computation
  /// What it remembers of the instants so far, for another process that goes on; resume() is called there instead of start().
  virtual void save(const hdf5::Group&) const {}
  virtual void resume(const hdf5::Group&) {}
};

/// Solve every instant of `steps` behind the first, cutting and adapting steps as time_stepping.hpp says. A failure that no cut
/// helps is thrown on, after end(false).
/// @param past attempts of another process, at whose last instant solver and observers stand: nobody is told of them again
void evolve(const TimeSteps& steps, InstantSolver& solver, std::span<EvolutionObserver* const> observers,
            const Course& past = {});

}  // namespace lacon
