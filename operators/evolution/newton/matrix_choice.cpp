#include "lacon/operators/evolution/newton/matrix_choice.hpp"

#include <utility>

#include "lacon/operators/evolution/newton/convergence.hpp"

namespace lacon {
namespace {

/// Of a residual: what an iteration without the second derivatives of gaps may leave. From 1 to 1e-6 this takes an iteration
/// or two more than quadratic convergence.
constexpr double quick = 0.05;
/// Unbalanced forces, of the largest force of the equilibrium.
constexpr double far_from_balance = 1;
/// Of a residual: iterations in a row that leave more come nearer slowly. Three show that the ratio stays, and cost less than
/// what they end: at the ratio 1/4 it takes ten from `near_balance` to 1e-8. Where residuals grow, they may lead to another
/// equilibrium, a stable one.
constexpr double sluggish = 0.15;
constexpr int patience = 3;

}  // namespace

void MatrixChoice::start_instant(bool follows) {
  unstable_ = replaced_ = far_ = balances_ = false;
  follows_ = follows;
  slow_ = 0;
  settled_ = traits_.settling;
  flat_ = elastic_ = {};
  iterations_ = without_ = 0;
  forget_residual();
  curved_ = false;
}

NewtonMatrix MatrixChoice::suited(SolidMatrix asked, bool touches) const {
  const bool unsafe = flat_.left > 0 || far_, flat = waits_ || unsafe;
  if (elastic_.left > 0 || (!traits_.linear && settled_ < traits_.settling)) return {SolidMatrix::elastic, !flat};
  if (asked != SolidMatrix::tangent || traits_.linear) return {asked, !flat};
  if (!traits_.symmetric && !flat) return {SolidMatrix::whole, true};
  return {(traits_.made_symmetric && touches) || unstable_ || unsafe ? SolidMatrix::stressless : asked, !flat};
}

bool MatrixChoice::note_pivots(NewtonMatrix present, bool curves, std::int64_t negative, std::int64_t constraints) {
  if (negative <= constraints || balances_ || follows_) return false;
  if (present.curved && curves) {
    flat_.begin();
    return replaced_ = true;
  }
  if (present.solid != SolidMatrix::tangent || traits_.linear) return false;
  return unstable_ = replaced_ = true;
}

bool MatrixChoice::note_residual(const Unbalance& unbalance) {
  ++iterations_;
  without_ += flat_.left > 0;
  const bool grows = unbalance.in_flow && unbalance.largest > residual_;
  const bool curved = unbalance.curved && !unbalance.statuses_change;
  const bool slow = waits_ && curved && curved_ && unbalance.largest > quick * residual_;
  if (slow) waits_ = false;
  const bool near = curved && unbalance.share < near_balance;
  const bool without = flat_.left > 0;
  const double ratio = unbalance.largest / residual_;
  slow_ = near && without && ratio > sluggish && ratio < 1 ? slow_ + 1 : near && !without ? slow_ : 0;
  const bool begins = !balances_ && slow_ >= patience;
  if (begins) flat_.left = 0;
  const bool goes_on = balances_ && near && unbalance.largest < residual_;
  if (balances_ && !goes_on) slow_ = 0;
  balances_ = begins || goes_on;
  residual_ = unbalance.largest;
  curved_ = curved;
  const bool far = unbalance.share > far_from_balance || (unbalance.in_flow && unbalance.statuses_change);
  const bool was_far = std::exchange(far_, far && !traits_.symmetric);
  const bool curved_again = slow || begins || (flat_.left > 0 && --flat_.left == 0);
  const bool other = curved_again || far_ != was_far;
  if (elastic_.left > 0) {
    --elastic_.left;
    return other;
  }
  if (grows) elastic_.begin();
  return grows || other;
}

}  // namespace lacon
