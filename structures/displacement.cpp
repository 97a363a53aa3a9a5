#include "lacon/structures/displacement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
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

std::vector<HeldDirection> held_directions(const Mesh& mesh, std::span<const Load> loads) {
  const auto axis_of = [&](const std::string& name) -> std::optional<Vec3> {
    const auto found = std::ranges::find(names.begin(), names.begin() + mesh.dimension, name) - names.begin();
    if (found == mesh.dimension) return std::nullopt;
    return Vec3{found == 0 ? 1.0 : 0.0, found == 1 ? 1.0 : 0.0, found == 2 ? 1.0 : 0.0};
  };
  std::vector<HeldDirection> held;
  for (const Load& load : loads) {
    for (const LoadTerm& term : load.imposed)
      if (const auto axis = axis_of(term.component)) held.push_back({term.place, *axis});
    for (const Relation& relation : load.relations) {
      Vec3 along{};
      const bool of_one = std::ranges::all_of(relation.terms, [&](const RelationTerm& term) {
        const auto axis = axis_of(term.component);
        if (axis) along = along + term.coefficient * *axis;
        return axis && term.node == relation.terms.front().node;
      });
      if (of_one && norm(along) > 0) held.push_back({relation.terms.front().node, along / norm(along)});
    }
  }
  return held;
}

void displace(const Mesh& mesh, std::span<const double> values, int dimension, std::vector<double>& coordinates) {
  const auto axes = static_cast<std::size_t>(dimension);
  const std::size_t width = values.size() / std::max<std::size_t>(mesh.n_nodes(), 1);
  coordinates = mesh.coordinates;
  for (std::size_t node = 0; node < mesh.n_nodes(); ++node)
    for (std::size_t d = 0; d < axes; ++d) coordinates[3 * node + d] += values[node * width + d];
}

double extent(const Mesh& mesh) {
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = axis; i < mesh.coordinates.size(); i += 3) {
      low = std::min(low, mesh.coordinates[i]);
      high = std::max(high, mesh.coordinates[i]);
    }
    longest = std::max(longest, high - low);
  }
  return longest;
}

std::vector<double> displaced(const Mesh& mesh, const Field& field) {
  std::vector<double> coordinates = nodal_displacements(mesh, field, 3);
  for (std::size_t i = 0; i < coordinates.size(); ++i) coordinates[i] += mesh.coordinates[i];
  return coordinates;
}

}  // namespace lacon
