#include "lacon/structures/bodies.hpp"

#include <algorithm>
#include <numeric>

#include "lacon/catalog/wording.hpp"

namespace lacon {

Bodies::Bodies(const Mesh& mesh) : mesh_(mesh), lowest_(mesh.n_nodes()) {
  // union-find: a chain of lower and lower nodes leads to the lowest one
  std::iota(lowest_.begin(), lowest_.end(), 0);
  const auto root = [&](std::int32_t node) {
    while (lowest_[node] != node) node = lowest_[node] = lowest_[lowest_[node]];
    return node;
  };
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    if (mesh.row(cell).dimension != mesh.dimension) continue;
    for (const std::int32_t node : mesh.cells[cell]) {
      const std::int32_t a = root(mesh.cells[cell][0]), b = root(node);
      lowest_[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(lowest_.size()); ++node) lowest_[node] = root(node);
}

std::string Bodies::name_at(std::int32_t node) const {
  const std::int32_t body = of(node);
  const auto inside = [&](std::int32_t cell) {
    return mesh_.row(cell).dimension == mesh_.dimension && of(mesh_.cells[cell][0]) == body;
  };
  const Group* largest = nullptr;
  for (const Group& group : mesh_.cell_groups)
    if ((!largest || group.members.size() > largest->members.size()) && !group.members.empty() &&
        std::all_of(group.members.begin(), group.members.end(), inside))
      largest = &group;
  if (largest) return largest->name;
  for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(mesh_.n_cells()); ++cell)
    if (inside(cell)) return part("body_of_cell", {{"cell", cell_name(cell)}});
  return part("no_body");
}

}  // namespace lacon
