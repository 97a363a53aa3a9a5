#include "lacon/structures/displacement.hpp"

namespace lacon {

std::vector<double> nodal_displacements(const Mesh& mesh, const Field& field, int dimension) {
  constexpr const char* names[] = {"DX", "DY", "DZ"};
  const auto width = static_cast<std::size_t>(dimension);
  std::vector<double> values(mesh.n_nodes() * width, 0.0);
  for (std::size_t d = 0; d < width; ++d) {
    const int found = field.component(names[d]);
    if (found < 0) continue;
    const auto column = static_cast<std::size_t>(found);
    for (std::size_t i = 0; i < field.support.size(); ++i)
      if (field.has(i, column)) values[static_cast<std::size_t>(field.support[i]) * width + d] = field.at(i, column);
  }
  return values;
}

void displace(const Mesh& mesh, std::span<const double> displacement, int dimension, std::vector<double>& coordinates) {
  const auto width = static_cast<std::size_t>(dimension);
  coordinates = mesh.coordinates;
  for (std::size_t node = 0; node < mesh.n_nodes(); ++node)
    for (std::size_t d = 0; d < width; ++d) coordinates[3 * node + d] += displacement[node * width + d];
}

std::vector<double> displaced(const Mesh& mesh, const Field& field) {
  std::vector<double> coordinates = nodal_displacements(mesh, field, 3);
  for (std::size_t i = 0; i < coordinates.size(); ++i) coordinates[i] += mesh.coordinates[i];
  return coordinates;
}

}  // namespace lacon
