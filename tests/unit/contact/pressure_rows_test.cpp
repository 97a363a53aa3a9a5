// How far pressures along rows of patches go up and down.
#include "lacon/operators/contact/pressure_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace lacon {
namespace {

/// (0, 1)^2 in n x n squares, or (0, 1) in n patches.
struct Skin {
  std::vector<std::vector<std::int32_t>> nodes;
  std::vector<Vec3> normals;
  std::vector<double> pressure, area;
  std::vector<bool> whole, pressed;
  std::size_t shared;

  static Skin square(int n, const std::function<double(int i, int j)>& field) {
    Skin skin{.shared = 2};
    const auto node = [&](int i, int j) { return i * (n + 1) + j; };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        skin.add({node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)}, field(i, j), 1.0 / n / n);
    return skin;
  }
  /// @param ends of the patches
  static Skin line(const std::vector<double>& ends, const std::function<double(double from, double to)>& field) {
    Skin skin{.shared = 1};
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const auto node = static_cast<std::int32_t>(i);
      skin.add({node, node + 1}, field(ends[i], ends[i + 1]), ends[i + 1] - ends[i]);
    }
    return skin;
  }
  static std::vector<double> even(int n) {
    std::vector<double> ends;
    for (int i = 0; i <= n; ++i) ends.push_back(static_cast<double>(i) / n);
    return ends;
  }
  void add(std::vector<std::int32_t> of, double value, double size) {
    nodes.push_back(std::move(of));
    normals.push_back({0, 0, 1});
    pressure.push_back(value);
    area.push_back(size);
    whole.push_back(true);
    pressed.push_back(true);
  }
  std::optional<AlternatingPressures> measure() const {
    return PressureRows(nodes, normals, shared).measure(pressure, area, whole, pressed);
  }
  /// @param first patches from here on count
  std::optional<AlternatingPressures> measure_inside(std::size_t first = 0) const {
    std::vector<bool> counting(pressure.size());
    std::fill(counting.begin() + static_cast<std::ptrdiff_t>(first), counting.end(), true);
    return PressureRows(nodes, normals, shared).measure_inside(pressure, area, whole, pressed, counting);
  }
};

double sign(int i) { return i % 2 == 0 ? 1 : -1; }

TEST(PressureRows, AreTheAmplitudeOfWhatChangesItsSignFromPatchToPatch) {
  for (const double a : {0.01, 0.3, 0.9}) {
    const double size = std::sqrt(1 + a * a);
    int at = 0;
    EXPECT_NEAR(Skin::line(Skin::even(12), [&](double, double) { return -65 * (1 + a * sign(at++)); }).measure()->share,
                a / size, 1e-12);
    // a checkerboard in both directions, stripes in one of the two
    EXPECT_NEAR(Skin::square(8, [&](int i, int j) { return -3 * (1 + a * sign(i + j)); }).measure()->share, a / size, 1e-12);
    EXPECT_NEAR(Skin::square(8, [&](int i, int) { return -3 * (1 + a * sign(i)); }).measure()->share, a / size / std::sqrt(2),
                1e-12);
  }
}

TEST(PressureRows, AreNotWhatPressuresVaryByElsewise) {
  const auto share = [](const std::vector<double>& ends, const std::function<double(double x)>& integral) {
    return Skin::line(ends, [&](double from, double to) { return (integral(to) - integral(from)) / (to - from); })
        .measure()
        ->share;
  };
  // patches of any size: what varies linearly has no part
  const std::vector<double> uneven{0, 0.1, 0.15, 0.3, 0.32, 0.4, 0.55, 0.6, 0.7, 0.72, 0.9, 0.97, 1};
  EXPECT_LT(share(uneven, [](double x) { return -3 * x; }), 1e-14);
  EXPECT_LT(share(uneven, [](double x) { return x * x - 3 * x; }), 1e-14);
  for (const int n : {11, 12, 40}) {
    // Hertz, half of it and all; a punch
    EXPECT_LT(share(Skin::even(n), [](double x) { return -(x * std::sqrt(1 - x * x) + std::asin(x)); }), 1e-2);
    EXPECT_LT(
        share(Skin::even(n), [](double x) { return -((2 * x - 1) * std::sqrt(x - x * x) / 2 + std::asin(2 * x - 1) / 4); }),
        1e-2);
    EXPECT_LT(share(Skin::even(n), [](double x) { return -std::acos(1 - 2 * x); }), 1e-2);
  }
}

TEST(PressureRows, CountOpenPatchesBetweenPressedOnesAsSomeWithoutPressure) {
  const auto row = [](int hole, int of = 2, int n = 16) {
    Skin skin = Skin::line(Skin::even(n), [](double, double) { return -1; });
    for (int i = 0; i < n; ++i)
      if (i % of >= hole) skin.pressed[static_cast<std::size_t>(i)] = false;
    return skin;
  };
  // 1, 0, 1, 0: half of the pressure where it presses up and down, over the root of a half
  EXPECT_NEAR(row(1).measure()->share, std::sqrt(0.5), 0.03);
  // 1, 0, 0: differences 1/2, -1/4, -1/4
  EXPECT_NEAR(row(1, 3, 301).measure()->share, std::sqrt((0.125 + 0.125 - 0.0625) / 3 / (1.0 / 3)), 1e-2);
  EXPECT_FALSE(row(1, 4, 301).measure());             // contacts of one patch each
  EXPECT_LT(row(4, 8, 301).measure()->share, 1e-14);  // likewise, of four
  Skin edge = row(99);
  for (const std::size_t p : {0, 1, 2, 14, 15}) edge.pressed[p] = false;  // beside the contact
  EXPECT_LT(edge.measure()->share, 1e-14);
  Skin unseen = row(1);
  for (std::size_t p = 1; p < 16; p += 2) unseen.whole[p] = false;
  EXPECT_FALSE(unseen.measure());
}

// An edge under which the pressure is high, and low beside it; inside, what goes up and down does so for both.
TEST(PressureRows, AreMeasuredWithoutTheEdgesOfAContact) {
  const auto row = [](double edge, double waves) {
    int at = 0;
    return Skin::line(Skin::even(16), [&](double, double) {
      const int from_edge = std::min(at, 15 - at);
      return -1 - (from_edge == 0 ? edge : from_edge == 1 ? -edge / 3 : 0) - waves * sign(at++);
    });
  };
  EXPECT_GT(row(2, 0).measure()->share, 0.1);
  EXPECT_LT(row(2, 0).measure_inside()->share, 0.02);
  EXPECT_NEAR(row(0, 0.3).measure_inside()->share, 0.3 / std::sqrt(1.09), 1e-12);
  const std::size_t patch = row(2, 0.3).measure_inside()->patch;
  EXPECT_TRUE(patch >= 2 && patch < 14) << patch;
  EXPECT_NEAR(row(2, 0.3).measure_inside()->share, 0.3 / std::sqrt(1.09), 0.02);

  // in space rows along an edge are left out as well
  const auto square = [](double edge, double waves) {
    return Skin::square(9, [&](int i, int j) {
      const int from_edge = std::min({i, j, 8 - i, 8 - j});
      return -1 - (from_edge < 2 ? edge * sign(i + j) : waves * sign(i + j));
    });
  };
  EXPECT_GT(square(0.5, 0).measure()->share, 0.3);
  EXPECT_LT(square(0.5, 0).measure_inside()->share, 0.2);  // what differs beside it, at the middle of a line
  EXPECT_NEAR(square(0.3, 0.3).measure_inside()->share, 0.3 / std::sqrt(1.09), 2e-2);
}

TEST(PressureRows, AreMeasuredOverPatchesThatCount) {
  int at = 0;
  const Skin skin = Skin::line(Skin::even(40), [&](double from, double) { return from < 0.5 ? -1 : -1 - 0.3 * sign(at++); });
  EXPECT_EQ(skin.measure_inside(24)->by, AlternatingBy::rows);
  EXPECT_NEAR(skin.measure_inside(24)->share, 0.3 / std::sqrt(1.09), 1e-2);
  EXPECT_LT(skin.measure()->share, 0.25);
  EXPECT_EQ(skin.measure()->by, AlternatingBy::facets);
  EXPECT_FALSE(skin.measure_inside(32));  // 32 to 37: five couples
  EXPECT_TRUE(skin.measure_inside(29));   // eight
  EXPECT_FALSE(skin.measure_inside(30));
}

TEST(PressureRows, EndAtEdgesOfBodies) {
  Skin skin = Skin::line(Skin::even(20), [](double from, double) { return from < 0.45 ? -1 : -3; });
  const auto share = [&](double degrees) {
    for (std::size_t p = 10; p < 20; ++p) skin.normals[p] = {std::sin(degrees / 57.3), 0, std::cos(degrees / 57.3)};
    return skin.measure().value().share;
  };
  EXPECT_GT(share(0), 0.01);
  EXPECT_EQ(share(50), share(0));
  EXPECT_EQ(share(90), 0);
}

TEST(PressureRows, NeedRowsThatAreLongEnoughAndNoTriangles) {
  EXPECT_FALSE(Skin::line(Skin::even(10), [](double, double) { return -1; }).measure());  // seven couples
  EXPECT_TRUE(Skin::line(Skin::even(11), [](double, double) { return -1; }).measure());
  Skin triangles{.shared = 2};
  const auto node = [&](int i, int j) { return i * 9 + j; };
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      for (const bool upper : {false, true})
        triangles.add({node(i, j), node(i + 1, j + 1), upper ? node(i, j + 1) : node(i + 1, j)}, upper ? -1.5 : -0.5, 1);
  EXPECT_FALSE(triangles.measure());
}

}  // namespace
}  // namespace lacon
