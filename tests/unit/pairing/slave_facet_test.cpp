// The parts of pairing in space: what a slave facet may meet, where points of polygons lie, where normals meet bent masters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "lacon/pairing/chart_points.hpp"
#include "lacon/pairing/slave_facet.hpp"
#include "skins_in_space.hpp"

namespace lacon::test {
namespace {

/// One facet, its nodes moved at random.
Skin3 shaken_facet(CellType type, double shake, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-shake, shake);
  Skin3 skin;
  const catalog::CellRow& row = catalog::cell(type);
  std::vector<std::int32_t> nodes;
  for (int a = 0; a < row.n_nodes; ++a) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    nodes.push_back(skin.add_node({3 + row.nodes[2 * a] + x, row.nodes[2 * a + 1] + y - 2, z + 1}));
  }
  skin.surface.add_cell(type, nodes);
  return skin;
}

/// A place of the reference cell, on its border now and then.
Vec2 place_in(Family family, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  double a = uniform(random), b = uniform(random);
  if (random() % 3 == 0) a = std::round(a);
  if (random() % 3 == 0) b = std::round(2 * b) / 2;
  return family == Family::TRIA ? Vec2{a, (1 - a) * b} : Vec2{2 * a - 1, 2 * b - 1};
}

// A box that holds a point of a normal is never left out, however the facet is bent and wherever on the normal it lies.
TEST(SlaveFacets, TouchEveryBoxThatANormalPasses) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  int met = 0;
  for (const CellType type : kinds)
    for (int trial = 0; trial < 300; ++trial) {
      Skin3 skin = shaken_facet(type, trial % 2 ? 0.05 : 0.3, random);
      if (trial % 3 == 0)
        for (std::size_t a = 0; a < skin.n_nodes(); ++a) {
          const Vec3 n{uniform(random) - 0.5, uniform(random) - 0.5, 1};
          for (const double value : {n.x, n.y, n.z}) skin.normals.push_back(value / norm(n));
        }
      space::SlaveFacet e;
      e.set(skin.view(), 0, 2, {});
      e.lay_out(false);
      if (e.degenerate) continue;
      for (int sample = 0; sample < 40; ++sample) {
        const Vec2 xi = place_in(e.f.family, random);
        const double height = std::pow(10, 3 * uniform(random) - 1) * (sample % 2 ? 1 : -1);
        const Vec3 q = e.f.origin + e.f.x(xi).x + height * e.direction(xi);
        Box<3> box = Box<3>::empty();
        for (const double side : {-1.0, 1.0}) {
          const Vec3 corner = q + (side * 0.3 * uniform(random)) * Vec3{1, uniform(random), uniform(random)};
          box.add(std::array{corner.x, corner.y, corner.z}.data());
        }
        for (int d = 0; d < 3; ++d) {
          box.low[d] = std::min(box.low[d], component(q, d));
          box.high[d] = std::max(box.high[d], component(q, d));
        }
        ++met;
        ASSERT_TRUE(e.touches(box)) << catalog::cell(type).name << ", trial " << trial;
      }
    }
  EXPECT_GT(met, 20'000);
}

// What a piece stands for are normals between those of its vertices: a box that one of them passes is never left out.
TEST(SlaveFacets, PiecesReachWhatNormalsBetweenThoseOfTheirVerticesPass) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::size_t met = 0, left_out = 0;
  for (const CellType type : kinds)
    for (int trial = 0; trial < 100; ++trial) {
      Skin3 skin = shaken_facet(type, trial % 2 ? 0.05 : 0.3, random);
      space::SlaveFacet e;
      e.set(skin.view(), 0, 2, {});
      if (e.degenerate) continue;
      e.lay_out(true);
      for (const space::Piece& piece : e.pieces)
        for (int sample = 0; sample < 10; ++sample) {
          const double a = uniform(random), b = (1 - a) * uniform(random), c = 1 - a - b;
          const Vec3 x = a * piece.x[0] + b * piece.x[1] + c * piece.x[2], n = a * piece.n[0] + b * piece.n[1] + c * piece.n[2];
          const Vec3 q = x + (std::pow(10, 3 * uniform(random) - 1) * (sample % 2 ? 1 : -1)) * n;
          const Vec3 half = 0.3 * Vec3{uniform(random), uniform(random), uniform(random)};
          const Vec3 off{(2 * uniform(random) - 1) * half.x, (2 * uniform(random) - 1) * half.y,
                         (2 * uniform(random) - 1) * half.z};
          ++met;
          ASSERT_TRUE(piece.reach.touches(q + off, half)) << catalog::cell(type).name << ", trial " << trial;
          // and it leaves out others: what lies beside it by three times its size
          const Vec3 side = cross(n, piece.x[1] - piece.x[0]);
          left_out += !piece.reach.touches(x + (3 / norm(n)) * side, {});
        }
    }
  EXPECT_GT(met, 50'000U);
  EXPECT_GT(left_out, met / 10 * 9);
}

// A cell that straightens and bends again over the end of a master: the largest second difference of what is covered, over the
// square of the step. A smooth course has some, a leap has more the smaller the step.
double largest_leap(CellType type, bool keeps_cut) {
  const auto bent = [&](double by) {
    std::mt19937 random(1);
    const Place3 place = [by](double x, double y) { return Vec3{x, y, by * (x * x + 0.5 * x * y - 0.7 * y * y)}; };
    return mesh({.nx = 1, .ny = 1, .type = type, .up = false}, place, random, true);
  };
  std::mt19937 random(1);
  const Place3 oblique = [](double x, double y) { return Vec3{0.55 * x + 0.1 * y, y, -0.1}; };
  Skin3 master = mesh({.nx = 2, .ny = 2, .y0 = -0.5, .y1 = 1.5}, oblique, random);
  std::vector<SlaveCut> cuts(keeps_cut ? bent(0).surface.size() : 0);
  const auto covered = [&](double by) {
    Skin3 slave = bent(by);
    slave.surface.cuts = cuts;
    const Pairing found = pair(slave.view(), master.view(), {.traced = true});
    return std::accumulate(found.cells.weight.begin(), found.cells.weight.end(), 0.0);
  };
  constexpr int steps = 500;
  constexpr double most = 0.2, step = most / steps;
  std::vector<double> course;
  for (int i = -steps; i <= steps; ++i) course.push_back(covered(std::abs(i) * step));
  double leap = 0;
  for (int i = 2; i <= 2 * steps; ++i)
    if (i != steps + 1) leap = std::max(leap, std::abs(course[i] - 2 * course[i - 1] + course[i - 2]));
  return leap / (step * step);
}

// Newton's method goes to and fro where the gap of a patch leaps: a cell stays cut as finely as it had to be.
TEST(SlaveFacets, StayCutAsTheyWereWithoutLeapsOfWhatIsCovered) {
  for (const CellType type : {CellType::TRIA6, CellType::QUAD4, CellType::QUAD8, CellType::QUAD9})
    EXPECT_LT(largest_leap(type, true), 10) << catalog::cell(type).name;
  EXPECT_GT(largest_leap(CellType::TRIA6, false), 100);
}

// Whether a cell is cut more finely than its present shape asks for.
TEST(SlaveFacets, TellWhereTheyAreCutAsTheyWere) {
  const SlaveCut flat{.steps = 1}, fine{.steps = 4}, curved{.steps = 1, .curved = true}, affine{.steps = 1, .affine = true};
  const auto kept = [](SlaveCut now, const SlaveCut& before) {
    now.refine(before);
    return now.kept;
  };
  for (const SlaveCut& more : {fine, curved, affine}) {
    EXPECT_TRUE(kept(flat, more));
    EXPECT_FALSE(kept(more, flat));
    EXPECT_FALSE(kept(more, more));
  }
  std::mt19937 random(1);
  const auto bent = [&](double by) {
    const Place3 place = [by](double x, double y) { return Vec3{x, y, by * x * y}; };
    return mesh({.nx = 1, .ny = 1, .type = CellType::QUAD4, .up = false}, place, random, true);
  };
  const Place3 level = [](double x, double y) { return Vec3{x, y, -0.1}; };
  Skin3 master = mesh({.nx = 1, .ny = 1}, level, random);
  std::vector<SlaveCut> cuts(1);
  for (const double by : {0.1, 0.4, 0.4, 0.1, 0.1}) {  // what it once was stays
    Skin3 slave = bent(by);
    slave.surface.cuts = cuts;
    const std::uint8_t before = cuts[0].steps;
    pair(slave.view(), master.view(), {.traced = true});
    EXPECT_GE(cuts[0].steps, before);
    EXPECT_EQ(cuts[0].kept, by < 0.2 && before > 2) << by;
  }
  EXPECT_GT(cuts[0].steps, 2);
}

// Whichever corner of a cell comes first, the same places are near it.
TEST(SlaveFacets, HaveTheSameNeighbourhoodFromEachCorner) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(-2, 2);
  int near = 0;
  for (int sample = 0; sample < 1000; ++sample) {
    const Vec2 p{uniform(random), uniform(random)};
    const bool in_triangle = space::near_reference_cell(Family::TRIA, p, 0.25),
               in_square = space::near_reference_cell(Family::QUAD, p, 0.25);
    near += in_triangle;
    EXPECT_EQ(space::near_reference_cell(Family::TRIA, {p.y, 1 - p.x - p.y}, 0.25), in_triangle);
    EXPECT_EQ(space::near_reference_cell(Family::TRIA, {1 - p.x - p.y, p.x}, 0.25), in_triangle);
    EXPECT_EQ(space::near_reference_cell(Family::QUAD, {-p.y, p.x}, 0.25), in_square);
  }
  EXPECT_GT(near, 50);
}

/// The integral of x^a y^b over the triangle of the corners 0, (1, 0) and (0, 1).
double moment(int a, int b) { return std::exp(std::lgamma(a + 1) + std::lgamma(b + 1) - std::lgamma(a + b + 3)); }

// A rule of a degree integrates polynomials of this degree exactly, on every polygon; Gauss's rules in two directions do with
// degree / 2 + 1 points in each, and no triangle takes more.
TEST(ChartPoints, IntegrateTheirDegreeWithNoMorePointsThanItTakes) {
  const space::Polygon triangle{{0, 0}, {1, 0}, {0, 1}}, pentagon{{0, 0}, {0.5, 0}, {1, 0}, {0.5, 0.5}, {0, 1}};
  space::ChartPoints points;
  for (int degree = 1; degree <= 40; ++degree)
    for (const bool traced : {false, true})
      for (const space::Polygon& polygon : {triangle, pentagon}) {
        space::place_points(polygon, degree, true, traced, points);
        for (int a = 0; a <= degree; ++a) {
          const int b = degree - a;
          double sum = 0;
          for (std::size_t g = 0; g < points.y.size(); ++g)
            sum += points.weight[g] * std::pow(points.y[g].x, a) * std::pow(points.y[g].y, b);
          EXPECT_NEAR(sum, moment(a, b), 1e-12 * moment(0, 0)) << degree << ' ' << a;
        }
        if (polygon.size() > 3) continue;
        const auto each_way = static_cast<std::size_t>(degree / 2 + 1);
        EXPECT_LE(points.y.size(), degree <= 4   ? 6
                                   : degree <= 5 ? 7
                                   : degree <= 6 ? 12
                                   : degree <= 8 ? 16
                                                 : each_way * each_way)
            << degree;
      }
  const space::Polygon square{{1, 0}, {3, 1}, {2, 3}, {0, 2}};  // of area 5
  for (int degree = 1; degree <= 12; ++degree) {
    space::place_points(square, degree, true, false, points);
    for (int a = 0; a <= degree; ++a) {
      double sum = 0, expected = 0;
      for (std::size_t g = 0; g < points.y.size(); ++g) {
        const Vec2 p = points.y[g] - Vec2{1, 0};
        sum += points.weight[g] * std::pow((2 * p.x + p.y) / 5, a) * std::pow((2 * p.y - p.x) / 5, degree - a);
      }
      expected = 5.0 / ((a + 1) * (degree - a + 1));  // of s^a t^b over the unit square
      EXPECT_NEAR(sum, expected, 1e-12) << degree << ' ' << a;
    }
  }
}

// Normals meet masters that are strongly bent where they say: no image is beside its normal, wherever Newton's method for eight
// lines at once has gone.
TEST(SlaveFacets, MeetStronglyBentMastersOnTheirNormals) {
  std::mt19937 random(13);
  int points = 0;
  for (const CellType of_slave : kinds)
    for (const CellType type : {CellType::TRIA6, CellType::QUAD8, CellType::QUAD9})
      for (int trial = 0; trial < 8; ++trial) {
        Skin3 slave = shaken_facet(of_slave, 0.1, random), master = shaken_facet(type, 0.4, random);
        for (std::size_t i = 2; i < master.coordinates.size(); i += 3) master.coordinates[i] += 0.4 * (trial % 5);
        // the master faces the slave
        Skin3 facing = master;
        facing.surface.nodes = {};
        std::vector<std::int32_t> nodes(master.surface.nodes[0].begin(), master.surface.nodes[0].end());
        const int n = catalog::cell(type).n_vertices;
        std::reverse(nodes.begin(), nodes.begin() + n);
        std::reverse(nodes.begin() + n, nodes.begin() + 2 * n - 1);
        facing.surface.nodes.push_back(nodes);
        const ContactCells cells = pair(slave.view(), facing.view()).cells;
        points += static_cast<int>(cells.weight.size());
        EXPECT_LT(forces(slave, facing, cells).off_ray, 1e-9) << catalog::cell(of_slave).name << catalog::cell(type).name;
      }
  EXPECT_GT(points, 1'200);
}

// A needle of a master that the slave's normals meet at its far end: how far that is does not hang on the node it begins with.
TEST(SlaveFacets, AreAsFarFromAMasterWhicheverNodeIsItsFirst) {
  for (const double side : {1.0, -1.0})  // the same in a mirror: its edges the other way round
    for (int first = 0; first < 3; ++first)
      for (const bool beyond : {false, true}) {
        Skin3 slave, master;
        std::vector<std::int32_t> square, needle;
        for (const auto& [x, y] : {std::pair(-0.0955, 0.001), {-0.0955, 0.003}, {-0.0945, 0.003}, {-0.0945, 0.001}})
          square.push_back(slave.add_node({x, side * y, 0}));
        for (const Vec3 p : {Vec3{0, side * 0.1, -0.52}, Vec3{-0.1, 0, -1.02}, Vec3{0.1, 0, -0.02}})
          needle.push_back(master.add_node(p));
        std::rotate(needle.begin(), needle.begin() + first, needle.end());
        if (side < 0) {
          std::reverse(square.begin(), square.end());
          std::reverse(needle.begin() + 1, needle.end());
        }
        slave.surface.add_cell(CellType::QUAD4, square);
        master.surface.add_cell(CellType::TRIA3, needle);
        // the gap is 0.99, and the longest edge, by which limits are measured, 1.02
        const Pairing found = pair(slave.view(), master.view(), {.distance_limit = beyond ? 0.85 : 1.0});
        EXPECT_EQ(found.cells.size(), beyond ? 0u : 1u) << first << side;
        EXPECT_EQ(found.count(Rejection::too_far), beyond ? 1 : 0) << first << side;
      }
}

}  // namespace
}  // namespace lacon::test
