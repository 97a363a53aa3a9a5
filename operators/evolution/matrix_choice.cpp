#include "lacon/operators/evolution/matrix_choice.hpp"

#include <limits>

namespace lacon {

void MatrixChoice::start_instant() {
  unstable_ = false;
  elastic_ = 0;
  elastic_span_ = 1;
  residual_ = std::numeric_limits<double>::infinity();
}

SolidMatrix MatrixChoice::suited(SolidMatrix asked, bool touches) const {
  if (elastic_ > 0) return SolidMatrix::elastic;
  if (asked != SolidMatrix::tangent || linear_) return asked;
  return (has_memory_ && touches) || unstable_ ? SolidMatrix::stressless : asked;
}

bool MatrixChoice::note_pivots(SolidMatrix present, std::int64_t negative, std::int64_t constraints) {
  if (present != SolidMatrix::tangent || linear_ || negative <= constraints) return false;
  unstable_ = true;
  return true;
}

bool MatrixChoice::note_residual(double residual) {
  const bool grows = has_memory_ && residual > residual_;
  residual_ = residual;
  if (elastic_ > 0) {
    --elastic_;
    return false;
  }
  if (!grows) return false;
  elastic_ = elastic_span_;
  elastic_span_ *= 2;
  return true;
}

}  // namespace lacon
