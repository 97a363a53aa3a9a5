#include "lacon/operators/crea_maillage/restriction.hpp"

#include <algorithm>

namespace lacon {
namespace {

/// The new number of each member of `kept`, -1 for every other. @param kept increasing
std::vector<std::int32_t> new_numbers(const std::vector<std::int32_t>& kept, std::size_t count) {
  std::vector<std::int32_t> number(count, -1);
  for (std::size_t i = 0; i < kept.size(); ++i) number[static_cast<std::size_t>(kept[i])] = static_cast<std::int32_t>(i);
  return number;
}

/// What is left of the groups; of those that are not named, only with `all`, and where it is not empty.
std::vector<Group> left_of(const std::vector<Group>& groups, const std::vector<std::int32_t>& number,
                           const std::vector<std::string>& named, bool all) {
  std::vector<Group> left;
  for (const Group& group : groups) {
    Group part{group.name, {}};
    for (const std::int32_t member : group.members)
      if (number[static_cast<std::size_t>(member)] >= 0) part.members.push_back(number[static_cast<std::size_t>(member)]);
    const bool is_named = std::ranges::find(named, group.name) != named.end();
    if (is_named || (all && !part.members.empty())) left.push_back(std::move(part));
  }
  return left;
}

}  // namespace

Mesh restricted(const Mesh& mesh, const Keywords& factor) {
  std::vector<std::int32_t> cells;
  for (const std::string& group : factor.texts("GROUP_MA")) {
    const auto members = cells_of_group(mesh, group, factor.path("GROUP_MA"));
    cells.insert(cells.end(), members.begin(), members.end());
  }
  std::ranges::sort(cells);
  cells.erase(std::ranges::unique(cells).begin(), cells.end());
  for (const std::string& group : factor.texts("GROUP_NO")) nodes_of_group(mesh, group, factor.path("GROUP_NO"));

  const std::vector<std::int32_t> nodes = nodes_of_cells(mesh, cells);
  const auto node_number = new_numbers(nodes, mesh.n_nodes());
  Mesh part;
  part.name = mesh.name;
  part.dimension = mesh.dimension;
  for (const std::int32_t node : nodes) {
    const auto point = mesh.point(static_cast<std::size_t>(node));
    part.coordinates.insert(part.coordinates.end(), point.begin(), point.end());
  }
  for (const std::int32_t cell : cells) {
    std::vector<std::int32_t> own;
    for (const std::int32_t node : mesh.cells[static_cast<std::size_t>(cell)])
      own.push_back(node_number[static_cast<std::size_t>(node)]);
    part.add_cell(mesh.types[static_cast<std::size_t>(cell)], own);
  }
  part.cell_groups =
      left_of(mesh.cell_groups, new_numbers(cells, mesh.n_cells()), factor.texts("GROUP_MA"), factor.yes("TOUT_GROUP_MA"));
  part.node_groups = left_of(mesh.node_groups, node_number, factor.texts("GROUP_NO"), factor.yes("TOUT_GROUP_NO"));
  return part;
}

}  // namespace lacon
