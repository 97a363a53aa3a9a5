#include <algorithm>

#include "lacon/structures/storage/storage.hpp"

#include "lacon/catalog/wording.hpp"
#include "lacon/structures/storage/pieces.hpp"

namespace lacon::storage {
namespace {

void write_groups(const hdf5::Group& root, const std::string& name, const std::vector<Group>& groups) {
  std::vector<std::string> names;
  Ragged<std::int32_t> members;
  for (const Group& g : groups) {
    names.push_back(g.name);
    members.push_back(g.members);
  }
  root.write_strings(name + "/name", names);
  write_ragged(root, name, members);
}

std::vector<Group> read_groups(const hdf5::Group& root, const std::string& name, std::size_t n_entities) {
  std::vector<Group> groups;
  if (!root.has(name)) return groups;
  const std::vector<std::string> names = root.read_strings(name + "/name");
  const auto members = read_ragged<std::int32_t>(root, name);
  if (members.size() != names.size()) refuse(root, part("is_inconsistent", {{"what", name}}));
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const std::int32_t m : members[i])
      if (m < 0 || static_cast<std::size_t>(m) >= n_entities)
        refuse(root, part("group_names_member", {{"group", names[i]}, {"member", std::to_string(m)}}));
    groups.push_back({names[i], {members[i].begin(), members[i].end()}});
  }
  return groups;
}

/// Patches that fit each other and their mesh.
void check(const hdf5::Group& root, const Mesh& mesh) {
  const Patches& patches = *mesh.patches;
  const auto below = [](const Ragged<std::int32_t>& rows, std::size_t n) {
    return std::all_of(rows.values.begin(), rows.values.end(),
                       [n](std::int32_t i) { return i >= 0 && static_cast<std::size_t>(i) < n; });
  };
  const std::vector<std::int64_t>& offset = patches.zone_offset;
  const bool sound = offset.size() == patches.zone_group.size() + 1 && offset.front() == 0 &&
                     std::is_sorted(offset.begin(), offset.end()) &&
                     offset.back() == static_cast<std::int64_t>(patches.size()) && patches.parent.size() == patches.size() &&
                     patches.cells.size() == patches.size() && patches.carriers.size() == patches.size() &&
                     below(patches.cells, mesh.n_cells()) && below(patches.carriers, mesh.n_nodes());
  if (!sound) refuse(root, part("is_inconsistent", {{"what", "patches"}}));
}

}  // namespace

Mesh read_mesh(const hdf5::Group& root) {
  Mesh mesh;
  mesh.name = root.text("name");
  mesh.dimension = static_cast<int>(root.integer("dimension"));
  if (mesh.dimension != 2 && mesh.dimension != 3) refuse(root, part("mesh_dimensions"));
  mesh.coordinates = root.read<double>("coordinates", with_room);
  if (root.has("first_place")) mesh.first_place = root.read<double>("first_place");
  if (mesh.coordinates.size() % 3 != 0) refuse(root, part("node_coordinates"));
  const hdf5::Group cells = root.open("cells");
  std::vector<CellType> types;
  for (const std::string& name : cells.attribute_strings("types")) {
    const auto type = catalog::find_cell(name);
    if (!type) refuse(root, part("no_cell_type", {{"type", name}}));
    types.push_back(*type);
  }
  mesh.cells = read_ragged<std::int32_t>(cells, "offset", "nodes", with_room);
  const std::vector<std::int8_t> codes = cells.read<std::int8_t>("type");
  mesh.types.reserve(with_room(codes.size()));
  for (const std::int8_t code : codes) {
    if (code < 0 || static_cast<std::size_t>(code) >= types.size())
      refuse(root, part("cell_has_type", {{"type", std::to_string(code)}}));
    mesh.types.push_back(types[static_cast<std::size_t>(code)]);
  }
  if (mesh.types.size() != mesh.cells.size())
    refuse(root, part("does_not_fit", {{"what", "cells/type"}, {"other", "cells/offset"}}));
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    if (mesh.cells[c].size() != static_cast<std::size_t>(mesh.row(c).n_nodes))
      refuse(root, part("cell_wrong_nodes", {{"cell", cell_name(static_cast<std::int64_t>(c))}}));
    for (const std::int32_t n : mesh.cells[c])
      if (n < 0 || static_cast<std::size_t>(n) >= mesh.n_nodes())
        refuse(root, part("cell_unknown_node", {{"cell", cell_name(static_cast<std::int64_t>(c))}}));
  }
  mesh.cell_groups = read_groups(root, "groups/cells", mesh.n_cells());
  mesh.node_groups = read_groups(root, "groups/nodes", mesh.n_nodes());
  if (root.has("patches")) {
    const hdf5::Group group = root.open("patches");
    Patches& patches = mesh.patches.emplace();
    patches.zone_group = group.read_strings("zone_group");
    patches.zone_offset = group.read<std::int64_t>("zone_offset");
    patches.kind = group.read<std::int32_t>("kind");
    patches.parent = group.read<std::int32_t>("parent");
    patches.cells = read_ragged<std::int32_t>(group, "cells");
    patches.carriers = read_ragged<std::int32_t>(group, "carriers");
    check(root, mesh);
  }
  return mesh;
}

void write(const hdf5::Group& root, const Mesh& mesh) {
  root.set("name", mesh.name);
  root.set("dimension", std::int64_t{mesh.dimension});
  root.write("coordinates", mesh.coordinates, {mesh.n_nodes(), 3});
  if (!mesh.first_place.empty()) root.write("first_place", mesh.first_place);
  const hdf5::Group cells = root.create("cells");
  std::vector<std::string> names;
  for (const catalog::CellRow& row : catalog::cells()) names.emplace_back(row.name);
  cells.set("types", names);
  std::vector<std::int8_t> codes;
  for (const CellType type : mesh.types) codes.push_back(static_cast<std::int8_t>(type));
  cells.write("type", codes);
  cells.write("offset", mesh.cells.offset);
  cells.write("nodes", mesh.cells.values);
  write_groups(root, "groups/cells", mesh.cell_groups);
  write_groups(root, "groups/nodes", mesh.node_groups);
  if (mesh.patches) {
    const hdf5::Group group = root.create("patches");
    group.write_strings("zone_group", mesh.patches->zone_group);
    group.write("zone_offset", mesh.patches->zone_offset);
    group.write("kind", mesh.patches->kind);
    group.write("parent", mesh.patches->parent);
    write_ragged(group, "cells", mesh.patches->cells);
    write_ragged(group, "carriers", mesh.patches->carriers);
  }
}

std::vector<std::string> references(const Mesh&) { return {}; }

}  // namespace lacon::storage
