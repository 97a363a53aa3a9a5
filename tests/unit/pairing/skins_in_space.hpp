#pragma once
// Skins in space for the tests of pairing, and what a test measures on contact cells, by formulas of its own. The slave is the
// lower skin of a body above it, its outward normal points down; masters look up.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "lacon/elements/reference.hpp"
#include "lacon/pairing/facet.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/pairing/pairing.hpp"

namespace lacon::test {

using Place3 = std::function<Vec3(double, double)>;

struct Skin3 {
  std::vector<double> coordinates, normals;
  Surface surface;

  const Surface& view() {
    surface.dimension = 3;
    surface.coordinates = coordinates;
    surface.normals = normals;
    return surface;
  }
  std::int32_t add_node(Vec3 p) {
    coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
    return static_cast<std::int32_t>(coordinates.size() / 3) - 1;
  }
  Vec3 node(std::int32_t i) const { return {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]}; }
  std::size_t n_nodes() const { return coordinates.size() / 3; }
};

inline constexpr CellType kinds[] = {CellType::TRIA3, CellType::TRIA6, CellType::QUAD4, CellType::QUAD8, CellType::QUAD9};

struct Grid {
  int nx = 3, ny = 3;
  CellType type = CellType::QUAD4;
  bool up = true;     ///< normals look along +z
  double jitter = 0;  ///< of inner nodes, in units of the mesh size
  double x0 = 0, x1 = 1, y0 = 0, y1 = 1;
};

/// Add the cells of another skin, with nodes of their own.
inline void append(Skin3& skin, const Skin3& other) {
  const auto shift = static_cast<std::int32_t>(skin.n_nodes());
  skin.coordinates.insert(skin.coordinates.end(), other.coordinates.begin(), other.coordinates.end());
  for (std::size_t c = 0; c < other.surface.size(); ++c) {
    std::vector<std::int32_t> nodes(other.surface.nodes[c].begin(), other.surface.nodes[c].end());
    for (std::int32_t& n : nodes) n += shift;
    skin.surface.add_cell(other.surface.types[c], nodes);
  }
}

/// A mesh of a rectangle, mapped by `place`; mid nodes are mapped too if `curved`, else they lie in the middle of edges.
inline Skin3 mesh(const Grid& g, const Place3& place, std::mt19937& random, bool curved = false) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Vec2> at;
  const double hx = (g.x1 - g.x0) / g.nx, hy = (g.y1 - g.y0) / g.ny;
  for (int j = 0; j <= g.ny; ++j)
    for (int i = 0; i <= g.nx; ++i) {
      Vec2 p{g.x0 + hx * i, g.y0 + hy * j};
      if (i > 0 && i < g.nx) p.x += g.jitter * hx * uniform(random);
      if (j > 0 && j < g.ny) p.y += g.jitter * hy * uniform(random);
      at.push_back(p);
    }
  Skin3 skin;
  for (const Vec2 p : at) skin.add_node(place(p.x, p.y));
  std::map<std::vector<std::int32_t>, std::int32_t> mids;
  const auto middle = [&](std::vector<std::int32_t> ends) {
    std::sort(ends.begin(), ends.end());
    const auto [found, isnew] = mids.try_emplace(ends, 0);
    if (isnew) {
      Vec2 p{};
      Vec3 x{};
      for (const std::int32_t n : ends) {
        p = p + (1.0 / static_cast<double>(ends.size())) * at[n];
        x = x + (1.0 / static_cast<double>(ends.size())) * skin.node(n);
      }
      found->second = skin.add_node(curved ? place(p.x, p.y) : x);
    }
    return found->second;
  };
  const auto add = [&](std::vector<std::int32_t> corners) {
    if (!g.up) std::reverse(corners.begin(), corners.end());
    std::vector<std::int32_t> nodes = corners;
    if (catalog::cell(g.type).order == 2)
      for (std::size_t i = 0; i < corners.size(); ++i) nodes.push_back(middle({corners[i], corners[(i + 1) % corners.size()]}));
    if (g.type == CellType::QUAD9) nodes.push_back(middle(corners));
    skin.surface.add_cell(g.type, nodes);
  };
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const std::int32_t a = j * (g.nx + 1) + i, b = a + 1, c = b + g.nx + 1, d = c - 1;
      if (catalog::cell(g.type).family == Family::QUAD) {
        add({a, b, c, d});
      } else if (random() % 2 == 0) {
        add({a, b, c});
        add({a, c, d});
      } else {
        add({a, b, d});
        add({b, c, d});
      }
    }
  return skin;
}

/// Moves mid nodes along their straight edges by up to `most` of the edge, middles of QUAD9 by as much in the facet.
inline void slide_mid_nodes(Skin3& skin, double most, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-most, most);
  std::map<std::int32_t, Vec3> moved;
  for (std::size_t c = 0; c < skin.surface.size(); ++c) {
    const auto nodes = skin.surface.nodes[c];
    const int n = catalog::cell(skin.surface.types[c]).n_vertices;
    const auto edge = [&](int i) { return skin.node(nodes[(i + 1) % n]) - skin.node(nodes[i]); };
    for (int i = n; i < static_cast<int>(nodes.size()); ++i) {
      const Vec3 by = i < 2 * n ? uniform(random) * edge(i - n) : uniform(random) * edge(0) + uniform(random) * edge(1);
      moved.try_emplace(nodes[i], skin.node(nodes[i]) + by);
    }
  }
  for (const auto& [node, p] : moved) {
    double* const q = skin.coordinates.data() + 3 * static_cast<std::size_t>(node);
    q[0] = p.x, q[1] = p.y, q[2] = p.z;
  }
}

/// Every cell by itself and cell order mixed: cell i of the result is cell order[i].
inline Skin3 permuted(const Skin3& skin, std::vector<std::int32_t>& order, std::mt19937& random) {
  order.resize(skin.surface.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
  std::shuffle(order.begin(), order.end(), random);
  Skin3 other;
  other.coordinates = skin.coordinates;
  other.normals = skin.normals;
  for (const std::int32_t c : order) other.surface.add_cell(skin.surface.types[c], skin.surface.nodes[c]);
  return other;
}

/// Rotations about z and x, a scale, a shift.
struct Motion {
  double angle = 0, tilt = 0, scale = 1;
  Vec3 shift{};
  void operator()(Skin3& skin) const {
    const double c = std::cos(angle), s = std::sin(angle), ct = std::cos(tilt), st = std::sin(tilt);
    for (std::size_t i = 0; i < skin.coordinates.size(); i += 3) {
      double* q = skin.coordinates.data() + i;
      const double x = c * q[0] - s * q[1], y = s * q[0] + c * q[1], z = q[2];
      q[0] = scale * x + shift.x;
      q[1] = scale * (ct * y - st * z) + shift.y;
      q[2] = scale * (st * y + ct * z) + shift.z;
    }
  }
};

struct Point3 {
  Vec3 x{}, normal{};
  double jacobian;
  std::vector<double> shape;
};

/// By the shape functions of elements/, not by the polynomials of pairing/.
inline Point3 evaluate(const Skin3& skin, std::int32_t cell, const double* xi) {
  const CellType type = skin.surface.types[cell];
  const auto nodes = skin.surface.nodes[cell];
  Point3 p;
  p.shape.resize(nodes.size());
  std::vector<double> points;
  shape_functions(type, std::span(xi, 2), p.shape);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    p.x = p.x + p.shape[i] * skin.node(nodes[i]);
    const Vec3 q = skin.node(nodes[i]);
    points.insert(points.end(), {q.x, q.y, q.z});
  }
  p.normal = cell_normal(type, points, std::span(xi, 2));
  p.jacobian = norm(p.normal);
  p.normal = (1 / p.jacobian) * p.normal;
  return p;
}

template <class Action>
void for_points(const Skin3& slave, const Skin3& master, const ContactCells& cells, const Action& action) {
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::int64_t g = cells.offset[c]; g < cells.offset[c + 1]; ++g) {
      const Point3 x = evaluate(slave, cells.slave[c], &cells.slave_point[2 * g]);
      const Point3 y = evaluate(master, cells.master[c], &cells.master_point[2 * g]);
      action(c, cells.weight[g] * x.jacobian, x, y);
    }
}

/// Integrals of shape functions over a skin of its own, by a rule that is exact for flat facets.
inline std::vector<double> nodal_areas(const Skin3& skin) {
  std::vector<double> areas(skin.n_nodes(), 0.0);
  for (std::size_t c = 0; c < skin.surface.size(); ++c) {
    const Rule& rule = integration_rule(catalog::cell(skin.surface.types[c]).family, 100);
    for (int g = 0; g < rule.size(); ++g) {
      const Point3 p = evaluate(skin, static_cast<std::int32_t>(c), &rule.points[2 * g]);
      for (std::size_t i = 0; i < p.shape.size(); ++i)
        areas[skin.surface.nodes[c][i]] += rule.weights[g] * p.jacobian * p.shape[i];
    }
  }
  return areas;
}

inline double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double v : values) total += v;
  return total;
}

struct Forces {
  std::vector<double> slave, master;
  double area = 0, gap = 0, off_ray = 0;
};

inline Forces forces(const Skin3& slave, const Skin3& master, const ContactCells& cells) {
  Forces f{std::vector<double>(slave.n_nodes(), 0.0), std::vector<double>(master.n_nodes(), 0.0)};
  for_points(slave, master, cells, [&](std::size_t c, double w, const Point3& x, const Point3& y) {
    const Vec3 d = y.x - x.x;
    f.area += w;
    f.gap += w * dot(d, x.normal);
    f.off_ray = std::max(f.off_ray, norm(cross(d, x.normal)));
    for (std::size_t i = 0; i < x.shape.size(); ++i) f.slave[slave.surface.nodes[cells.slave[c]][i]] += w * x.shape[i];
    for (std::size_t i = 0; i < y.shape.size(); ++i) f.master[master.surface.nodes[cells.master[c]][i]] += w * y.shape[i];
  });
  return f;
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// Integral of the slave's and master's first shape functions by couple: what must not depend on order.
using Couples = std::map<std::pair<std::int32_t, std::int32_t>, std::vector<double>>;
inline Couples couples(const ContactCells& cells, const std::vector<std::int32_t>& slave_order = {},
                       const std::vector<std::int32_t>& master_order = {}) {
  Couples found;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::vector<double>& data = found[{slave_order.empty() ? cells.slave[c] : slave_order[cells.slave[c]],
                                       master_order.empty() ? cells.master[c] : master_order[cells.master[c]]}];
    for (std::int64_t g = cells.offset[c]; g < cells.offset[c + 1]; ++g)
      data.insert(data.end(), {cells.weight[g], cells.slave_point[2 * g], cells.slave_point[2 * g + 1],
                               cells.master_point[2 * g], cells.master_point[2 * g + 1]});
  }
  return found;
}

inline Place3 plane(double z) {
  return [z](double x, double y) { return Vec3{x, y, z}; };
}

inline Place3 sheared(double z) {
  return [z](double x, double y) { return Vec3{x + 0.3 * y, y - 0.1 * x, z}; };
}

/// The skin cut of a hexahedron's face (METHOD.md 1.4): E1 to E4 around E5, a square of `inner` times the size of the other.
inline Skin3 hexahedron_cut(CellType type, bool up, double inner) {
  Skin3 skin;
  std::vector<std::int32_t> outer_nodes, inner_nodes;
  for (const auto& [x, y] : {std::pair(-1., -1.), std::pair(1., -1.), std::pair(1., 1.), std::pair(-1., 1.)}) {
    outer_nodes.push_back(skin.add_node({x, y, 0}));
    inner_nodes.push_back(skin.add_node({inner * x, inner * y, 0}));
  }
  const auto add = [&](std::vector<std::int32_t> nodes) {
    if (!up) std::reverse(nodes.begin(), nodes.end());
    if (type != CellType::QUAD4)
      for (int i = 0; i < 4; ++i) nodes.push_back(skin.add_node(0.5 * (skin.node(nodes[i]) + skin.node(nodes[(i + 1) % 4]))));
    if (type == CellType::QUAD9) nodes.push_back(skin.add_node(0.5 * (skin.node(nodes[4]) + skin.node(nodes[6]))));
    skin.surface.add_cell(type, nodes);
  };
  for (int i = 0; i < 4; ++i) add({outer_nodes[i], outer_nodes[(i + 1) % 4], inner_nodes[(i + 1) % 4], inner_nodes[i]});
  add(inner_nodes);
  return skin;
}

/// What quadrature leaves of the patch test: the largest error of a nodal force of a uniform pressure, on either side, relative
/// to the largest one. The skins are flat and cover each other.
inline double patch_error(Skin3& slave, Skin3& master, const PairingOptions& options) {
  const Forces found = forces(slave, master, pair(slave.view(), master.view(), options).cells);
  const std::vector<double> on_slave = nodal_areas(slave), on_master = nodal_areas(master);
  double most = 0;
  for (const auto* areas : {&on_slave, &on_master})
    for (const double area : *areas) most = std::max(most, std::abs(area));
  return std::max(largest_difference(found.slave, on_slave), largest_difference(found.master, on_master)) / most;
}

}  // namespace lacon::test
