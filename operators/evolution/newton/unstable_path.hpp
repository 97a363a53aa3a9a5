#pragma once
// Which instants follow an equilibrium that is not stable at once, and which look for a stable one first.
#include <cstdint>
#include <optional>

#include "lacon/operators/evolution/newton/doubling.hpp"

namespace lacon::hdf5 {
class Group;
}

namespace lacon {

/// What is known of the equilibrium that an instant ends with.
enum class Stability { stable, unstable, unknown };
/// @param follows the instant took the matrix as it is: others have left it, or stay on it by symmetry
/// (Newton::consistent_pivots)  @param negative pivots of it, where they are known
inline Stability stability_of(bool follows, std::optional<std::int64_t> negative, std::int64_t constraints) {
  if (!follows || (negative && *negative <= constraints)) return Stability::stable;
  return negative ? Stability::unstable : Stability::unknown;
}

/// An instant whose iterations leave an unstable equilibrium, and find no other, is solved once more near it. To look for a
/// stable one costs all the iterations that an instant may have; where there was none, there seldom is one a step later. So
/// behind an instant that has looked in vain the next one follows the unstable equilibrium at once, and twice as many do each
/// time in a row; one of them that fails looks after all.
class UnstablePath {
 public:
  /// An instant begins, or begins again. @return whether it follows
  bool begin();
  /// The attempt has failed. @param left its iterations left an unstable equilibrium
  /// @return whether the other way is worth an attempt: it has not been tried
  bool fail(bool left);
  /// The instant is solved. @param unstable as an equilibrium that is not stable, or may not be
  void solve(bool unstable);

  void save(const hdf5::Group& group) const;
  void resume(const hdf5::Group& group);

 private:
  enum class Attempt { first, follows, looks };
  Attempt next_ = Attempt::first, present_ = Attempt::first;
  bool follows_ = false;  ///< the present attempt does
  Doubling at_once_;      ///< instants that follow at once
};

}  // namespace lacon
