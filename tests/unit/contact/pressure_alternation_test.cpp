// How far pressures of triangular patches alternate.
#include "lacon/operators/contact/pressure_alternation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lacon {
namespace {

/// The square (0, 1)^2 in n x n squares of two triangles each, all diagonals alike: six triangles around each inner vertex.
struct Square {
  std::vector<std::vector<std::int32_t>> corners;
  std::vector<double> pressure, area;
  std::vector<bool> pressed;

  /// @param field of the middle of a triangle, and whether it is an upper one
  Square(int n, const std::function<double(double x, double y, bool upper)>& field) {
    const auto node = [&](int i, int j) { return i * (n + 1) + j; };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (const bool upper : {false, true}) {
          corners.push_back({node(i, j), node(i + 1, j + 1), upper ? node(i, j + 1) : node(i + 1, j)});
          pressure.push_back(field((i + (upper ? 1 : 2) / 3.0) / n, (j + (upper ? 2 : 1) / 3.0) / n, upper));
          area.push_back(0.5 / n / n);
          pressed.push_back(true);
        }
  }
  std::optional<AlternatingPressures> measure() const {
    return PressureAlternation(corners).measure(pressure, area, pressed, pressed);
  }
  /// Open ones count.
  std::optional<AlternatingPressures> measure_all() const {
    return PressureAlternation(corners).measure(pressure, area, std::vector<bool>(pressed.size(), true), pressed);
  }
};

TEST(PressureAlternation, IsTheAmplitudeOfWhatNoVertexFeels) {
  for (const double amplitude : {0.01, 0.3, 0.9}) {
    Square square(6, [&](double, double, bool upper) { return -65 * (1 + (upper ? amplitude : -amplitude)); });
    const auto found = square.measure();
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->share, amplitude / std::sqrt(1 + amplitude * amplitude), 1e-12);
    square.pressure[60] *= 1.5;  // of the square (5, 0), all of its vertices on the border: no part of it
    EXPECT_NEAR(square.measure()->share, found->share, 1e-12);
    square.pressure[43] *= 2;  // the upper one of the square (3, 3)
    EXPECT_EQ(square.measure()->patch, 43U);
  }
}

TEST(PressureAlternation, IsNotWhatPressuresVaryByElsewise) {
  const auto share = [](const Square& square) { return square.measure().value().share; };
  EXPECT_LT(share(Square(8, [](double, double, bool) { return -3; })), 1e-14);
  EXPECT_LT(share(Square(8, [](double x, double y, bool) { return 2 * x - y - 3; })), 1e-14);
  EXPECT_LT(share(Square(8, [](double x, double y, bool) { return x * x + 2 * y * y - x * y - 3; })), 1e-2);
  // Hertz, and the edges of a punch
  EXPECT_LT(share(Square(8, [](double x, double y, bool) { return -std::sqrt(2.01 - x * x - y * y); })), 1e-2);
  EXPECT_LT(share(Square(8, [](double x, double y, bool) { return -1 / std::sqrt(x * (1 - y)); })), 1e-2);
}

TEST(PressureAlternation, IsOfPatchesInTheMiddleOfTheContact) {
  const auto field = [](double, double, bool upper) { return upper ? -1.5 : -0.5; };
  EXPECT_FALSE(Square(3, field).measure());  // two patches have three vertices inside
  Square square(6, field);
  ASSERT_TRUE(square.measure());
  const double share = square.measure()->share;
  for (std::size_t p = 0; p < 24; ++p) square.pressed[p] = false;  // two columns: three are left, and two of vertices inside
  for (std::size_t p = 0; p < 24; ++p) square.pressure[p] = 1e9;
  ASSERT_TRUE(square.measure());
  EXPECT_NEAR(square.measure()->share, share, 1e-12);
  square.pressed.assign(square.pressed.size(), false);
  EXPECT_FALSE(square.measure());
}

TEST(PressureAlternation, TellsTrianglesThatPressAloneFromContactsThatEnd) {
  // one of two, of four and of six
  for (const int every : {1, 2, 3}) {
    Square square(12, [](double, double, bool) { return -7; });
    for (std::size_t p = 0; p < square.pressed.size(); ++p) square.pressed[p] = p % 2 == 1 && (p / 2) % every == 0;
    const auto found = square.measure_all();
    ASSERT_TRUE(found);
    EXPECT_GT(found->share, 0.45) << every;
    EXPECT_LT(found->pressing, 0.51);
    EXPECT_FALSE(square.measure());
  }
  // contacts that end inside the skin, smoothly or not
  const auto share = [](const std::function<double(double)>& pressure, double radius) {
    Square square(12, [&](double x, double y, bool) { return -pressure(std::hypot(x - 0.52, y - 0.47) / radius); });
    for (std::size_t p = 0; p < square.pressed.size(); ++p) square.pressed[p] = square.pressure[p] < 0;
    const AlternatingPressures found = square.measure_all().value();
    EXPECT_GT(found.pressing, 0.8) << radius;
    return found.share;
  };
  for (const double radius : {0.12, 0.2, 0.3, 0.4}) {
    EXPECT_LT(share([](double r) { return std::sqrt(std::max(1 - r * r, 0.0)); }, radius), 0.01) << radius;
    EXPECT_LT(share([](double r) { return r < 1 ? 1.0 : 0; }, radius), 0.1) << radius;
    EXPECT_LT(share([](double r) { return r < 1 ? 1 / std::sqrt(1.02 - r * r) : 0; }, radius), 0.4) << radius;
  }
}

TEST(PressureAlternation, IsMeasuredOnTrianglesAlone) {
  Square square(6, [](double, double, bool upper) { return upper ? -1.5 : -0.5; });
  for (std::vector<std::int32_t>& corners : square.corners) corners.push_back(1000 + corners[0]);  // a fourth one
  EXPECT_FALSE(square.measure());
}

}  // namespace
}  // namespace lacon
