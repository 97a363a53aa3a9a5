#include "lacon/pairing/polygon.hpp"

#include <algorithm>
#include <utility>

namespace lacon::space {

void clip(const Polygon& polygon, const HalfPlane& half, Polygon& inside) {
  inside.clear();
  if (polygon.empty()) return;
  Vec2 before = polygon.back();
  double s_before = half(before);
  for (const Vec2 now : polygon) {
    const double s = half(now);
    if ((s >= 0) != (s_before >= 0)) inside.push_back(before + (s_before / (s_before - s)) * (now - before));
    if (s >= 0) inside.push_back(now);
    before = now;
    s_before = s;
  }
  if (inside.size() < 3) inside.clear();
}

double double_area(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) sum += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return sum;
}

Vec2 middle(const Polygon& polygon) {
  Vec2 sum{};
  for (const Vec2 v : polygon) sum = sum + v;
  return (1.0 / static_cast<double>(polygon.size())) * sum;
}

bool separated(const Region& a, const Region& b, double width) {
  const auto beyond = [width](const Region& p, const Region& q) {
    return std::any_of(p.halves.begin(), p.halves.end(), [&](const HalfPlane& half) {
      const double most = width * width * dot(half.slope, half.slope);
      return std::all_of(q.polygon.begin(), q.polygon.end(), [&](Vec2 y) {
        const double s = half(y);
        return s <= 0 || s * s <= most;
      });
    });
  };
  return beyond(a, b) || beyond(b, a);
}

Region intersection(const Region& a, const Region& b) {
  Region both = a;
  Polygon next;
  for (const HalfPlane& half : b.halves) {
    clip(both.polygon, half, next);
    both.polygon.swap(next);
  }
  both.halves.insert(both.halves.end(), b.halves.begin(), b.halves.end());
  return both;
}

void subtract(const Region& a, const Region& b, double sliver, std::vector<Region>& rest) {
  Region inside = a;
  Polygon outside, next;
  for (const HalfPlane& half : b.halves) {
    clip(inside.polygon, half.opposite(), outside);
    if (double_area(outside) > sliver) {
      rest.push_back({outside, inside.halves});
      rest.back().halves.push_back(half.opposite());
    }
    clip(inside.polygon, half, next);
    inside.polygon.swap(next);
    inside.halves.push_back(half);
  }
}

}  // namespace lacon::space
