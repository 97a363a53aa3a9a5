// How thick bodies are, and what lies beyond them.
#include "lacon/pairing/thickness.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "moved.hpp"
#include "skins.hpp"
#include "skins_in_space.hpp"

namespace lacon {
namespace {

using namespace test;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The lower and the upper side of a plate in the plane, the lower one first, in `n` cells each, on x = 0 to 4.
Skin plate(double low, double high, int n, Kind kind = Kind::linear) {
  Skin skin;
  add_chain(skin, line(low), uniform(0, 4, n), kind);
  add_chain(skin, line(high), uniform(4, 0, n), kind);
  return skin;
}

const Surface& with_body(Skin& skin, const std::vector<std::int32_t>& body) {
  skin.surface.body = body;
  return skin.view();
}

TEST(Thickness, IsToTheNearestOtherSideOfTheSameBody) {
  const std::vector<std::int32_t> one(40, 7), other(40, 8);
  for (const Kind kind : {Kind::linear, Kind::quadratic}) {
    Skin upper = plate(0, 0.25, 4, kind), lower = plate(-3, 0, 7, kind);
    const Thickness found = thickness(with_body(upper, one), with_body(lower, other));
    EXPECT_EQ(found.slave, std::vector<double>(8, 0.25));
    EXPECT_EQ(found.master, std::vector<double>(14, 3));
  }
  // of one body whose sides are in both skins; and one that has a cavity
  Skin bottom, rest;
  add_chain(bottom, line(0), {0, 4}, Kind::linear);
  add_chain(rest, line(2), {4, 0}, Kind::linear);
  const Thickness through = thickness(with_body(bottom, one), with_body(rest, one));
  EXPECT_EQ(through.slave, std::vector<double>{2});
  EXPECT_EQ(through.master, std::vector<double>{2});
  add_chain(rest, line(0.5), {3, 1}, Kind::linear);
  EXPECT_EQ(thickness(with_body(bottom, one), with_body(rest, one)).slave, std::vector<double>{0.5});
  EXPECT_EQ(thickness(with_body(bottom, one), with_body(rest, other)).slave, std::vector<double>{infinite});
}

TEST(Thickness, InSpaceMissesNoCellByRoundOff) {
  // middles of triangles over edges of quadrangles, and the other way round
  std::mt19937 random(5);
  const std::vector<std::int32_t> one(4000, 7), other(4000, 8);
  for (const CellType below : kinds)
    for (const CellType above : kinds) {
      Skin3 bottom = mesh({6, 6, below, false}, plane(0.1), random), top = mesh({4, 9, above, true}, plane(0.4), random);
      bottom.surface.body = top.surface.body = one;
      const Thickness found = thickness(bottom.view(), top.view());
      for (const std::vector<double>& side : {found.slave, found.master})
        for (const double thick : side) EXPECT_NEAR(thick, 0.3, 1e-14);
      top.surface.body = other;
      EXPECT_EQ(thickness(bottom.view(), top.view()).slave, std::vector<double>(bottom.surface.size(), infinite));
    }
}

TEST(Thickness, OverlapsOfMoreThanHalfOfBothBodiesAreLeftOut) {
  const std::vector<std::int32_t> one(40, 7), other(40, 8);
  // the lower one 3 thick: the far sides overlap by 4, near ones by nothing
  Skin upper = plate(0, 1, 1), lower = plate(-3, 0, 1);
  Surface slave = with_body(upper, one), master = with_body(lower, other);
  const Thickness thick = thickness(slave, master);
  const auto rejected = [&](double raised, const PairingOptions& options, double closer = 0) {
    const std::vector<double> now = moved(upper.coordinates, {0, raised, 0}), rest = moved(now, {0, closer, 0});
    Surface of_slave = slave;
    of_slave.coordinates = now;
    of_slave.rest = rest;
    return pair(of_slave, master, options).count(Rejection::too_deep);
  };
  const PairingOptions deep{.depth_limit = 4};
  EXPECT_EQ(rejected(0, deep), 0);  // no thickness is known
  slave.thickness = thick.slave;
  EXPECT_EQ(rejected(0, deep), 0);
  master.thickness = thick.master;
  EXPECT_EQ(rejected(0, deep), 1);
  EXPECT_EQ(rejected(0, {.distance_limit = 4}), 0);  // who gives a limit has it
  EXPECT_EQ(rejected(0, {}), 0);
  // half of both is 2: a near side less deep than that stays, and a far one that deep goes
  EXPECT_EQ(rejected(-1.999, deep), 1);
  EXPECT_EQ(rejected(-2.001, deep), 1);  // the near side now
  EXPECT_EQ(pair(slave, master, deep).cells.slave, std::vector<std::int32_t>{0});
  // what the near side has come closer since bodies were at rest comes on top
  EXPECT_EQ(rejected(-3, deep, 1.001), 0);
  EXPECT_EQ(rejected(-3, deep, 0.999), 1);
  // of foils points of coarse patches may lie inside by more than they are thick: up to half a cell of 4
  std::vector<double> thin(2, 0.01), thinner(2, 0.02);
  slave.thickness = thin, master.thickness = thinner;
  EXPECT_EQ(rejected(-1, deep), 1);  // the far sides alone, which overlap by 3
  slave.thickness = thick.slave;
  // what one body is thick alone says nothing of the other
  const std::vector<double> unknown(2, infinite);
  master.thickness = unknown;
  EXPECT_EQ(rejected(0, deep), 0);
}

}  // namespace
}  // namespace lacon
