#include "lacon/operators/contact/facets.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lacon/elements/reference.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

/// In the plane: nodes inside a patch lie on the straight edge that its cells have cut; the neighbours of each.
std::map<std::int32_t, std::vector<std::int32_t>> nodes_on_cut_edges(const Surface& skin) {
  std::map<std::int32_t, std::vector<std::int32_t>> neighbours;
  for (std::size_t cell = 0; skin.dimension == 2 && !skin.inner.empty() && cell < skin.size(); ++cell)
    for (int i = 0; i < 2; ++i)
      if (skin.inner[static_cast<std::size_t>(skin.nodes[cell][i])] != 0)
        neighbours[skin.nodes[cell][i]].push_back(skin.nodes[cell][1 - i]);
  return neighbours;
}

}  // namespace

std::vector<Bulge> missing_bulge(const Surface& skin) {
  const std::vector<double> normals = nodal_normals(skin);
  const auto at = [](std::span<const double> rows, std::int32_t node) {
    return vector_at(rows.data() + 3 * std::ptrdiff_t{node});
  };
  const auto cut = nodes_on_cut_edges(skin);
  // the end of the whole edge, seen from `other`
  const auto end_of_edge = [&](std::int32_t node, std::int32_t other) {
    for (auto found = cut.find(node); found != cut.end(); found = cut.find(node))
      other = std::exchange(node, found->second.front() == other ? found->second.back() : found->second.front());
    return node;
  };
  std::vector<Bulge> missing;
  std::vector<double> shape, points;
  for (std::size_t cell = 0; cell < skin.size(); ++cell) {
    const auto nodes = skin.nodes[cell];
    const catalog::CellRow& row = catalog::cell(skin.types[cell]);
    points.clear();
    for (const std::int32_t node : nodes)
      points.insert(points.end(), &skin.coordinates[3 * static_cast<std::size_t>(node)],
                    &skin.coordinates[3 * static_cast<std::size_t>(node) + 3]);
    double turn = 0;
    for (int i = 0; i < row.n_vertices; ++i) {
      const auto vertex =
          row.nodes.subspan(static_cast<std::size_t>(i * row.dimension), static_cast<std::size_t>(row.dimension));
      const Vec3 own = cell_normal(skin.types[cell], points, vertex);
      turn = std::max(turn, std::acos(std::clamp(dot(own, at(normals, nodes[i])) / norm(own), -1.0, 1.0)));
    }
    Bulge& largest = missing.emplace_back();
    for (int i = 0; i < row.n_vertices; ++i)
      for (int j = 0; j < i; ++j) {
        const std::int32_t first = end_of_edge(nodes[i], nodes[j]), last = end_of_edge(nodes[j], nodes[i]);
        const Vec3 a = at(skin.coordinates, first), b = at(skin.coordinates, last), m = at(normals, first),
                   n = at(normals, last);
        const double wanted = dot(n - m, b - a) / 8;
        Bulge found{wanted, 8 * wanted / dot(b - a, b - a), turn};
        // the middle between the two vertices, on the cell
        std::vector<double> middle(static_cast<std::size_t>(row.dimension));
        for (int d = 0; d < row.dimension; ++d)
          middle[d] = 0.5 * (row.nodes[i * row.dimension + d] + row.nodes[j * row.dimension + d]);
        shape.resize(nodes.size());
        shape_functions(skin.types[cell], middle, shape);
        Vec3 there = -0.5 * (at(skin.coordinates, nodes[i]) + at(skin.coordinates, nodes[j]));
        for (std::size_t k = 0; k < nodes.size(); ++k) there = there + shape[k] * at(skin.coordinates, nodes[k]);
        found.missing -= dot(there, 0.5 * (m + n));
        if (std::abs(found.missing) >= std::abs(largest.missing)) largest = found;
      }
  }
  return missing;
}

}  // namespace lacon
