// The meshes of a MED file that is written.
#include <algorithm>
#include <optional>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/formats/file_names.hpp"
#include "lacon/structures/formats/med.hpp"
#include "lacon/structures/formats/med_pieces.hpp"

namespace lacon {
namespace {

using namespace med;
using H5Group = hdf5::Group;

/// Rows of 80 characters, as arrays of bytes.
void write_names(const H5Group& group, const std::vector<std::string>& names) {
  const hsize_t width = group_name_length, rows = names.size();
  const hdf5::Handle type(H5Tarray_create2(H5T_STD_I8LE, 1, &width), H5Tclose);
  const hdf5::Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
  std::vector<char> bytes(rows * width, '\0');
  for (std::size_t i = 0; i < names.size(); ++i)
    std::copy(names[i].begin(), names[i].end(), bytes.begin() + static_cast<long>(i * width));
  const hdf5::Handle set(H5Dcreate2(group.id(), "NOM", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  if (set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
    fail("BASE_3", {{"file", group.path().string()}, {"reason", part("group_names_not_written")}});
}

/// The mesh as it will be read back: cells sorted by type, groups by name.
Mesh as_read(const Mesh& mesh) {
  Mesh sorted;
  sorted.dimension = mesh.dimension;
  sorted.coordinates = mesh.coordinates;
  std::vector<std::int32_t> number(mesh.n_cells());
  for (const auto& [type, cells] : by_type(mesh))
    CellCursor(cells).next(cells.size, [&](std::size_t, std::size_t first, std::size_t size) {
      for (std::size_t c = first; c < first + size; ++c) {
        number[c] = static_cast<std::int32_t>(sorted.n_cells());
        sorted.add_cell(mesh.types[c], mesh.cells[c]);
      }
    });
  const auto tidy = [](std::vector<Group> groups) {
    for (Group& group : groups) {
      std::sort(group.members.begin(), group.members.end());
      group.members.erase(std::unique(group.members.begin(), group.members.end()), group.members.end());
    }
    std::sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.name < b.name; });
    return groups;
  };
  std::vector<Group> cell_groups = mesh.cell_groups;
  for (Group& group : cell_groups)
    for (std::int32_t& member : group.members) member = number[static_cast<std::size_t>(member)];
  sorted.cell_groups = tidy(std::move(cell_groups));
  sorted.node_groups = tidy(mesh.node_groups);
  return sorted;
}

bool same_groups(const std::vector<Group>& a, const std::vector<Group>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Group& x, const Group& y) { return x.name == y.name && x.members == y.members; });
}

bool same_geometry(const Mesh& a, const Mesh& b) {
  return a.dimension == b.dimension && a.coordinates == b.coordinates && a.types == b.types && a.cells.values == b.cells.values;
}

/// Families: the set of groups an entity belongs to, numbered in order of appearance. Writes them below `parent`.
/// @param sign 1 for nodes, -1 for cells @return the family of each entity, empty where all are in none
std::vector<std::int32_t> write_families(const H5Group& root, const std::string& mesh, const char* kind, int sign,
                                         const std::vector<Group>& groups, std::size_t n_entities) {
  if (groups.empty()) return {};
  // the groups that an entity has been found in so far, as a number of `sets`
  std::vector<std::vector<std::int32_t>> sets{{}};
  std::vector<std::int32_t> set_of(n_entities, 0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto own = static_cast<std::int32_t>(g);
    std::map<std::int32_t, std::int32_t> with_this;  // a set -> the set with this group too
    std::int32_t last = -1, next = -1;
    for (const std::int32_t member : groups[g].members) {
      std::int32_t& set = set_of[static_cast<std::size_t>(member)];
      if (set != last) {
        last = set;
        std::vector<std::int32_t> larger = sets[static_cast<std::size_t>(set)];
        if (!larger.empty() && larger.back() == own) {
          next = set;  // named twice
        } else {
          const auto [at, is_new] = with_this.try_emplace(set, static_cast<std::int32_t>(sets.size()));
          larger.push_back(own);
          if (is_new) sets.push_back(std::move(larger));
          next = at->second;
        }
      }
      set = next;
    }
  }
  std::vector<std::int32_t> number(sets.size(), 0);  // of the family of a set
  std::vector<std::vector<std::int32_t>> families;
  std::vector<std::int32_t>& family = set_of;  // in place
  for (std::size_t i = 0; i < n_entities; ++i) {
    const auto set = static_cast<std::size_t>(set_of[i]);
    if (set > 0 && number[set] == 0) {
      families.push_back(sets[set]);
      number[set] = sign * static_cast<std::int32_t>(families.size());
    }
    family[i] = number[set];
  }
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (groups[g].members.empty()) families.push_back({static_cast<std::int32_t>(g)});
  if (families.empty()) return {};
  const H5Group parent = root.create("FAS/" + mesh + "/" + kind);
  for (std::size_t f = 0; f < families.size(); ++f) {
    const auto n = sign * static_cast<std::int64_t>(f + 1);
    const H5Group one = parent.create("FAM_" + std::to_string(n));
    set_int(one, "NUM", n);
    const H5Group list = one.create("GRO");
    set_int(list, "NBR", static_cast<std::int64_t>(families[f].size()));
    std::vector<std::string> names;
    for (const std::int32_t g : families[f]) names.push_back(groups[static_cast<std::size_t>(g)].name);
    write_names(list, names);
  }
  return family;
}

/// The mesh's group, with its attributes. @return that of its only time step
H5Group write_head(const H5Group& root, const Mesh& mesh, const std::string& name) {
  int dimension = 0;
  for (const CellType type : mesh.types) dimension = std::max(dimension, catalog::cell(type).dimension);
  const auto space = static_cast<std::size_t>(mesh.dimension);
  const std::vector<std::string> axes = {"X", "Y", "Z"};
  const H5Group group = root.create("ENS_MAA/" + name);
  set_int(group, "DIM", dimension);
  set_int(group, "ESP", mesh.dimension);
  set_int(group, "REP", 0);
  set_int(group, "TYP", 0);
  set_int(group, "SRT", 0);
  set_int(group, "NXT", -1);
  set_int(group, "NXI", -1);
  set_text(group, "UNT", "");
  set_text(group, "UNI", std::string(16 * space, ' '));
  set_text(group, "NOM", in_columns({axes.begin(), axes.begin() + mesh.dimension}));
  set_text(group, "DES", "written by Lacon");
  H5Group step = group.create(no_step);
  for (const auto& [attribute, value] :
       {std::pair("CGT", 1), {"NDT", -1}, {"NOR", -1}, {"NXT", -1}, {"NXI", -1}, {"PVT", -1}, {"PVI", -1}})
    set_int(step, attribute, value);
  step.set("PDT", -1.0);
  return step;
}

/// @param family of each node; empty without groups
void write_nodes(const H5Group& step, const Mesh& mesh, const std::vector<std::int32_t>& family) {
  const auto space = static_cast<std::size_t>(mesh.dimension);
  const H5Group nodes = step.create("NOE");
  set_int(nodes, "CGT", 1);
  set_int(nodes, "CGS", 1);
  set_text(nodes, "PFL", no_profile);
  write_numbers<double>(nodes, "COO", mesh.n_nodes(), space, [&](std::size_t first, std::span<double> part) {
    const std::size_t here = part.size() / space;
    const double* const from = mesh.coordinates.data() + 3 * first;
    with_known_size(space, [&](const auto n_axes) {
      for (std::size_t i = 0; i < here; ++i)
        for (std::size_t k = 0; k < n_axes; ++k) part[k * here + i] = from[3 * i + k];
    });
  });
  if (family.empty()) return;
  write_numbers<std::int32_t>(nodes, "FAM", mesh.n_nodes(), 1, [&](std::size_t first, std::span<std::int32_t> part) {
    std::copy_n(family.begin() + static_cast<std::ptrdiff_t>(first), part.size(), part.begin());
  });
}

/// An integer of each cell of a type. @param of  the cell's number in the mesh -> the integer
template <class Cells, class Of>
void write_integers(const H5Group& group, const char* dataset, const Cells& cells, const Of& of) {
  write_numbers<std::int32_t>(group, dataset, cells.size, 1,
                              [&, cursor = CellCursor(cells)](std::size_t, std::span<std::int32_t> part) mutable {
                                cursor.next(part.size(), [&](std::size_t place, std::size_t first, std::size_t n) {
                                  for (std::size_t i = 0; i < n; ++i) part[place + i] = of(first + i);
                                });
                              });
}

/// Nodes of each cell of a type, node by node, from 1, in MED's order.
template <class Cells>
void write_connectivity(const H5Group& group, const Mesh& mesh, const catalog::CellRow& row, const Cells& cells) {
  const auto size = static_cast<std::size_t>(row.n_nodes);
  write_numbers<std::int32_t>(group, "NOD", cells.size, size,
                              [&, cursor = CellCursor(cells)](std::size_t, std::span<std::int32_t> part) mutable {
                                const auto column = columns(row, part.size() / size);
                                cursor.next(part.size() / size, [&](std::size_t place, std::size_t first, std::size_t n) {
                                  const std::int32_t* const nodes_of_run = mesh.cells[first].data();
                                  with_known_size(size, [&](const auto n_columns) {
                                    for (std::size_t c = 0; c < n; ++c)
                                      for (std::size_t j = 0; j < n_columns; ++j)
                                        part[column[j] + place + c] = nodes_of_run[c * n_columns + j] + 1;
                                  });
                                });
                              });
}

/// @param family of each cell; empty without groups
void write_cells(const H5Group& step, const Mesh& mesh, const std::vector<std::int32_t>& family) {
  const H5Group all = step.create("MAI");
  set_int(all, "CGT", 1);
  for (const auto& [type, cells] : by_type(mesh)) {
    const catalog::CellRow& row = catalog::cell(type);
    const H5Group one = all.create(row.med_name);
    set_int(one, "CGT", 1);
    set_int(one, "CGS", 1);
    set_text(one, "PFL", no_profile);
    set_int(one, "GEO", row.dimension == 0 ? 1 : 100 * row.dimension + row.n_nodes);
    write_connectivity(one, mesh, row, cells);
    write_integers(one, "NUM", cells, [](std::size_t cell) { return static_cast<std::int32_t>(cell) + 1; });
    if (!family.empty()) write_integers(one, "FAM", cells, [&](std::size_t cell) { return family[cell]; });
  }
}

void write_mesh(const H5Group& root, const Mesh& mesh, const std::string& name) {
  for (const Group& group : mesh.cell_groups) check_name(root, part("type_group_ma"), group.name, group_name_length, false);
  for (const Group& group : mesh.node_groups) check_name(root, part("type_group_no"), group.name, group_name_length, false);
  const H5Group step = write_head(root, mesh, name);
  const H5Group families = root.create("FAS/" + name + "/FAMILLE_ZERO");
  set_int(families, "NUM", 0);
  const std::vector<std::int32_t> node_family = write_families(root, name, "NOEUD", 1, mesh.node_groups, mesh.n_nodes());
  const std::vector<std::int32_t> cell_family = write_families(root, name, "ELEME", -1, mesh.cell_groups, mesh.n_cells());
  write_nodes(step, mesh, node_family);
  write_cells(step, mesh, cell_family);
}

}  // namespace

std::string MedFile::add_mesh(const Mesh& mesh, std::string_view name) {
  check_name(root_, part("mesh"), name, name_length);
  std::optional<Mesh> wanted;
  bool there = false, same = false;
  const std::string chosen = free_name(std::string(name), [&](const std::string& candidate) {
    there = root_.has("ENS_MAA/" + candidate);
    if (!there) return true;
    if (!wanted) wanted = as_read(mesh);
    const Mesh present = read_mesh(root_, candidate);
    same = same_groups(present.cell_groups, wanted->cell_groups) && same_groups(present.node_groups, wanted->node_groups);
    return same_geometry(present, *wanted);
  });
  if (there && same) return chosen;
  if (there)
    for (const char* part : {"ENS_MAA/", "FAS/"}) H5Ldelete(root_.id(), (part + chosen).c_str(), H5P_DEFAULT);
  write_mesh(root_, mesh, chosen);
  return chosen;
}

}  // namespace lacon
