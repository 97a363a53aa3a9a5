// What kernels are written with.
#include "lacon/elements/lanes.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace lacon;

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
/// x y - 1, which a fused instruction does not round in between.
LACON_KERNEL double product_less_one(double x, double y) { return x * y - 1; }

TEST(Kernels, AreRunWithTheInstructionSetOfTheProcessorWhoeverMadeIt) {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) GTEST_SKIP() << "the processor has no fused product";
  volatile double small = 0x1p-40;  // (1 + e) (1 - e) - 1 = -e^2
  EXPECT_EQ(product_less_one(1 + small, 1 - small), -0x1p-80);
}
#endif

TEST(LaneErrorsTest, TheFirstErrorOfEachLaneStays) {
  static_assert(LACON_LANES == 8);
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const Lanes values = {1, -1, nan, inf, -inf, 0, 5, 1e308};
  LaneErrors errors;
  errors.set(6, true, LACON_BEYOND_CURVE);
  errors.set(5, false, LACON_BEYOND_CURVE);
  errors.set(values < 0, LACON_BAD_JACOBIAN);
  errors.check_finite(values);
  errors.set(~(values > 0), LACON_BAD_RADIUS);
  std::int32_t stored[2 * LACON_LANES] = {};
  errors.store(stored, 1);
  const std::int32_t expected[] = {LACON_FINE,         LACON_BAD_JACOBIAN, LACON_NOT_FINITE,   LACON_NOT_FINITE,
                                   LACON_BAD_JACOBIAN, LACON_BAD_RADIUS,   LACON_BEYOND_CURVE, LACON_FINE};
  for (int l = 0; l < LACON_LANES; ++l) {
    EXPECT_EQ(stored[l], 0);
    EXPECT_EQ(stored[LACON_LANES + l], expected[l]) << l;
  }
}

}  // namespace
