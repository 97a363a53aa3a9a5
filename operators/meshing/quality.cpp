#include "lacon/operators/meshing/quality.hpp"

#include <algorithm>
#include <array>

#include "lacon/elements/reference.hpp"

namespace lacon {
namespace {

constexpr int max_nodes = 27;

/// Below it, relative to the cell's greatest Jacobian, a corner counts as flat: round-off of differences of coordinates.
constexpr double flat_corner = 1e-10;

double jacobian(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates,
                std::span<const double> xi) {
  const auto n = nodes.size();
  const auto d = static_cast<std::size_t>(catalog::cell(type).dimension);
  std::array<double, 3 * max_nodes> gradients;
  shape_gradients(type, xi, {gradients.data(), n * d});
  double j[3][3] = {};
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t k = 0; k < d; ++k)
        j[i][k] += gradients[a * d + i] * coordinates[3 * static_cast<std::size_t>(nodes[a]) + k];
  if (d == 1) return j[0][0];
  if (d == 2) return j[0][0] * j[1][1] - j[0][1] * j[1][0];
  return j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) - j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
         j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
}

std::array<double, 3> centre(const catalog::CellRow& row) {
  std::array<double, 3> xi{};
  const auto d = static_cast<std::size_t>(row.dimension);
  for (std::size_t v = 0; v < static_cast<std::size_t>(row.n_vertices); ++v)
    for (std::size_t k = 0; k < d; ++k) xi[k] += row.nodes[v * d + k] / row.n_vertices;
  return xi;
}

}  // namespace

double central_jacobian(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates) {
  const std::array<double, 3> xi = centre(catalog::cell(type));
  return jacobian(type, nodes, coordinates, {xi.data(), static_cast<std::size_t>(catalog::cell(type).dimension)});
}

JacobianRange jacobian_range(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates) {
  const catalog::CellRow& row = catalog::cell(type);
  const auto d = static_cast<std::size_t>(row.dimension);
  const std::array<double, 3> middle = centre(row);
  const double towards_centre = row.family == Family::PYRAM ? 0.1 : 0.0;
  const double first = central_jacobian(type, nodes, coordinates);
  JacobianRange range{first, first};
  for (std::size_t a = 0; a < static_cast<std::size_t>(row.n_nodes); ++a) {
    std::array<double, 3> xi{};
    for (std::size_t k = 0; k < d; ++k) xi[k] = (1 - towards_centre) * row.nodes[a * d + k] + towards_centre * middle[k];
    const double here = jacobian(type, nodes, coordinates, {xi.data(), d});
    range.least = std::min(range.least, here);
    range.greatest = std::max(range.greatest, here);
  }
  return range;
}

bool is_sound(const JacobianRange& range) { return range.greatest > 0 && range.least >= -flat_corner * range.greatest; }

}  // namespace lacon
