#pragma once
// Which statuses an iteration of Newton's method goes on with.
#include <cstddef>
#include <optional>
#include <vector>

#include "lacon/operators/contact/patches.hpp"

namespace lacon {

/// Sets of active patches that come back.
struct StatusCycle {
  std::vector<std::size_t> patches;  ///< that change in it
  std::size_t period = 0;            ///< after how many sets they come back
};

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

  /// What statuses went round in before they were kept.
  const std::optional<StatusCycle>& round() const { return round_; }
  /// What repeats for good: equilibria whose patches change one by one.
  const std::optional<StatusCycle>& endless() const { return endless_; }

 private:
  bool keeps_ = false;
  std::vector<std::vector<bool>> active_;  ///< sets of active patches that there were, while statuses do not wait
  std::vector<std::vector<bool>> single_;  ///< those in equilibrium from which one patch has changed, since fewest_ fell
  std::size_t fewest_ = 0;                 ///< patches that were to change at an equilibrium
  std::optional<StatusCycle> round_, endless_;
};

}  // namespace lacon
