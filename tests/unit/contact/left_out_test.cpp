// Masters that a patch does not see: those far behind others, and walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "skins.hpp"

namespace lacon {
namespace {

/// Patches over a step: squares at 0.1 below the slave up to x = 0.6, and a floor at `floor` below it.
struct Step {
  Skins skins{4, 4, false};
  std::int32_t floor_cell;

  Step() {
    ContactZone& zone = skins.contact.zones[0];
    for (std::size_t i = 0; i < skins.mesh.coordinates.size(); i += 3)
      if (skins.mesh.coordinates[i + 2] < 0) skins.mesh.coordinates[i] -= 0.4;
    const std::vector<std::int32_t> floor = skins.add(1, true, -0.6);
    floor_cell = floor[0];
    zone.master.push_back(floor_cell);
    skins.model.element.push_back(0);
    skins.displacement.assign(skins.mesh.coordinates.size(), 0.0);
  }
  std::vector<double> floor_raised(double by) const {
    std::vector<double> displacement = skins.displacement;
    for (std::size_t i = 2; i < displacement.size(); i += 3)
      if (skins.mesh.coordinates[i] == -0.6) displacement[i] = by;
    return displacement;
  }
};

TEST(LeftOut, MastersFarBehindOthersOfAPatchAreLeftOut) {
  const Step step;
  Registry registry;
  ContactGeometry geometry(step.skins.mesh, step.skins.model, step.skins.contact, registry);
  const auto expect = [&](double share_of_the_step, double gap) {
    int there = 0;
    for (const ContactGeometry::Zone& zone : geometry.zones())
      for (const std::int32_t slave : zone.slaves) {
        const auto patch = static_cast<std::size_t>(step.skins.contact.slaves[static_cast<std::size_t>(slave)].patch);
        double least = INFINITY, most = -INFINITY;
        for (const std::int32_t node : step.skins.mesh.cells[step.skins.contact.slaves[static_cast<std::size_t>(slave)].cell]) {
          least = std::min(least, step.skins.mesh.coordinates[3 * static_cast<std::size_t>(node)]);
          most = std::max(most, step.skins.mesh.coordinates[3 * static_cast<std::size_t>(node)]);
        }
        if (!(least < 0.6 && most > 0.6) || step.skins.mesh.cells[step.skins.contact.slaves[patch].cell].size() != 4) continue;
        EXPECT_NEAR(geometry.coverage(patch), share_of_the_step, 1e-12);
        EXPECT_NEAR(geometry.gap(patch), gap, 1e-12);
        ++there;
      }
    EXPECT_EQ(there, 2);
  };
  geometry.rest_at(step.skins.displacement);
  geometry.update(step.skins.displacement);
  expect(1, 0.4 * 0.1 + 0.6 * 0.6);
  EXPECT_TRUE(geometry.choose_masters());
  expect(0.4, 0.1);
  EXPECT_FALSE(geometry.choose_masters());
  const std::vector<std::int32_t> out = geometry.kept().left_out;
  EXPECT_EQ(out.size() % 2, 0U);
  EXPECT_GE(out.size(), 8U);  // squares and triangles over the edge
  for (std::size_t i = 1; i < out.size(); i += 2) EXPECT_EQ(out[i], step.floor_cell);
  // patches over the floor alone see it
  EXPECT_NEAR(geometry.gap(geometry.n_patches() - 1), 0.6, 1e-12);

  // it stays out on the way, and as long as it lies 0.45 of the patch behind
  for (const double raised : {0.387, 0.388}) {
    geometry.update(step.floor_raised(raised));
    expect(0.4, 0.1);
    EXPECT_EQ(geometry.choose_masters(), raised > 0.5 - 0.45 * 0.25) << raised;
    geometry.rest_at(step.skins.displacement);  // an instant that begins again begins as before
    EXPECT_EQ(geometry.kept().left_out, out);
  }
  ContactGeometry taken_up(step.skins.mesh, step.skins.model, step.skins.contact, registry);
  taken_up.keep({.left_out = out, .in_front = {}, .flush = {}});
  taken_up.update(step.skins.displacement);
  geometry.update(step.skins.displacement);
  for (std::size_t p = 0; p < geometry.n_patches(); ++p) EXPECT_EQ(taken_up.gap(p), geometry.gap(p));
}

TEST(LeftOut, WhatIsHiddenByAFarMasterIsFarAsWell) {
  Step step;
  const std::int32_t lower = step.skins.add(1, true, -1.2)[0];
  step.skins.contact.zones[0].master.push_back(lower);
  step.skins.model.element.push_back(0);
  step.skins.displacement.assign(step.skins.mesh.coordinates.size(), 0.0);
  Registry registry;
  ContactGeometry geometry(step.skins.mesh, step.skins.model, step.skins.contact, registry);
  geometry.update(step.skins.displacement);
  EXPECT_TRUE(geometry.choose_masters());
  const std::vector<std::int32_t> out = geometry.kept().left_out;
  EXPECT_EQ(std::count(out.begin(), out.end(), lower), std::count(out.begin(), out.end(), step.floor_cell));
  for (std::size_t p = 0; p < geometry.n_patches(); ++p)
    EXPECT_TRUE(std::abs(geometry.gap(p) - 0.1) < 1e-12 || std::abs(geometry.gap(p) - 0.6) < 1e-12) << p;
}

/// A step that goes down over `reach`.
struct Slope : Step {
  std::int32_t cell;

  explicit Slope(double reach) {
    std::vector<std::int32_t> edge;  // of the upper level, and of the floor
    for (const double z : {-0.1, -0.6})
      for (const double y : {0.0, 1.0}) {
        edge.push_back(static_cast<std::int32_t>(skins.mesh.n_nodes()));
        skins.mesh.coordinates.insert(skins.mesh.coordinates.end(), {z == -0.1 ? 0.6 : 0.6 + reach, y, z});
      }
    cell = static_cast<std::int32_t>(skins.mesh.types.size());
    skins.mesh.types.push_back(CellType::QUAD4);
    skins.mesh.cells.push_back(std::vector<std::int32_t>{edge[0], edge[2], edge[3], edge[1]});
    skins.model.element.push_back(0);
    skins.contact.zones[0].master.push_back(cell);
    skins.displacement.assign(skins.mesh.coordinates.size(), 0.0);
  }
};

constexpr double leaning_by_10_degrees = 0.5 * 0.1763;

TEST(LeftOut, SlopesAreNotFarBehindAndWallsAreLeftOutWithoutTheirNames) {
  for (const double reach : {0.5, leaning_by_10_degrees}) {
    Slope slope(reach);
    Registry registry;
    ContactGeometry geometry(slope.skins.mesh, slope.skins.model, slope.skins.contact, registry);
    geometry.update(slope.skins.displacement);
    EXPECT_EQ(geometry.choose_masters(), reach < 0.5);
    const std::vector<std::int32_t> out = geometry.kept().left_out;
    EXPECT_EQ(std::count(out.begin(), out.end(), slope.cell), 0) << reach;
    EXPECT_EQ(out.empty(), reach == 0.5) << reach;
    EXPECT_EQ(geometry.rejected()[static_cast<std::size_t>(Rejection::wall)] > 0, reach < 0.5) << reach;
  }
}

TEST(LeftOut, WallsBesideAMasterInFrontAreLeftOut) {
  // those that see the step and the wall see the step alone; one that sees the wall and nothing in front of it sees the wall
  for (const bool step : {true, false}) {
    Slope slope(leaning_by_10_degrees);
    std::vector<std::int32_t>& masters = slope.skins.contact.zones[0].master;
    std::erase_if(masters, [&](std::int32_t cell) { return cell == slope.floor_cell || (!step && cell != slope.cell); });
    Registry registry;
    ContactGeometry geometry(slope.skins.mesh, slope.skins.model, slope.skins.contact, registry);
    geometry.update(slope.skins.displacement);
    const std::vector<double> before = [&] {
      std::vector<double> gaps;
      for (std::size_t p = 0; p < geometry.n_patches(); ++p) gaps.push_back(geometry.gap(p));
      return gaps;
    }();
    EXPECT_EQ(geometry.choose_masters(), step);
    EXPECT_FALSE(geometry.choose_masters());
    int other = 0;
    for (std::size_t p = 0; p < geometry.n_patches(); ++p) {
      if (step && geometry.covered(p) > 0) {
        EXPECT_NEAR(geometry.gap(p), 0.1, 1e-12) << p;
      }
      other += std::abs(geometry.gap(p) - before[p]) > 1e-3 ? 1 : 0;
    }
    EXPECT_EQ(other > 0, step);
    if (!step) continue;

    // another computation goes on with it, and an instant that begins again
    const KeptPairing kept = geometry.kept();
    EXPECT_FALSE(kept.in_front.empty());
    ContactGeometry taken_up(slope.skins.mesh, slope.skins.model, slope.skins.contact, registry);
    taken_up.keep(kept);
    for (ContactGeometry* const one : {&geometry, &taken_up}) {
      one->rest_at(slope.skins.displacement);
      one->update(slope.skins.displacement);
    }
    for (std::size_t p = 0; p < geometry.n_patches(); ++p) EXPECT_EQ(taken_up.gap(p), geometry.gap(p));
    EXPECT_FALSE(taken_up.choose_masters());
  }
}

TEST(LeftOut, WallsAreDecidedAnewWhereTheyHaveTurned) {
  Slope slope(leaning_by_10_degrees);
  std::erase(slope.skins.contact.zones[0].master, slope.floor_cell);
  Registry registry;
  ContactGeometry geometry(slope.skins.mesh, slope.skins.model, slope.skins.contact, registry),
      taken_up(slope.skins.mesh, slope.skins.model, slope.skins.contact, registry);
  const auto walls = [&] { return geometry.rejected()[static_cast<std::size_t>(Rejection::wall)]; };
  const auto foot_moved = [&](double by) {
    std::vector<double> displacement = slope.skins.displacement;
    for (const std::int32_t node : slope.skins.mesh.cells[slope.cell])
      if (slope.skins.mesh.coordinates[3 * static_cast<std::size_t>(node) + 2] == -0.6)
        displacement[3 * static_cast<std::size_t>(node)] = by;
    return displacement;
  };
  geometry.update(slope.skins.displacement);
  EXPECT_TRUE(geometry.choose_masters());
  EXPECT_GT(walls(), 0);
  // 0.5 down over 0.33 is 56.6 degrees, a cosine of 0.55; over 0.5, 45 degrees
  for (const auto& [reach, turned] : {std::pair(0.33, false), std::pair(0.5, true)}) {
    geometry.update(foot_moved(reach - leaning_by_10_degrees));
    EXPECT_GT(walls(), 0);
    EXPECT_EQ(geometry.choose_masters(), turned) << reach;
    EXPECT_EQ(walls() > 0, !turned) << reach;
    EXPECT_EQ(geometry.walls_decided_at().empty(), !turned) << reach;
  }
  // another process goes on with it, and the next instant begins with what is at rest
  taken_up.keep(geometry.kept());
  taken_up.decide_walls(geometry.walls_decided_at());
  taken_up.update(foot_moved(0.5 - leaning_by_10_degrees));
  for (std::size_t p = 0; p < geometry.n_patches(); ++p) EXPECT_EQ(taken_up.gap(p), geometry.gap(p));
  geometry.rest_at(slope.skins.displacement);
  EXPECT_TRUE(geometry.walls_decided_at().empty());
}

TEST(LeftOut, FrozenGapsAreAveragesOverAllMasters) {
  Step step;
  step.skins.contact.frozen_gap = true;
  Registry registry;
  ContactGeometry geometry(step.skins.mesh, step.skins.model, step.skins.contact, registry);
  geometry.update(step.skins.displacement);
  EXPECT_FALSE(geometry.choose_masters());
}

}  // namespace
}  // namespace lacon
