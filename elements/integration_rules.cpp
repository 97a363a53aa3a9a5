// Integration rules of the reference cells.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "lacon/elements/reference.hpp"

namespace lacon {

namespace {

/// Value and derivative of the Jacobi polynomial P_n^(a, 0).
std::pair<double, double> jacobi_polynomial(int n, int a, double x) {
  double before = 1, now = 0.5 * (a + (a + 2) * x), slope_before = 0, slope = 0.5 * (a + 2);
  if (n == 0) return {1, 0};
  for (int k = 1; k < n; ++k) {
    const double s = 2 * k + a;
    const double c1 = 2 * (k + 1) * (k + a + 1) * s, c2 = (s + 1) * a * a, c3 = s * (s + 1) * (s + 2),
                 c4 = 2 * (k + a) * k * (s + 2);
    const double next = ((c2 + c3 * x) * now - c4 * before) / c1;
    const double next_slope = ((c2 + c3 * x) * slope + c3 * now - c4 * slope_before) / c1;
    before = std::exchange(now, next);
    slope_before = std::exchange(slope, next_slope);
  }
  return {now, slope};
}

/// The n-point Gauss rule on [-1, 1] with the weight (1 - x)^a, by Newton on the roots not found yet.
Rule gauss_jacobi(int n, int a) {
  Rule rule{1, std::vector<double>(static_cast<std::size_t>(n)), std::vector<double>(static_cast<std::size_t>(n))};
  for (int i = 0; i < n; ++i) {
    double x = -std::cos((2 * i + 1) * std::numbers::pi / (2 * n));
    if (i > 0) x = 0.5 * (x + rule.points[static_cast<std::size_t>(i - 1)]);
    for (int step = 0; step < 100; ++step) {
      const auto [value, slope] = jacobi_polynomial(n, a, x);
      double found = 0;
      for (int j = 0; j < i; ++j) found += 1 / (x - rule.points[static_cast<std::size_t>(j)]);
      const double change = value / (slope - value * found);
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    const double slope = jacobi_polynomial(n, a, x).second;
    rule.points[static_cast<std::size_t>(i)] = x;
    rule.weights[static_cast<std::size_t>(i)] = std::exp2(a + 1) / ((1 - x * x) * slope * slope);
  }
  if (a == 0)  // symmetric to the last bit
    for (std::size_t i = 0, j = rule.points.size() - 1; i <= j && j < rule.points.size(); ++i, --j) {
      const double x = 0.5 * (rule.points[j] - rule.points[i]), w = 0.5 * (rule.weights[i] + rule.weights[j]);
      rule.points[i] = -x;
      rule.points[j] = x;
      rule.weights[i] = rule.weights[j] = w;
    }
  return rule;
}

/// The same on [0, 1].
Rule on_unit_interval(Rule rule, int a) {
  for (double& x : rule.points) x = 0.5 * (1 + x);
  for (double& w : rule.weights) w *= std::exp2(-a - 1);
  return rule;
}

/// Every point of `first` with every point of `second`; the coordinates of `first` come first and vary fastest.
Rule product(const Rule& first, const Rule& second) {
  Rule rule{first.dimension + second.dimension, {}, {}};
  for (std::size_t j = 0; j < second.weights.size(); ++j)
    for (std::size_t i = 0; i < first.weights.size(); ++i) {
      const auto d1 = first.dimension, d2 = second.dimension;
      rule.points.insert(rule.points.end(), first.points.begin() + static_cast<long>(i) * d1,
                         first.points.begin() + static_cast<long>(i + 1) * d1);
      rule.points.insert(rule.points.end(), second.points.begin() + static_cast<long>(j) * d2,
                         second.points.begin() + static_cast<long>(j + 1) * d2);
      rule.weights.push_back(first.weights[i] * second.weights[j]);
    }
  return rule;
}

/// A product rule drawn together to a point: (x, ..., t) -> ((1 - t) x, ..., t), with the weight (1 - t)^(dimension - 1) in
/// `axis`.
Rule cone(const Rule& base, const Rule& axis) {
  Rule rule = product(base, axis);
  for (std::size_t p = 0; p < rule.weights.size(); ++p) {
    const std::size_t last = p * static_cast<std::size_t>(rule.dimension) + static_cast<std::size_t>(base.dimension);
    for (std::size_t c = last - static_cast<std::size_t>(base.dimension); c < last; ++c)
      rule.points[c] *= 1 - rule.points[last];
  }
  return rule;
}

/// Points of a simplex that differ by a permutation of their barycentric coordinates.
struct Orbit {
  double weight;  ///< of each point, the simplex having the measure 1
  std::array<double, 4> barycentric;
};

/// A symmetric rule on the reference triangle (dimension 2) or tetrahedron (3); the point nearest to node 1 comes first.
Rule symmetric(int dimension, std::initializer_list<Orbit> orbits) {
  Rule rule{dimension, {}, {}};
  const double measure = dimension == 2 ? 1.0 / 2 : 1.0 / 6;
  for (const Orbit& orbit : orbits) {
    std::vector<double> b(orbit.barycentric.begin(), orbit.barycentric.begin() + dimension + 1);
    std::sort(b.begin(), b.end(), std::greater<>());
    do {
      rule.points.insert(rule.points.end(), b.begin() + 1, b.end());
      rule.weights.push_back(orbit.weight * measure);
    } while (std::prev_permutation(b.begin(), b.end()));
  }
  return rule;
}

/// An orbit whose coordinates are all `a` but the last, which makes the sum 1.
Orbit orbit(double weight, int dimension, double a) {
  Orbit o{weight, {a, a, a, a}};
  const double last = 1 - dimension * a;
  if (std::abs(last - a) > 1e-15) o.barycentric[static_cast<std::size_t>(dimension)] = last;  // else the centre: one point
  return o;
}

/// Triangle. 1, 3, 6, 7 points (degrees 1, 2, 4, 5) in closed form, 12 and 16 (6, 8) from Dunavant's tables, other squares m^2
/// (degree 2 m - 1) as a cone.
Rule triangle_rule(int n) {
  const double r10 = std::sqrt(10.0), r15 = std::sqrt(15.0);
  switch (n) {
    case 1:
      return symmetric(2, {orbit(1, 2, 1.0 / 3)});
    case 3:
      return symmetric(2, {orbit(1.0 / 3, 2, 1.0 / 6)});
    case 6: {
      const double d = std::sqrt(38 - 44 * std::sqrt(0.4)), e = std::sqrt(213125 - 53320 * r10);
      return symmetric(2, {orbit((620 + e) / 3720, 2, (8 - r10 + d) / 18), orbit((620 - e) / 3720, 2, (8 - r10 - d) / 18)});
    }
    case 7:
      return symmetric(2, {orbit(9.0 / 40, 2, 1.0 / 3), orbit((155 + r15) / 1200, 2, (6 + r15) / 21),
                           orbit((155 - r15) / 1200, 2, (6 - r15) / 21)});
    case 12:
      return symmetric(2, {orbit(0.116786275726379366, 2, 0.249286745170910421),
                           orbit(0.050844906370206817, 2, 0.063089014491502227),
                           {0.082851075618373575, {0.053145049844816947, 0.310352451033784405, 0.636502499121398648, 0}}});
    case 16:
      return symmetric(2, {orbit(0.144315607677787168, 2, 1.0 / 3),
                           orbit(0.095091634267284625, 2, 0.459292588292723156),
                           orbit(0.103217370534718250, 2, 0.170569307751760206),
                           orbit(0.032458497623198080, 2, 0.050547228317030975),
                           {0.027230314174434994, {0.008394777409957605, 0.263112829634638113, 0.728492392955404281, 0}}});
    default: {
      const int m = static_cast<int>(std::lround(std::sqrt(n)));
      if (m < 2 || m * m != n) return {};
      return cone(on_unit_interval(gauss_jacobi(m, 0), 0), on_unit_interval(gauss_jacobi(m, 1), 1));
    }
  }
}

/// Square: Radon's 7 points of degree 5, and products of Gauss rules, m^2 points exact to degree 2 m - 1 in each coordinate.
Rule square_rule(int n) {
  if (n == 7) {
    const double a = std::sqrt(14.0 / 15), b = std::sqrt(3.0 / 5), c = std::sqrt(1.0 / 3), wa = 20.0 / 63, wb = 5.0 / 9;
    return {2, {-b, -c, b, -c, 0, -a, 0, 0, 0, a, -b, c, b, c}, {wb, wb, wa, 8.0 / 7, wa, wb, wb}};
  }
  const int m = static_cast<int>(std::lround(std::sqrt(n)));
  return m * m == n ? product(gauss_rule(m), gauss_rule(m)) : Rule{};
}

/// Tetrahedron: degrees 1, 2, 3 (whose central weight is negative) and 5.
Rule tetrahedron_rule(int n) {
  const double r5 = std::sqrt(5.0), r15 = std::sqrt(15.0);
  switch (n) {
    case 1:
      return symmetric(3, {orbit(1, 3, 0.25)});
    case 4:
      return symmetric(3, {orbit(0.25, 3, (5 - r5) / 20)});
    case 5:
      return symmetric(3, {orbit(-0.8, 3, 0.25), orbit(0.45, 3, 1.0 / 6)});
    case 15: {
      const double a = (5 - r15) / 20, b = (5 + r15) / 20;
      return symmetric(3, {orbit(16.0 / 135, 3, 0.25),
                           orbit((2665 - 14 * r15) / 37800, 3, (7 + r15) / 34),
                           orbit((2665 + 14 * r15) / 37800, 3, (7 - r15) / 34),
                           {10.0 / 189, {a, a, b, b}}});
    }
    default:
      return {};
  }
}

/// Pyramid: 5 points of degree 2 in closed form, m^3 of degree 2 m - 1 as a cone.
Rule pyramid_rule(int n) {
  if (n == 5) {
    const double low = (10 - std::sqrt(15.0)) / 40, high = (1 + 4 * std::sqrt(0.15)) / 4, w = 4.0 / 15;
    return {3, {-0.5, -0.5, low, 0.5, -0.5, low, 0.5, 0.5, low, -0.5, 0.5, low, 0, 0, high}, {w, w, w, w, w}};
  }
  const int m = static_cast<int>(std::lround(std::cbrt(n)));
  if (m * m * m != n) return {};
  return cone(product(gauss_rule(m), gauss_rule(m)), on_unit_interval(gauss_jacobi(m, 2), 2));
}

/// The rule, empty where there is none.
Rule make_rule(Family family, int n) {
  const int cube = static_cast<int>(std::lround(std::cbrt(n)));
  switch (family) {
    case Family::POINT:
      return n == 1 ? Rule{0, {}, {1.0}} : Rule{};
    case Family::SEG:
      return gauss_rule(n);
    case Family::TRIA:
      return triangle_rule(n);
    case Family::QUAD:
      return square_rule(n);
    case Family::TETRA:
      return tetrahedron_rule(n);
    case Family::PENTA:
      if (n == 6) return product(triangle_rule(3), gauss_rule(2));
      if (n == 21) return product(triangle_rule(7), gauss_rule(3));
      return {};
    case Family::PYRAM:
      return pyramid_rule(n);
    case Family::HEXA:
      return cube * cube * cube == n ? product(integration_rule(Family::QUAD, cube * cube), gauss_rule(cube)) : Rule{};
  }
  return {};
}

/// Rules that were made, at addresses that stay.
template <class Key>
class Cache {
 public:
  template <class Make>
  const Rule& get(const Key& key, Make make) {
    {
      const std::scoped_lock lock(mutex_);
      if (const auto found = rules_.find(key); found != rules_.end()) return found->second;
    }
    Rule rule = make();  // outside the lock: a rule may need others
    const std::scoped_lock lock(mutex_);
    return rules_.try_emplace(key, std::move(rule)).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<Key, Rule> rules_;
};

constexpr int max_gauss = 32;

}  // namespace

const Rule& integration_rule(Family family, int n_points) {
  static Cache<std::pair<Family, int>> cache;
  return cache.get({family, n_points}, [&] {
    Rule rule = n_points < 1 || n_points > max_gauss * max_gauss * max_gauss ? Rule{} : make_rule(family, n_points);
    if (rule.weights.empty())
      throw std::logic_error("no integration rule of " + std::to_string(n_points) + " points for the family " +
                             std::to_string(static_cast<int>(family)));
    return rule;
  });
}

const Rule& gauss_rule(int n_points) {
  static Cache<int> cache;
  if (n_points < 1 || n_points > max_gauss) throw std::logic_error("no Gauss rule of " + std::to_string(n_points) + " points");
  return cache.get(n_points, [&] { return gauss_jacobi(n_points, 0); });
}

}  // namespace lacon
