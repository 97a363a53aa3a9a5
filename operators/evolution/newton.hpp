#pragma once
// Newton's method for one instant: equilibrium, geometry, contact and behaviour in one loop (METHOD.md 3.2, 5.3).
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/operators/evolution/equilibrium.hpp"
#include "lacon/operators/evolution/matrix_choice.hpp"
#include "lacon/operators/evolution/status_rule.hpp"

namespace lacon {

struct NewtonOptions {
  ConvergenceCriteria criteria;
  int iterations = 10;                            ///< ITER_GLOB_MAXI
  SolidMatrix matrix = SolidMatrix::tangent;      ///< NEWTON/MATRICE
  SolidMatrix prediction = SolidMatrix::tangent;  ///< NEWTON/PREDICTION: of the first iteration of an instant
};

class Newton {
 public:
  /// Criteria of contact are those of the problem's contact.
  Newton(const StaticProblem& problem, const NewtonOptions& options, std::unique_ptr<Engine> engine);

  /// The state before any load: displacements zero, statuses of CONTACT_INIT.
  StaticState initial_state();
  /// Begin with a state of another computation: statuses are those of CONTACT_INIT where `patches` is empty, multipliers of
  /// relations are found anew. Throws EVOLUTION_10 where its stresses are not those of the laws. @param label of the result it
  /// comes from
  void begin(StaticState& state, const std::string& label);

  /// Solve the instant, starting from `state`, which is in equilibrium. Calls `report` for each iteration.
  /// @return number of iterations. Throws EVOLUTION_4 (not converged), EVOLUTION_15, SOLVER_3 (singular), ELEMENT_1 ...:
  /// severity S. `state` is then between two instants.
  int solve(double instant, StaticState& state, const std::function<void(const IterationReport&)>& report);
  /// Go back to a state: contact, stresses and system are those of `state` again, as solve() needs them.
  void restart(const StaticState& state);

  const Equilibrium& equilibrium() const { return equilibrium_; }
  /// The contact at the last evaluation; nullptr without contact.
  const ContactState* contact() const { return equilibrium_.contact(); }

 private:
  void assemble(const StaticState& state, const StaticState& previous, SolidMatrix asked);
  /// The solution of the present system. @param rough a few digits will do. Throws SOLVER_3.
  std::vector<double> solve_system(std::span<const double> step, bool rough, IterationReport& line);
  /// What pressures and gaps ask for at the state's geometry, in `line` how many patches want to change; nothing without
  /// contact.
  std::vector<Status> wanted_statuses(const StaticState& state, IterationReport& line) const;
  /// Throws EVOLUTION_15 where no statuses satisfy all patches.
  void fail_if_endless(double instant) const;
  /// Go back along an increment that goes too far (line_search.hpp); the geometry is paired where it ends.
  /// @param solution that `state` has moved by  @param increment of all unknowns of nodes, shortened as well
  void shorten(std::span<const double> solution, const StaticState& previous, StaticState& state,
               std::vector<double>& increment);
  /// What keeps the last iteration from being the solution, in words.
  std::string unmet_criteria(const IterationReport& line, std::size_t first_changed) const;

  const StaticProblem& problem_;
  NewtonOptions options_;
  Equilibrium equilibrium_;
  MatrixChoice choice_;
  StatusRule statuses_;
  SaddlePointSolver solver_;
};

}  // namespace lacon
