#include "lacon/operators/evolution/linear_solver.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

// AUTO iterates where a factor would take more than half of the memory: in space from 698 500 equations on with 24 GB, as 4.2
// GB were measured for 311 469 and grow as N^1.3; never for fewer than that.
TEST(LinearSolver, IteratesWhereAFactorWouldBeTooLarge) {
  EXPECT_NEAR(memory_of_factor(311'469, 3), 4.2e9, 1e6);
  EXPECT_NEAR(memory_of_factor(698'500, 3), 12e9, 0.01e9);
  EXPECT_FALSE(suits_iterations(690'000, 3, 24e9));
  EXPECT_TRUE(suits_iterations(710'000, 3, 24e9));
  EXPECT_TRUE(suits_iterations(311'469, 3, 8e9));
  EXPECT_FALSE(suits_iterations(710'000, 2, 24e9));
}

}  // namespace
}  // namespace lacon
