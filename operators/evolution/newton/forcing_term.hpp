#pragma once
// How exactly an iteration of Newton's method solves its linear system, where the engine iterates itself (inexact Newton).
// Eisenstat, Walker: Choosing the forcing terms in an inexact Newton method, SIAM Journal on Scientific Computing 17 (1996).
#include "lacon/operators/evolution/newton/convergence.hpp"

namespace lacon {

class ForcingTerm {
 public:
  void start_instant() { last_residual_ = 0; }
  /// For the next iteration of an instant: what share of the right side its linear solution may leave; 0: as little as the
  /// engine leaves, where forces are not in balance yet and statuses stay.
  /// @param line what the last iteration has left  @param rough statuses are changing: its digits will be of no use
  double next(const IterationReport& line, bool rough);

 private:
  double last_residual_ = 0;
};

}  // namespace lacon
