#include "lacon/operators/post_elem/parts.hpp"

namespace lacon {

std::vector<Part> parts_of(const Mesh& mesh, const ModelPoints& points, const Keywords& factor) {
  std::vector<Part> parts;
  if (!factor.has("GROUP_MA")) {
    parts.push_back({"TOUT", "TOUT", std::vector<char>(mesh.n_cells())});
    for (std::size_t c = 0; c < mesh.n_cells(); ++c) parts.back().cells[c] = points.is_solid(c);
  }
  for (const std::string& group : factor.texts("GROUP_MA")) {
    parts.push_back({"GROUP_MA", group, std::vector<char>(mesh.n_cells())});
    for (const std::int32_t cell : cells_of_group(mesh, group, factor.path("GROUP_MA")))
      parts.back().cells[static_cast<std::size_t>(cell)] = 1;
  }
  return parts;
}

}  // namespace lacon
