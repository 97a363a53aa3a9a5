#pragma once
// Which matrix Newton's method goes on with.
#include <cstdint>
#include <limits>

#include "lacon/assembly/element_sets.hpp"
#include "lacon/operators/evolution/newton/doubling.hpp"

namespace lacon {

/// A matrix of Newton's method.
struct NewtonMatrix {
  SolidMatrix solid = SolidMatrix::tangent;
  bool curved = true;  ///< with the second derivatives of gaps
  bool operator==(const NewtonMatrix&) const = default;
};

/// What a problem says of its matrices.
struct MatrixTraits {
  bool linear = false;          ///< the stiffness never changes
  bool made_symmetric = false;  ///< of a law's tangent that is not symmetric it has the symmetric part
  bool symmetric = true;        ///< otherwise the matrix may be that of an unsymmetric tangent, as it is
  bool in_space = false;        ///< second derivatives of gaps wait
  std::int64_t settling = 0;    ///< CONT_STAT_ELAS: iterations without change of status before which the matrix is elastic
};

/// The unbalanced forces that an iteration leaves.
struct Unbalance {
  double largest = 0;            ///< of a node
  double share = 0;              ///< the same over the largest force of the equilibrium
  bool in_flow = false;          ///< a law flows
  bool statuses_change = false;  ///< stresses are still those of other contacts
  bool curved = false;           ///< gaps have second derivatives
};

/// The matrix to go on with where the user asks for one. A tangent that is not symmetric (PETIT_REAC) is taken as it is where
/// the problem's matrix may be. Otherwise, in contact, it goes without the terms of the stress: made symmetric, what this
/// leaves of them is no help where bodies turn and touch. Far from the solution the consistent matrix may be unstable, which a
/// symmetric one tells by its pivots:
/// - without contact, the tangent goes without the terms of the stress for the rest of the instant: that leads downhill to a
///   stable equilibrium;
/// - in contact, both the terms of the stress and the second derivatives of gaps are left out for some iterations. They go
///   together: when a body turns they are in balance. Near the solution the consistent matrix is worth more. Where iterations
///   without them come to an equilibrium slowly, it is this equilibrium itself that is unstable (a round body that stands on
///   the border of two patches): then the consistent matrix is taken as it is for as long as residuals fall.
/// One that is not symmetric has no such sign: both are left out behind an iteration that leaves forces unbalanced by more than
/// the largest of them, or contacts that change on bodies that flow.
/// Where the matrix overshoots (the residual has grown while a law flows), the elastic one takes its place for some iterations:
/// it is an upper bound of any tangent of plastic flow. So it does as long as statuses change, where the user wants that
/// (CONT_STAT_ELAS).
/// In space second derivatives of gaps cost as much as a part of a factorisation, and fill it: they wait until they are worth
/// it. Without them residuals fall by a constant ratio, the pressure over the stiffness of the body times how much surfaces
/// bend and slide; where it is small, as between nearly flat skins, their iterations are no fewer.
class MatrixChoice {
 public:
  explicit MatrixChoice(const MatrixTraits& traits) : traits_(traits), waits_(traits.in_space) {}

  /// @param follows it takes the matrix as it is, whatever its pivots say
  void start_instant(bool follows = false);
  bool follows_unstable() const { return follows_; }
  /// All that lasts longer than an instant: whether second derivatives of gaps wait.
  bool waits() const { return waits_; }
  void set_waits(bool waits) { waits_ = waits; }
  /// Forces are others from here on: what was seen of their matrices says nothing any more.
  void start_again() { unstable_ = far_ = balances_ = false, slow_ = 0, flat_ = {}; }
  /// Forces leap a little: the last residual is no measure of the next one.
  void forget_residual() { residual_ = std::numeric_limits<double>::infinity(); }
  NewtonMatrix suited(SolidMatrix asked, bool touches) const;
  /// More negative pivots than constraints: beyond a limit point or a bifurcation, from where a step of the tangent leads
  /// anywhere. @param curves gaps of active patches have second derivatives @return whether the matrix has to be another one
  bool note_pivots(NewtonMatrix present, bool curves, std::int64_t negative, std::int64_t constraints);
  /// Whether a consistent matrix of the instant was unstable, and another one took its place.
  bool has_replaced() const { return replaced_; }
  /// Whether the pivots of the consistent one tell at an equilibrium: not those of a tangent that is made symmetric. Not in
  /// space: columns that flow had a negative pivot too many at one instant, and whether that is true is not known.
  bool pivots_tell() const { return traits_.symmetric && !traits_.made_symmetric && !traits_.in_space; }
  /// Whether most iterations of the instant went without what made the consistent matrix unstable, in contact.
  bool leaves_unstable() const { return 2 * without_ > iterations_; }
  /// How many patches an iteration has changed, before its matrix is made. @param flows a law does: the elastic matrix is
  /// another
  void note_statuses(std::int64_t changes, bool flows) { settled_ = changes > 0 && flows ? 0 : settled_ + 1; }
  /// After an iteration that did not solve the instant. @return whether the matrix has to be another one
  bool note_residual(const Unbalance& unbalance);

 private:
  MatrixTraits traits_;
  std::int64_t settled_ = 0;          ///< iterations without change of status
  bool waits_;                        ///< for a residual that falls slowly with the second derivatives of gaps
  bool unstable_ = false;             ///< the tangent of an iterate of this instant was
  bool replaced_ = false;             ///< that, or second derivatives of gaps were left out for it
  Doubling flat_;                     ///< iterations without terms of stress and second derivatives of gaps
  int slow_ = 0;                      ///< iterations in a row without them, near an equilibrium, that came a little nearer
  bool follows_ = false;              ///< the instant takes the matrix as it is
  bool balances_ = false;             ///< near an unstable equilibrium: the matrix is taken as it is
  int iterations_ = 0, without_ = 0;  ///< of the instant: all, and those of flat_
  bool far_ = false;                  ///< as flat_, of a matrix that is not symmetric
  Doubling elastic_;                  ///< iterations with the elastic matrix
  double residual_ = 0;               ///< of the last iteration
  bool curved_ = false;               ///< its gaps had second derivatives, and no status changed
};

}  // namespace lacon
