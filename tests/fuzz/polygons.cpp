#include "polygons.hpp"

#include <algorithm>
#include <cmath>

namespace lacon::fuzz {
namespace {

constexpr double on_border = 1e-11;  // of coordinates of a few hundreds
constexpr double parallel = 1e-12;   // lines of a lesser angle: where they cross is any place

/// Whether a point is in a polygon or on its border.
bool holds(const space::Polygon& polygon, Vec2 p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (cross(edge, p - polygon[i]) < -on_border * std::hypot(edge.x, edge.y)) return false;
  }
  return true;
}

}  // namespace

double area(const space::Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

double common_area(const space::Polygon& a, const space::Polygon& b) {
  space::Polygon corners;
  for (const Vec2 p : a)
    if (holds(b, p)) corners.push_back(p);
  for (const Vec2 p : b)
    if (holds(a, p)) corners.push_back(p);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) {
      const Vec2 p = a[i], q = b[j], u = a[(i + 1) % a.size()] - p, v = b[(j + 1) % b.size()] - q;
      const double across = cross(u, v);
      if (std::abs(across) <= parallel * std::hypot(u.x, u.y) * std::hypot(v.x, v.y)) continue;
      const double s = cross(q - p, v) / across, t = cross(q - p, u) / across;
      if (s >= 0 && s <= 1 && t >= 0 && t <= 1) corners.push_back(p + s * u);
    }
  if (corners.size() < 3) return 0;
  const Vec2 mean = space::middle(corners);
  std::sort(corners.begin(), corners.end(),
            [&](Vec2 p, Vec2 q) { return std::atan2(p.y - mean.y, p.x - mean.x) < std::atan2(q.y - mean.y, q.x - mean.x); });
  for (Vec2& p : corners) p = p - mean;
  return area(corners);
}

}  // namespace lacon::fuzz
