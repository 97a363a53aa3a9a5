// Pairing in the plane. A slave chain that runs along +x is the lower skin of a body above it; its masters run along -x below.
#include "lacon/pairing/pairing.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "lacon/pairing/normals.hpp"
#include "moved.hpp"
#include "skins.hpp"
#include "threads.hpp"

namespace lacon::test {
namespace {

/// Turn, scale and shift by the same map.
void move(Skin& skin, double angle, double scale, Point shift) {
  for (std::size_t i = 0; i < skin.coordinates.size(); i += 3) {
    const double x = skin.coordinates[i], y = skin.coordinates[i + 1];
    skin.coordinates[i] = scale * (std::cos(angle) * x - std::sin(angle) * y) + shift[0];
    skin.coordinates[i + 1] = scale * (std::sin(angle) * x + std::cos(angle) * y) + shift[1];
  }
}

double length(const Skin& skin) {
  double sum = 0;
  for (std::size_t c = 0; c < skin.surface.size(); ++c) {
    const auto nodes = skin.surface.nodes[c];
    sum += std::hypot(skin.coordinates[3 * nodes[1]] - skin.coordinates[3 * nodes[0]],
                      skin.coordinates[3 * nodes[1] + 1] - skin.coordinates[3 * nodes[0] + 1]);
  }
  return sum;
}

TEST(Pairing, TheBitsDoNotDependOnTheNumberOfThreads) {
  std::mt19937 random(4);
  Skin slave, master;
  const Path wave = [](double x) { return Point{x, 0.05 * std::sin(9 * x)}; };
  add_chain(slave, wave, scattered(0, 1, 300, random), Kind::mixed, &random);
  add_chain(master, line(-0.1), scattered(1.2, -0.2, 400, random), Kind::mixed, &random);
  const Pairing alone = pair(slave.view(), master.view());
  EXPECT_GT(alone.cells.size(), 500U);
  test::expect_same_in_threads(alone, [&] { return pair(slave.view(), master.view()); });
}

// Also where round-off has moved it into the slave.
TEST(Pairing, AnEndOfTheSlaveIsNoMastersNodeThoughOneLiesThere) {
  for (const double moved : {0.0, -1e-15, 1e-15})
    for (const int n_masters : {1, 2, 3, 4, 8, 12}) {
      Skin slave, master;
      add_chain(slave, line(0), uniform(0, 1, 4), Kind::linear);
      add_chain(master, line(-0.1), uniform(1 + moved, moved, n_masters), Kind::linear);
      const ContactCells cells = pair(slave.view(), master.view()).cells;
      EXPECT_GE(cells.size(), 4U);
      for (std::size_t v = 0; v < cells.vertex.size(); ++v) {
        const std::int32_t node = cells.vertex_node[v];
        ASSERT_EQ(node<0, std::abs(cells.vertex[v])> 1 - 1e-9) << n_masters << ' ' << moved;
        if (node < 0) continue;
        EXPECT_NEAR(place(slave, cells.slave[v / 2], cells.vertex[v]).x[0], master.coordinates[3 * node], 1e-14);
      }
    }
}

TEST(Pairing, CoversFlatSkinsWithoutGapOrOverlapForRandomMeshes) {
  // METHOD.md D.2: the couples' measure is the slave's; neighbours share their ends bit by bit; the gap of parallel lines is
  // exact
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const double gap = trial % 3 == 0 ? 0.3 : trial % 3 == 1 ? 0.0 : -0.05;  // apart, touching, overlapping
    Skin slave, master;
    add_chain(slave, line(0), scattered(0, 1, 1 + trial % 17, random), Kind::mixed, &random);
    add_chain(master, line(-gap), scattered(1.2, -0.2, 1 + trial % 23, random), Kind::mixed, &random);
    const double angle = 0.1 * trial, scale = std::pow(10, trial % 7 - 3);
    for (Skin* skin : {&slave, &master}) move(*skin, angle, scale, {3 * scale, -7 * scale});
    const Pairing found = pair(slave.view(), master.view());
    const double size = length(slave);
    EXPECT_NEAR(integral(slave, master, found.cells, [](auto, auto) { return 1; }), size, 1e-12 * size);
    EXPECT_NEAR(
        integral(slave, master, found.cells, [&](auto c, auto g) { return sample(slave, master, found.cells, c, g).gap; }),
        gap * scale * size, 1e-12 * scale * size);
    std::vector<double> end(slave.surface.size(), -1);
    for (std::size_t c = 0; c < found.cells.size(); ++c) {
      EXPECT_EQ(found.cells.vertex[2 * c], end[found.cells.slave[c]]);
      end[found.cells.slave[c]] = found.cells.vertex[2 * c + 1];
    }
    for (const double e : end) EXPECT_EQ(e, 1);
    EXPECT_EQ(found.count(Rejection::facing_away), 0);
    EXPECT_EQ(found.count(Rejection::no_image), 0);
  }
}

TEST(Pairing, IntegratesMasterShapeFunctionsExactlyOnStraightSkins) {
  // What a patch test needs: the nodal forces of a uniform pressure on the master, through points on the slave. Every pair of
  // kinds.
  std::mt19937 random(4);
  for (const Kind slave_kind : {Kind::linear, Kind::quadratic})
    for (const Kind master_kind : {Kind::linear, Kind::quadratic}) {
      Skin slave, master;
      add_chain(slave, line(0), scattered(-0.5, 1.5, 7, random), slave_kind);
      add_chain(master, line(-0.1), scattered(1, 0, 9, random), master_kind);
      const Pairing found = pair(slave.view(), master.view());
      std::vector<double> force(master.coordinates.size() / 3, 0.0), expected(force);
      for (std::size_t c = 0; c < found.cells.size(); ++c)
        for (std::int64_t g = found.cells.offset[c]; g < found.cells.offset[c + 1]; ++g) {
          const std::int32_t m = found.cells.master[c];
          const std::vector<double> phi = shape(master.surface.types[m], found.cells.master_point[g]);
          for (std::size_t i = 0; i < phi.size(); ++i)
            force[master.surface.nodes[m][i]] +=
                found.cells.weight[g] * sample(slave, master, found.cells, c, g).jacobian * phi[i];
        }
      for (std::size_t m = 0; m < master.surface.size(); ++m) {
        const auto nodes = master.surface.nodes[m];
        const double size = std::abs(master.coordinates[3 * nodes[1]] - master.coordinates[3 * nodes[0]]);
        const bool linear = nodes.size() == 2;
        for (std::size_t i = 0; i < nodes.size(); ++i) expected[nodes[i]] += size * (linear ? 0.5 : i < 2 ? 1.0 / 6 : 2.0 / 3);
      }
      for (std::size_t i = 0; i < force.size(); ++i) EXPECT_NEAR(force[i], expected[i], 1e-14);
    }
}

TEST(Pairing, IntegratesMasterShapeFunctionsWhereMidNodesAreOffTheMiddle) {
  // The same with mid nodes anywhere on their straight cells. There J = h (1 + d s) / 2, and the integrals are exact by
  // Simpson.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> by(-0.15, 0.15);  // of the cell
  for (const Kind slave_kind : {Kind::linear, Kind::quadratic}) {
    Skin slave, master;
    add_chain(slave, line(0), scattered(-0.5, 1.5, 7, random), slave_kind);
    add_chain(master, line(-0.1), scattered(1, 0, 9, random), Kind::quadratic);
    for (Skin* skin : {&slave, &master})
      for (std::size_t c = 0; c < skin->surface.size(); ++c) {
        const auto nodes = skin->surface.nodes[c];
        if (nodes.size() == 3)
          skin->coordinates[3 * nodes[2]] += by(random) * (skin->coordinates[3 * nodes[1]] - skin->coordinates[3 * nodes[0]]);
      }
    const Pairing found = pair(slave.view(), master.view());
    std::vector<double> force(master.coordinates.size() / 3, 0.0), expected(force);
    for (std::size_t c = 0; c < found.cells.size(); ++c)
      for (std::int64_t g = found.cells.offset[c]; g < found.cells.offset[c + 1]; ++g) {
        const std::int32_t m = found.cells.master[c];
        const std::vector<double> phi = shape(CellType::SEG3, found.cells.master_point[g]);
        for (std::size_t i = 0; i < phi.size(); ++i)
          force[master.surface.nodes[m][i]] +=
              found.cells.weight[g] * sample(slave, master, found.cells, c, g).jacobian * phi[i];
      }
    for (std::size_t m = 0; m < master.surface.size(); ++m) {
      const auto nodes = master.surface.nodes[m];
      const auto x = [&](int i) { return master.coordinates[3 * nodes[i]]; };
      const auto jacobian = [&](double s) { return std::abs(0.5 * (x(1) - x(0)) + s * (x(0) + x(1) - 2 * x(2))); };
      expected[nodes[0]] += jacobian(-1) / 3;
      expected[nodes[1]] += jacobian(1) / 3;
      expected[nodes[2]] += 4 * jacobian(0) / 3;
    }
    for (std::size_t i = 0; i < force.size(); ++i) EXPECT_NEAR(force[i], expected[i], 1e-12);
  }
}

/// Curved, broken, folded chains on both sides, some pieces with their back turned.
void scatter_pieces(Skin& slave, Skin& master, std::mt19937& random, bool smooth) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto wavy = [&](double y) {
    const double amplitude = 0.3 * unit(random), frequency = 6 * unit(random), phase = 6 * unit(random);
    return [=](double x) {
      return Point{x + 0.1 * std::sin(3 * frequency * x), y + amplitude * std::sin(frequency * x + phase)};
    };
  };
  add_chain(slave, wavy(0), scattered(0, 2, 12, random), Kind::mixed, &random);
  add_chain(slave, wavy(0.5), scattered(2.5, 3.5, 5, random), Kind::mixed, &random);
  for (int piece = 0; piece < 5; ++piece) {
    const double from = 4 * unit(random) - 0.5, to = 4 * unit(random) - 0.5;
    if (std::abs(from - to) < 0.1) continue;
    add_chain(master, wavy(-unit(random)), scattered(from, to, 9, random), Kind::mixed, &random);
  }
  if (smooth) slave.normals = nodal_normals(slave.view());
}

TEST(Pairing, FindsWhatBruteForceFindsOnCurvedAndBrokenSurfaces) {
  std::mt19937 random(5);
  std::size_t cells = 0, hidden = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Skin slave, master;
    scatter_pieces(slave, master, random, trial % 2);
    PairingOptions brute_force;
    brute_force.brute_force = true;
    const Pairing found = pair(slave.view(), master.view()), oracle = pair(slave.view(), master.view(), brute_force);
    EXPECT_EQ(as_set(found.cells), as_set(oracle.cells));
    EXPECT_EQ(found.rejected, oracle.rejected);
    EXPECT_EQ(found.cells.slave, oracle.cells.slave);
    cells += found.cells.size();
    hidden += static_cast<std::size_t>(found.count(Rejection::hidden));
  }
  EXPECT_GT(cells, 3000u);
  EXPECT_GT(hidden, 100u);
}

TEST(Pairing, CoversNoPointTwiceAndPutsImagesOnTheNormal) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 300; ++trial) {
    Skin slave, master;
    scatter_pieces(slave, master, random, trial % 2);
    const Pairing found = pair(slave.view(), master.view());
    EXPECT_EQ(found.count(Rejection::no_image), 0);
    for (const double covered : coverage(slave, found.cells)) EXPECT_LE(covered, 1 + 1e-14);
    double end = -1;
    for (std::size_t c = 0; c < found.cells.size(); ++c) {
      if (c == 0 || found.cells.slave[c] != found.cells.slave[c - 1]) end = -1;
      EXPECT_GE(found.cells.vertex[2 * c], end);
      end = found.cells.vertex[2 * c + 1];
      for (std::int64_t g = found.cells.offset[c]; g < found.cells.offset[c + 1]; ++g) {
        // the normal is as good as the tangent is long: folds of these skins come close to none
        const Sample s = sample(slave, master, found.cells, c, g);
        EXPECT_LT(s.off_ray, 1e-14 * (1 + std::abs(s.gap) / s.jacobian));
        if (s.jacobian > 0.05) {
          EXPECT_LT(s.off_ray, 1e-12);
        }
        EXPECT_LE(std::abs(found.cells.master_point[g]), 1 + 1e-9);
      }
    }
  }
}

TEST(Pairing, DoesNotDependOnTheOrderOfCells) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 100; ++trial) {
    Skin slave, master;
    scatter_pieces(slave, master, random, trial % 2);
    std::vector<std::int32_t> slave_order, master_order;
    Skin other_slave = permuted(slave, slave_order, random), other_master = permuted(master, master_order, random);
    const Pairing found = pair(slave.view(), master.view()), other = pair(other_slave.view(), other_master.view());
    EXPECT_EQ(as_set(found.cells), as_set(other.cells, slave_order, master_order));
    EXPECT_EQ(found.rejected, renumbered(other.rejected, slave_order, master_order));
  }
}

TEST(Pairing, HasTheSameBitsInEveryRun) {
  std::mt19937 random(8);
  Skin slave, master;
  scatter_pieces(slave, master, random, true);
  const Pairing a = pair(slave.view(), master.view()), b = pair(slave.view(), master.view());
  EXPECT_EQ(a.cells.slave_point, b.cells.slave_point);
  EXPECT_EQ(a.cells.master_point, b.cells.master_point);
  EXPECT_EQ(a.cells.weight, b.cells.weight);
}

/// Integrals of slave and master shape functions: what C and G are made of.
std::map<std::pair<int, std::int32_t>, double> integrals(const Skin& slave, const Skin& master, const ContactCells& cells) {
  std::map<std::pair<int, std::int32_t>, double> sums;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::int64_t g = cells.offset[c]; g < cells.offset[c + 1]; ++g) {
      const Sample s = sample(slave, master, cells, c, g);
      const double w = cells.weight[g] * s.jacobian;
      sums[{2, cells.slave[c]}] += w * s.gap;
      const auto add = [&](int side, const Skin& skin, std::int32_t cell, double xi) {
        const std::vector<double> phi = shape(skin.surface.types[cell], xi);
        for (std::size_t i = 0; i < phi.size(); ++i) sums[{side, skin.surface.nodes[cell][i]}] += w * phi[i];
      };
      add(0, slave, cells.slave[c], cells.slave_point[g]);
      add(1, master, cells.master[c], cells.master_point[g]);
    }
  return sums;
}

TEST(Pairing, OfMatchingMeshesStandsAShakeOfTheCoordinates) {
  // Coincident ends: slivers of 1e-13 come and go, the integrals stay.
  std::mt19937 random(9);
  std::uniform_real_distribution<double> shake(-1e-13, 1e-13);
  for (const Kind kind : {Kind::linear, Kind::quadratic})
    for (int trial = 0; trial < 50; ++trial) {
      Skin slave, master;
      add_chain(slave, line(0), uniform(0, 1, 10), kind);
      add_chain(master, line(0), uniform(1, 0, 10), kind);
      const auto before = integrals(slave, master, pair(slave.view(), master.view()).cells);
      for (Skin* skin : {&slave, &master})
        for (std::size_t i = 0; i < skin->coordinates.size(); ++i)
          if (i % 3 < 2) skin->coordinates[i] += shake(random);
      const auto after = integrals(slave, master, pair(slave.view(), master.view()).cells);
      ASSERT_EQ(before.size(), after.size());
      for (const auto& [what, value] : before) EXPECT_NEAR(after.at(what), value, 1e-12);
    }
}

TEST(Pairing, GapBetweenConcentricArcsErrsAsSeg3DoesAtOrderFour) {
  // A SEG3 of half angle t with its three nodes on a circle of radius r lies inside it by at most r (1 - cos t)^2 / 8, which is
  // O(h^4); between two such skins the larger of the two errors bounds the gap's.
  double coarse = 0;
  for (const int n : {4, 8, 16, 32}) {
    Skin slave, master;
    const auto arc = [](double r) { return [r](double a) { return Point{r * std::cos(a), r * std::sin(a)}; }; };
    // the slave is the inner skin of the outer body: its normal points to the centre
    add_chain(slave, arc(1.1), uniform(std::numbers::pi / 2, 0, n), Kind::quadratic);
    add_chain(master, arc(1.0), uniform(-0.3, 1.9, n + 3), Kind::quadratic);
    const Pairing found = pair(slave.view(), master.view());
    double error = 0;
    for (std::size_t c = 0; c < found.cells.size(); ++c)
      for (std::int64_t g = found.cells.offset[c]; g < found.cells.offset[c + 1]; ++g)
        error = std::max(error, std::abs(sample(slave, master, found.cells, c, g).gap - 0.1));
    const auto bound = [](double r, double half_angle) { return r * std::pow(1 - std::cos(half_angle), 2) / 8; };
    const double expected = std::max(bound(1.1, std::numbers::pi / 4 / n), bound(1.0, 1.1 / (n + 3)));
    EXPECT_LT(error, 1.02 * expected);
    EXPECT_GT(error, 0.4 * expected);
    if (n == 4) coarse = error;
    if (n == 32) {
      EXPECT_NEAR(std::log2(coarse / error) / 3, 4, 0.5);
    }
  }
}

TEST(Pairing, FindsTwoSeparateMastersUnderOneSlaveCell) {
  Skin slave, master;
  add_chain(slave, line(0), {0, 1}, Kind::linear);
  add_chain(master, line(-0.1), {0.3, -0.2}, Kind::linear);
  add_chain(master, line(-0.2), {1.5, 0.8, 0.6}, Kind::quadratic);
  const Pairing found = pair(slave.view(), master.view());
  EXPECT_EQ(found.cells.master, (std::vector<std::int32_t>{0, 2, 1}));
  EXPECT_NEAR(coverage(slave, found.cells)[0], 0.7, 1e-14);
}

TEST(Pairing, StandsHangingNodes) {
  // The right master is cut twice as fine, and its first node lies on the middle of a neighbour's edge.
  Skin slave, master;
  add_chain(slave, line(0), uniform(0, 1, 3), Kind::linear);
  add_chain(master, line(-0.1), {0.5, 0}, Kind::linear);
  add_chain(master, line(-0.1), uniform(1, 0.5, 4), Kind::linear);
  const Pairing found = pair(slave.view(), master.view());
  for (const double covered : coverage(slave, found.cells)) EXPECT_NEAR(covered, 1, 1e-14);
}

TEST(Pairing, GivesOverlappingMastersToTheNearest) {
  // Two layers, above and below the slave: the one with the smaller |gap| keeps each point, and the loss is counted.
  for (const double sign : {1.0, -1.0}) {
    Skin slave, master;
    add_chain(slave, line(0), {0, 1}, Kind::linear);
    add_chain(master, line(-0.3 * sign), {1, 0}, Kind::linear);
    add_chain(master, line(0.1), {0.75, 0.25}, Kind::linear);
    const Pairing found = pair(slave.view(), master.view());
    EXPECT_EQ(found.cells.master, (std::vector<std::int32_t>{0, 1, 0}));
    EXPECT_NEAR(coverage(slave, found.cells)[0], 1, 1e-14);
    EXPECT_EQ(found.count(Rejection::hidden), 1);
  }
}

TEST(Pairing, IsNotCutByWhatLiesHidden) {
  Skin slave, master;
  add_chain(slave, line(0), {0, 1}, Kind::linear);
  add_chain(master, line(-0.1), {1, 0}, Kind::linear);
  add_chain(master, line(-0.4), {0.6, 0.2}, Kind::linear);
  const Pairing found = pair(slave.view(), master.view());
  EXPECT_EQ(found.cells.vertex, (std::vector<double>{-1, 1}));
  EXPECT_EQ(found.cells.master, (std::vector<std::int32_t>{0}));
}

TEST(Pairing, TakesOneOfTwoIdenticalMasters) {
  Skin slave, master;
  add_chain(slave, line(0), {0, 1}, Kind::linear);
  add_chain(master, line(-0.1), {1, 0}, Kind::linear);
  master.add_cell({0, 1});
  const Pairing found = pair(slave.view(), master.view());
  EXPECT_EQ(found.cells.master, (std::vector<std::int32_t>{0}));
  EXPECT_EQ(found.count(Rejection::hidden), 1);
}

TEST(Pairing, RefusesMastersThatShowTheirBack) {
  Skin slave, master;
  add_chain(slave, line(0), {0, 1}, Kind::linear);
  add_chain(master, line(-0.1), {0, 1}, Kind::linear);
  const Pairing found = pair(slave.view(), master.view());
  EXPECT_EQ(found.cells.size(), 0u);
  EXPECT_EQ(found.count(Rejection::facing_away), 1);
}

TEST(Pairing, SeesOnlyTheNearSideOfAClosedMaster) {
  // A disc in a ring: the normals of the ring's skin cross the disc twice.
  Skin slave, master;
  const auto circle = [](double r) { return [r](double a) { return Point{r * std::cos(a), r * std::sin(a)}; }; };
  add_chain(slave, circle(1.05), uniform(2 * std::numbers::pi, 0, 36), Kind::quadratic);
  add_chain(master, circle(1), uniform(0, 2 * std::numbers::pi, 50), Kind::quadratic);
  const Pairing found = pair(slave.view(), master.view());
  for (const double covered : coverage(slave, found.cells)) EXPECT_NEAR(covered, 1, 1e-13);
  for (std::size_t c = 0; c < found.cells.size(); ++c)
    EXPECT_NEAR(sample(slave, master, found.cells, c, found.cells.offset[c]).gap, 0.05, 1e-4);
}

TEST(Pairing, WithSmoothedNormalsLeavesNoGapAtTheCornersOfAPolygon) {
  // Normals that are continuous from slave cell to slave cell meet the master continuously: it is covered once, from the first
  // to the last slave node. With the cells' own normals the wedges at convex corners would miss some of it.
  Skin slave, master;
  const auto circle = [](double r) { return [r](double a) { return Point{r * std::cos(a), r * std::sin(a)}; }; };
  add_chain(slave, circle(1), uniform(0, 1, 5), Kind::linear);
  add_chain(master, circle(1.3), uniform(1.7, -0.7, 40), Kind::linear);
  const auto seen = [&] {
    const Pairing found = pair(slave.view(), master.view());
    double sum = 0;  // length of the master that is seen: its points move linearly between the ends of a couple
    for (std::size_t c = 0; c < found.cells.size(); ++c) {
      const std::int64_t first = found.cells.offset[c], last = found.cells.offset[c + 1] - 1;
      const Place a = place(master, found.cells.master[c], found.cells.master_point[first]);
      const Place b = place(master, found.cells.master[c], found.cells.master_point[last]);
      const double part = (found.cells.slave_point[last] - found.cells.slave_point[first]) /
                          (found.cells.vertex[2 * c + 1] - found.cells.vertex[2 * c]);
      sum += std::hypot(b.x[0] - a.x[0], b.x[1] - a.x[1]) / part;
    }
    return sum;
  };
  const double apart = seen();
  slave.normals = nodal_normals(slave.view());
  const double smooth = seen();
  EXPECT_NEAR(apart, 1.0, 0.02);          // the slave's own length
  EXPECT_NEAR(smooth, 1.3 - 0.06, 0.02);  // the master's, but for half a wedge of 0.3 * 0.1 at each end
}

TEST(Pairing, OfConcaveSlavesCoversNothingTwice) {
  // The master lies beyond the slave's centre of curvature: normals cross before they meet it.
  Skin slave, master;
  add_chain(
      slave,
      [](double a) {
        return Point{std::cos(a), std::sin(a)};
      },
      {std::numbers::pi * 0.7, std::numbers::pi * 0.3}, Kind::quadratic);
  add_chain(master, line(-2), uniform(-5, 5, 10), Kind::linear);
  add_chain(master, line(-2), uniform(5, -5, 10), Kind::linear);
  for (const double covered : coverage(slave, pair(slave.view(), master.view()).cells)) EXPECT_NEAR(covered, 1, 1e-13);
}

TEST(Pairing, NamesDegenerateCellsInsteadOfReturningNumbersThatAreNone) {
  Skin slave, master;
  add_chain(slave, line(0), {0, 0.5, 1}, Kind::linear);
  const std::int32_t again = slave.add_node({1, 0});
  slave.add_cell({again, again});                    // no length
  slave.add_cell({0, 1, slave.add_node({0.5, 0})});  // folded: the middle lies on the end
  slave.add_cell({0, slave.add_node({std::numeric_limits<double>::quiet_NaN(), 0})});
  add_chain(master, line(-0.1), {1, 0}, Kind::linear);
  const std::int32_t point = master.add_node({0.5, -0.05});
  master.add_cell({point, point});
  master.add_cell({point, master.add_node({0, std::numeric_limits<double>::infinity()})});
  const Pairing found = pair(slave.view(), master.view());
  EXPECT_EQ(found.cells.slave, (std::vector<std::int32_t>{0, 1}));
  using enum Rejection;
  EXPECT_EQ(found.rejected, (std::vector<RejectedCouple>{{-1, 1, degenerate_master},
                                                         {-1, 2, degenerate_master},
                                                         {2, -1, degenerate_slave},
                                                         {3, -1, degenerate_slave},
                                                         {4, -1, degenerate_slave}}));
  EXPECT_EQ(found.count(degenerate_slave), 3);
  EXPECT_EQ(found.count(degenerate_master), 2);
  for (const double value : found.cells.master_point) EXPECT_TRUE(std::isfinite(value));
}

TEST(Pairing, LeavesOutWhatIsFurtherThanTheLimit) {
  // cells of length 1, a master of length 2 at the distance 1: half a diameter of the larger one, apart or overlapping
  for (const double side : {-1.0, 1.0}) {
    Skin slave, master;
    add_chain(slave, line(0), {0, 1}, Kind::linear);
    add_chain(master, line(side), {1.5, -0.5}, Kind::linear);
    const Pairing near = pair(slave.view(), master.view(), {.distance_limit = 0.5001}),
                  far = pair(slave.view(), master.view(), {.distance_limit = 0.4999});
    EXPECT_EQ(near.cells.size(), 1u);
    EXPECT_TRUE(near.rejected.empty());
    EXPECT_EQ(far.cells.size(), 0u);
    EXPECT_EQ(far.rejected, (std::vector<RejectedCouple>{{0, 0, side > 0 ? Rejection::too_deep : Rejection::too_far}}));
    const auto found_after = [&](double distance) {  // of the master, to where it is
      const std::vector<double> rest = moved(master.coordinates, {0, -distance, 0});
      Surface of_master = master.view();
      of_master.rest = rest;
      return pair(slave.view(), of_master, {.distance_limit = 0.4}).cells.size();
    };
    EXPECT_EQ(found_after(0.2001 * side), 1u);
    EXPECT_EQ(found_after(0.1999 * side), 0u);
    for (const double none : {-1.0, 0.0})
      EXPECT_EQ(pair(slave.view(), master.view(), {.distance_limit = none}).cells.size(), 1u);
  }
}

TEST(Pairing, LeavesOutTheOtherSideOfTheSameBody) {
  // as above, 1 deep behind the slave: half a diameter
  Skin slave, master;
  add_chain(slave, line(0), {0, 1}, Kind::linear);
  add_chain(master, line(1), {1.5, -0.5}, Kind::linear);
  const std::vector<std::int32_t> one(2, 7), other(2, 8);
  const auto rejected = [&](const std::vector<std::int32_t>& body, double limit, double at_rest = 1) {
    const std::vector<double> rest = moved(master.coordinates, {0, at_rest - 1, 0});
    Surface of_slave = slave.view(), of_master = master.view();
    of_slave.body = one;
    of_master.body = body;
    of_master.rest = rest;
    return pair(of_slave, of_master, {.own_depth_limit = limit}).rejected;
  };
  const std::vector<RejectedCouple> none, through{{0, 0, Rejection::other_side}};
  EXPECT_EQ(rejected(one, 0.4999), through);
  EXPECT_EQ(rejected(one, 0.5001), none);
  EXPECT_EQ(rejected(one, 0), none);
  EXPECT_EQ(rejected(other, 0.25), none);
  EXPECT_EQ(rejected(one, 0.25, -1), none);  // in front of it: they have met since
  EXPECT_EQ(rejected(one, 0.25, 0.4), none);
  EXPECT_EQ(rejected(one, 0.25, 0.6), through);
  const std::vector<RejectedCouple> unknown = pair(slave.view(), master.view()).rejected;
  EXPECT_EQ(unknown, none);
}

TEST(Pairing, LeavesOutOverlapsThatAreDeeperThanTheLimitAndTheMotion) {
  // as above; the outward normal of the slave points to y < 0
  for (const double side : {-1.0, 1.0}) {
    Skin slave, master;
    add_chain(slave, line(0), {0, 1}, Kind::linear);
    add_chain(master, line(side), {1.5, -0.5}, Kind::linear);
    const auto rejected = [&](double limit, double closer, double sideways = 0) {  // since they were at rest, half of it each
      const std::vector<double> slave_rest = moved(slave.coordinates, {0, 0.5 * closer, 0}),
                                master_rest = moved(master.coordinates, {sideways, -0.5 * closer, 0});
      Surface of_slave = slave.view(), of_master = master.view();
      of_slave.rest = slave_rest;
      of_master.rest = master_rest;
      return pair(of_slave, of_master, {.depth_limit = limit}).rejected;
    };
    const std::vector<RejectedCouple> none, deep{{0, 0, Rejection::too_deep}};
    EXPECT_EQ(rejected(0.4999, 0), side > 0 ? deep : none);
    EXPECT_EQ(rejected(0.4, 0.1999), side > 0 ? deep : none);
    EXPECT_EQ(rejected(0.4, 0.2001), none);
    EXPECT_EQ(rejected(0.4, -0.2001), side > 0 ? deep : none);    // the farther apart before
    EXPECT_EQ(rejected(0.4, 0, 0.2001), side > 0 ? deep : none);  // along the walls: behind the body all the time
    EXPECT_EQ(rejected(0.5001, 0), none);
  }
}

// A share of 1 up to the angle, then t^2 (3 - 2 t) of the cosine over its one: nothing jumps on the way to 90 degrees.
TEST(Pairing, CountsWallsBesideAnEdgeLessTheSteeperTheyAre) {
  constexpr double degree = std::numbers::pi / 180;
  for (const double angle : {0.0, 80.0, 84.9, 85.1, 88.0, 89.9}) {
    const double a = angle * std::numbers::pi / 180;
    Skin slave, master;
    add_chain(slave, line(0), {0, 1}, Kind::linear);
    master.add_cell({master.add_node({0.5 + std::cos(a), -0.1 - std::sin(a)}), master.add_node({0.5, -0.1})});
    const Pairing found = pair(slave.view(), master.view(), {.steep_angle = 85}),
                  all = pair(slave.view(), master.view(), {.steep_angle = 90});
    ASSERT_EQ(all.cells.size(), 1u) << angle;
    ASSERT_EQ(found.cells.size(), 1u) << angle;
    const double t = std::min(std::cos(a) / std::cos(85 * degree), 1.0);
    for (std::size_t p = 0; p < all.cells.weight.size(); ++p)
      EXPECT_NEAR(found.cells.weight[p], t * t * (3 - 2 * t) * all.cells.weight[p], 1e-15) << angle;
  }
}

TEST(Pairing, OfNothingIsEmpty) {
  Skin slave, nothing;
  add_chain(slave, line(0), {0, 1}, Kind::linear);
  EXPECT_EQ(pair(slave.view(), nothing.view()).cells.size(), 0u);
  EXPECT_EQ(pair(nothing.view(), slave.view()).cells.size(), 0u);
}

TEST(Pairing, RefusesCellsOfSpace) {
  Skin slave, master;
  slave.surface.add_cell(CellType::TRIA3, std::vector<std::int32_t>{0, 1, 2});
  EXPECT_THROW(pair(slave.view(), master.view()), std::invalid_argument);
  slave.surface.dimension = 3;
  EXPECT_THROW(pair(slave.view(), master.view()), std::invalid_argument);
}

TEST(Rejection, HasANameForEachReason) {
  for (int reason = 0; reason < n_rejections; ++reason) EXPECT_FALSE(rejection_name(static_cast<Rejection>(reason)).empty());
}

}  // namespace
}  // namespace lacon::test
