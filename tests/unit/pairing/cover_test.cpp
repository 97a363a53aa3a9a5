// What pairing in the plane keeps at its limits: of any size, at the ends of covers, of slivers, of slanted overlaps.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "lacon/elements/reference.hpp"
#include "lacon/pairing/normals.hpp"
#include "skins.hpp"

namespace lacon::test {
namespace {

// Lengths have no unit: what counts as degenerate is relative, whatever power of ten coordinates are in.
TEST(Covers, AreTheSameInAnyUnit) {
  for (const Kind kind : {Kind::linear, Kind::quadratic})
    for (const double scale : {1e-15, 1e-6, 1.0, 1e15}) {
      Skin slave, master;
      add_chain(slave, line(0, scale), uniform(0, 1, 3), kind);
      add_chain(master, line(-0.1, scale), uniform(1.2, -0.2, 4), kind);
      for (const bool smooth : {false, true}) {
        if (smooth) slave.normals = nodal_normals(slave.view());
        for (const double covered : coverage(slave, pair(slave.view(), master.view()).cells))
          EXPECT_NEAR(covered, 1, 1e-13) << scale << ' ' << smooth;
      }
    }
}

TEST(NodalNormals, AreTheSameInAnyUnit) {
  for (const double scale : {1e-12, 1e-6, 1e6, 1e12}) {
    Skin skin, small;
    const auto wave = [](double by) { return [by](double x) { return Point{by * x, by * 0.2 * std::sin(5 * x)}; }; };
    add_chain(skin, wave(1), uniform(0, 1, 6), Kind::quadratic);
    add_chain(small, wave(scale), uniform(0, 1, 6), Kind::quadratic);
    const std::vector<double> expected = nodal_normals(skin.view()), found = nodal_normals(small.view());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-13) << scale;
  }
}

// Nodal normals that are opposite cancel on the way from one to the other: such a cell has no normal there.
TEST(Covers, NeedNormalsThatDoNotCancel) {
  Skin slave, master;
  add_chain(slave, line(0), {0, 1}, Kind::linear);
  add_chain(master, line(-0.1), {1.5, -0.5}, Kind::linear);
  slave.normals = {0, -1, 0, 0, 1, 0};
  const Pairing found = pair(slave.view(), master.view());
  EXPECT_EQ(found.rejected, (std::vector<RejectedCouple>{{0, -1, Rejection::degenerate_slave}}));
  slave.normals = {0, -1, 0, 0.6, -0.8, 0};
  EXPECT_EQ(pair(slave.view(), master.view()).cells.size(), 1u);
}

// Only where the masters end does the cover fade; between two of them it goes over from one to the other bit by bit, and where
// it reaches beyond a master, images lie on the normals all the same.
TEST(Covers, FadeWhereTheMastersEndAlone) {
  for (const Kind kind : {Kind::linear, Kind::quadratic})
    for (const double width : {0.0, 0.5}) {
      Skin slave, master;
      add_chain(slave, line(0), {0, 1}, Kind::linear);
      add_chain(
          master,
          [](double x) {
            return Point{x, -0.1 - 0.05 * x * x};
          },
          uniform(0.95, 0.05, 5), kind);
      const Pairing found = pair(slave.view(), master.view(), {.fading = width});
      const ContactCells& cells = found.cells;
      ASSERT_EQ(cells.size(), 5u);
      EXPECT_EQ(found.count(Rejection::no_image), 0);
      for (std::size_t v = 1; v + 1 < cells.vertex.size(); ++v) {
        EXPECT_EQ(cells.vertex[v], cells.vertex_crossing[v]) << v;
        if (v % 2 == 1) {
          EXPECT_EQ(cells.vertex[v], cells.vertex[v + 1]) << v;
        }
      }
      for (const std::size_t v : {std::size_t{0}, cells.vertex.size() - 1}) {
        EXPECT_NEAR(std::abs(cells.vertex_crossing[v]), 0.9, 1e-14);
        // at the share t of the band the cover ends 2 t^2 - t^3 widths from the end of the slave
        const double t = width > 0 ? 0.1 / width : 0;
        EXPECT_NEAR(std::abs(cells.vertex[v]), width > 0 ? 1 - width * (2 * t * t - t * t * t) : 0.9, 1e-14);
      }
      for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::int64_t g = cells.offset[c]; g < cells.offset[c + 1]; ++g)
          EXPECT_LT(sample(slave, master, cells, c, g).off_ray, 1e-11) << c << ' ' << width;
    }
}

// PairingTolerances::sliver is a fraction of the slave cell.
TEST(Covers, AreLeftOutBelowTheirSliver) {
  constexpr double sliver = 1e-3;
  for (const double part : {0.5, 0.9, 1.1, 1.4, 3.0}) {
    Skin slave, master;
    add_chain(slave, line(0), {0, 2}, Kind::linear);
    add_chain(master, line(-0.1), {1 + 2 * part * sliver, 1}, Kind::linear);
    const Pairing found = pair(slave.view(), master.view(), {.tolerances = {.sliver = sliver}});
    EXPECT_EQ(found.cells.size(), part > 1 ? 1u : 0u) << part;
    EXPECT_EQ(found.count(Rejection::sliver), part > 1 ? 0 : 1) << part;
  }
}

// How deep an overlap may be goes with the cosine between the two cells: seen along the master's normal it is the same.
TEST(Covers, OfSlantedOverlapsAreAsDeepAlongTheMastersNormal) {
  for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
    const double angle = degrees * std::numbers::pi / 180, limit = 0.5;
    for (const double depth : {0.9 * limit * std::cos(angle), 1.1 * limit * std::cos(angle)}) {
      // a master of length 1 above the slave of length 1, crossed in its middle by the normal of the slave's middle
      Skin slave, master;
      add_chain(slave, line(0), {0, 1}, Kind::linear);
      const double dx = 0.5 * std::cos(angle), dy = 0.5 * std::sin(angle);
      master.add_cell({master.add_node({0.5 + dx, depth + dy}), master.add_node({0.5 - dx, depth - dy})});
      const Pairing found = pair(slave.view(), master.view(), {.depth_limit = limit});
      EXPECT_EQ(found.count(Rejection::too_deep), depth > limit * std::cos(angle) ? 1 : 0) << degrees << ' ' << depth;
    }
  }
}

// On an arc whose middle node is over the middle of its chord, the image is a polynomial of the slave's coordinate: it takes
// the fewest points; where the middle node is off, more.
TEST(Covers, OfArcsTakeTheFewestPoints) {
  const auto points = [](double off) {
    Skin slave, master;
    add_chain(slave, line(0), {3, 4}, Kind::linear);
    const std::int32_t a = master.add_node({4.2, -0.1}), b = master.add_node({2.8, -0.1});
    master.add_cell({a, b, master.add_node({3.5 + off, -0.05})});
    const ContactCells cells = pair(slave.view(), master.view()).cells;
    return cells.size() == 1 ? cells.weight.size() : 0;
  };
  EXPECT_EQ(points(0), 4u);
  EXPECT_GT(points(0.1), 6u);
}

// Integrals of the shape functions of such an arc, and of these times what a slave cell brings (its own shape functions, its
// Jacobian, in axisymmetry the radius): its points keep twelve digits.
TEST(Covers, OfArcsWhoseMiddleNodeIsOffKeepTwelveDigits) {
  constexpr double half = 0.7;
  const Rule& rule = gauss_rule(8);  // exact to the degree 15
  for (const double off : {1e-6, 1e-4, 1e-3, 0.004, 0.0105, 0.015, 0.02, 0.05, 0.1, 0.2}) {
    Skin slave, master;
    add_chain(slave, line(0), {0, 7}, Kind::linear);
    const std::int32_t a = master.add_node({3.5 + half, -0.1}), b = master.add_node({3.5 - half, -0.1});
    master.add_cell({a, b, master.add_node({3.5 + off, -0.05})});
    const ContactCells cells = pair(slave.view(), master.view()).cells;
    ASSERT_EQ(cells.size(), 1u) << off;
    for (int power = 0; power <= 4; ++power) {
      std::array<double, 3> found{}, exact{}, shape;
      const auto add = [&](std::array<double, 3>& sum, double at, double way, double weight) {
        shape_functions(CellType::SEG3, std::array{at}, shape);
        for (std::size_t i = 0; i < 3; ++i) sum[i] += weight * std::pow(way / half, power) * shape[i];
      };
      for (std::size_t g = 0; g < cells.weight.size(); ++g)  // 3.5: of the slave's middle, and dx by its coordinate
        add(found, cells.master_point[g], 3.5 * cells.slave_point[g], 3.5 * cells.weight[g]);
      for (std::size_t g = 0; g < rule.weights.size(); ++g) {
        const double xi = rule.points[g];
        add(exact, xi, -half * xi + off * (1 - xi * xi), (half + 2 * off * xi) * rule.weights[g]);
      }
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], exact[i], 1e-12) << off << ' ' << power << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace lacon::test
