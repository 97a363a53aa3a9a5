#pragma once
// Which matrix Newton's method goes on with.
#include <cstdint>

#include "lacon/assembly/element_sets.hpp"

namespace lacon {

/// The matrix to go on with where the user asks for one. The tangent goes without the terms of the stress
/// - in contact, of laws with a memory (PETIT_REAC): when a body turns they are in balance with the terms of contact forces
///   that turn with their surface, and these the linearisation of contact does not have. The exact tangent of Green-Lagrange
///   strains keeps them: there they are worth more than that balance;
/// - for the rest of an instant in which it was unstable: without them it leads downhill to a stable equilibrium.
/// Where it overshoots (the residual of a law with a memory has grown), the elastic matrix takes its place for some
/// iterations: it is an upper bound of any tangent of plastic flow.
class MatrixChoice {
 public:
  /// @param linear the stiffness never changes  @param has_memory a law goes from the last state in equilibrium to the present
  MatrixChoice(bool linear, bool has_memory) : linear_(linear), has_memory_(has_memory) {}

  void start_instant();
  SolidMatrix suited(SolidMatrix asked, bool touches) const;
  /// More negative pivots than constraints: beyond a limit point or a bifurcation, from where a step of the tangent leads
  /// anywhere. @return whether the matrix has to be another one
  bool note_pivots(SolidMatrix present, std::int64_t negative, std::int64_t constraints);
  /// After an iteration that did not solve the instant. @return whether the matrix has to be another one
  bool note_residual(double residual);

 private:
  bool linear_, has_memory_;
  bool unstable_ = false;  ///< the tangent of an iterate of this instant was
  int elastic_ = 0;        ///< how many more iterations take the elastic matrix
  int elastic_span_ = 1;   ///< twice as long each time that it was not enough
  double residual_ = 0;    ///< of the last iteration
};

}  // namespace lacon
