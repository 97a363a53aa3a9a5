#include "lacon/operators/meshing/named_nodes.hpp"

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/names.hpp"

namespace lacon {
namespace {

std::vector<std::int32_t> cells_by_name(const Mesh& mesh, const Keywords& factor, const std::string& keyword) {
  std::vector<std::int32_t> cells;
  for (const std::string& name : factor.texts(keyword)) {
    const std::optional<std::int32_t> cell = find_by_name(mesh, name, Entity::cell);
    if (!cell)
      fail("GROUPE_2", {{"keyword", factor.path(keyword)},
                        {"what", part("cell")},
                        {"name", name},
                        {"first", cell_name(0)},
                        {"last", cell_name(static_cast<std::int64_t>(mesh.n_cells()) - 1)}});
    cells.push_back(*cell);
  }
  return cells;
}

}  // namespace

std::vector<std::int32_t> nodes_by_name(const Mesh& mesh, const Keywords& factor, const std::string& keyword) {
  std::vector<std::int32_t> nodes;
  for (const std::string& name : factor.texts(keyword)) {
    const std::optional<std::int32_t> node = find_by_name(mesh, name, Entity::node);
    if (!node)
      fail("CHARGE_1", {{"keyword", factor.path(keyword)},
                        {"name", name},
                        {"last", node_name(static_cast<std::int64_t>(mesh.n_nodes()) - 1)}});
    nodes.push_back(*node);
  }
  return nodes;
}

std::vector<char> nodes_left_out(const Mesh& mesh, const Keywords& factor) {
  std::vector<char> out(mesh.n_nodes(), 0);
  const auto leave_out = [&](const auto& nodes) {
    for (const std::int32_t node : nodes) out[static_cast<std::size_t>(node)] = 1;
  };
  for (const std::string& group : factor.texts("SANS_GROUP_MA"))
    leave_out(nodes_of_cells(mesh, cells_of_group(mesh, group, factor.path("SANS_GROUP_MA"))));
  for (const std::string& group : factor.texts("SANS_GROUP_NO"))
    leave_out(nodes_of_group(mesh, group, factor.path("SANS_GROUP_NO")));
  leave_out(nodes_of_cells(mesh, cells_by_name(mesh, factor, "SANS_MAILLE")));
  leave_out(nodes_by_name(mesh, factor, "SANS_NOEUD"));
  return out;
}

}  // namespace lacon
