// Bodies that go through each other in one step, where pairing sees nothing of them any more.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/operators/contact/facing.hpp"

namespace lacon {
namespace {

constexpr double length = 0.1;

/// One slave cell, a segment or a square of this length that looks down, at the origin, over master cells. Its body is as thick
/// as one likes.
struct Scene {
  Mesh mesh;
  Model model;
  Contact contact;
  Registry registry;

  explicit Scene(int dimension) {
    mesh.dimension = dimension;
    mesh.patches.emplace().kind.push_back(0);
    model.elements = {dimension == 2 ? "D_PLAN/SEG2" : "3D/QUAD4"};
    contact.slaves.push_back({0, 0, 0, ""});
    contact.zones.push_back({.jacobian = "ACTUALISE"});
    ContactZone& zone = contact.zones.front();
    zone.patches = {0};
    zone.slave = {0};
    const double half = length / 2;
    add(dimension == 2 ? std::vector<Vec3>{{-half, 0, 0}, {half, 0, 0}}
                       : std::vector<Vec3>{{-half, 0, -half}, {half, 0, -half}, {half, 0, half}, {-half, 0, half}},
        false);
  }
  /// A cell that looks up or down.
  void add(std::vector<Vec3> corners, bool up) {
    std::vector<std::int32_t> nodes;
    for (const Vec3& corner : corners) {
      nodes.push_back(static_cast<std::int32_t>(mesh.n_nodes()));
      mesh.coordinates.insert(mesh.coordinates.end(), {corner.x, corner.y, corner.z});
    }
    const auto cell = static_cast<std::int32_t>(mesh.types.size());
    mesh.types.push_back(mesh.dimension == 2 ? CellType::SEG2 : CellType::QUAD4);
    model.element.push_back(0);
    mesh.cells.push_back(nodes);
    if ((facing(mesh, cell, mesh.coordinates).normal.y > 0) != up) {
      Mesh turned = mesh;
      std::reverse(nodes.begin(), nodes.end());
      turned.cells = {};
      for (std::int32_t other = 0; other < cell; ++other)
        turned.cells.push_back(std::vector<std::int32_t>(mesh.cells[other].begin(), mesh.cells[other].end()));
      turned.cells.push_back(nodes);
      mesh = std::move(turned);
    }
    if (cell > 0) contact.zones.front().master.push_back(cell);
  }
  /// A master from x = a to x = b; in space as wide as the model.
  void add_master(Vec3 a, Vec3 b, bool up = true) {
    if (mesh.dimension == 2) return add({a, b}, up);
    const Vec3 across{0, 0, 1};
    add({a - across, b - across, b + across, a + across}, up);
  }
  /// @return of gone_through(), 0 for nothing, after a step from `start` to `end`, which say where a point is then
  double sizes(const std::function<Vec3(Vec3, bool is_slave)>& start, const std::function<Vec3(Vec3, bool is_slave)>& end) {
    ContactGeometry geometry(mesh, model, contact, registry);
    const auto moved = [&](const auto& place) {
      std::vector<double> displacement;
      for (std::size_t node = 0; node < mesh.n_nodes(); ++node) {
        const Vec3 at = vector_at(&mesh.coordinates[3 * node]), step = place(at, node < (mesh.dimension == 2 ? 2 : 4)) - at;
        for (int d = 0; d < mesh.dimension; ++d) displacement.push_back(component(step, d));
      }
      return displacement;
    };
    geometry.rest_at(moved(start));
    geometry.update(moved(end));
    const auto found = geometry.gone_through(0);
    if (!found) return 0;
    EXPECT_EQ(found->cell, 0);
    return found->sizes * geometry.sizes()[0] / length;
  }
  double sizes(Vec3 step) {
    return sizes([](Vec3 at, bool) { return at; }, [&](Vec3 at, bool is_slave) { return is_slave ? at + step : at; });
  }
};

class Crossings : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(InPlaneAndSpace, Crossings, testing::Values(2, 3));

TEST_P(Crossings, OfAFloor) {
  Scene scene(GetParam());
  for (const double x : {-1.0, -0.5, 0.0, 0.5}) scene.add_master({x, -0.2, 0}, {x + 0.5, -0.2, 0});  // 0 lies over an edge
  EXPECT_EQ(scene.sizes({0, -0.15, 0}), 0);
  EXPECT_EQ(scene.sizes({0, -0.25, 0}), 0);  // what coarse cells overlap by
  EXPECT_NEAR(scene.sizes({0, -1.7, 0}), 15, 1e-9);
  EXPECT_NEAR(scene.sizes({0.37, -1.7, 0}), 15, 1e-9);
  EXPECT_EQ(scene.sizes({20, -1.7, 0}), 0);            // it passes beyond the end
  EXPECT_NEAR(scene.sizes({1.2, -1.7, 0}), 15, 1e-9);  // it passes the floor, and ends beside it
  EXPECT_EQ(scene.sizes({5, 0, 0}), 0);
}

TEST_P(Crossings, OfATouchedFloor) {
  Scene scene(GetParam());
  scene.add_master({-1, 1e-9, 0}, {1, 1e-9, 0});
  EXPECT_NEAR(scene.sizes({0, -2.5, 0}), 25, 1e-6);
  EXPECT_EQ(scene.sizes({0.3, 0, 0}), 0);
}

TEST_P(Crossings, OfAPlateThatIsThinnerThanTheWay) {
  Scene scene(GetParam());
  scene.add_master({-1, -0.2, 0}, {1, -0.2, 0});
  scene.add_master({-1, -0.22, 0}, {1, -0.22, 0}, false);
  EXPECT_NEAR(scene.sizes({0, -2.7, 0}), 25, 1e-9);
  EXPECT_EQ(scene.sizes({0, -0.15, 0}), 0);
}

// Where bodies slide at the same height, off corners and over edges, round-off decides what their middles pass.
TEST_P(Crossings, SlidingOverABlockIsNone) {
  for (const double height : {0.0, 1e-9, -1e-9, -1e-3}) {
    for (const double from : {-3.0, 0.0, 3.0}) {
      Scene scene(GetParam());
      const double top = -height;
      scene.add_master({-1, top, 0}, {1, top, 0});
      scene.add_master({-1, top, 0}, {-1.1, top - 5, 0}, true);  // its side walls
      scene.add_master({1, top, 0}, {0.9, top - 5, 0}, false);
      const auto start = [&](Vec3 at, bool is_slave) { return is_slave ? at + Vec3{from, 0, 0} : at; };
      for (const Vec3 to : {Vec3{-3, 0, 0}, Vec3{0, 0, 0}, Vec3{3, 0, 0}, Vec3{4, from < 0 ? 0.0 : -2.0, 0}})
        EXPECT_EQ(scene.sizes(start, [&](Vec3 at, bool is_slave) { return is_slave ? at + to : at; }), 0)
            << from << ' ' << to.x;
    }
  }
}

TEST_P(Crossings, AThinSheetThatIsCarriedAlongIsNone) {
  for (const double height : {0.0, 1e-9, -1e-9}) {
    Scene scene(GetParam());
    scene.add_master({-1, -height, 0}, {1, -height, 0});
    scene.add_master({-1, -0.002, 0}, {1, -0.002, 0}, false);
    const auto stays = [](Vec3 at, bool) { return at; };
    EXPECT_EQ(scene.sizes(stays, [](Vec3 at, bool) { return at + Vec3{7, 3, 0}; }), 0);
    EXPECT_EQ(scene.sizes({0.8, 0, 0}), 0);
  }
}

TEST_P(Crossings, AWayOverAHillIsNone) {
  Scene scene(GetParam());
  scene.add_master({-0.1, -0.05, 0}, {0.9, 0.45, 0});
  scene.add_master({0.9, 0.45, 0}, {1.9, -0.05, 0});
  EXPECT_EQ(scene.sizes({1.8, 0, 0}), 0);  // from the one slope to the other, to round-off
  EXPECT_EQ(scene.sizes({1.85, 0, 0}), 0);
}

TEST_P(Crossings, MotionsOfBothAreNone) {
  Scene scene(GetParam());
  scene.add_master({-1, -0.02, 0}, {1, -0.02, 0});
  const auto stays = [](Vec3 at, bool) { return at; };
  const auto turned = [](Vec3 at, bool) { return Vec3{3 - at.y, at.x - 7, at.z}; };
  EXPECT_EQ(scene.sizes(stays, turned), 0);
  EXPECT_EQ(scene.sizes(stays, [](Vec3 at, bool) { return Vec3{at.x, at.y - 5, at.z}; }), 0);
  EXPECT_NEAR(scene.sizes(stays,
                          [](Vec3 at, bool is_slave) {
                            return Vec3{at.x, at.y + (is_slave ? 0 : 2.52), at.z};
                          }),
              25, 1e-9);
}

}  // namespace
}  // namespace lacon
