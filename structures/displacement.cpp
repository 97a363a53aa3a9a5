#include "lacon/structures/displacement.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace lacon {
namespace {

const std::array<std::string, 3> names = {"DX", "DY", "DZ"};

}  // namespace

std::vector<double> nodal_values(const Mesh& mesh, const Field& field, std::span<const std::string> components) {
  const std::size_t width = components.size();
  std::vector<double> values(mesh.n_nodes() * width, 0.0);
  for (std::size_t d = 0; d < width; ++d) {
    const int found = field.component(components[d]);
    if (found < 0) continue;
    const auto column = static_cast<std::size_t>(found);
    for (std::size_t i = 0; i < field.support.size(); ++i)
      if (field.has(i, column)) values[static_cast<std::size_t>(field.support[i]) * width + d] = field.at(i, column);
  }
  return values;
}

std::vector<double> nodal_displacements(const Mesh& mesh, const Field& field, int dimension) {
  return nodal_values(mesh, field, std::span(names).first(static_cast<std::size_t>(dimension)));
}

std::vector<std::uint8_t> free_displacements(const Mesh& mesh, std::span<const Load> loads) {
  const auto n = static_cast<std::size_t>(mesh.dimension);
  std::vector<std::uint8_t> free(mesh.n_nodes() * n, 1);
  for (const Load& load : loads)
    for (const LoadTerm& term : load.imposed)
      for (std::size_t d = 0; d < n; ++d)
        if (term.component == names[d]) free[static_cast<std::size_t>(term.place) * n + d] = 0;
  return free;
}

void displace(const Mesh& mesh, std::span<const double> values, int dimension, std::vector<double>& coordinates) {
  const auto axes = static_cast<std::size_t>(dimension);
  const std::size_t width = values.size() / std::max<std::size_t>(mesh.n_nodes(), 1);
  coordinates = mesh.coordinates;
  for (std::size_t node = 0; node < mesh.n_nodes(); ++node)
    for (std::size_t d = 0; d < axes; ++d) coordinates[3 * node + d] += values[node * width + d];
}

std::vector<double> displaced(const Mesh& mesh, const Field& field) {
  std::vector<double> coordinates = nodal_displacements(mesh, field, 3);
  for (std::size_t i = 0; i < coordinates.size(); ++i) coordinates[i] += mesh.coordinates[i];
  return coordinates;
}

}  // namespace lacon
