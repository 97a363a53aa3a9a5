// Patches that lose their master where they press: once is a slide off an edge, twice is what no status satisfies.
#include "lacon/operators/evolution/newton/lost_masters.hpp"

#include <gtest/gtest.h>

#include "statuses.hpp"

namespace lacon {
namespace {

using Statuses = std::vector<Status>;
using Patches = std::vector<std::size_t>;

TEST(LostMasters, AreTheSecondOnesOfAnInstant) {
  LostMasters lost;
  const auto is_covered = [](std::size_t patch) { return patch != 1; };
  const std::vector<double> pressed{-1, -1, -1};
  lost.start_instant();
  EXPECT_EQ(lost.note({A, A, A}, {A, U, A}, pressed, false, is_covered), Patches{});
  EXPECT_EQ(lost.note({A, U, A}, {A, O, A}, pressed, false, is_covered), Patches{});  // it has none to lose
  EXPECT_EQ(lost.note({A, O, A}, {A, A, A}, pressed, false, is_covered), Patches{});
  EXPECT_EQ(lost.note({A, A, A}, {A, O, A}, pressed, false, is_covered), Patches{1});  // too little of it, or nothing
  lost.forget(1);
  EXPECT_EQ(lost.note({A, A, A}, {A, U, A}, pressed, false, is_covered), Patches{});
  lost.start_instant();
  EXPECT_EQ(lost.note({A, A, A}, {A, U, A}, pressed, false, is_covered), Patches{});
  EXPECT_EQ(lost.note({A, A, A}, {A, U, A}, pressed, false, is_covered), Patches{1});
}

TEST(LostMasters, AreNotThoseOfPatchesThatOpen) {
  LostMasters lost;
  const auto bare = [](std::size_t) { return false; };
  const auto whole = [](std::size_t) { return true; };
  for (int iteration = 0; iteration < 3; ++iteration) {
    EXPECT_EQ(lost.note({A}, {O}, std::vector<double>{-1.0}, false, whole), Patches{});  // its gap is wide
    EXPECT_EQ(lost.note({A}, {U}, std::vector<double>{1.0}, false, bare), Patches{});    // it is pulled
    EXPECT_EQ(lost.note({A}, {A}, std::vector<double>{-1.0}, false, bare), Patches{});
  }
}

TEST(LostMasters, AreThoseOfPatchesThatPullOnTheWayToAnEquilibriumAsWell) {
  LostMasters lost;
  const auto bare = [](std::size_t) { return false; };
  const auto whole = [](std::size_t) { return true; };
  const std::vector<double> pulled{1.0};
  EXPECT_EQ(lost.note({A}, {O}, pulled, true, bare), Patches{});
  EXPECT_EQ(lost.note({A}, {O}, pulled, true, bare), Patches{});  // it is kept active, and has none to lose
  EXPECT_EQ(lost.note({A}, {A}, pulled, true, whole), Patches{});
  EXPECT_EQ(lost.note({A}, {O}, pulled, true, bare), Patches{0});
}

}  // namespace
}  // namespace lacon
