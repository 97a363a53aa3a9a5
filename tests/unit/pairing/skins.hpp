#pragma once
// Skins for the tests of pairing, and what a test measures on contact cells, by formulas of its own.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <tuple>
#include <vector>

#include "lacon/pairing/pairing.hpp"

namespace lacon::test {

using Point = std::array<double, 2>;
using Path = std::function<Point(double)>;

inline Path line(double y, double scale = 1) {
  return [y, scale](double x) { return Point{scale * x, scale * y}; };
}

/// A surface that owns its coordinates.
struct Skin {
  std::vector<double> coordinates;
  std::vector<double> normals;
  Surface surface;

  std::int32_t add_node(Point p) {
    coordinates.insert(coordinates.end(), {p[0], p[1], 0.0});
    return static_cast<std::int32_t>(coordinates.size() / 3) - 1;
  }
  void add_cell(std::vector<std::int32_t> nodes) {
    surface.add_cell(nodes.size() == 2 ? CellType::SEG2 : CellType::SEG3, nodes);
  }
  const Surface& view() {
    surface.coordinates = coordinates;
    surface.normals = normals;
    return surface;
  }
};

enum class Kind { linear, quadratic, mixed };

/// A chain of cells along a path, from parameter to parameter; it runs backwards for the facing skin.
inline void add_chain(Skin& skin, const Path& path, const std::vector<double>& at, Kind kind, std::mt19937* random = nullptr) {
  std::int32_t previous = skin.add_node(path(at[0]));
  for (std::size_t i = 1; i < at.size(); ++i) {
    const std::int32_t next = skin.add_node(path(at[i]));
    const bool quadratic = kind == Kind::quadratic || (kind == Kind::mixed && random && (*random)() % 2 == 0);
    if (quadratic)
      skin.add_cell({previous, next, skin.add_node(path(0.5 * (at[i - 1] + at[i])))});
    else
      skin.add_cell({previous, next});
    previous = next;
  }
}

inline std::vector<double> uniform(double from, double to, int n) {
  std::vector<double> at;
  for (int i = 0; i <= n; ++i) at.push_back(from + (to - from) * i / n);
  return at;
}

/// n + 1 random parameters, the ends included; no cell is shorter than a tenth of the mean.
inline std::vector<double> scattered(double from, double to, int n, std::mt19937& random) {
  std::uniform_real_distribution<double> length(0.1, 1.9);
  std::vector<double> at{0};
  for (int i = 0; i < n; ++i) at.push_back(at.back() + length(random));
  const double total = at.back();
  for (double& a : at) a = from + (to - from) * (a / total);
  at.back() = to;
  return at;
}

/// A random order of cells, and what is where: cell i of the result is cell order[i] of `skin`.
inline Skin permuted(const Skin& skin, std::vector<std::int32_t>& order, std::mt19937& random) {
  order.resize(skin.surface.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  Skin other;
  other.coordinates = skin.coordinates;
  other.normals = skin.normals;
  for (const std::int32_t cell : order) other.surface.add_cell(skin.surface.types[cell], skin.surface.nodes[cell]);
  return other;
}

/// Rejected couples with the numbers of the surfaces that were permuted.
inline std::vector<RejectedCouple> renumbered(std::vector<RejectedCouple> rejected,
                                              const std::vector<std::int32_t>& slave_order,
                                              const std::vector<std::int32_t>& master_order) {
  for (RejectedCouple& couple : rejected) {
    if (couple.slave >= 0) couple.slave = slave_order[couple.slave];
    if (couple.master >= 0) couple.master = master_order[couple.master];
  }
  std::sort(rejected.begin(), rejected.end());
  return rejected;
}

/// Position and derivative at a reference point.
struct Place {
  Point x, dx;
};

inline std::vector<double> shape(CellType type, double xi) {
  if (type == CellType::SEG2) return {0.5 * (1 - xi), 0.5 * (1 + xi)};
  return {0.5 * xi * (xi - 1), 0.5 * xi * (xi + 1), 1 - xi * xi};
}

inline Place place(const Skin& skin, std::int32_t cell, double xi) {
  const CellType type = skin.surface.types[cell];
  const std::vector<double> n = shape(type, xi);
  const std::vector<double> dn =
      type == CellType::SEG2 ? std::vector<double>{-0.5, 0.5} : std::vector<double>{xi - 0.5, xi + 0.5, -2 * xi};
  Place p{};
  for (std::size_t i = 0; i < n.size(); ++i)
    for (int d = 0; d < 2; ++d) {
      p.x[d] += n[i] * skin.coordinates[3 * skin.surface.nodes[cell][i] + d];
      p.dx[d] += dn[i] * skin.coordinates[3 * skin.surface.nodes[cell][i] + d];
    }
  return p;
}

/// The outward unit normal that pairing projects along.
inline Point normal(const Skin& skin, std::int32_t cell, double xi) {
  Point n{};
  if (skin.normals.empty()) {
    const Place p = place(skin, cell, xi);
    n = {p.dx[1], -p.dx[0]};
  } else {
    const std::vector<double> phi = shape(skin.surface.types[cell], xi);
    for (std::size_t i = 0; i < phi.size(); ++i)
      for (int d = 0; d < 2; ++d) n[d] += phi[i] * skin.normals[3 * skin.surface.nodes[cell][i] + d];
  }
  const double length = std::hypot(n[0], n[1]);
  return {n[0] / length, n[1] / length};
}

/// What a point of a contact cell shows.
struct Sample {
  double gap, off_ray, jacobian;
};

inline Sample sample(const Skin& slave, const Skin& master, const ContactCells& cells, std::size_t cell, std::int64_t point) {
  const Place x = place(slave, cells.slave[cell], cells.slave_point[point]);
  const Place y = place(master, cells.master[cell], cells.master_point[point]);
  const Point n = normal(slave, cells.slave[cell], cells.slave_point[point]);
  const Point d{y.x[0] - x.x[0], y.x[1] - x.x[1]};
  return {d[0] * n[0] + d[1] * n[1], std::abs(d[0] * n[1] - d[1] * n[0]), std::hypot(x.dx[0], x.dx[1])};
}

/// Sum over all points of weight times Jacobian times `value`(cell, point).
template <class Value>
double integral(const Skin& slave, const Skin& master, const ContactCells& cells, const Value& value) {
  double sum = 0;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::int64_t g = cells.offset[c]; g < cells.offset[c + 1]; ++g)
      sum += cells.weight[g] * sample(slave, master, cells, c, g).jacobian * value(c, g);
  return sum;
}

/// Covered fraction of each slave cell's reference space.
inline std::vector<double> coverage(const Skin& slave, const ContactCells& cells) {
  std::vector<double> covered(slave.surface.size(), 0.0);
  for (std::size_t c = 0; c < cells.size(); ++c)
    covered[cells.slave[c]] += 0.5 * (cells.vertex[2 * c + 1] - cells.vertex[2 * c]);
  return covered;
}

/// The contact cells as a set: (slave, master, first vertex) -> second vertex, then points and weights.
using CellSet = std::map<std::tuple<std::int32_t, std::int32_t, double>, std::vector<double>>;
inline CellSet as_set(const ContactCells& cells, const std::vector<std::int32_t>& slave_order = {},
                      const std::vector<std::int32_t>& master_order = {}) {
  CellSet set;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::vector<double> data{cells.vertex[2 * c + 1]};
    for (std::int64_t g = cells.offset[c]; g < cells.offset[c + 1]; ++g)
      data.insert(data.end(), {cells.slave_point[g], cells.master_point[g], cells.weight[g]});
    const std::int32_t s = slave_order.empty() ? cells.slave[c] : slave_order[cells.slave[c]];
    const std::int32_t m = master_order.empty() ? cells.master[c] : master_order[cells.master[c]];
    set.emplace(std::tuple(s, m, cells.vertex[2 * c]), data);
  }
  return set;
}

}  // namespace lacon::test
