#include "lacon/structures/mesh.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

/// Number of single-character edits between two names.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replace});
    }
  }
  return row.back();
}

const Group* find(const std::vector<Group>& groups, std::string_view name) {
  const auto at = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.name == name; });
  return at == groups.end() ? nullptr : &*at;
}

/// The members of a group of `groups`. @param others the groups of the other kind, `what` and `other` the names of the kinds
std::span<const std::int32_t> members(const std::vector<Group>& groups, const std::vector<Group>& others, std::string_view name,
                                      std::string_view what, std::string_view other, std::string_view keyword) {
  const Group* group = find(groups, name);
  if (!group) {
    std::vector<std::string> names;
    for (const Group& g : groups) names.push_back(g.name);
    std::sort(names.begin(), names.end());
    const std::string near = nearest_name(name, names);
    std::string known;
    for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
    const std::string hint =
        find(others, name)
            ? part("other_kind_of_group", {{"other", part(other)}, {"keyword", other == "node" ? "GROUP_NO" : "GROUP_MA"}})
        : near.empty() ? ""
                       : part("did_you_mean", {{"name", near}});
    fail("MESH_1", {{"keyword", std::string(keyword)},
                    {"what", part(what)},
                    {"group", std::string(name)},
                    {"hint", hint},
                    {"known", known.empty() ? part("no_groups") : known}});
  }
  if (group->members.empty())
    fail("MESH_2", {{"keyword", std::string(keyword)}, {"what", part(what)}, {"group", std::string(name)}});
  return group->members;
}

}  // namespace

void Mesh::add_cell(CellType type, std::span<const std::int32_t> nodes) {
  types.push_back(type);
  cells.push_back(nodes);
}

const Group* Mesh::find_cell_group(std::string_view group_name) const { return find(cell_groups, group_name); }
const Group* Mesh::find_node_group(std::string_view group_name) const { return find(node_groups, group_name); }

int least_dimension(const Mesh& mesh) {
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    if (mesh.row(c).dimension == 3) return 3;
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.coordinates[3 * n + 2] != 0.0) return 3;
  return 2;
}

std::string node_name(std::int64_t node) { return "N" + std::to_string(node + 1); }
std::string cell_name(std::int64_t cell) { return "M" + std::to_string(cell + 1); }

std::optional<std::int32_t> number_of_name(std::string_view name, char letter, std::size_t count) {
  std::int64_t number = 0;
  const char* end = name.data() + name.size();
  const bool read = name.size() > 1 && name[0] == letter && name[1] != '0' && name[1] != '-' &&
                    std::from_chars(name.data() + 1, end, number).ptr == end;
  if (!read || number < 1 || number > static_cast<std::int64_t>(count)) return std::nullopt;
  return static_cast<std::int32_t>(number - 1);
}

std::string nearest_name(std::string_view name, std::span<const std::string> names) {
  while (name.starts_with(' ')) name.remove_prefix(1);
  while (name.ends_with(' ')) name.remove_suffix(1);
  std::string best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : names)
    if (const std::size_t d = distance(name, candidate); d < least) {
      least = d;
      best = candidate;
    }
  return best;
}

std::span<const std::int32_t> cells_of_group(const Mesh& mesh, std::string_view group, std::string_view keyword) {
  return members(mesh.cell_groups, mesh.node_groups, group, "cell", "node", keyword);
}

std::span<const std::int32_t> nodes_of_group(const Mesh& mesh, std::string_view group, std::string_view keyword) {
  return members(mesh.node_groups, mesh.cell_groups, group, "node", "cell", keyword);
}

std::vector<std::int32_t> nodes_of_cells(const Mesh& mesh, std::span<const std::int32_t> cells) {
  std::vector<std::int32_t> nodes;
  for (const std::int32_t cell : cells) {
    const auto own = mesh.cells[static_cast<std::size_t>(cell)];
    nodes.insert(nodes.end(), own.begin(), own.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace lacon
