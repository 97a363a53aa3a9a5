#include "lacon/operators/evolution/newton/linear_solver.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

constexpr const char* too_large = "factor_too_large";

// A factor takes more than half of the memory: in double precision from 698 500 equations in space on with 24 GB, as 4.2 GB
// were measured for 311 469. In the plane hardly ever.
TEST(LinearSolver, IteratesWhereAFactorWouldBeTooLarge) {
  const auto reason = [](std::int64_t n, int dimension, double memory, bool in_double_precision = false) {
    return reason_of_iterations(n, dimension, memory_of_factor(n, dimension, in_double_precision), memory);
  };
  EXPECT_NEAR(memory_of_factor(964'603, 3), 7e9, 1e6);
  EXPECT_NEAR(memory_of_factor(311'469, 3, true), 4.2e9, 1e6);
  EXPECT_NEAR(memory_of_factor(698'500, 3, true), 12e9, 0.01e9);
  EXPECT_STRNE(reason(1'500'000, 3, 24e9), too_large);
  EXPECT_STREQ(reason(1'530'000, 3, 24e9), too_large);
  EXPECT_STRNE(reason(690'000, 3, 24e9, true), too_large);
  EXPECT_STREQ(reason(710'000, 3, 24e9, true), too_large);
  EXPECT_STREQ(reason(200'000, 3, 1e9), too_large);
  EXPECT_EQ(reason(1'530'000, 2, 24e9), nullptr);
}

TEST(LinearSolver, IteratesWhereThatIsFaster) {
  EXPECT_STREQ(reason_of_iterations(300'000, 3, 1e9, 1e12), "iterations_are_faster");
  EXPECT_EQ(reason_of_iterations(299'999, 3, 1e9, 1e12), nullptr);
  EXPECT_EQ(reason_of_iterations(3'000'000, 2, 1e9, 1e12), nullptr);
}

}  // namespace
}  // namespace lacon
