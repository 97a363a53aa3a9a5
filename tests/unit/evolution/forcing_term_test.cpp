// How exactly inexact Newton solves its linear systems.
#include "lacon/operators/evolution/forcing_term.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

constexpr double criterion = 1e-6;
const ConvergenceCriteria criteria{.resi_glob_rela = criterion, .resi_glob_maxi = {}};

IterationReport left(double residual) { return {.rela = residual}; }

// Where statuses stay, what is left of a residual is below the criterion, whatever that residual is; and there is something to
// solve.
TEST(ForcingTerm, MeetsTheCriterionWhereStatusesStay) {
  ForcingTerm forcing;
  forcing.start_instant();
  for (double residual = 1; residual > 1e-12; residual *= 0.1) {
    const double share = forcing.next(criteria, left(residual), false);
    EXPECT_LE(share * residual, 0.1 * criterion);
    EXPECT_GT(share, 0);
    EXPECT_LT(share, 0.1);
  }
}

// Of criteria the one that is furthest from being met counts.
TEST(ForcingTerm, MeetsAllCriteria) {
  ForcingTerm forcing;
  const ConvergenceCriteria two{.resi_glob_rela = criterion, .resi_glob_maxi = 1e-3};
  const double rela = forcing.next(two, {.rela = 1e-2, .maxi = 1e-2}, false);
  EXPECT_EQ(rela, forcing.next(criteria, left(1e-2), false));
  EXPECT_LT(forcing.next(two, {.rela = 1e-2, .maxi = 1e3}, false), rela);
  EXPECT_LT(forcing.next(two, {.rela = 1e-2, .constraint = 1}, false), rela);
}

// While statuses change it is rougher, and no rougher than the square of what the iteration before has gained (choice 2).
TEST(ForcingTerm, IsRoughWhileStatusesChange) {
  ForcingTerm forcing;
  const double large = 1e3, still = forcing.next(criteria, left(large), false);
  forcing.start_instant();
  const double changing = forcing.next(criteria, left(large), true);
  EXPECT_GT(changing, still);
  const double gain = 1e-3, after = forcing.next(criteria, left(large * gain), true);
  EXPECT_LE(after, gain * gain);
  EXPECT_GT(after, 0);
}

}  // namespace
}  // namespace lacon
