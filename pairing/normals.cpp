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

}  // namespace

Vec3 cell_normal(CellType type, std::span<const double> points, std::span<const double> xi) {
  const catalog::CellRow& row = catalog::cell(type);
  std::array<double, max_nodes * 2> gradient;
  shape_gradients(type, xi, std::span(gradient).first(static_cast<std::size_t>(row.n_nodes * row.dimension)));
  std::array<Vec3, 2> tangent{};
  for (int node = 0; node < row.n_nodes; ++node)
    for (int d = 0; d < row.dimension; ++d)
      tangent[d] = tangent[d] + gradient[node * row.dimension + d] * vector_at(&points[3 * node]);
  if (row.dimension == 1) return {tangent[0].y, -tangent[0].x, 0};
  return cross(tangent[0], tangent[1]);
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
    std::array<Vec3, max_nodes> at_node;
    double longest = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      at_node[i] = cell_normal(surface.types[cell], points, row.nodes.subspan(i * row.dimension, row.dimension));
      longest = std::max(longest, norm(at_node[i]));
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double length = norm(at_node[i]);
      if (!(length > cancelled * longest)) continue;
      visit(nodes[i], at_node[i] / length);
    }
  }
}

}  // namespace

std::vector<double> nodal_normals(const Surface& surface) {
  std::vector<double> normals(surface.coordinates.size(), 0.0);
  for_each_corner(surface, [&](std::int32_t node, Vec3 own) {
    for (int x = 0; x < 3; ++x) normals[3 * node + x] += component(own, x);
  });
  std::vector<int> adjacent(surface.coordinates.size() / 3, 0);
  for (const std::int32_t node : surface.nodes.values) ++adjacent[node];
  for (std::size_t node = 0; node < adjacent.size(); ++node) {
    double* n = normals.data() + 3 * node;
    const double length = norm(vector_at(n));
    const bool has_direction = length > cancelled * adjacent[node];
    for (int x = 0; x < 3; ++x) n[x] = has_direction ? n[x] / length : 0;
  }
  return normals;
}

TurnedNormals turned_normals(const Surface& surface, std::span<const double> normals, double angle) {
  TurnedNormals turned;
  for_each_corner(surface, [&](std::int32_t node, Vec3 own) {
    if (dot(own, vector_at(&normals[3 * node])) < std::cos(angle) && turned.count++ == 0) turned.first = node;
  });
  return turned;
}

double smallest_edge(const Surface& surface) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t cell = 0; cell < surface.size(); ++cell)
    for (const catalog::EdgeRow& edge : catalog::cell(surface.types[cell]).edges) {
      const Vec3 first = vector_at(&surface.coordinates[3 * surface.nodes[cell][edge.first]]);
      const Vec3 second = vector_at(&surface.coordinates[3 * surface.nodes[cell][edge.second]]);
      smallest = std::min(smallest, norm(second - first));
    }
  return std::isfinite(smallest) ? smallest : 0;
}

}  // namespace lacon
