// Planes of symmetry in which both skins of a zone end.
#include "lacon/operators/contact/mirrors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "../pairing/skins_in_space.hpp"

namespace lacon {
namespace {

/// Two skins over the unit square in one numbering of nodes, as those of a mesh.
struct TwoSkins {
  std::vector<double> coordinates;
  Surface slave, master;

  TwoSkins(CellType slave_type, CellType master_type, const test::Place3& place, bool curved,
           const test::Place3& place_of_master = {}) {
    std::mt19937 random(7);
    const auto flat = [](double x, double y) { return Vec3{x, y, 0}; };
    add(test::mesh({.nx = 2, .ny = 2, .type = slave_type, .up = false}, place, random, curved), slave);
    add(test::mesh({.nx = 3, .ny = 3, .type = master_type}, place_of_master ? place_of_master : flat, random,
                   place_of_master != nullptr),
        master);
    slave.coordinates = master.coordinates = coordinates;
  }
  std::size_t n_nodes() const { return coordinates.size() / 3; }

 private:
  void add(const test::Skin3& skin, Surface& surface) {
    const auto first = static_cast<std::int32_t>(n_nodes());
    coordinates.insert(coordinates.end(), skin.coordinates.begin(), skin.coordinates.end());
    surface.dimension = 3;
    for (std::size_t c = 0; c < skin.surface.size(); ++c) {
      std::vector<std::int32_t> nodes(skin.surface.nodes[c].begin(), skin.surface.nodes[c].end());
      for (std::int32_t& node : nodes) node += first;
      surface.add_cell(skin.surface.types[c], nodes);
    }
  }
};

/// All nodes, along the axes.
std::vector<HeldDirection> all_held(const TwoSkins& skins) {
  std::vector<HeldDirection> held;
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(skins.n_nodes()); ++node)
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) held.push_back({node, axis});
  return held;
}

/// The covered part of the slave's reference cells.
double cover(const TwoSkins& skins, bool traced) {
  const Pairing found = pair(skins.slave, skins.master, {.traced = traced});
  const double whole = catalog::cell(skins.slave.types[0]).family == Family::QUAD ? 4 : 0.5;
  return std::accumulate(found.cells.weight.begin(), found.cells.weight.end(), 0.0) /
         (whole * static_cast<double>(skins.slave.size()));
}

TEST(Mirrors, NormalsThatLeanOverAPlaneOfSymmetryMeetWhatLiesBehindIt) {
  const auto tilted = [](double x, double y) { return Vec3{x, y, 0.05 + 0.1 * x}; };
  // the slope is 0.1 at the end x = 1, and 0.04 at y = 0: normals lean out at both
  const auto bent = [](double x, double y) { return Vec3{x, y, 0.05 + 0.05 * x * x - 0.04 * (y - y * y)}; };
  for (const CellType of_slave : test::kinds)
    for (const CellType of_master : test::kinds)
      for (const bool curved : {false, true})
        for (const bool traced : {false, true}) {
          if (curved && catalog::cell(of_slave).order == 1) continue;
          TwoSkins skins(of_slave, of_master, curved ? test::Place3(bent) : test::Place3(tilted), curved);
          const auto what = [&] {
            return testing::Message() << catalog::cell(of_slave).name << ' ' << catalog::cell(of_master).name << curved
                                      << traced;
          };
          // the strip behind the end is as wide as the normal leans: a tenth of the gap there
          if (!curved) {
            EXPECT_NEAR(cover(skins, traced), 1 - 0.1 * 0.15 / (1 + 0.1 * 0.1), 1e-9) << what();
          }
          if (curved) {
            EXPECT_LT(cover(skins, traced), 1 - 0.005) << what();
          }
          const std::vector<EndPlane> planes = end_planes(skins.slave, skins.master, all_held(skins));
          EXPECT_EQ(planes.size(), 4U);
          const std::vector<std::uint8_t> mirrored = mirrored_edges(planes, skins.master, skins.coordinates);
          skins.master.mirrored = mirrored;
          EXPECT_NEAR(cover(skins, traced), 1, 1e-9) << what();
        }
}

/// Of two triangles that share a curved edge one alone may have a mirrored edge, and go on. Both have the same line between
/// them: nothing of the slave is left out, and nothing of one hides behind the other.
TEST(Mirrors, CurvedEdgesAreCutAtTheSamePlacesWhetherTheyGoOnOrNot) {
  const auto above = [](double x, double y) { return Vec3{x, y, 0.05}; };
  const auto bent = [](double x, double y) {  // within the square, and a little out of its plane
    const double bump = std::sin(3.1 * x) * std::sin(2.9 * y);
    return Vec3{x + 0.05 * x * (1 - x) * std::cos(4 * y), y + 0.05 * bump * y * (1 - y), 0.003 * bump};
  };
  for (const CellType of_master : {CellType::TRIA6, CellType::QUAD8, CellType::QUAD9})
    for (const bool traced : {false, true}) {
      TwoSkins skins(CellType::QUAD4, of_master, above, false, bent);
      const std::vector<std::uint8_t> mirrored =
          mirrored_edges(end_planes(skins.slave, skins.master, all_held(skins)), skins.master, skins.coordinates);
      EXPECT_GE(std::ranges::count_if(mirrored, [](std::uint8_t edges) { return edges != 0; }), 8);
      skins.master.mirrored = mirrored;
      const Pairing found = pair(skins.slave, skins.master, {.traced = traced});
      EXPECT_EQ(found.count(Rejection::hidden), 0) << catalog::cell(of_master).name << traced;
      EXPECT_NEAR(cover(skins, traced), 1, 1e-12) << catalog::cell(of_master).name << traced;
    }
}

TEST(Mirrors, EdgesAreThoseThatEndWhereTheSlaveDoes) {
  const auto flat = [](double x, double y) { return Vec3{x, y, 0.1}; };
  TwoSkins skins(CellType::QUAD4, CellType::QUAD8, flat, false);
  const auto n_mirrored = [](const std::vector<std::uint8_t>& mirrored) {
    return std::count_if(mirrored.begin(), mirrored.end(), [](std::uint8_t edges) { return edges != 0; });
  };
  const auto x_of = [&](std::size_t node) -> double& { return skins.coordinates[3 * node]; };
  const std::vector<HeldDirection> held = all_held(skins), free;
  const std::vector<EndPlane> planes = end_planes(skins.slave, skins.master, held);
  // free, the slave over the master is as near as one that bends away from it
  EXPECT_EQ(end_planes(skins.slave, skins.master, free).size(), 4U);
  TwoSkins one(
      CellType::QUAD4, CellType::QUAD8,
      [](double x, double y) {
        return Vec3{x, y, 0.1 * x};
      },
      false);
  const std::vector<EndPlane> free_ends = end_planes(one.slave, one.master, free);
  ASSERT_EQ(free_ends.size(), 4U);  // not where the master lies, z = 0
  for (const EndPlane& plane : free_ends) {
    const bool along = plane.normal.x < 0;  // both borders are the line x = 0
    EXPECT_EQ(plane.ends.size(), along ? 0U : 3U);
    EXPECT_EQ(plane.flush.size(), along ? 3U : 0U);
  }
  EXPECT_EQ(n_mirrored(mirrored_edges(free_ends, one.master, one.coordinates)), 7);
  const std::vector<double> flush = one.coordinates;
  for (const auto& [shift, expected] : {std::pair{0.0, 3}, {3.3e-4, 3}, {3.4e-4, 0}}) {  // a thousandth of a third
    one.coordinates = flush;
    for (std::size_t node = 0; node < 9; ++node) one.coordinates[3 * node] -= shift;
    EXPECT_EQ(n_mirrored(flush_edges(free_ends, one.master, one.coordinates)), expected) << shift;
  }
  ASSERT_EQ(planes.size(), 4U);
  EXPECT_EQ(planes[0].normal.x, -1);
  EXPECT_EQ(planes[0].ends.size(), 3U);
  EXPECT_EQ(n_mirrored(mirrored_edges(planes, skins.master, skins.coordinates)), 8);  // all but the middle one
  // cells of a third: their outline goes on by a sixteenth of that, half of which is allowed for
  const std::vector<double> before = skins.coordinates;
  for (const auto& [shift, expected] : {std::pair{0.01, 8}, {0.011, 6}}) {
    skins.coordinates = before;
    for (std::size_t node = 0; node < 9; ++node) x_of(node) += shift;  // of the slave
    EXPECT_EQ(n_mirrored(mirrored_edges(planes, skins.master, skins.coordinates)), expected) << shift;
  }
  EXPECT_EQ(end_planes(skins.slave, skins.master, held).size(), 2U);  // one that reaches further ends elsewhere
}

/// What ends in oblique planes goes on as what ends in those of the axes does, if the nodes are held in them.
TEST(Mirrors, PlanesMayBeOblique) {
  const auto turned = [](Vec3 x) {  // about (1, 2, 2) / 3 by 40 degrees
    const Vec3 axis = Vec3{1, 2, 2} / 3.0;
    const double c = std::cos(0.7), s = std::sin(0.7);
    return c * x + s * cross(axis, x) + (1 - c) * dot(axis, x) * axis;
  };
  for (const CellType kind : test::kinds) {
    TwoSkins skins(
        kind, CellType::QUAD8,
        [](double x, double y) {
          return Vec3{x, y, 0.05 + 0.1 * x};
        },
        false);
    std::vector<HeldDirection> held;  // on the sides x = 0, 1 of the square
    for (std::size_t node = 0; node < skins.n_nodes(); ++node) {
      double* const row = skins.coordinates.data() + 3 * node;
      if (row[0] == 0 || row[0] == 1) held.push_back({static_cast<std::int32_t>(node), turned({1, 0, 0})});
      const Vec3 there = turned(vector_at(row));
      row[0] = there.x, row[1] = there.y, row[2] = there.z;
    }
    EXPECT_TRUE(end_planes(skins.slave, skins.master, {}).empty());
    const std::vector<EndPlane> planes = end_planes(skins.slave, skins.master, held);
    ASSERT_EQ(planes.size(), 2U);
    const std::vector<std::uint8_t> mirrored = mirrored_edges(planes, skins.master, skins.coordinates);
    EXPECT_LT(cover(skins, true), 1 - 0.01);
    skins.master.mirrored = mirrored;
    EXPECT_NEAR(cover(skins, true), 1, 1e-9) << catalog::cell(kind).name;
  }
}

}  // namespace
}  // namespace lacon
