#include "lacon/pairing/normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lacon/elements/reference.hpp"

namespace lacon {
namespace {

constexpr int max_nodes = 9;  // of a skin cell
constexpr double cancelled =
    1e-8;  // a mean of unit normals shorter than this has no direction, nor a normal of a cell by its longest

double norm(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

}  // namespace

std::array<double, 3> cell_normal(CellType type, std::span<const double> points, std::span<const double> xi) {
  const catalog::CellRow& row = catalog::cell(type);
  std::array<double, max_nodes * 2> gradient;
  shape_gradients(type, xi, std::span(gradient).first(static_cast<std::size_t>(row.n_nodes * row.dimension)));
  std::array<std::array<double, 3>, 2> tangent{};
  for (int node = 0; node < row.n_nodes; ++node)
    for (int d = 0; d < row.dimension; ++d)
      for (int x = 0; x < 3; ++x) tangent[d][x] += gradient[node * row.dimension + d] * points[3 * node + x];
  const auto& [t, s] = tangent;
  if (row.dimension == 1) return {t[1], -t[0], 0};
  return {t[1] * s[2] - t[2] * s[1], t[2] * s[0] - t[0] * s[2], t[0] * s[1] - t[1] * s[0]};
}

namespace {

/// Call visit(node, unit normal) for each corner of each cell; not where a cell has collapsed.
template <class Visit>
void for_each_corner(const Surface& surface, Visit visit) {
  std::vector<double> points;
  for (std::size_t cell = 0; cell < surface.size(); ++cell) {
    const catalog::CellRow& row = catalog::cell(surface.types[cell]);
    const auto nodes = surface.nodes[cell];
    points.clear();
    for (const std::int32_t node : nodes)
      points.insert(points.end(), surface.coordinates.begin() + 3 * node, surface.coordinates.begin() + 3 * node + 3);
    std::array<std::array<double, 3>, max_nodes> at_node;
    double longest = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      at_node[i] = cell_normal(surface.types[cell], points, row.nodes.subspan(i * row.dimension, row.dimension));
      longest = std::max(longest, norm(at_node[i]));
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double length = norm(at_node[i]);
      if (!(length > cancelled * longest)) continue;
      for (double& x : at_node[i]) x /= length;
      visit(nodes[i], at_node[i]);
    }
  }
}

}  // namespace

std::vector<double> nodal_normals(const Surface& surface) {
  std::vector<double> normals(surface.coordinates.size(), 0.0);
  for_each_corner(surface, [&](std::int32_t node, const std::array<double, 3>& own) {
    for (int x = 0; x < 3; ++x) normals[3 * node + x] += own[x];
  });
  std::vector<int> adjacent(surface.coordinates.size() / 3, 0);
  for (const std::int32_t node : surface.nodes.values) ++adjacent[node];
  for (std::size_t node = 0; node < adjacent.size(); ++node) {
    double* n = normals.data() + 3 * node;
    const double length = std::hypot(n[0], n[1], n[2]);
    const bool has_direction = length > cancelled * adjacent[node];
    for (int x = 0; x < 3; ++x) n[x] = has_direction ? n[x] / length : 0;
  }
  return normals;
}

TurnedNormals turned_normals(const Surface& surface, std::span<const double> normals, double angle) {
  TurnedNormals turned;
  for_each_corner(surface, [&](std::int32_t node, const std::array<double, 3>& own) {
    const double* const n = normals.data() + 3 * node;
    if (own[0] * n[0] + own[1] * n[1] + own[2] * n[2] < std::cos(angle) && turned.count++ == 0) turned.first = node;
  });
  return turned;
}

double smallest_edge(const Surface& surface) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t cell = 0; cell < surface.size(); ++cell)
    for (const catalog::EdgeRow& edge : catalog::cell(surface.types[cell]).edges) {
      const double* a = surface.coordinates.data() + 3 * surface.nodes[cell][edge.first];
      const double* b = surface.coordinates.data() + 3 * surface.nodes[cell][edge.second];
      smallest = std::min(smallest, std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
    }
  return std::isfinite(smallest) ? smallest : 0;
}

}  // namespace lacon
