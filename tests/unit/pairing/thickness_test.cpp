// How thick bodies are, what lies beyond them, and ways through them.
#include "lacon/pairing/thickness.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

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

struct BothSides {
  std::vector<double> slave, master;
};

BothSides thickness(const Surface& slave, const Surface& master) {
  const WaysThrough ways({&slave, &master});
  return {lacon::thickness(slave, ways), lacon::thickness(master, ways)};
}

TEST(Thickness, IsToTheNearestOtherSideOfTheSameBody) {
  const std::vector<std::int32_t> one(40, 7), other(40, 8);
  for (const Kind kind : {Kind::linear, Kind::quadratic}) {
    Skin upper = plate(0, 0.25, 4, kind), lower = plate(-3, 0, 7, kind);
    const BothSides found = thickness(with_body(upper, one), with_body(lower, other));
    EXPECT_EQ(found.slave, std::vector<double>(8, 0.25));
    EXPECT_EQ(found.master, std::vector<double>(14, 3));
  }
  // of one body whose sides are in both skins; and one that has a cavity
  Skin bottom, rest;
  add_chain(bottom, line(0), {0, 4}, Kind::linear);
  add_chain(rest, line(2), {4, 0}, Kind::linear);
  const BothSides through = thickness(with_body(bottom, one), with_body(rest, one));
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
      const BothSides found = thickness(bottom.view(), top.view());
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
  const BothSides thick = thickness(slave, master);
  slave.body = master.body = {};  // so that no way through them is looked at
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

/// A key that is 2 wide and 3 high in the keyway of a shaft, with its lower half. Cells go against the clock around the bodies.
struct Keyway {
  Skin shaft, key;
  std::vector<std::int32_t> of_shaft = std::vector<std::int32_t>(40, 7), of_key = std::vector<std::int32_t>(40, 8);

  /// @param moved the key, to the left
  explicit Keyway(double moved = 0) {
    const auto through = [](Skin& skin, const std::vector<Vec2>& corners) {
      for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const Vec2 a = corners[i], b = corners[i + 1];
        add_chain(
            skin,
            [=](double t) {
              return std::array{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
            },
            {0, 1}, Kind::linear);
      }
    };
    // the upper side falls to the left, so that normals below it lean into the keyway
    through(shaft, {{1, 0}, {1, -1.5}, {-1, -1.5}, {-1, 0}, {-2, -0.5}});
    std::vector<Vec2> corners{{-1, 1.5}, {-1, -1.5}, {1, -1.5}, {1, 1.5}};
    for (Vec2& corner : corners) corner.x -= moved;
    through(key, corners);
  }
  Pairing operator()(const PairingOptions& options, double closer = 0) {
    Surface slave = with_body(shaft, of_shaft), master = with_body(key, of_key);
    const std::vector<double> rest = moved(key.coordinates, {0, closer, 0});
    master.rest = rest;
    return pair(slave, master, options);
  }
};

// The upper side of the shaft sees the bottom of the key, through a corner of the shaft and through the key.
TEST(WaysThrough, WhatIsSeenThroughASideOfABodyIsLeftOut) {
  Keyway keyway;
  const auto sees = [](const Pairing& found, std::int32_t slave, std::int32_t master) {
    bool any = false;
    for (std::size_t c = 0; c < found.cells.size(); ++c)
      any = any || (found.cells.slave[c] == slave && found.cells.master[c] == master);
    return any;
  };
  const PairingOptions deep{.depth_limit = 4};
  constexpr std::int32_t upper = 3, floor = 1, bottom = 1;
  EXPECT_TRUE(sees(keyway({}), upper, bottom));
  const Pairing found = keyway(deep);
  EXPECT_FALSE(sees(found, upper, bottom));
  EXPECT_EQ(found.count(Rejection::too_deep), 1);
  EXPECT_TRUE(sees(found, floor, bottom));
  EXPECT_TRUE(sees(keyway({.distance_limit = 4}), upper, bottom));  // who gives a limit has it
  // what has come closer since bodies were at rest may be an iterate
  EXPECT_TRUE(sees(keyway(deep, 1.5), upper, bottom));
  // a key that lies in the wall by more than half of its cells, but on no way out of both
  Keyway pressed(1.8);
  EXPECT_TRUE(sees(pressed(deep), 2, 0));
  // of one body other limits hold
  keyway.of_key.assign(40, 7);
  EXPECT_EQ(keyway(deep).count(Rejection::too_deep), 0);
}

// A leaf of a spring in its free shape, which lies in a block by more than it is thick.
TEST(WaysThrough, AThinBodyInsideOfAnotherOneStaysInContact) {
  const std::vector<std::int32_t> one(82, 7), other(82, 8);
  Skin leaf = plate(-0.6, -0.5, 40), block = plate(-3, 0, 40);  // 0.1 thick, the block 3
  const PairingOptions deep{.depth_limit = 40};
  Surface slave = with_body(leaf, one), master = with_body(block, other);
  const BothSides thick = thickness(slave, master);
  slave.thickness = thick.slave, master.thickness = thick.master;
  const Pairing found = pair(slave, master, deep);
  EXPECT_GE(found.count(Rejection::too_deep), 40);  // its upper side and the lower one of the block
  std::set<std::int32_t> pressed;                   // of its lower side, by the upper one of the block
  for (std::size_t c = 0; c < found.cells.size(); ++c)
    if (found.cells.master[c] >= 40) pressed.insert(found.cells.slave[c]);
  ASSERT_EQ(pressed.size(), 40U);
  EXPECT_EQ(*pressed.rbegin(), 39);
}

// Two plates on each other, ten times as long as thick in each cell: their far sides overlap by a fifth of a cell.
TEST(WaysThrough, FarSidesOfThinPlatesAreLeftOut) {
  const std::vector<std::int32_t> one(40, 7), other(40, 8);
  Skin lower = plate(-0.1, 0, 4), upper = plate(0, 0.1, 4);
  Surface slave = with_body(lower, one), master = with_body(upper, other);
  const BothSides thick = thickness(slave, master);
  slave.thickness = thick.slave, master.thickness = thick.master;
  const auto far = [&](const PairingOptions& options) {
    const Pairing found = pair(slave, master, options);
    EXPECT_GE(found.cells.size(), 4U);
    return std::ranges::count_if(found.cells.slave, [](std::int32_t cell) { return cell < 4; });
  };
  EXPECT_EQ(far({.depth_limit = 4}), 0);
  EXPECT_EQ(far({.distance_limit = 4}), 4);  // who gives a limit has it
}

// Of a body whose far side is in no zone the boundary tells where ways leave it.
TEST(WaysThrough, GoByTheWholeBoundaryWhereItIsKnown) {
  const std::vector<std::int32_t> one(80, 7), other(80, 8);
  Skin skin, rack, boundary;
  // a slave that looks down from the top of its plate; 3 below the plate the top of a block that is 1 high
  add_chain(
      skin,
      [](double t) {
        return std::array{1 - t, 0.0};
      },
      {0, 1}, Kind::linear);
  add_chain(
      rack,
      [](double t) {
        return std::array{1 - t, -2.0};
      },
      {1, 0}, Kind::linear);
  const Surface slave = with_body(skin, one), master = with_body(rack, other);
  EXPECT_EQ(pair(slave, master, {.depth_limit = 4}).cells.size(), 1U);
  std::vector<std::int32_t> body;
  for (const double height : {0.0, -1.0, -2.0, -1.5}) {
    const bool top = height == 0 || height == -1.5;
    add_chain(
        boundary,
        [=](double t) {
          return std::array{top ? 1 - t : t, height};
        },
        {0, 1}, Kind::linear);
    body.resize(boundary.coordinates.size() / 3, height >= -1 ? 7 : 8);
  }
  boundary.surface.body = body;
  const WaysWhenAsked ways({&boundary.view()});
  const Pairing found = pair(slave, master, {.depth_limit = 4, .ways = &ways});
  EXPECT_EQ(found.cells.size(), 0U);
  EXPECT_EQ(found.count(Rejection::too_deep), 1);
}

/// A slave of length 1 under a ledge of the master, which ends above it at `end`; behind that the master is 3 further away.
/// @param ledge whether it is there at all  @param bar whether a bar lies on the way, whose upper side alone is known
/// @param cells of the master behind it
Pairing under_ledge(double end, bool ledge, bool bar, const PairingOptions& options = {.depth_limit = 4}, int cells = 1) {
  Skin slave, master;
  const auto add = [](Skin& skin, Vec2 a, Vec2 b) {
    add_chain(
        skin,
        [=](double t) {
          return std::array{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        },
        {0, 1}, Kind::linear);
  };
  add(slave, {1, 0}, {0, 0});
  if (ledge) add(master, {-1, 0}, {end, 0});
  for (int i = 0; i < cells; ++i) add(master, {end + i * (2 - end) / cells, 3}, {end + (i + 1) * (2 - end) / cells, 3});
  if (bar) add(master, {2, 1.5}, {0.5, 1.5});
  const std::vector<std::int32_t> one(40, 7), other(5000, 8);  // by node
  return pair(with_body(slave, one), with_body(master, other), options);
}

// Where ends lie on each other round-off decides whether a slave sees past them, and what it sees there has a derivative that
// is as large as its gap.
TEST(WaysThrough, SliversPastTheEndOfWhatIsNearAreLeftOut) {
  constexpr double round_off = 1e-12, sliver = 9e-4, more = 0.011, much = 0.021;
  const auto far = [](const Pairing& found) {
    return std::ranges::count(found.cells.master, found.cells.master.empty() ? 0 : found.cells.master.back());
  };
  for (const double width : {round_off, sliver}) {
    const Pairing found = under_ledge(1 - width, true, false);
    EXPECT_EQ(found.cells.master, std::vector<std::int32_t>{0}) << width;
    EXPECT_EQ(found.count(Rejection::sliver), 1) << width;
    // where there is nothing near what is far is all that there is
    EXPECT_EQ(far(under_ledge(1 - width, false, false)), 1) << width;
  }
  // not where gaps are not differentiated
  EXPECT_EQ(under_ledge(1 - sliver, true, false, {.depth_limit = 4, .drops_slivers = false}).cells.master,
            (std::vector<std::int32_t>{1, 0}));
  // masters count together, however fine they are
  EXPECT_GT(under_ledge(1 - 3e-3, true, false, {.depth_limit = 4}, 2000).cells.master.size(), 5U);
  // through a bar, up to a fiftieth of the slave
  EXPECT_EQ(under_ledge(1 - more, true, false).cells.master, (std::vector<std::int32_t>{1, 0}));
  const Pairing behind = under_ledge(1 - more, true, true);
  EXPECT_EQ(behind.cells.master, std::vector<std::int32_t>{0});
  EXPECT_EQ(behind.count(Rejection::hidden), 1);
  EXPECT_EQ(under_ledge(1 - much, true, true).cells.master, (std::vector<std::int32_t>{1, 0}));
}

// The same in space, the upper side of a block beside a pocket and the bottom of what is in it, whatever the cells.
TEST(WaysThrough, InSpaceAsInThePlane) {
  std::mt19937 random(3);
  const std::vector<std::int32_t> of_block(4000, 7), of_key(4000, 8);
  const auto wall = [](double at) { return [=](double x, double y) { return Vec3{at, y, x}; }; };
  for (const CellType type : kinds) {
    // its normals lean by 0.5 into the pocket at x > 0
    Skin3 block = mesh(
        {1, 1, type, true, 0, -1, 0, 0, 1},
        [](double x, double y) {
          return Vec3{x, y, 0.5 * x};
        },
        random);
    Skin3 key = mesh(
        {1, 1, type, false, 0, 0, 1, 0, 1},
        [](double x, double y) {
          return Vec3{x, y, -1.5};
        },
        random);
    block.surface.body = of_block, key.surface.body = of_key;
    const PairingOptions deep{.depth_limit = 4};
    const auto n_upper = static_cast<std::int32_t>(block.surface.size()),
               n_bottom = static_cast<std::int32_t>(key.surface.size());
    for (const bool of_block_too : {true, false})
      for (const bool of_key_too : {true, false}) {
        Skin3 slave = block, master = key;
        if (of_block_too) append(slave, mesh({1, 1, CellType::QUAD4, false, 0, -1.5, 0, 0, 1}, wall(0), random));
        if (of_key_too) append(master, mesh({1, 1, CellType::QUAD4, true, 0, -1.5, 1, 0, 1}, wall(0), random));
        slave.surface.body = of_block, master.surface.body = of_key;
        const Pairing found = pair(slave.view(), master.view(), deep);
        std::size_t count = 0;
        for (std::size_t c = 0; c < found.cells.size(); ++c)
          count += found.cells.slave[c] < n_upper && found.cells.master[c] < n_bottom;
        EXPECT_EQ(count == 0, of_block_too && of_key_too) << catalog::cell(type).name;
        EXPECT_EQ(found.count(Rejection::too_deep) > 0, of_block_too && of_key_too) << catalog::cell(type).name;
      }
  }
}

}  // namespace
}  // namespace lacon
