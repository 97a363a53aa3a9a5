#include "lacon/pairing/surface.hpp"

namespace lacon {

Vec3 normal_of(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates) {
  const auto to = [&](std::size_t from, std::size_t i) {
    return vector_at(coordinates.data() + 3 * static_cast<std::size_t>(nodes[i])) -
           vector_at(coordinates.data() + 3 * static_cast<std::size_t>(nodes[from]));
  };
  Vec3 normal{};
  switch (catalog::cell(type).n_vertices) {
    case 2:
      normal = {to(0, 1).y, -to(0, 1).x, 0};
      break;
    case 3:
      normal = cross(to(0, 1), to(0, 2));
      break;
    default:
      normal = cross(to(0, 2), to(1, 3));
  }
  const double size = norm(normal);
  return size > 0 ? normal / size : Vec3{};
}

Vec3 middle_of(std::span<const std::int32_t> nodes, std::span<const double> coordinates) {
  Vec3 sum{};
  for (const std::int32_t node : nodes) sum = sum + vector_at(coordinates.data() + 3 * static_cast<std::size_t>(node));
  return sum / static_cast<double>(nodes.size());
}

Surface surface_of(const Mesh& mesh, std::span<const std::int32_t> cells, std::span<const double> coordinates) {
  Surface surface;
  surface.dimension = mesh.dimension;
  surface.coordinates = coordinates;
  surface.types.reserve(cells.size());
  for (const std::int32_t cell : cells) surface.add_cell(mesh.types[cell], mesh.cells[cell]);
  return surface;
}

}  // namespace lacon
