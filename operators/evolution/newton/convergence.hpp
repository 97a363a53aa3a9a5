#pragma once
// When an instant is solved: the criteria of CONVERGENCE and of contact, judged on figures alone (METHOD.md 3.2).
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "lacon/assembly/saddle_point_solver.hpp"

namespace lacon {

/// Unbalanced forces, of the largest force of the equilibrium: it is near, iterations may come to it, and shapes are nearly its
/// own.
constexpr double near_balance = 0.01;

struct ConvergenceCriteria {
  std::optional<double> resi_glob_rela;
  std::optional<double> resi_glob_maxi;
  std::optional<double> resi_refe_rela = {};
  double resi_geom = 1e-6;
  double constraint = 1e-8;  ///< largest |g_T| / h over active patches
};

/// The forces of a state, as figures; largest entries, those of displacements.
struct ForceFigures {
  double unbalanced = 0;        ///< what is left of forces that should be in balance
  std::int64_t worst_dof = -1;  ///< where
  double significant = 0;       ///< what is left where it is more than round-off, below which no iteration gets
  double felt = 0;              ///< external forces, those of relations and of contact, where they are far more than it
  /// External forces, reactions, forces of relations and of contact: what a residual is measured against.
  double reference = 0;
  double over_own = 0;  ///< the largest over that of its degree of freedom (reference_forces.hpp)
  /// Likewise of the vectors of nodes, which no axes change: what is left of a node's force or moment, and the reference of it.
  double unbalanced_vector = 0, reference_vector = 0;
};

double largest_entry(std::span<const double> values);
/// The longest displacement of a node. @param values (n_nodes, n_components), displacements first
double longest_displacement(std::span<const double> values, std::size_t n_components, std::size_t dimension);
/// The longest vector of a node's force, or of what works on its other components (moments). @param values likewise
double longest_force(std::span<const double> values, std::size_t n_components, std::size_t dimension);

/// The displacements of an iteration, as figures.
struct MotionFigures {
  double increment = 0;  ///< the largest vector of a node
  double whole = 0;      ///< likewise, of the whole displacement
  double vanishing = 0;  ///< below it a displacement is none
};

/// One line of the Newton table.
struct IterationReport {
  int iteration = 0;
  double rela = 0, maxi = 0, refe = 0;
  bool rela_met = true, maxi_met = true, refe_met = true;
  bool round_off = false;  ///< RESI_GLOB_RELA is not met, though forces are there: what is left is round-off
  /// `maxi` and `rela` of the vectors of nodes: by them Newton's method goes on, for axes are no matter of bodies
  double longest = 0, longest_share = 0;
  std::int64_t worst_dof = -1;  ///< where the residual is largest
  std::int64_t status_changes = 0;
  double geometry = 0;  ///< max |du| / max |u|
  bool geometry_met = true;
  double constraint = 0;  ///< max |g_T| / h
  bool constraint_met = true;
  bool pairs_anew = false;       ///< the next iteration sees other contact cells: Newton::pairs_anew()
  SolutionReport solution;       ///< how the linear system was solved
  std::int64_t constraints = 0;  ///< active patches and relations when the matrix was made: the negative pivots to expect
  double seconds = 0;

  /// With the statuses that the patches have.
  bool in_equilibrium() const { return rela_met && maxi_met && refe_met && geometry_met && constraint_met && !solution.rough; }
  bool converged() const { return in_equilibrium() && status_changes == 0 && !pairs_anew; }
};

/// RESI_GLOB_RELA, RESI_GLOB_MAXI and RESI_REFE_RELA: fills in rela, maxi, refe and whether they are met. The relative residual
/// is measured against the present equilibrium alone, whatever iterates or instants before it were; where its forces vanish,
/// what round-off leaves of them meets it whatever it is of nothing. Where forces are there, round-off of what is much stiffer
/// meets it up to near_balance. What is not finite meets nothing.
void judge_forces(const ConvergenceCriteria& criteria, const ForceFigures& forces, IterationReport& report);

/// The largest of these over what is asked.
double forces_over_asked(const ConvergenceCriteria& criteria, const IterationReport& report);

/// RESI_GEOM and the gaps of active patches: fills in geometry, constraint and whether they are met.
void judge_contact(const ConvergenceCriteria& criteria, const MotionFigures& motion, double constraint,
                   IterationReport& report);

}  // namespace lacon
