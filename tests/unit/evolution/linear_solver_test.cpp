#include "lacon/operators/evolution/linear_solver.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

// AUTO iterates where a factor would take more than half of the memory: in space from 1.5 million equations on with 24 GB, as 7
// GB were measured for 964 603; in double precision from 698 500 on, as 4.2 GB were for 311 469. In the plane hardly ever.
TEST(LinearSolver, IteratesWhereAFactorWouldBeTooLarge) {
  const auto iterates = [](std::int64_t n, int dimension, double memory, bool in_double_precision = false) {
    return suits_iterations(memory_of_factor(n, dimension, in_double_precision), memory);
  };
  EXPECT_NEAR(memory_of_factor(964'603, 3), 7e9, 1e6);
  EXPECT_NEAR(memory_of_factor(311'469, 3, true), 4.2e9, 1e6);
  EXPECT_NEAR(memory_of_factor(698'500, 3, true), 12e9, 0.01e9);
  EXPECT_FALSE(iterates(1'500'000, 3, 24e9));
  EXPECT_TRUE(iterates(1'530'000, 3, 24e9));
  EXPECT_FALSE(iterates(690'000, 3, 24e9, true));
  EXPECT_TRUE(iterates(710'000, 3, 24e9, true));
  EXPECT_TRUE(iterates(400'000, 3, 4e9));
  EXPECT_FALSE(iterates(1'530'000, 2, 24e9));
}

}  // namespace
}  // namespace lacon
