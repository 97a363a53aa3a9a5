// The parts of pairing: polynomials, the box tree, nodal normals.
#include <gtest/gtest.h>

#include <numbers>

#include "lacon/pairing/box_tree.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/pairing/polynomial.hpp"
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
