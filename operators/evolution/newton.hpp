#pragma once
// Newton's method for one instant: equilibrium, geometry, contact and behaviour in one loop (METHOD.md 3.2, 5.3).
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/operators/evolution/contact_state.hpp"
#include "lacon/operators/evolution/relations.hpp"
#include "lacon/operators/evolution/static_problem.hpp"
#include "lacon/operators/evolution/system.hpp"

namespace lacon {

struct NewtonCriteria {
  std::optional<double> resi_glob_rela;
  std::optional<double> resi_glob_maxi;
  double resi_geom = 1e-6;
  double constraint = 1e-8;                       ///< largest |g_T| / h over active patches
  int iterations = 10;                            ///< ITER_GLOB_MAXI
  SolidMatrix matrix = SolidMatrix::tangent;      ///< NEWTON/MATRICE
  SolidMatrix prediction = SolidMatrix::tangent;  ///< NEWTON/PREDICTION: of the first iteration of an instant
};

/// One line of the Newton table.
struct IterationReport {
  int iteration = 0;
  double rela = 0, maxi = 0;
  bool rela_met = true, maxi_met = true;
  std::int64_t worst_dof = -1;  ///< where the residual is largest
  std::int64_t status_changes = 0;
  double geometry = 0;  ///< max |du| / max |u|
  bool geometry_met = true;
  double constraint = 0;  ///< max |g_T| / h
  bool constraint_met = true;
  SolutionReport solution;       ///< how the linear system was solved
  std::int64_t constraints = 0;  ///< active patches and relations when the matrix was made: the negative pivots to expect
  double seconds = 0;

  bool converged() const {
    return rela_met && maxi_met && geometry_met && constraint_met && status_changes == 0 && !solution.rough;
  }
};

/// What the integration points of a solid set hold.
struct PointValues {
  std::vector<double> stress;    ///< (cells, points, components)
  std::vector<double> variable;  ///< (cells, points, internal variables)
};

/// All unknowns at an instant, and what laws with a memory remember.
struct StaticState {
  std::vector<double> displacement;  ///< (n_nodes, dimension)
  Patchwise patches;
  std::vector<double> relations;    ///< multipliers of the loads' relations
  std::vector<PointValues> points;  ///< of each solid set
};

class Newton {
 public:
  Newton(const StaticProblem& problem, const NewtonCriteria& criteria, std::unique_ptr<Engine> engine);

  /// The state before any load: displacements zero, statuses of CONTACT_INIT.
  StaticState initial_state();
  /// Begin with a state of another computation: statuses are those of CONTACT_INIT where `patches` is empty, multipliers of
  /// relations are found anew. Throws EVOLUTION_10 where its stresses are not those of the laws. @param label of the result it
  /// comes from
  void begin(StaticState& state, const std::string& label);

  /// Solve the instant, starting from `state`, which is in equilibrium. Calls `report` for each iteration.
  /// @return number of iterations. Throws EVOLUTION_4 (not converged), SOLVER_3 (singular), ELEMENT_1 ...: severity S. `state`
  /// is then between two instants.
  int solve(double instant, StaticState& state, const std::function<void(const IterationReport&)>& report);

  /// The contact at the last evaluation; nullptr without contact.
  const ContactState* contact() const { return contact_ ? &*contact_ : nullptr; }
  /// Go back to a state: contact, stresses and system are those of `state` again, as solve() needs them.
  void restart(const StaticState& state);

 private:
  /// The matrix to go on with where `asked` is what the user wants. The tangent goes without the terms of the stress
  /// - in contact, of laws with a memory (PETIT_REAC): when a body turns they are in balance with the terms of contact forces
  ///   that turn with their surface, and these the linearisation of contact does not have. The exact tangent of Green-Lagrange
  ///   strains keeps them: there they are worth more than that balance;
  /// - for the rest of an instant in which it was unstable: without them it leads downhill to a stable equilibrium.
  /// Where it overshoots (the residual of a law with a memory has grown), the elastic matrix takes its place for some
  /// iterations: it is an upper bound of any tangent of plastic flow.
  SolidMatrix suited(SolidMatrix asked, const StaticState& state) const;
  /// @param previous the last state in equilibrium
  void assemble(const StaticState& state, const StaticState& previous, SolidMatrix wanted);
  /// Solve the present system in place. @param rough a few digits will do
  SolutionReport solve_system(std::vector<double>& right_side, bool rough);
  /// What keeps the last iteration from being the solution, in words.
  std::string unmet_criteria(const IterationReport& line, std::int64_t first_changed) const;
  void judge(const StaticState& state, IterationReport& report);

  const StaticProblem& problem_;
  NewtonCriteria criteria_;
  Relations relations_;
  Ragged<std::int32_t> elements_;
  System system_;
  SaddlePointSolver solver_;
  bool linear_ = true;                       ///< the stiffness never changes
  bool has_stiffness_ = false;               ///< and is in the matrix
  SolidMatrix present_ = SolidMatrix::none;  ///< of which kind that one is
  bool unstable_ = false;                    ///< the tangent of an iterate of this instant was
  int elastic_ = 0;                          ///< how many more assemblies take the elastic matrix
  bool has_memory_ = false;                  ///< a law goes from the last state in equilibrium to the present one
  std::optional<ContactState> contact_;
  std::vector<PointValues> points_;         ///< of each solid set at the last evaluation
  std::optional<std::int32_t> inside_out_;  ///< a cell that the last evaluation found turned inside out
  std::optional<double> instant_;           ///< that of the loads
  std::vector<double> given_;     ///< at that instant: dead forces, and behind them what the multipliers' rows are to be
  std::vector<double> external_;  ///< the same with following forces at the last evaluation
  double force_scale_ = 0;        ///< largest sum of |element forces| at a node
  double largest_force_ = 0;      ///< largest reference of a residual so far
};

}  // namespace lacon
