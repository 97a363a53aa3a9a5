// How far the edge of a contact that is too large moves at once.
#include "lacon/operators/contact/contact_edge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace lacon {
namespace {

/// Patches in a row, number 0 in the middle of the contact and n at its edge, with the force of pressures beyond radii.
struct Row {
  std::vector<std::vector<std::int32_t>> neighbours;
  std::vector<double> force;
  std::vector<bool> pulled, pressed;

  /// @param beyond force of the pressures between a radius, of 1, and the edge
  Row(int n, const std::function<double(double)>& beyond) {
    for (int i = 0; i < n; ++i) {
      std::vector<std::int32_t>& around = neighbours.emplace_back();
      if (i > 0) around.push_back(i - 1);
      if (i + 1 < n) around.push_back(i + 1);
      force.push_back(beyond(static_cast<double>(i) / n) - beyond((i + 1.0) / n));
      pulled.push_back(force.back() > 0);
      pressed.push_back(force.back() < 0);
    }
  }
  /// Those that stay, of n: the new radius.
  double stays() const {
    double left = 0;
    for (const bool p : pressed) left += p;
    return (left - static_cast<double>(behind_the_edge(neighbours, force, pulled, pressed).size())) /
           static_cast<double>(pressed.size());
  }
};

// A sphere that sticks within the radius 1, under the force that belongs to the radius a: pressures are
// K / sqrt(1 - r^2) - B sqrt(1 - r^2) with K / B = (1 - a^3) / 3. Newton's method for K(c) = 0 goes to 1 / 3 + 2 a^3 / 3 = r^2.
TEST(ContactEdge, GoesWhereNewtonsMethodForTheRadiusOfASphereGoes) {
  for (const double a : {0.95, 0.8, 0.5, 0.1}) {
    const double ratio = (1 - a * a * a) / 3;
    const Row row(200, [&](double r) {
      const double w = std::sqrt(1 - r * r);
      return 2 * M_PI * (ratio * w - w * w * w / 3);
    });
    const double newton = std::sqrt(1.0 / 3 + 2 * a * a * a / 3);
    EXPECT_NEAR(row.stays(), newton, 1.0 / 200) << a;
    EXPECT_GE(row.stays(), a - 1.0 / 200);
  }
}

// A cylinder: K / B = (1 - a^2) / 2. The edge is found to the second order, from outside.
TEST(ContactEdge, OfACylinderIsApproachedFromOutside) {
  for (const double a : {0.95, 0.9, 0.8, 0.5, 0.1}) {
    const double ratio = (1 - a * a) / 2;
    const Row row(200, [&](double r) {
      const double angle = std::acos(r);
      return ratio * angle - (angle - std::sin(angle) * std::cos(angle)) / 2;
    });
    EXPECT_GE(row.stays(), a - 1.0 / 200) << a;
    EXPECT_LE(row.stays(), a + (1 - a) * (1 - a) / 2 + 1.0 / 200) << a;
  }
}

TEST(ContactEdge, StaysWhereNothingPullsOrWhatIsBehindHoldsIt) {
  Row row(10, [](double r) { return -(1 - r * r); });
  EXPECT_TRUE(behind_the_edge(row.neighbours, row.force, row.pulled, row.pressed).empty());
  row.force[9] = 0.1;  // against the next one's -0.19
  row.pulled[9] = true, row.pressed[9] = false;
  EXPECT_TRUE(behind_the_edge(row.neighbours, row.force, row.pulled, row.pressed).empty());
  row.force[9] = 2;  // 2, 1.83, 1.68, 1.55, 1.44, below 1.41 behind the next
  EXPECT_EQ(behind_the_edge(row.neighbours, row.force, row.pulled, row.pressed), (std::vector<std::size_t>{8, 7, 6, 5}));
}

// Two rows that are pulled at together open as one of them does by itself: each patch stands against its part.
TEST(ContactEdge, OfTwoRowsMovesAsThatOfOne) {
  for (const double pull : {0.3, 1.0, 2.0, 3.5}) {
    Row row(10, [](double r) { return -(1 - r * r); });
    row.force[9] = pull;
    row.pulled[9] = true, row.pressed[9] = false;
    Row both = row;
    for (std::size_t i = 0; i < 10; ++i) {
      both.neighbours.push_back(row.neighbours[i]);
      for (std::int32_t& next : both.neighbours.back()) next += 10;
      both.force.push_back(row.force[i]);
      both.pulled.push_back(row.pulled[i]);
      both.pressed.push_back(row.pressed[i]);
    }
    both.neighbours[9].push_back(19);
    both.neighbours[19].push_back(9);
    std::vector<std::size_t> expected = behind_the_edge(row.neighbours, row.force, row.pulled, row.pressed),
                             found = behind_the_edge(both.neighbours, both.force, both.pulled, both.pressed);
    const std::size_t one = expected.size();
    for (std::size_t i = 0; i < one; ++i) expected.push_back(expected[i] + 10);
    std::ranges::sort(expected);
    std::ranges::sort(found);
    EXPECT_EQ(found, expected) << pull;
  }
}

/// An edge that bending moves: the pull of its patch is the moment there, and the next one holds it.
Row bent(std::size_t edge, double moment) {
  Row row(40, [](double) { return 0.0; });
  for (std::size_t i = 0; i < 40; ++i) {
    row.force[i] = i == edge ? moment : i + 1 == edge ? -1.5 * moment : i < edge ? -1e-3 : 0;
    row.pulled[i] = i == edge;
    row.pressed[i] = i < edge;
  }
  return row;
}

// Moments that fall by as much for each patch end where the secant through the last two does.
TEST(ContactEdge, ThatBendingMovesGoesWhereTheSecantDoes) {
  EdgeCourse course;
  const auto opened = [&](std::size_t edge, double moment) {
    const Row row = bent(edge, moment);
    return behind_the_edge(row.neighbours, row.force, row.pulled, row.pressed, &course).size();
  };
  EXPECT_EQ(opened(30, 9), 0);
  EXPECT_EQ(opened(29, 6.5), 1);   // 6.5 / 2.5: two layers
  EXPECT_EQ(opened(27, 2.4), 0);   // 2.4 / 4.1 of two layers: one
  EXPECT_EQ(opened(26, 2.39), 3);  // level: four layers, not more
  EXPECT_EQ(opened(22, 2.5), 0);   // a pull that grows has no zero ahead
  EXPECT_EQ(opened(10, 1), 0);     // another edge
  course = {};
  EXPECT_EQ(opened(9, 0.9), 0);  // another instant
}

}  // namespace
}  // namespace lacon
