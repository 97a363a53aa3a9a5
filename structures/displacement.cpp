#include "lacon/structures/displacement.hpp"

#include <algorithm>
#include <string>

namespace lacon {

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
  const std::string names[] = {"DX", "DY", "DZ"};
  return nodal_values(mesh, field, std::span(names).first(static_cast<std::size_t>(dimension)));
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
