#include "lacon/operators/contact/facing.hpp"

#include <tuple>
#include <vector>

#include "lacon/pairing/normals.hpp"

namespace lacon {

Facing facing(const Mesh& mesh, std::int32_t cell, std::span<const double> coordinates) {
  std::vector<double> points;
  Vec3 sum{};
  for (const std::int32_t node : mesh.cells[cell]) {
    const auto point = coordinates.subspan(3 * static_cast<std::size_t>(node), 3);
    points.insert(points.end(), point.begin(), point.end());
    sum = sum + vector_at(point.data());
  }
  const catalog::CellRow& row = mesh.row(cell);
  const Vec3 normal = cell_normal(mesh.types[cell], points, row.nodes.first(static_cast<std::size_t>(row.dimension)));
  return {sum / static_cast<double>(mesh.cells[cell].size()), normal / norm(normal)};
}

const Rule& measuring_rule(CellType type) {
  const auto& [family, order] = std::tie(catalog::cell(type).family, catalog::cell(type).order);
  return integration_rule(family, family == Family::SEG    ? 4
                                  : family == Family::TRIA ? (order == 1 ? 6 : 16)
                                                           : (order == 1 ? 9 : 25));
}

double cell_extent(const Mesh& mesh, std::int32_t cell) {
  const catalog::CellRow& row = mesh.row(cell);
  const Rule& rule = measuring_rule(row.type);
  std::vector<double> points;
  for (const std::int32_t node : mesh.cells[cell])
    points.insert(points.end(), mesh.point(node).begin(), mesh.point(node).end());
  double sum = 0;
  for (int p = 0; p < rule.size(); ++p)
    sum += rule.weights[p] *
           norm(cell_normal(row.type, points, std::span(rule.points).subspan(p * rule.dimension, rule.dimension)));
  return sum;
}

}  // namespace lacon
