// Patches that lose their master where they press: once is a slide off an edge, twice is what no status satisfies.
#include "lacon/operators/evolution/lost_masters.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

using Statuses = std::vector<Status>;
using Patches = std::vector<std::size_t>;
constexpr Status A = Status::active, O = Status::open, U = Status::unpaired;

TEST(LostMasters, AreTheSecondOnesOfAnInstant) {
  LostMasters lost;
  bool covered = false;
  const auto is_covered = [&](std::size_t patch) { return patch != 1 || covered; };
  const std::vector<double> pressed{-1, -1, -1};
  const auto note = [&](const Statuses& before, const Statuses& wanted, bool is) {
    covered = is;
    return lost.note(before, wanted, pressed, false, is_covered);
  };
  lost.start_instant();
  EXPECT_EQ(note({A, A, A}, {A, U, A}, false), Patches{});
  EXPECT_EQ(note({A, U, A}, {A, U, A}, false), Patches{});  // it has none to lose
  EXPECT_EQ(note({A, U, A}, {A, O, A}, true), Patches{});
  EXPECT_EQ(note({A, O, A}, {A, A, A}, true), Patches{});
  EXPECT_EQ(note({A, A, A}, {A, O, A}, false), Patches{1});  // too little of it, or nothing
  EXPECT_EQ(note({A, O, A}, {A, A, A}, true), Patches{});
  lost.forget(1);
  EXPECT_EQ(note({A, A, A}, {A, U, A}, false), Patches{});
  lost.start_instant();
  EXPECT_EQ(note({A, A, A}, {A, U, A}, false), Patches{});
  EXPECT_EQ(note({A, U, A}, {A, A, A}, true), Patches{});
  EXPECT_EQ(note({A, A, A}, {A, U, A}, false), Patches{1});
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
