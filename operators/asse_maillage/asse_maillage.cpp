#include "lacon/operators/asse_maillage/asse_maillage.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/meshing/body.hpp"

namespace lacon {
namespace {

/// Add groups whose members are counted from `shift`.
void add_groups(std::vector<Group>& groups, const std::vector<Group>& more, std::size_t shift, const char* kind) {
  for (Group group : more) {
    if (std::ranges::any_of(groups, [&](const Group& own) { return own.name == group.name; }))
      fail("ASSEMAIL_1", {{"kind", kind}, {"group", group.name}});
    for (std::int32_t& member : group.members) member += static_cast<std::int32_t>(shift);
    groups.push_back(std::move(group));
  }
}

}  // namespace

void asse_maillage(const Order& order, const Base& base) {
  Mesh mesh = base.mesh(order.keywords.concept_id("MAILLAGE_1"));
  const Mesh second = base.mesh(order.keywords.concept_id("MAILLAGE_2"));
  refuse_cut_mesh(mesh, order.command, base.label(order.keywords.concept_id("MAILLAGE_1")));
  refuse_cut_mesh(second, order.command, base.label(order.keywords.concept_id("MAILLAGE_2")));
  const std::size_t n_nodes = mesh.n_nodes(), n_cells = mesh.n_cells();

  mesh.dimension = std::max(mesh.dimension, second.dimension);
  mesh.coordinates.insert(mesh.coordinates.end(), second.coordinates.begin(), second.coordinates.end());
  for (std::size_t c = 0; c < second.n_cells(); ++c) {
    std::vector<std::int32_t> nodes(second.cells[c].begin(), second.cells[c].end());
    for (std::int32_t& node : nodes) node += static_cast<std::int32_t>(n_nodes);
    mesh.add_cell(second.types[c], nodes);
  }
  add_groups(mesh.cell_groups, second.cell_groups, n_cells, "GROUP_MA");
  add_groups(mesh.node_groups, second.node_groups, n_nodes, "GROUP_NO");
  fmt::print("  nodes {:>8} + {:>8}\n  cells {:>8} + {:>8}\n", n_nodes, second.n_nodes(), n_cells, second.n_cells());
  base.store(mesh);
}

}  // namespace lacon
