// The parts of pairing: polynomials, the box tree, facets, nodal normals.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <random>

#include "lacon/pairing/box_tree.hpp"
#include "lacon/pairing/facet.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/pairing/polynomial.hpp"
#include "region.hpp"
#include "skins.hpp"

namespace lacon::test {
namespace {

Polynomial with_zeros(const std::vector<double>& zeros, double leading) {
  Polynomial p;
  p.c[0] = leading;
  for (const double zero : zeros) {
    for (int k = ++p.degree; k >= 0; --k) p.c[k] = (k > 0 ? p.c[k - 1] : 0) - zero * p.c[k];
  }
  return p;
}

TEST(SignChanges, AreAllFoundForZerosAnywhere) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-1.5, 1.5);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> zeros(1 + trial % 4);
    for (double& zero : zeros) zero = anywhere(random);
    std::sort(zeros.begin(), zeros.end());
    bool apart = true;  // a double zero moves by the square root of round-off
    for (std::size_t i = 1; i < zeros.size(); ++i) apart = apart && zeros[i] - zeros[i - 1] > 1e-2;
    if (!apart) continue;
    std::erase_if(zeros, [](double z) { return std::abs(z) > 1; });
    std::vector<double> all = zeros;
    const SignChanges found = sign_changes(with_zeros(all, trial % 2 ? 1.0 : -3.0));
    ASSERT_EQ(found.n, static_cast<int>(zeros.size()));
    for (int i = 0; i < found.n; ++i) EXPECT_NEAR(found.at[i], zeros[i], 1e-11);
  }
}

TEST(SignChanges, DoNotMindAVanishingLeadingCoefficient) {
  for (const double tiny : {0.0, 1e-300, 1e-17, -1e-17}) {
    Polynomial p;
    p.degree = 3;
    p.c = {0.25, -0.5, tiny, -tiny, 0};
    const SignChanges found = sign_changes(p);
    ASSERT_EQ(found.n, 1);
    EXPECT_NEAR(found.at[0], 0.5, 1e-15);
    EXPECT_TRUE(found.positive);
  }
}

TEST(SignChanges, ZeroAtTheStartCountsAsPositive) {
  Polynomial p;
  p.degree = 1;
  p.c = {-1, -1};
  const SignChanges found = sign_changes(p);
  EXPECT_TRUE(found.positive);
  ASSERT_EQ(found.n, 1);
  EXPECT_EQ(found.at[0], -1);
}

TEST(Minimum, IsFoundInsideAndAtTheEnds) {
  EXPECT_NEAR(minimum(with_zeros({0.3, 0.3}, 1)), 0, 1e-15);
  EXPECT_NEAR(minimum(with_zeros({2}, 1)), -3, 1e-15);
}

template <int D>
void expect_boxes_of_points() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> where(-1, 1);
  for (int n = 1; n < 5; ++n) {
    std::vector<double> points;
    for (int i = 0; i < n * D; ++i) points.push_back(where(random));
    points.insert(points.end(), {-50, 50, -50});  // of others
    Box<D> box = Box<D>::empty();
    for (int i = 0; i < n; ++i) box.add(points.data() + i * D);
    for (int d = 0; d < D; ++d) {
      double low = 2, high = -2;
      for (int i = 0; i < n; ++i) low = std::min(low, points[i * D + d]), high = std::max(high, points[i * D + d]);
      EXPECT_EQ(box.low[d], low);
      EXPECT_EQ(box.high[d], high);
    }
  }
}

TEST(Boxes, ReachFromTheLeastToTheLargestOfTheirPoints) {
  expect_boxes_of_points<2>();
  expect_boxes_of_points<3>();
}

TEST(BoxTree, ReportsWhatALinearScanReports) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> where(0, 1);
  for (const std::size_t n : {0u, 1u, 4u, 5u, 257u, 1000u}) {
    std::vector<Box<3>> boxes(n);
    for (Box<3>& box : boxes) {
      box = Box<3>::empty();
      for (int corner = 0; corner < 2; ++corner) box.add(std::array{where(random), 0.1 * where(random), where(random)}.data());
    }
    const BoxTree<3> tree(boxes);
    for (int trial = 0; trial < 20; ++trial) {
      const double x = where(random), y = 0.1 * where(random);
      const auto touches = [&](const Box<3>& box) {
        return box.low[0] <= x && x <= box.high[0] && box.low[1] <= y && y <= box.high[1];
      };
      std::vector<std::int32_t> found, expected;
      tree.visit(touches, [&](std::int32_t item) { found.push_back(item); });
      for (std::size_t i = 0; i < n; ++i)
        if (touches(boxes[i])) expected.push_back(static_cast<std::int32_t>(i));
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected);
    }
  }
}

/// The places of a facet's reference nodes, times a length, each moved by `shift(k)` in direction k.
template <class Shift>
std::vector<Vec3> facet(CellType type, double length, const Shift& shift) {
  const catalog::CellRow& row = catalog::cell(type);
  std::vector<Vec3> nodes;
  for (int a = 0; a < row.n_nodes; ++a) {
    const double x = shift(0), y = shift(1), z = shift(2);
    nodes.push_back(length * Vec3{row.nodes[2 * a] + x, row.nodes[2 * a + 1] + y, z});
  }
  return nodes;
}

constexpr CellType facets[] = {CellType::TRIA3, CellType::TRIA6, CellType::QUAD4, CellType::QUAD8, CellType::QUAD9};

/// Lines through points of a facet, nearly along z, from somewhere on the line.
struct Aimed {
  std::vector<Vec2> xi;
  std::vector<space::Line> lines;

  Aimed(const space::Map3& map, Family family, double length, std::size_t n, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (std::size_t i = 0; i < n; ++i) {
      Vec2 p{uniform(random), uniform(random)};
      if (family == Family::TRIA) p = {0.5 * (1 + p.x), 0.25 * (1 + p.y) * (1 - p.x)};
      const Vec3 lean{0.1 * uniform(random), 0.1 * uniform(random), 1};
      const Vec3 n_line = (1 / norm(lean)) * lean;
      xi.push_back(p);
      lines.push_back({map(p).x + (length * uniform(random)) * n_line, n_line});
    }
  }
};

// Whatever a facet's size: Newton's quadratic convergence arrives within the steps that eight lines have together.
TEST(Lines, MeetCurvedFacetsWhereTheyAreAimedAt) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.04, 0.04);
  for (const CellType type : facets)
    for (const double length : {1e-5, 1.0, 1e5})
      for (int trial = 0; trial < 20; ++trial) {
        const Family family = catalog::cell(type).family;
        std::vector<Vec3> nodes = facet(type, length, [&](int) { return shift(random); });
        if (type == CellType::QUAD9) nodes[8] = nodes[8] + length * Vec3{0.2, -0.1, 0.1};
        const space::Map3 map = space::interpolate(type, nodes);
        const Aimed aimed(map, family, length, 13, random);
        std::vector<space::Meeting> meetings(13);
        space::meet(map, family, aimed.lines, 1e-12 * length, 0.25, meetings);
        for (std::size_t i = 0; i < 13; ++i) {
          ASSERT_TRUE(meetings[i].found) << catalog::cell(type).name << ' ' << length;
          EXPECT_NEAR(meetings[i].xi.x, aimed.xi[i].x, 1e-10);
          EXPECT_NEAR(meetings[i].xi.y, aimed.xi[i].y, 1e-10);
          const space::Map3::Value at = map(aimed.xi[i]);
          EXPECT_NEAR(meetings[i].jacobian, dot(cross(at.d1, at.d2), aimed.lines[i].n), 1e-9 * length * length);
        }
      }
}

TEST(Lines, DoNotMeetWhatIsBehindAFold) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> shift(-0.7, 0.7);
  int found = 0, aimed_behind = 0;
  for (const CellType type : {CellType::TRIA6, CellType::QUAD8, CellType::QUAD9})
    for (const double length : {1e-5, 1.0, 1e5})
      for (int trial = 0; trial < 100; ++trial) {
        const Family family = catalog::cell(type).family;
        const space::Map3 map = space::interpolate(type, facet(type, length, [&](int k) { return k < 2 ? shift(random) : 0; }));
        const Aimed aimed(map, family, length, 16, random);
        std::vector<space::Meeting> meetings(16);
        space::meet(map, family, aimed.lines, 1e-12 * length, 0.25, meetings);
        const double middle = family == Family::TRIA ? 1.0 / 3 : 0;
        for (std::size_t i = 0; i < 16; ++i) {
          const auto jacobian = [&](Vec2 p) { return dot(cross(map(p).d1, map(p).d2), aimed.lines[i].n); };
          const double there = jacobian({middle, middle});
          aimed_behind += jacobian(aimed.xi[i]) * there < 0;
          if (!meetings[i].found) continue;
          ++found;
          EXPECT_GE(jacobian(meetings[i].xi) * there, -1e-8 * there * there);
        }
      }
  EXPECT_GT(found, 1000);
  EXPECT_GT(aimed_behind, 500);
}

TEST(Facets, AreAffineOrDistortedWhateverTheirSize) {
  const Vec3 up{0, 0, 1};
  for (const double length : {1e-9, 1.0, 1e9}) {
    for (const CellType type : facets) {
      const Family family = catalog::cell(type).family;
      std::vector<Vec3> nodes = facet(type, length, [](int) { return 0; });
      for (Vec3& x : nodes) x = {2 * x.x + 0.5 * x.y, x.y - 0.25 * x.x, 0.3 * x.x};
      const space::Map3 affine = space::interpolate(type, nodes);
      EXPECT_TRUE(space::is_affine(affine, up));
      EXPECT_FALSE(space::is_affine(affine, -1 * up));
      EXPECT_NEAR(space::distortion(affine, family, up), 0, 1e-14);
      EXPECT_EQ(space::distortion(affine, family, -1 * up), 1);
      const space::Map2 flat = space::project(affine, {1, 0, 0}, {0, 1, 0});
      const space::Inverse inverse(flat, family);
      EXPECT_TRUE(inverse.affine());
      const std::optional<Vec2> xi = inverse(flat({0.25, 0.375}).x, 1e-14 * length, 0.25);
      ASSERT_TRUE(xi);
      EXPECT_NEAR(xi->x, 0.25, 1e-14);
      EXPECT_NEAR(xi->y, 0.375, 1e-14);
    }
    for (const double d : {1e-6, 0.1, 0.7}) {
      // J = 1 + d eta, and, along x, J = 1 + d xi of a parabola
      std::vector<Vec3> trapezium = facet(CellType::QUAD4, length, [](int) { return 0; });
      for (Vec3& x : trapezium) x.x *= 1 + d * x.y / length;
      const space::Map3 bilinear = space::interpolate(CellType::QUAD4, trapezium);
      EXPECT_FALSE(space::is_affine(bilinear, up));
      EXPECT_NEAR(space::distortion(bilinear, Family::QUAD, up), d, 1e-14);
      const space::Map2 flat = space::project(bilinear, {1, 0, 0}, {0, 1, 0});
      const space::Inverse inverse(flat, Family::QUAD);
      EXPECT_FALSE(inverse.affine());
      const std::optional<Vec2> xi = inverse(flat({0.25, 0.375}).x, 1e-14 * length, 0.25);
      ASSERT_TRUE(xi);
      EXPECT_NEAR(xi->x, 0.25, 1e-12);
      EXPECT_NEAR(xi->y, 0.375, 1e-12);
      std::vector<Vec3> parabola = facet(CellType::QUAD9, length, [](int) { return 0; });
      for (Vec3& x : parabola) x.x += d * x.x * x.x / (2 * length);
      EXPECT_NEAR(space::distortion(space::interpolate(CellType::QUAD9, parabola), Family::QUAD, up),
                  d < 1e-3 ? d : 2 * d / (1 + d * d), 1e-14);
    }
  }
}

// Whatever the length of the slopes that half-planes have: the strip is a length.
TEST(Regions, AreSeparatedWhereTheyOverlapByNoMoreThanTheWidth) {
  const auto rectangle = [](double from, double to, double slope) {
    space::Region made = region({{from, 0}, {to, 0}, {to, 1}, {from, 1}});
    for (space::HalfPlane& half : made.halves) half.slope = (slope / norm(half.slope)) * half.slope;
    return made;
  };
  for (const double slope : {0.25, 1.0, 4.0})
    for (const double width : {0.0, 1e-6, 0.1})
      for (const double overlap : {-0.5, 0.9 * width, 1.1 * width + 1e-9, 0.5}) {
        const space::Region a = rectangle(0, 1, slope), b = rectangle(1 - overlap, 2, slope);
        EXPECT_EQ(space::separated(a, b, width), overlap <= width) << slope << ' ' << width << ' ' << overlap;
        EXPECT_EQ(space::separated(b, a, width), overlap <= width) << slope << ' ' << width << ' ' << overlap;
      }
}

TEST(NodalNormals, AreRadialOnARegularPolygonAndOnAnArc) {
  const Path circle = [](double a) { return Point{2 * std::cos(a), 2 * std::sin(a)}; };
  for (const Kind kind : {Kind::linear, Kind::quadratic}) {
    Skin skin;
    add_chain(skin, circle, uniform(0, 2, 12), kind);
    const std::vector<double> normals = nodal_normals(skin.view());
    const std::size_t n = skin.coordinates.size() / 3;
    std::vector<int> cells_at(n, 0);
    for (const std::int32_t node : skin.surface.nodes.values) ++cells_at[node];
    for (std::size_t node = 0; node < n; ++node) {
      if (cells_at[node] == 1 && (kind == Kind::linear || node == 0 || node + 2 == n)) continue;  // ends: one cell decides
      EXPECT_NEAR(normals[3 * node], skin.coordinates[3 * node] / 2, 1e-14);
      EXPECT_NEAR(normals[3 * node + 1], skin.coordinates[3 * node + 1] / 2, 1e-14);
    }
  }
}

TEST(NodalNormals, AreZeroWhereTheyCancelAndOffTheSurface) {
  Skin skin;
  const std::int32_t a = skin.add_node({0, 0}), b = skin.add_node({1, 0});
  skin.add_node({5, 5});
  skin.add_cell({a, b});
  skin.add_cell({b, a});
  for (const double n : nodal_normals(skin.view())) EXPECT_EQ(n, 0);
}

TEST(NodalNormals, LeaveASkinInSpace) {
  const std::vector<double> square{0, 0, 1, 2, 0, 1, 2, 2, 1, 0, 2, 1};
  const std::array<double, 2> middle{0, 0};
  const Vec3 normal = cell_normal(CellType::QUAD4, square, middle);
  EXPECT_EQ(normal.x, 0);
  EXPECT_EQ(normal.y, 0);
  EXPECT_EQ(normal.z, 1);
}

TEST(SmallestEdge, IsMeasuredBetweenEnds) {
  Skin skin;
  add_chain(
      skin,
      [](double x) {
        return Point{x, 0};
      },
      {0, 1, 1.25, 3}, Kind::quadratic);
  EXPECT_DOUBLE_EQ(smallest_edge(skin.view()), 0.25);
  EXPECT_EQ(smallest_edge(Surface{}), 0);
}

}  // namespace
}  // namespace lacon::test
