#include "lacon/pairing/surface.hpp"

namespace lacon {

Surface surface_of(const Mesh& mesh, std::span<const std::int32_t> cells, std::span<const double> coordinates) {
  Surface surface;
  surface.dimension = mesh.dimension;
  surface.coordinates = coordinates;
  surface.types.reserve(cells.size());
  for (const std::int32_t cell : cells) surface.add_cell(mesh.types[cell], mesh.cells[cell]);
  return surface;
}

}  // namespace lacon
