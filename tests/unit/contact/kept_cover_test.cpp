// Patches whose cover keeps its place in the derivatives of their gap: what the end of a master then does, and what not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "lacon/operators/contact/contact_geometry.hpp"

namespace lacon {
namespace {

/// A slave cell over flat masters that are inclined to it, each a patch of its own.
struct KeptScene {
  Mesh mesh;
  Model model;
  Contact contact;
  std::vector<std::int32_t> master_nodes;

  void slave(CellType type, const std::vector<std::int32_t>& nodes, std::int32_t kind) {
    ContactZone& zone = contact.zones.emplace_back();
    zone.jacobian = "ACTUALISE";
    zone.slave = {0};
    zone.patches = {0};
    mesh.add_cell(type, nodes);
    Patches& patches = mesh.patches.emplace();
    patches.kind = {kind};
    patches.cells.push_back(std::vector<std::int32_t>{0});
    contact.slaves.push_back({0, 0, 0, ""});
  }
  void master(CellType type, const std::vector<std::int32_t>& nodes) {
    contact.zones[0].master.push_back(static_cast<std::int32_t>(mesh.n_cells()));
    mesh.add_cell(type, nodes);
  }
  std::int32_t node(double x, double y, double z) {
    mesh.coordinates.insert(mesh.coordinates.end(), {x, y, z});
    return static_cast<std::int32_t>(mesh.n_nodes()) - 1;
  }
};

/// In the plane: a bent slave that looks down, from x = 0 to 1, over masters from -0.2 to `end`, the last one as steep as
/// asked.
KeptScene in_plane(double end, double slope = 0.2) {
  KeptScene scene;
  scene.mesh.dimension = 2;
  const auto a = scene.node(1, 0.1, 0), b = scene.node(0, 0.1, 0), c = scene.node(0.5, 0.13, 0);
  scene.slave(CellType::SEG3, {b, a, c}, 14);
  std::int32_t last = -1;
  for (const double x : {-0.2, 0.3, end}) {
    const auto next = scene.node(x, 0.05 + 0.2 * std::min(x, 0.3) + slope * std::max(x - 0.3, 0.0), 0);
    if (last >= 0) scene.master(CellType::SEG2, {next, last});
    last = next;
  }
  scene.master_nodes = {last};
  scene.model.dimension = 2;
  scene.model.elements = {"D_PLAN/SEG2", "D_PLAN/SEG3"};
  for (const CellType type : scene.mesh.types) scene.model.element.push_back(type == CellType::SEG2 ? 0 : 1);
  return scene;
}

/// In space: a warped slave that looks down, over two masters side by side, flat but for `warp`, from x = -0.2 to `end`.
KeptScene in_space(double end, bool quadratic, double warp = 0) {
  KeptScene scene;
  scene.mesh.dimension = 3;
  const auto a = scene.node(0, 0, 0.1), b = scene.node(0, 1, 0.1), c = scene.node(1, 1, 0.14), d = scene.node(1, 0, 0.1);
  scene.slave(CellType::QUAD4, {a, b, c, d}, 0);
  const auto at = [&](double x, double y) { return scene.node(x, y, 0.02 + 0.15 * x + 0.05 * y + warp * x * y); };
  std::vector<std::int32_t> low, high, middle;
  for (const double y : {-0.2, 0.45, 1.2}) low.push_back(at(-0.2, y)), high.push_back(at(end, y));
  if (quadratic) {
    for (const double y : {-0.2, 0.45, 1.2}) middle.push_back(at((end - 0.2) / 2, y));
    for (const double y : {(-0.2 + 0.45) / 2, (0.45 + 1.2) / 2}) low.push_back(at(-0.2, y)), high.push_back(at(end, y));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<std::int32_t> nodes = {low[i], high[i], high[i + 1], low[i + 1]};
    if (quadratic) nodes.insert(nodes.end(), {middle[i], high[3 + i], middle[i + 1], low[3 + i]});
    scene.master(quadratic ? CellType::QUAD8 : CellType::QUAD4, nodes);
  }
  scene.master_nodes = high;
  scene.model.dimension = 3;
  scene.model.elements = {"3D/QUAD4", "3D/QUAD8"};
  for (const CellType type : scene.mesh.types) scene.model.element.push_back(type == CellType::QUAD4 ? 0 : 1);
  return scene;
}

/// Derivatives of the gap of the patch.
struct Derivatives {
  double gap = 0;
  std::vector<double> gradient, hessian;
  /// What they leave out of their own derivatives, because ends are still: (n), (n, n).
  std::vector<double> of_gap, of_gradient;
};

Derivatives derivatives(const KeptScene& scene, bool kept, bool sees_walls = true) {
  const auto d = static_cast<std::size_t>(scene.mesh.dimension), n = d * scene.mesh.n_nodes();
  Registry registry;
  ContactGeometry geometry(scene.mesh, scene.model, scene.contact, registry);
  geometry.find_ends({});
  geometry.update(std::vector<double>(n));
  if (!sees_walls) geometry.choose_masters();
  Derivatives sum{0, std::vector<double>(n), std::vector<double>(n * n), std::vector<double>(n), std::vector<double>(n * n)};
  for (const auto& of : geometry.vary(std::vector<std::int8_t>{2}, {kept})) {
    const auto at = [&](std::size_t i) { return d * static_cast<std::size_t>(of.nodes[i / d]) + i % d; };
    const std::size_t m = of.of_gap.gradient.size();
    sum.gap += of.of_gap.gap;
    for (std::size_t i = 0; i < m; ++i) {
      sum.gradient[at(i)] += of.of_gap.gradient[i];
      for (std::size_t j = 0; j < m; ++j) sum.hessian[at(i) * n + at(j)] += of.of_gap.hessian[i * m + j];
      for (const MovingEnd& end : of.of_gap.ends) {
        sum.of_gap[at(i)] += end.gap * end.place[i];
        for (std::size_t j = 0; j < m; ++j) sum.of_gradient[at(i) * n + at(j)] += end.gradient[i] * end.place[j];
      }
    }
  }
  return sum;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

/// Scenes whose master ends on the slave, or behind it.
std::vector<KeptScene> scenes(double end) { return {in_plane(end), in_space(end, false), in_space(end, true)}; }

// Where a flat master grows along itself no gap changes, and nothing but the cover does.
TEST(KeptCover, TheEndOfAMasterThatMovesAlongTheMasterDoesNoWork) {
  for (const KeptScene& scene : scenes(0.6)) {
    const auto d = static_cast<std::size_t>(scene.mesh.dimension);
    const auto work = [&](bool kept) {
      const Derivatives of = derivatives(scene, kept);
      double sum = 0;
      for (const std::int32_t node : scene.master_nodes) {
        sum += of.gradient[d * static_cast<std::size_t>(node)];
        sum += of.gradient[d * static_cast<std::size_t>(node) + d - 1] * (d == 2 ? 0.2 : 0.15);
      }
      return sum / largest(of.gradient);
    };
    EXPECT_GT(std::abs(work(false)), 1e-3);
    EXPECT_NEAR(work(true), 0, 1e-13);
  }
}

// Rigid motions of all leave the gap as it is, wherever the cover ends: forces and moments balance, and turn with the bodies.
TEST(KeptCover, LeavesForcesBalanced) {
  for (const KeptScene& scene : scenes(0.6)) {
    const auto d = static_cast<std::size_t>(scene.mesh.dimension), n = d * scene.mesh.n_nodes();
    const Derivatives of = derivatives(scene, true);
    const double scale = largest(of.gradient), second = largest(of.hessian);
    EXPECT_GT(scale, 1e-3);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(of.hessian[i * n + j], of.hessian[j * n + i], 1e-12 * second);
    for (std::size_t k = 0; k < d; ++k) {
      double sum = 0;
      for (std::size_t i = k; i < n; i += d) sum += of.gradient[i];
      EXPECT_NEAR(sum, 0, 1e-13 * scale);
    }
    // turns in each pair of axes: a spin of the places, and the same of the forces
    for (std::size_t a = 0; a < d; ++a)
      for (std::size_t b = 0; b < a; ++b) {
        std::vector<double> turn(n), turned(n);
        for (std::size_t node = 0; node < scene.mesh.n_nodes(); ++node) {
          turn[d * node + a] = scene.mesh.coordinates[3 * node + b], turn[d * node + b] = -scene.mesh.coordinates[3 * node + a];
          turned[d * node + a] = of.gradient[d * node + b], turned[d * node + b] = -of.gradient[d * node + a];
        }
        double moment = 0;
        for (std::size_t i = 0; i < n; ++i) {
          moment += turn[i] * of.gradient[i];
          double row = 0;
          for (std::size_t j = 0; j < n; ++j) row += of.hessian[i * n + j] * turn[j];
          EXPECT_NEAR(row, turned[i], 1e-11 * second) << i;
        }
        EXPECT_NEAR(moment, 0, 1e-12 * scale);
      }
  }
}

TEST(KeptCover, IsNothingElseWhereTheMasterCoversTheWholePatch) {
  for (const KeptScene& scene : scenes(1.3)) {
    const Derivatives moves = derivatives(scene, false), kept = derivatives(scene, true);
    EXPECT_EQ(moves.gap, kept.gap);
    EXPECT_EQ(moves.gradient, kept.gradient);
    EXPECT_EQ(moves.hessian, kept.hessian);
  }
}

// The gap itself, and what it does by normals that turn and images that move, do not hang on it: moved along the slave's
// normal alone the end of the master stays where it is on a straight slave.
TEST(KeptCover, ChangesNoGapAndNoForceAlongTheNormal) {
  KeptScene scene = in_plane(0.6);
  scene.mesh.coordinates[3 * 2 + 1] = 0.1;  // its middle node
  const Derivatives moves = derivatives(scene, false), kept = derivatives(scene, true);
  EXPECT_EQ(moves.gap, kept.gap);
  for (std::size_t node = 3; node < scene.mesh.n_nodes(); ++node)
    EXPECT_NEAR(moves.gradient[2 * node + 1], kept.gradient[2 * node + 1], 1e-14);
  const auto end = 2 * static_cast<std::size_t>(scene.master_nodes[0]);
  EXPECT_GT(std::abs(moves.gradient[end] - kept.gradient[end]), 1e-3);
}

// Gaps and forces of a kept cover against their differences: what the symmetric part lacks is what the ends that move add.
void expect_differences(KeptScene& scene) {
  const auto d = static_cast<std::size_t>(scene.mesh.dimension), n = d * scene.mesh.n_nodes();
  const Derivatives of = derivatives(scene, true);
  double lacking = 0;
  for (std::size_t j = 0; j < n; ++j) {
    constexpr double step = 1e-6;
    double& place = scene.mesh.coordinates[3 * (j / d) + j % d];
    const double middle = place;
    place = middle + step;
    const Derivatives after = derivatives(scene, true);
    place = middle - step;
    const Derivatives before = derivatives(scene, true);
    place = middle;
    EXPECT_NEAR((after.gap - before.gap) / (2 * step), of.gradient[j] + of.of_gap[j], 1e-7 * largest(of.gradient)) << j;
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR((after.gradient[i] - before.gradient[i]) / (2 * step), of.hessian[i * n + j] + of.of_gradient[i * n + j],
                  1e-7 * largest(of.hessian))
          << i << ' ' << j;
      lacking = std::max(lacking, std::abs(of.of_gradient[i * n + j] - of.of_gradient[j * n + i]));
    }
  }
  EXPECT_GT(lacking, 1e-2 * largest(of.hessian));  // it is not symmetric
  EXPECT_GT(largest(of.of_gap), 1e-3 * largest(of.gradient));
}

TEST(KeptCover, IsDifferentiatedWhollyByItsEndsAsWell) {
  for (const bool smoothing : {false, true}) {
    SCOPED_TRACE(smoothing ? "nodal normals" : "normals of cells");
    for (const double slope : {0.2, 3.0, 30.0}) {  // the steepest has a share that turns with it
      SCOPED_TRACE(slope);
      KeptScene scene = in_plane(slope > 1 ? 0.32 : 0.6, slope);
      scene.contact.smoothing = smoothing;
      expect_differences(scene);
    }
    for (const bool quadratic : {false, true}) {
      SCOPED_TRACE(quadratic ? "QUAD8" : "QUAD4");
      // warped: differences would go from the rule of flat masters to that of others
      KeptScene scene = in_space(0.6, quadratic, quadratic ? 0 : 0.01);
      scene.contact.smoothing = smoothing;
      expect_differences(scene);
    }
  }
}

// Where the skin of the master goes on as a wall, which the patch does not see, the master ends for it.
TEST(KeptCover, EndsWhereAWallBegins) {
  for (const bool quadratic : {false, true}) {
    const Derivatives alone = derivatives(in_space(0.6, quadratic), true);
    KeptScene scene = in_space(0.6, quadratic);
    std::vector<std::int32_t> foot;
    for (const double y : {-0.2, 0.45, 1.2}) foot.push_back(scene.node(0.7, y, -0.5));
    for (std::size_t i = 0; i < 2; ++i) {
      scene.master(CellType::QUAD4, {scene.master_nodes[i], foot[i], foot[i + 1], scene.master_nodes[i + 1]});
      scene.model.element.push_back(0);
    }
    const Derivatives beside = derivatives(scene, true, false);
    EXPECT_NEAR(beside.gap, alone.gap, 1e-15);
    for (std::size_t i = 0; i < beside.gradient.size(); ++i)
      EXPECT_NEAR(beside.gradient[i], i < alone.gradient.size() ? alone.gradient[i] : 0, 1e-14 * largest(alone.gradient)) << i;
  }
}

/// Two cells of a wall, at 85.6 and 89.2 degrees, the node between them below x = 1, where the slave ends.
KeptScene beside_a_wall(double between) {
  KeptScene scene;
  scene.mesh.dimension = 2;
  const auto a = scene.node(1, 0.1, 0), b = scene.node(0, 0.1, 0);
  scene.slave(CellType::SEG2, {b, a}, 13);
  std::int32_t last = -1;
  for (const auto& [x, y] : {std::pair(-0.2, 0.05), std::pair(0.95, 0.05), std::pair(between, -0.6), std::pair(1.02, -2.0)}) {
    const auto next = scene.node(x, y, 0);
    if (last >= 0) scene.master(CellType::SEG2, {next, last});
    last = next;
  }
  scene.model.dimension = 2;
  scene.model.elements = {"D_PLAN/SEG2"};
  scene.model.element.assign(scene.mesh.n_cells(), 0);
  return scene;
}

// Cells of a wall count by shares that differ: where the node between them passes the end of a slave the derivative of the gap
// jumps by the difference of the shares, and the height there. Forces of a kept cover do not.
TEST(KeptCover, ForcesDoNotJumpWhereMastersOfOtherSharesPassAnEnd) {
  constexpr double near = 1e-7;
  const auto jump = [](bool kept) {
    const Derivatives a = derivatives(beside_a_wall(1 - near), kept), b = derivatives(beside_a_wall(1 + near), kept);
    double most = std::abs(a.gap - b.gap);
    for (std::size_t i = 0; i < a.gradient.size(); ++i) most = std::max(most, std::abs(a.gradient[i] - b.gradient[i]));
    return most;
  };
  EXPECT_GT(jump(false), 0.5);
  EXPECT_LT(jump(true), 200 * near);
}

}  // namespace
}  // namespace lacon
