#include "lacon/operators/evolution/matrix_choice.hpp"

#include <limits>

namespace lacon {
namespace {

/// Of a residual: what an iteration without the second derivatives of gaps may leave. From 1 to 1e-6 this takes an iteration
/// or two more than quadratic convergence.
constexpr double quick = 0.05;

}  // namespace

void MatrixChoice::start_instant() {
  unstable_ = false;
  flat_ = elastic_ = {};
  residual_ = std::numeric_limits<double>::infinity();
  curved_ = false;
}

NewtonMatrix MatrixChoice::suited(SolidMatrix asked, bool touches) const {
  const bool flat = waits_ || flat_.left > 0;
  if (elastic_.left > 0) return {SolidMatrix::elastic, !flat};
  if (asked != SolidMatrix::tangent || linear_) return {asked, !flat};
  return {(has_memory_ && touches) || unstable_ || flat_.left > 0 ? SolidMatrix::stressless : asked, !flat};
}

bool MatrixChoice::note_pivots(NewtonMatrix present, bool curves, std::int64_t negative, std::int64_t constraints) {
  if (negative <= constraints) return false;
  if (present.curved && curves) {
    flat_.begin();
    return true;
  }
  if (present.solid != SolidMatrix::tangent || linear_) return false;
  unstable_ = true;
  return true;
}

bool MatrixChoice::note_residual(double residual, bool curved) {
  const bool grows = has_memory_ && residual > residual_;
  const bool slow = waits_ && curved && curved_ && residual > quick * residual_;
  if (slow) waits_ = false;
  residual_ = residual;
  curved_ = curved;
  const bool curved_again = slow || (flat_.left > 0 && --flat_.left == 0);
  if (elastic_.left > 0) {
    --elastic_.left;
    return curved_again;
  }
  if (grows) elastic_.begin();
  return grows || curved_again;
}

}  // namespace lacon
