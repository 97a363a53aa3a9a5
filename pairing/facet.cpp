#include "lacon/pairing/facet.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "lacon/elements/lanes.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed between inlined functions alone

namespace lacon::space {

Map3 interpolate(CellType type, std::span<const Vec3> v) {
  Map3 m;
  switch (type) {
    case CellType::TRIA3:
      m.n = 3;
      m.c[0] = v[0];
      m.c[1] = v[1] - v[0];
      m.c[2] = v[2] - v[0];
      return m;
    case CellType::TRIA6: {
      // differences to the straight facet first, so that mid nodes in the middle give zero to round-off
      const Vec3 b1 = v[3] - 0.5 * (v[0] + v[1]), b2 = v[4] - 0.5 * (v[1] + v[2]), b3 = v[5] - 0.5 * (v[2] + v[0]);
      m.n = 6;
      m.c[0] = v[0];
      m.c[1] = v[1] - v[0] + 4 * b1;
      m.c[2] = v[2] - v[0] + 4 * b3;
      m.c[3] = 4 * (b2 - b1 - b3);
      m.c[4] = -4 * b1;
      m.c[5] = -4 * b3;
      return m;
    }
    default:
      break;
  }
  const Vec3 low = v[1] - v[0], high = v[2] - v[3];
  m.n = 4;
  m.c[0] = 0.25 * ((v[0] + v[2]) + (v[1] + v[3]));
  m.c[1] = 0.25 * (low + high);
  m.c[2] = 0.25 * ((v[3] - v[0]) + (v[2] - v[1]));
  m.c[3] = 0.25 * (high - low);
  if (type == CellType::QUAD4) return m;
  // differences to the bilinear facet: bulges of edges at (0, -1), (1, 0), (0, 1), (-1, 0) and of the middle
  const Vec3 s = v[4] - 0.5 * (v[0] + v[1]), e = v[5] - 0.5 * (v[1] + v[2]), n = v[6] - 0.5 * (v[2] + v[3]),
             w = v[7] - 0.5 * (v[3] + v[0]);
  const Vec3 middle = type == CellType::QUAD9 ? v[8] - m.c[0] : 0.5 * ((s + n) + (e + w));
  m.n = 9;
  m.c[0] = m.c[0] + middle;
  m.c[1] = m.c[1] + 0.5 * (e - w);
  m.c[2] = m.c[2] + 0.5 * (n - s);
  m.c[4] = 0.5 * (e + w) - middle;
  m.c[5] = 0.5 * (n + s) - middle;
  m.c[6] = -0.5 * (n - s);
  m.c[7] = -0.5 * (e - w);
  m.c[8] = middle - 0.5 * ((s + n) + (e + w));
  return m;
}

Map2 project(const Map3& map, Vec3 e1, Vec3 e2) {
  Map2 p;
  p.n = map.n;
  for (int t = 0; t < map.n; ++t) p.c[t] = {dot(map.c[t], e1), dot(map.c[t], e2)};
  return p;
}

namespace {

/// Jacobian over that in the middle: below it a place is behind a fold. A corner where it is zero, and round-off, is not.
constexpr double behind_fold = -1e-9;

/// Newton's method from a reference point. @return the point, and how far its image is from y
std::pair<Vec2, double> approach(const Map2& map, Vec2 p, Vec2 y) {
  Map2::Value v = map(p);
  double residual = norm(y - v.x);
  for (int iteration = 0; iteration < 60 && residual > 0; ++iteration) {
    const Vec2 r = y - v.x;
    const double det = cross(v.d1, v.d2);
    Vec2 step{cross(r, v.d2) / det, cross(v.d1, r) / det};
    if (!std::isfinite(step.x) || !std::isfinite(step.y)) break;
    const double length = std::max(std::abs(step.x), std::abs(step.y));
    if (length > 2) step = (2 / length) * step;
    bool better = false;
    for (int half = 0; half < 8 && !better; ++half, step = 0.5 * step) {
      const Vec2 q = p + step;
      const Map2::Value w = map(q);
      const double left = norm(y - w.x);
      if (!(left < residual)) continue;
      better = true;
      p = q;
      v = w;
      residual = left;
    }
    if (!better) break;                       // round-off
    if (map.n == 3 || length <= 1e-9) break;  // linear, or quadratic: the next step would be below round-off
  }
  return {p, residual};
}

}  // namespace

std::optional<Vec2> inverse(const Map2& map, Family family, Vec2 y, double tolerance, double margin) {
  const std::span<const Vec2> starts = probes(family);
  const auto jacobian = [&](Vec2 p) {
    const Map2::Value v = map(p);
    return cross(v.d1, v.d2);
  };
  const double middle = jacobian(starts.back());
  const auto found = [&](Vec2 start) -> std::optional<Vec2> {
    const auto [p, residual] = approach(map, start, y);
    const bool there = residual <= tolerance && near_reference_cell(family, p, margin) &&
                       (map.n <= 4 || jacobian(p) * middle >= behind_fold * middle * middle);
    return there ? std::optional(p) : std::nullopt;
  };
  if (const std::optional<Vec2> p = found(starts.back())) return p;
  // a strongly bent map is folded close to its cell: the way from the middle may end there, or behind the fold
  if (map.n > 4)
    for (const Vec2 start : starts.first(starts.size() - 1))
      if (const std::optional<Vec2> p = found(start)) return p;
  return std::nullopt;
}

namespace {

using Eight = double __attribute__((vector_size(LACON_LANES * sizeof(double))));
using EightMarks = std::int64_t __attribute__((vector_size(LACON_LANES * sizeof(std::int64_t))));

struct EightVectors {
  Eight x, y, z;
};
[[gnu::always_inline]] inline EightVectors operator-(const EightVectors& a, const EightVectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[gnu::always_inline]] inline EightVectors scaled(const Eight& s, const EightVectors& a) { return {s * a.x, s * a.y, s * a.z}; }
[[gnu::always_inline]] inline Eight dot(const EightVectors& a, const EightVectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline EightVectors cross(const EightVectors& a, const EightVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[gnu::always_inline]] inline void add(EightVectors& sum, const Eight& s, Vec3 c) {
  sum.x += s * c.x;
  sum.y += s * c.y;
  sum.z += s * c.z;
}
[[gnu::always_inline]] inline Eight magnitude(const Eight& a) { return a < 0.0 ? -a : a; }

/// A facet at eight reference points, and how far it is from eight lines there.
struct EightPoints {
  EightVectors d1, d2;
  EightVectors off;  ///< from the facet to the line, at a right angle to it
  Eight off2;        ///< its square

  [[gnu::always_inline]] EightPoints(const Map3& map, const Eight& xi, const Eight& eta, const EightVectors& x,
                                     const EightVectors& n) {
    const Eight zero{}, one = zero + 1.0;
    EightVectors at{zero, zero, zero};
    d1 = d2 = at;
    add(at, one, map.c[0]), add(at, xi, map.c[1]), add(at, eta, map.c[2]);
    add(d1, one, map.c[1]), add(d2, one, map.c[2]);
    if (map.n > 3) add(at, xi * eta, map.c[3]), add(d1, eta, map.c[3]), add(d2, xi, map.c[3]);
    if (map.n > 4) {
      add(at, xi * xi, map.c[4]), add(at, eta * eta, map.c[5]);
      add(d1, 2 * xi, map.c[4]), add(d2, 2 * eta, map.c[5]);
    }
    if (map.n > 6) {
      const Eight xx = xi * xi, yy = eta * eta, xy = xi * eta;
      add(at, xx * eta, map.c[6]), add(at, xi * yy, map.c[7]), add(at, xx * yy, map.c[8]);
      add(d1, 2 * xy, map.c[6]), add(d1, yy, map.c[7]), add(d1, 2 * xi * yy, map.c[8]);
      add(d2, xx, map.c[6]), add(d2, 2 * xy, map.c[7]), add(d2, 2 * xx * eta, map.c[8]);
    }
    const EightVectors to_line = x - at;
    off = to_line - scaled(dot(to_line, n), n);
    off2 = dot(off, off);
  }
};

LACON_KERNEL void meet_eight(const Map3& map, double start, const double* lines, double tolerance, double* met) {
  constexpr int most_steps = 12;  // quadratic convergence needs five or six
  const EightVectors x{lanes(lines, 0), lanes(lines, 1), lanes(lines, 2)}, n{lanes(lines, 3), lanes(lines, 4), lanes(lines, 5)};
  const Eight zero{};
  Eight xi = zero + start, eta = xi;
  EightPoints now(map, xi, eta, x, n);
  EightMarks going = now.off2 > 0.0, well = ~going;  // lanes that still move, lanes that have arrived
  const Eight middle = dot(cross(now.d1, now.d2), n);
  for (int step = 0; step < most_steps; ++step) {
    const Eight scale = 1 / dot(cross(now.d1, now.d2), n);
    const Eight by_xi = scale * dot(cross(now.off, now.d2), n), by_eta = scale * dot(cross(now.d1, now.off), n);
    const Eight a = magnitude(by_xi), b = magnitude(by_eta), length = a > b ? a : b;
    const EightPoints next(map, xi + by_xi, eta + by_eta, x, n);
    const EightMarks better = going & (next.off2 < now.off2) & (length <= 2.0), close = length <= 1e-9;
    well |= going & close;
    xi = better ? xi + by_xi : xi;
    eta = better ? eta + by_eta : eta;
    const auto moved = [&](Eight & old, const Eight& fresh) __attribute__((always_inline)) { old = better ? fresh : old; };
    for (EightVectors* const v : {&now.d1, &now.d2, &now.off}) {
      const EightVectors& w = v == &now.d1 ? next.d1 : v == &now.d2 ? next.d2 : next.off;
      moved(v->x, w.x), moved(v->y, w.y), moved(v->z, w.z);
    }
    moved(now.off2, next.off2);
    going = better & ~close;
    bool any = false;
    for (int lane = 0; lane < LACON_LANES; ++lane) any = any || going[lane] != 0;
    if (!any) break;
  }
  const Eight jacobian = dot(cross(now.d1, now.d2), n);
  if (map.n > 4) well &= jacobian * middle >= behind_fold * middle * middle;
  lanes(met, 0) = (well & (now.off2 <= tolerance * tolerance)) != 0 ? zero + 1.0 : zero;
  lanes(met, 1) = xi;
  lanes(met, 2) = eta;
  lanes(met, 3) = jacobian;
}

}  // namespace

void meet(const Map3& map, Family family, std::span<const Line> lines, double tolerance, double margin,
          std::span<Meeting> meetings) {
  const double start = family == Family::TRIA ? 1.0 / 3 : 0;
  double columns[6 * LACON_LANES], met[4 * LACON_LANES];
  for (std::size_t first = 0; first < lines.size(); first += LACON_LANES) {
    const std::size_t count = std::min<std::size_t>(LACON_LANES, lines.size() - first);
    for (std::size_t lane = 0; lane < LACON_LANES; ++lane) {
      const auto& [x, n] = lines[first + std::min(lane, count - 1)];
      const double values[6] = {x.x, x.y, x.z, n.x, n.y, n.z};
      for (std::size_t i = 0; i < 6; ++i) columns[i * LACON_LANES + lane] = values[i];
    }
    meet_eight(map, start, columns, tolerance, met);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const auto of_lane = [&](std::size_t i) { return met[i * LACON_LANES + lane]; };
      const Vec2 xi{of_lane(1), of_lane(2)};
      meetings[first + lane] = {of_lane(0) != 0 && near_reference_cell(family, xi, margin), xi, of_lane(3)};
    }
  }
}

constexpr double round_off = 1e-13;  // of higher terms, relative to the affine ones
constexpr double bent = 1e-3;        // of quadratic terms: below it a map is inverted as a bilinear one

Inverse::Inverse(const Map2& map, Family family) : map_(map), family_(family) {
  const auto size = [](Vec2 v) { return std::abs(v.x) + std::abs(v.y); };
  double higher = 0;
  for (int k = 3; k < map.n; ++k) higher += size(map.c[k]);
  const Vec2 d1 = map.c[1], d2 = map.c[2];
  jacobian_ = cross(d1, d2);
  row1_ = {d2.y / jacobian_, -d2.x / jacobian_};
  row2_ = {-d1.y / jacobian_, d1.x / jacobian_};
  affine_ = higher <= round_off * (size(d1) + size(d2)) && std::isfinite(size(row1_) + size(row2_));
}

bool is_affine(const Map3& map, Vec3 normal) {
  double higher = 0;
  for (int k = 3; k < map.n; ++k) higher += norm(map.c[k]);
  const double jacobian = dot(cross(map.c[1], map.c[2]), normal);
  return higher * (norm(map.c[1]) + norm(map.c[2])) <= round_off * jacobian && jacobian > 0;
}

double distortion(const Map3& map, Family family, Vec3 normal) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec2 p : probes(family)) {
    const Map3::Value v = map(p);
    const double jacobian = dot(cross(v.d1, v.d2), normal);
    low = std::min(low, jacobian);
    high = std::max(high, jacobian);
  }
  if (!(low > 0)) return 1;
  const double d = (high - low) / (high + low);
  double quadratic = 0;
  for (int k = family == Family::TRIA ? 3 : 4; k < map.n; ++k) quadratic += norm(map.c[k]);
  return quadratic <= bent * (norm(map.c[1]) + norm(map.c[2])) ? d : 2 * d / (1 + d * d);
}

std::vector<Vec3> hull(Family family, int degree, const std::function<Vec3(Vec2)>& polynomial) {
  std::vector<Vec3> net;
  if (family == Family::TRIA) {
    const std::span<const Vec2> p = probes(family);
    for (int i = 0; i < 3; ++i) net.push_back(polynomial(p[i]));
    for (int i = 0; i < 3 && degree == 2; ++i) net.push_back(2 * polynomial(p[3 + i]) - 0.5 * (net[i] + net[(i + 1) % 3]));
    return net;
  }
  // on a line: from values at degree + 1 equidistant points to coefficients
  static constexpr double coefficient[4][4][4] = {
      {},
      {{1, 0}, {0, 1}},
      {{1, 0, 0}, {-1. / 2, 2, -1. / 2}, {0, 0, 1}},
      {{1, 0, 0, 0}, {-5. / 6, 3, -3. / 2, 1. / 3}, {1. / 3, -3. / 2, 3, -5. / 6}, {0, 0, 0, 1}}};
  const auto& c = coefficient[degree];
  const int n = degree + 1;
  std::array<Vec3, 16> value;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) value[j * n + i] = polynomial({2.0 * i / degree - 1, 2.0 * j / degree - 1});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      Vec3 sum{};
      for (int l = 0; l < n; ++l)
        for (int k = 0; k < n; ++k) sum = sum + (c[i][k] * c[j][l]) * value[l * n + k];
      net.push_back(sum);
    }
  return net;
}

std::span<const Vec2> probes(Family family) {
  static constexpr Vec2 triangle[] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}, {1.0 / 3, 1.0 / 3}};
  static constexpr Vec2 square[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, 0}};
  return family == Family::TRIA ? std::span<const Vec2>(triangle) : std::span<const Vec2>(square);
}

}  // namespace lacon::space
