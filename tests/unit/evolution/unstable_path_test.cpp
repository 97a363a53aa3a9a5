// Which instants follow an equilibrium that is not stable.
#include "lacon/operators/evolution/newton/unstable_path.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "lacon/structures/hdf5.hpp"

namespace lacon {
namespace {

TEST(Stability, IsUnknownWithoutPivotsWhereTheMatrixIsTakenAsItIs) {
  EXPECT_EQ(stability_of(false, 9, 3), Stability::stable);
  EXPECT_EQ(stability_of(false, {}, 3), Stability::stable);
  EXPECT_EQ(stability_of(true, 3, 3), Stability::stable);
  EXPECT_EQ(stability_of(true, 4, 3), Stability::unstable);
  EXPECT_EQ(stability_of(true, {}, 3), Stability::unknown);
}

/// What instants do whose iterations leave an unstable equilibrium: L looks for a stable one, F follows. @param stable the
/// instant that finds one when it looks, if any  @param lost the instant that finds nothing near the unstable one
std::string attempts(UnstablePath& path, int instants, int stable = -1, int lost = -1) {
  std::string done;
  for (int instant = 0; instant < instants; ++instant) {
    for (;;) {
      const bool follows = path.begin();
      done += follows ? 'F' : 'L';
      if (follows ? instant != lost : instant == stable) {
        path.solve(follows);
        break;
      }
      if (path.fail(!follows)) continue;
      done += '!';
      break;
    }
    done += ' ';
  }
  return done;
}

TEST(UnstablePath, LooksLessAndLessOften) {
  UnstablePath path;
  EXPECT_EQ(attempts(path, 12), "LF F LF F F LF F F F F LF F ");
}

TEST(UnstablePath, AStableEquilibriumBeginsAnew) {
  UnstablePath path;
  EXPECT_EQ(attempts(path, 8, 5), "LF F LF F F L LF F ");
}

TEST(UnstablePath, WhatFollowsInVainLooksAfterAll) {
  UnstablePath found, neither;
  EXPECT_EQ(attempts(found, 6, 4, 4), "LF F LF F FL LF ");
  EXPECT_EQ(attempts(neither, 6, -1, 4), "LF F LF F FL! LF ");  // and fails with what the second attempt says
}

TEST(UnstablePath, WhereNothingIsUnstableFailuresAreFinal) {
  UnstablePath path;
  EXPECT_FALSE(path.begin());
  EXPECT_FALSE(path.fail(false));
  EXPECT_FALSE(path.begin());
}

TEST(UnstablePath, AnInstantThatIsStableAfterAllEndsIt) {
  UnstablePath path;
  attempts(path, 4);
  EXPECT_TRUE(path.begin());
  path.solve(false);
  EXPECT_FALSE(path.begin());
}

TEST(UnstablePath, IsKeptForAnotherProcess) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "lacon_unstable_path.h5";
  UnstablePath path, other;
  attempts(path, 4);
  hdf5::write_whole(file, [&](const hdf5::Group& root) { path.save(root.create("path")); });
  other.resume(hdf5::Reader(file).open("path"));
  std::filesystem::remove(file);
  EXPECT_EQ(attempts(other, 3), attempts(path, 3));
  EXPECT_EQ(attempts(other, 1), "F ");
}

}  // namespace
}  // namespace lacon
