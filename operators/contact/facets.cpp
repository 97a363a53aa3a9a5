#include "lacon/operators/contact/facets.hpp"

#include <algorithm>
#include <cmath>

#include "lacon/elements/reference.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

std::vector<double> missing_bulge(const Surface& skin) {
  const std::vector<double> normals = nodal_normals(skin);
  const auto at = [](std::span<const double> rows, std::int32_t node) {
    return vector_at(rows.data() + 3 * std::ptrdiff_t{node});
  };
  std::vector<double> missing;
  std::vector<double> shape;
  for (std::size_t cell = 0; cell < skin.size(); ++cell) {
    const auto nodes = skin.nodes[cell];
    const catalog::CellRow& row = catalog::cell(skin.types[cell]);
    double& largest = missing.emplace_back(0.0);
    for (int i = 0; i < row.n_vertices; ++i)
      for (int j = 0; j < i; ++j) {
        const Vec3 a = at(skin.coordinates, nodes[i]), b = at(skin.coordinates, nodes[j]), m = at(normals, nodes[i]),
                   n = at(normals, nodes[j]);
        const double wanted = dot(n - m, b - a) / 8;
        // the middle between the two vertices, on the cell
        std::vector<double> middle(static_cast<std::size_t>(row.dimension));
        for (int d = 0; d < row.dimension; ++d)
          middle[d] = 0.5 * (row.nodes[i * row.dimension + d] + row.nodes[j * row.dimension + d]);
        shape.resize(nodes.size());
        shape_functions(skin.types[cell], middle, shape);
        Vec3 there = -0.5 * (a + b);
        for (std::size_t k = 0; k < nodes.size(); ++k) there = there + shape[k] * at(skin.coordinates, nodes[k]);
        largest = std::max(largest, std::abs(wanted - dot(there, 0.5 * (m + n))));
      }
  }
  return missing;
}

}  // namespace lacon
