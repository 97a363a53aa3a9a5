// Properties of clipping and pairing for whatever is given; rapidcheck looks for the smallest input that breaks one.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "lacon/pairing/polygon.hpp"
#include "skins_in_space.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;

// ---------------------------------------------------------------------------------------------- clipping

/// A triangle or a parallelogram with corners on a lattice, which shrinks towards the origin and has exact areas.
space::Polygon any_polygon() {
  const auto number = [] { return static_cast<double>(*rc::gen::inRange(-20, 21)); };
  const Vec2 a{number(), number()}, u{number(), number()}, v{number(), number()};
  RC_PRE(cross(u, v) != 0.0);
  space::Polygon polygon{a, a + u, a + u + v, a + v};
  if (*rc::gen::arbitrary<bool>()) polygon.erase(polygon.begin() + 2);
  if (cross(u, v) < 0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

space::HalfPlane left_of(Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  return {a, {-d.y, d.x}, 0};
}

space::Region region(const space::Polygon& polygon) {
  space::Region made{polygon, {}};
  for (std::size_t i = 0; i < polygon.size(); ++i)
    made.halves.push_back(left_of(polygon[i], polygon[(i + 1) % polygon.size()]));
  return made;
}

double area(const space::Region& r) { return 0.5 * space::double_area(r.polygon); }

bool close(double a, double b, double scale) { return std::abs(a - b) <= 1e-13 * scale; }

constexpr double box = 120.0 * 120.0;  // what holds every polygon

RC_GTEST_PROP(Clipping, TheCommonPartIsTheSameFromBothSidesAndNoLargerThanEither, ()) {
  const space::Region a = region(any_polygon()), b = region(any_polygon());
  const double common = area(space::intersection(a, b));
  RC_ASSERT(close(common, area(space::intersection(b, a)), box));
  RC_ASSERT(common <= std::min(area(a), area(b)) + 1e-13 * box);
}

RC_GTEST_PROP(Clipping, TheTwoSidesOfALineMakeUpTheCommonPart, ()) {
  const space::Region a = region(any_polygon()), b = region(any_polygon());
  const space::Polygon line = any_polygon();
  const space::HalfPlane half = left_of(line[0], line[1]);
  double sum = 0;
  for (const space::HalfPlane& side : {half, half.opposite()}) {
    space::Region part{{}, b.halves};
    space::clip(b.polygon, side, part.polygon);
    part.halves.push_back(side);
    sum += area(space::intersection(a, part));
  }
  RC_ASSERT(close(sum, area(space::intersection(a, b)), box));
}

RC_GTEST_PROP(Clipping, WhatIsTakenAndWhatIsLeftMakeUpTheWhole, ()) {
  const space::Region a = region(any_polygon()), b = region(any_polygon());
  std::vector<space::Region> rest;
  space::subtract(a, b, 0, rest);
  double sum = area(space::intersection(a, b));
  for (const space::Region& part : rest) sum += area(part);
  RC_ASSERT(close(sum, area(a), box));
}

// ---------------------------------------------------------------------------------------------- pairing

struct Couple {
  Skin3 slave, master;
};

const std::vector<CellType> kinds_of_cells(std::begin(kinds), std::end(kinds));

/// A slave over the unit square, looking down, and masters below it that reach further on all sides.
Couple any_couple(double bend) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  const auto number = [] { return *rc::gen::inRange(1, 5); };
  const auto surface = [bend](double z) {
    return [bend, z](double x, double y) { return Vec3{x, y, z + bend * (x * x - x * y)}; };
  };
  const Grid slave{number(), number(), *rc::gen::elementOf(kinds_of_cells), false, 0.25};
  const Grid master{number(), number(), *rc::gen::elementOf(kinds_of_cells), true, 0.25, -0.3, 1.2, -0.1, 1.4};
  return {mesh(slave, surface(0.0), random), mesh(master, surface(-0.05), random)};
}

RC_GTEST_PROP(PairingInSpace, CoversAFlatSlaveOnce, ()) {
  auto [slave, master] = any_couple(0);
  const Forces found = forces(slave, master, pair(slave.view(), master.view()).cells);
  RC_ASSERT(std::abs(found.area - 1) <= 1e-12);
  RC_ASSERT(std::abs(found.gap - 0.05) <= 1e-12);
}

RC_GTEST_PROP(PairingInSpace, TurningAndMovingBothSkinsChangesNothing, ()) {
  auto [slave, master] = any_couple(0);
  const Forces still = forces(slave, master, pair(slave.view(), master.view()).cells);
  const auto angle = [] { return *rc::gen::inRange(-300, 301) / 100.0; };
  const Motion motion{angle(), angle(), 1, {angle(), angle(), angle()}};
  motion(slave), motion(master);
  const Forces moved = forces(slave, master, pair(slave.view(), master.view()).cells);
  RC_ASSERT(std::abs(moved.area - still.area) <= 1e-11);
  RC_ASSERT(std::abs(moved.gap - still.gap) <= 1e-11);
  for (std::size_t n = 0; n < still.slave.size(); ++n) RC_ASSERT(std::abs(moved.slave[n] - still.slave[n]) <= 1e-11);
  for (std::size_t n = 0; n < still.master.size(); ++n) RC_ASSERT(std::abs(moved.master[n] - still.master[n]) <= 1e-11);
}

/// Contact cells by the numbers of the cells in the files, with the bits of their weights.
std::multiset<std::tuple<std::int32_t, std::int32_t, std::vector<double>>> by_number(const ContactCells& cells,
                                                                                     const std::vector<std::int32_t>& slave,
                                                                                     const std::vector<std::int32_t>& master) {
  std::multiset<std::tuple<std::int32_t, std::int32_t, std::vector<double>>> found;
  for (std::size_t c = 0; c < cells.size(); ++c)
    found.emplace(slave[cells.slave[c]], master[cells.master[c]],
                  std::vector<double>(cells.weight.begin() + cells.offset[c], cells.weight.begin() + cells.offset[c + 1]));
  return found;
}

RC_GTEST_PROP(PairingInSpace, TheOrderOfCellsChangesNoBit, ()) {
  auto [slave, master] = any_couple(*rc::gen::inRange(0, 4) / 10.0);
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::vector<std::int32_t> slave_order, master_order;
  Skin3 same_slave = permuted(slave, slave_order, random), same_master = permuted(master, master_order, random);
  const auto as_it_is = [](const Skin3& skin) {
    std::vector<std::int32_t> order(skin.surface.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
    return order;
  };
  RC_ASSERT(by_number(pair(slave.view(), master.view()).cells, as_it_is(slave), as_it_is(master)) ==
            by_number(pair(same_slave.view(), same_master.view()).cells, slave_order, master_order));
}

}  // namespace
