#include "lacon/pairing/chart_points.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "lacon/elements/reference.hpp"

namespace lacon::space {
namespace {

constexpr int largest_degree = 61;  ///< of a rule of 32 points each way, on squares and on triangles

/// Rules by degree: found once, and then without the lock of integration_rule().
class KnownRules {
 public:
  template <class Points>
  const Rule& get(Family family, int degree, const Points& points) {
    if (degree < 0 || degree >= size) return integration_rule(family, points());
    std::atomic<const Rule*>& rule = rules_[static_cast<std::size_t>(degree)];
    if (!rule) rule = &integration_rule(family, points());
    return *rule;
  }

 private:
  static constexpr int size = largest_degree + 1;
  std::array<std::atomic<const Rule*>, size> rules_{};
};

const Rule& triangle_rule(int degree) {
  static KnownRules rules;
  return rules.get(Family::TRIA, degree, [&] {
    const int m = degree / 2 + 1;
    return degree <= 4 ? 6 : degree <= 5 ? 7 : degree <= 6 ? 12 : degree <= 8 ? 16 : m * m;
  });
}

/// The rule of the square that is exact for polynomials of this degree on any convex quadrangle: seen from the square they have
/// the degree in each coordinate, and the Jacobian adds one. That of a parallelogram is constant: there the total degree
/// counts.
const Rule& square_rule(int degree, bool parallelogram) {
  static KnownRules any, parallelograms;
  if (parallelogram && degree <= 5) return parallelograms.get(Family::QUAD, degree, [] { return 7; });
  return any.get(Family::QUAD, degree, [&] {
    const int m = (degree + 3) / 2;
    return m * m;
  });
}

}  // namespace

int integration_degree(const SlaveFacet& slave, const FacetKind& master) {
  const double d = std::min(0.999, std::max(slave.f.distortion, master.distortion));
  const int polynomial = 2 * std::max(slave.f.order, master.order);
  if (d <= 1e-12) return std::max(4, polynomial);
  const double rho = 1 / d + std::sqrt(1 / (d * d) - 1);
  const int degree = polynomial + static_cast<int>(std::ceil(12 * std::numbers::ln10 / std::log(rho)));
  return std::clamp(degree, 4, exact_polygons(slave, master) ? largest_degree : 8);
}

int of_derivatives(CellType slave, CellType master, bool smooth) {
  constexpr int there = 4;  // the least degree that integration_degree() gives
  // shape functions have this degree where they are not those of an affine map
  const auto of_shape = [](CellType type) {
    const catalog::CellRow& cell = catalog::cell(type);
    return type == CellType::QUAD9 ? 4 : cell.family == Family::QUAD ? cell.order + 1 : cell.order;
  };
  // how images slide times what they slide along; the normal's square times the gap
  const int highest = std::max(of_shape(slave), of_shape(master)), of_normal = smooth ? of_shape(slave) : of_shape(slave) - 1;
  return std::max({0, 2 * highest - 1 - there, 2 * of_normal + 1 - there});
}

void place_points(const Polygon& polygon, int degree, bool enough, bool traced, ChartPoints& points) {
  constexpr double round_off = 1e-13, no_area = 1e-15, small = 1e-6;  // the last two: of the area
  points.y.clear();
  points.weight.clear();
  const Rule& triangle = triangle_rule(degree);
  const auto on_triangle = [&](Vec2 a, Vec2 b, Vec2 c, double least) {
    const Vec2 u = b - a, v = c - a;
    const double area = cross(u, v);
    if (!(area > least)) return;
    for (int g = 0; g < triangle.size(); ++g)
      points.add(a + triangle.points[2 * g] * u + triangle.points[2 * g + 1] * v, triangle.weights[g] * area);
  };
  Polygon& corners = points.corners;
  if (enough && !traced && polygon.size() >= 4) {
    const double whole = double_area(polygon);
    corners = polygon;
    for (std::size_t i = 0; i < corners.size() && corners.size() > 3;) {
      const Vec2 a = corners[(i + corners.size() - 1) % corners.size()], b = corners[i], c = corners[(i + 1) % corners.size()];
      if (cross(b - a, c - a) <= small * whole) {
        on_triangle(a, b, c, no_area * whole);
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    if (corners.size() == 4) {
      const Vec2 a = corners[0], b = corners[1], c = corners[2], d = corners[3];
      const Vec2 middle = 0.25 * ((a + c) + (b + d)), s = 0.25 * ((b - a) + (c - d)), t = 0.25 * ((d - a) + (c - b)),
                 st = 0.25 * ((c - d) - (b - a));
      const auto size = [](Vec2 v) { return std::abs(v.x) + std::abs(v.y); };
      const double area = cross(s, t), by_s = cross(s, st), by_t = cross(st, t);
      const Rule& rule = square_rule(degree, size(st) <= round_off * (size(s) + size(t)));
      for (int g = 0; g < rule.size(); ++g) {
        const double x = rule.points[2 * g], y = rule.points[2 * g + 1];
        points.add(middle + x * s + y * t + (x * y) * st, rule.weights[g] * (area + x * by_s + y * by_t));
      }
      return;
    }
    points.y.clear();
    points.weight.clear();
  }
  points.fan.clear();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const std::size_t before = points.weight.size();
    on_triangle(polygon[0], polygon[i - 1], polygon[i], traced ? -std::numeric_limits<double>::infinity() : 0);
    for (std::size_t g = 0; before + g < points.weight.size(); ++g)
      points.fan.push_back(
          {static_cast<std::int32_t>(i), triangle.points[2 * g], triangle.points[2 * g + 1], triangle.weights[g]});
  }
}

}  // namespace lacon::space
