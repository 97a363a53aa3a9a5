#pragma once
// Which matrix Newton's method goes on with.
#include <cstdint>

#include "lacon/assembly/element_sets.hpp"

namespace lacon {

/// A matrix of Newton's method.
struct NewtonMatrix {
  SolidMatrix solid = SolidMatrix::tangent;
  bool curved = true;  ///< with the second derivatives of gaps
  bool operator==(const NewtonMatrix&) const = default;
};

/// The matrix to go on with where the user asks for one. In contact the tangent of laws with a memory goes without the terms of
/// the stress: that of PETIT_REAC is made symmetric, and what this leaves of them is no help where bodies turn and touch. Far
/// from the solution the consistent matrix may be unstable:
/// - without contact, the tangent goes without the terms of the stress for the rest of the instant: that leads downhill to a
///   stable equilibrium;
/// - in contact, both the terms of the stress and the second derivatives of gaps are left out for some iterations. They go
///   together: when a body turns they are in balance. Near the solution the consistent matrix is worth more.
/// Where it overshoots (the residual of a law with a memory has grown), the elastic matrix takes its place for some
/// iterations: it is an upper bound of any tangent of plastic flow.
/// In space second derivatives of gaps cost as much as a part of a factorisation, and fill it: they wait until they are worth
/// it. Without them residuals fall by a constant ratio, the pressure over the stiffness of the body times how much surfaces
/// bend and slide; where it is small, as between nearly flat skins, their iterations are no fewer.
class MatrixChoice {
 public:
  /// @param linear the stiffness never changes  @param has_memory a law goes from the last state in equilibrium to the present
  /// @param in_space second derivatives of gaps wait
  MatrixChoice(bool linear, bool has_memory, bool in_space = false)
      : linear_(linear), has_memory_(has_memory), waits_(in_space) {}

  void start_instant();
  NewtonMatrix suited(SolidMatrix asked, bool touches) const;
  /// More negative pivots than constraints: beyond a limit point or a bifurcation, from where a step of the tangent leads
  /// anywhere. @param curves gaps of active patches have second derivatives @return whether the matrix has to be another one
  bool note_pivots(NewtonMatrix present, bool curves, std::int64_t negative, std::int64_t constraints);
  /// After an iteration that did not solve the instant. @param curved gaps have second derivatives, and no status changed
  /// @return whether the matrix has to be another one
  bool note_residual(double residual, bool curved = false);

 private:
  /// Iterations with another matrix, twice as many each time that they were not enough.
  struct Span {
    int left = 0, next = 1;
    void begin() {
      left = next;
      next *= 2;
    }
  };

  bool linear_, has_memory_;
  bool waits_;             ///< for a residual that falls slowly with the second derivatives of gaps
  bool unstable_ = false;  ///< the tangent of an iterate of this instant was
  Span flat_;              ///< without terms of stress and second derivatives of gaps
  Span elastic_;
  double residual_ = 0;  ///< of the last iteration
  bool curved_ = false;  ///< as note_residual() was told of it
};

}  // namespace lacon
