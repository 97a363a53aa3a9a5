#include "lacon/operators/contact/facing.hpp"

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

}  // namespace lacon
