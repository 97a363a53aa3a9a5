// How exactly inexact Newton solves its linear systems.
#include "lacon/operators/evolution/newton/forcing_term.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

/// An iteration that has left that much, and whether this meets the criteria.
IterationReport left(double residual, bool met) { return {.rela_met = met, .longest_share = residual}; }

// Where statuses stay and forces are not in balance, a system is solved as exactly as the engine does; where they are, what is
// left to do is small.
TEST(ForcingTerm, IsExactUntilForcesAreInBalance) {
  ForcingTerm forcing;
  forcing.start_instant();
  for (double residual = 1; residual > 1e-6; residual *= 0.1) EXPECT_EQ(forcing.next(left(residual, false), false), 0);
  const double share = forcing.next(left(1e-7, true), false);
  EXPECT_GT(share, 0);
  EXPECT_LE(share, 1e-4) << "four digits more than what the criteria ask for: slender bodies lose two";
  EXPECT_EQ(forcing.next({.longest_share = 1e-8, .constraint = 1, .constraint_met = false}, false), 0);
}

// While statuses change it is rougher, and no rougher than the square of what the iteration before has gained (choice 2).
TEST(ForcingTerm, IsRoughWhileStatusesChange) {
  ForcingTerm forcing;
  forcing.start_instant();
  EXPECT_GT(forcing.next(left(1, false), true), 0);
  for (const double gain : {1e-3, 1e-4}) {
    forcing.start_instant();
    forcing.next(left(1, false), true);
    const double share = forcing.next(left(gain, false), true);
    EXPECT_LE(share, gain * gain);
    EXPECT_GT(share, 0);
  }
}

}  // namespace
}  // namespace lacon
