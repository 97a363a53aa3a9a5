#pragma once
// Iterations that creep: a resistance to all motion, in the matrix alone, leads Newton's method downhill.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/operators/evolution/problem/static_problem.hpp"
#include "lacon/operators/evolution/problem/system.hpp"

namespace lacon {

/// Pseudo-transient continuation (Kelley and Keyes 1998, SIAM J. Numer. Anal. 35, 508): each iteration is an implicit step of
/// a viscous motion under the unbalanced forces. It goes downhill, from an equilibrium that has ended or is not stable any more
/// to the next one that is, as far as iterations of half a cell lead; forces and the equilibrium know nothing of the
/// resistance. As a mass, it hardly resists what is deformed in a few cells, and resists the motion of a whole body about as
/// much as its stiffness does a deformation over the length of the model. It is raised until the matrix is that of a minimum
/// and no node moves by more than half of its cells, and eases while the residual falls, to nothing at the end: there
/// iterations converge as Newton's.
class Creep {
 public:
  /// @param stiffness the system at a state in equilibrium
  Creep(const StaticProblem& problem, const System& stiffness);

  /// Of each equation of a node, to be added to the diagonal of the matrix.
  std::vector<double> resistance() const;
  /// Longest motion of an increment along an axis, over the size of the cells there. @param solution of the system
  double over_cells(std::span<const double> solution) const;

  void raise();
  /// After an iteration. @param residual what it has left
  void ease(double residual);

 private:
  std::vector<double> mass_, size_;  ///< by equation of a node
  double factor_ = 1;
  double residual_ = 0;  ///< of the last iteration
  bool raised_ = false;  ///< in this iteration
};

}  // namespace lacon
