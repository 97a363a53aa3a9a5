#pragma once
// Which statuses an iteration of Newton's method goes on with.
#include <cstddef>
#include <vector>

#include "lacon/operators/contact/patches.hpp"

namespace lacon {

/// A patch takes the status that pressure and gap ask for, in every iteration, until a set of active patches comes back for
/// the second time: the iterations then go round (once it may come back by chance, far from the solution). From there on a set
/// is kept until its equilibrium is found. At each such equilibrium all patches change that are to, while they become fewer;
/// when they do not, the last of them alone does, until they are fewer than ever before. For a convex problem (P-matrix) this
/// comes to an end after finitely many sets (Murty 1974; Judice and Pires 1994). Where the problem is not, an equilibrium whose
/// patches have changed one by one may come back: no status satisfies them.
class StatusRule {
 public:
  void start_instant();
  /// Whether statuses wait for the equilibrium.
  bool keeps() const { return keeps_; }
  /// Before the equilibrium of an iteration is known. @param now statuses of the iteration that ends
  /// @param wanted what pressure and gap ask for @return statuses of the next one
  std::vector<Status> next(const std::vector<Status>& now, const std::vector<Status>& wanted);
  /// The equilibrium of statuses that were kept is found, and patches want others.
  std::vector<Status> change(const std::vector<Status>& now, const std::vector<Status>& wanted);

  /// Patches that take part in what repeats, and after how many sets it does; empty as long as nothing does for good.
  const std::vector<std::size_t>& endless() const { return endless_; }
  std::size_t period() const { return period_; }

 private:
  bool keeps_ = false;
  std::vector<std::vector<bool>> active_;  ///< sets of active patches that there were, while statuses do not wait
  std::vector<std::vector<bool>> single_;  ///< those in equilibrium from which one patch has changed, since fewest_ fell
  std::size_t fewest_ = 0;                 ///< patches that were to change at an equilibrium
  std::vector<std::size_t> endless_;
  std::size_t period_ = 0;
};

}  // namespace lacon
