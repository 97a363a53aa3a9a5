// Common parts and differences of convex polygons against sums over corners and crossings.
#include <algorithm>
#include <cmath>

#include "../unit/pairing/region.hpp"
#include "fuzz.hpp"
#include "polygons.hpp"

namespace lacon::fuzz {
namespace {

constexpr double box = 256.0 * 256.0;      // holds every polygon
constexpr double round_off = 1e-12 * box;  // of areas

/// The convex hull of some points of a lattice: nothing where these lie on a line.
space::Polygon hull(Choices& choices) {
  space::Polygon points;
  for (int n = choices.between(3, 8); n > 0; --n) {
    const double x = choices.byte() - 128, y = choices.byte() - 128;
    points.push_back({x, y});
  }
  std::sort(points.begin(), points.end(), [](Vec2 p, Vec2 q) { return p.x != q.x ? p.x < q.x : p.y < q.y; });
  space::Polygon around;
  for (int side = 0; side < 2; ++side, std::reverse(points.begin(), points.end())) {
    const std::size_t first = around.size();
    for (const Vec2 p : points) {
      while (around.size() >= first + 2 && cross(around.back() - around[around.size() - 2], p - around.back()) <= 0)
        around.pop_back();
      around.push_back(p);
    }
    around.pop_back();
  }
  return around;
}

bool same(double a, double b) { return std::abs(a - b) <= round_off; }

}  // namespace

void clipping(Bytes input) {
  Choices choices(input);
  const space::Polygon p = hull(choices), q = hull(choices);
  if (p.size() < 3 || q.size() < 3) return;
  const space::Region a = test::region(p), b = test::region(q);
  const double common = common_area(p, q);
  expect(same(0.5 * space::double_area(p), area(p)), "the area of a polygon");
  expect(same(0.5 * space::double_area(space::intersection(a, b).polygon), common), "the area of a common part");
  if (space::separated(a, b, 0)) expect(same(common, 0), "polygons that are separated share nothing");
  std::vector<space::Region> rest;
  space::subtract(a, b, 0, rest);
  double sum = common;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    sum += area(rest[i].polygon);
    expect(same(common_area(rest[i].polygon, q), 0), "what is left shares nothing with what was taken");
    for (std::size_t j = 0; j < i; ++j)
      expect(same(common_area(rest[i].polygon, rest[j].polygon), 0), "parts that are left share nothing");
  }
  expect(same(sum, area(p)), "what is taken and what is left make up the whole");
}

}  // namespace lacon::fuzz
