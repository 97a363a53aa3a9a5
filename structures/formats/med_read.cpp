#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/text.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/formats/file_names.hpp"
#include "lacon/structures/formats/med.hpp"
#include "lacon/structures/formats/med_layout.hpp"
#include "lacon/structures/formats/text_file.hpp"
#include "lacon/structures/memory.hpp"

namespace lacon {
namespace {

using H5Group = hdf5::Group;
namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

/// The size of a file, which may be one that is being written.
std::uint64_t bytes_of_file(const H5Group& root) {
  const hdf5::Handle file(H5Iget_file_id(root.id()), H5Fclose);
  hsize_t size = 0;
  H5Fget_filesize(file, &size);
  return size;
}

hdf5::Reader open(const fs::path& file) {
  if (first_bytes(file, 8) != "\x89HDF\r\n\x1a\n") fail("MED_2", {{"file", file.string()}, {"reason", part("file_not_hdf5")}});
  return hdf5::Reader(file, hdf5::Origin::elsewhere);
}

/// The root of a MED file of a version that is read.
hdf5::Reader open_med(const fs::path& file) {
  hdf5::Reader root = [&] {
    try {
      return open(file);
    } catch (const Error& error) {
      if (error.message().id != "BASE_2") throw;
      fail("MED_1", {{"file", file.string()}, {"reason", part("file_cut_off")}});
    }
  }();
  if (!root.is_group("INFOS_GENERALES")) fail("MED_2", {{"file", file.string()}, {"reason", part("med_no_header")}});
  const H5Group about = root.open("INFOS_GENERALES");
  for (const char* number : {"MAJ", "MIN", "REL"})
    if (!about.has_attribute(number)) fail("MED_2", {{"file", file.string()}, {"reason", part("med_no_version")}});
  const std::int64_t major = about.integer("MAJ");
  if (major < 2 || major > 4) {
    const std::string version =
        std::to_string(major) + "." + std::to_string(about.integer("MIN")) + "." + std::to_string(about.integer("REL"));
    fail("MED_3", {{"file", file.string()}, {"version", version}});
  }
  return root;
}

std::vector<std::string> mesh_names(const H5Group& root) {
  return root.is_group("ENS_MAA") ? root.open("ENS_MAA").children() : std::vector<std::string>{};
}

/// Reads one mesh; knows its name and file for the messages.
class MeshReader {
 public:
  MeshReader(const H5Group& root, std::string name)
      : root_(root), name_(std::move(name)), version_(root.open("INFOS_GENERALES").integer("MAJ")) {}

  Mesh read();

 private:
  /// Groups of nodes or of cells, by name, while they are read; of each family that is there, the groups that it stands for.
  struct Families {
    std::map<std::string, std::vector<med::Run>> members;
    std::map<std::int64_t, std::vector<std::vector<med::Run>*>> groups_of{{0, {}}};  // 0: in no group
    std::vector<Group> groups() const;
  };
  [[noreturn]] void damaged(const std::string& reason) const {
    fail("MED_7", {{"mesh", name_}, {"file", root_.path().string()}, {"reason", reason}});
  }
  [[noreturn]] void unsuitable(const std::string& reason) const {
    fail("MED_10", {{"mesh", name_}, {"file", root_.path().string()}, {"reason", reason}});
  }
  std::int64_t integer(const H5Group& group, const char* attribute, const std::string& where) const {
    if (!group.has_attribute(attribute)) damaged(part("has_no_attribute", {{"where", where}, {"attribute", attribute}}));
    return group.integer(attribute);
  }
  H5Group first_step(const H5Group& mesh) const;
  H5Group entities(const H5Group& parent, const std::string& name, const std::string& where) const;
  template <class T, class Visit>
  void dataset(const H5Group& group, const std::string& name, const std::string& where, std::size_t rows, std::size_t columns,
               const Visit& visit) const;
  std::size_t size_of(const H5Group& group, const char* dataset) const;
  std::int64_t rows_of(const H5Group& group, const char* dataset, std::size_t columns) const;
  std::size_t columns_of_cells(const H5Group& group, std::size_t n, std::size_t n_nodes) const;
  void read_nodes(const H5Group& step, std::int64_t space);
  void read_cells(const H5Group& step);
  Families families(const char* kind);
  void read_members(const H5Group& group, const std::string& where, std::size_t first, std::size_t n, Families& families);

  const H5Group& root_;
  std::string name_;
  std::int64_t version_;  ///< 2: no computation steps, families of nodes and cells side by side
  /// How many more members all groups may have: a file may put each of many nodes into each of many groups (docs/trust.md).
  std::uint64_t memberships_left_ = 16 * bytes_of_file(root_);
  FileNames file_names_;
  Mesh mesh_;
  Families node_families_, cell_families_;
};

/// The computation step of the lowest (NDT, NOR); "no step" (-1, -1) comes before every other.
H5Group MeshReader::first_step(const H5Group& mesh) const {
  if (version_ == 2) return root_.open("ENS_MAA/" + name_);
  std::string first;
  std::pair<std::int64_t, std::int64_t> lowest;
  for (const std::string& child : mesh.children()) {
    if (!mesh.is_group(child)) continue;
    const H5Group step = mesh.open(child);
    if (!step.has_attribute("NDT") || !step.has_attribute("NOR")) continue;
    const std::pair key(step.integer("NDT"), step.integer("NOR"));
    if (first.empty() || key < lowest) first = child, lowest = key;
  }
  if (first.empty()) damaged(part("med_no_step"));
  return mesh.open(first);
}

/// The group that holds the datasets of an entity. Files of all versions keep them directly in it; where it names a profile,
/// they belong to a part of the entities, which is not a whole mesh.
H5Group MeshReader::entities(const H5Group& parent, const std::string& name, const std::string& where) const {
  if (!parent.is_group(name)) damaged(part("med_has_no", {{"what", where}}));
  H5Group group = parent.open(name);
  const std::string profile = group.has_attribute("PFL") ? group.text("PFL") : std::string(med::no_profile);
  if (!profile.empty() && profile != med::no_profile)
    unsuitable(part("med_has_profile", {{"what", where}, {"profile", profile}}));
  return group.is_group(med::no_profile) ? group.open(med::no_profile) : std::move(group);
}

/// Read a dataset of `columns` columns by parts: hdf5::Group::read_columns().
template <class T, class Visit>
void MeshReader::dataset(const H5Group& group, const std::string& name, const std::string& where, std::size_t rows,
                         std::size_t columns, const Visit& visit) const {
  try {
    std::size_t found = 1;  // before reading: a spoilt file may claim any size
    for (const hsize_t extent : group.shape(name)) found *= extent;
    if (found != rows * columns)
      damaged(part("med_dataset_size", {{"dataset", name},
                                        {"what", where},
                                        {"found", std::to_string(found)},
                                        {"expected", std::to_string(rows * columns)}}));
    group.read_columns<T>(name, columns, visit);
  } catch (const Error& error) {
    if (error.message().id != "BASE_2") throw;
    damaged(part("med_dataset_unreadable", {{"dataset", name}, {"what", where}}));
  }
}

/// How many columns NOD has: a column a node; the first files of version 2 have one more behind these for some types.
std::size_t MeshReader::columns_of_cells(const H5Group& group, std::size_t n, std::size_t n_nodes) const {
  if (version_ != 2 || n == 0) return n_nodes;
  return size_of(group, "NOD") == n * (n_nodes + 1) ? n_nodes + 1 : n_nodes;
}

std::size_t MeshReader::size_of(const H5Group& group, const char* dataset) const {
  std::size_t found = 1;
  for (const hsize_t extent : group.shape(dataset)) found *= extent;
  return found;
}

/// The attribute NBR of a dataset; where version 2 lacks it, by the dataset's size.
std::int64_t MeshReader::rows_of(const H5Group& group, const char* dataset, std::size_t columns) const {
  const std::int64_t said = med::dataset_integer(group, dataset, "NBR");
  return said < 0 && version_ == 2 ? static_cast<std::int64_t>(size_of(group, dataset) / columns) : said;
}

void MeshReader::read_nodes(const H5Group& step, std::int64_t space) {
  const H5Group nodes = entities(step, "NOE", part("nodes"));
  if (!nodes.has("COO") || nodes.is_group("COO")) damaged(part("mesh_no_coordinates"));
  std::int64_t count = rows_of(nodes, "COO", static_cast<std::size_t>(space));
  if (count < 0) damaged(part("med_dataset_without", {{"dataset", "COO"}, {"what", part("nodes")}, {"attribute", "NBR"}}));
  if (count == 0) damaged(part("mesh_no_nodes"));
  if (count > std::numeric_limits<std::int32_t>::max() / 4)
    unsuitable(part("med_too_many", {{"count", std::to_string(count)}, {"what", part("nodes")}}));
  const auto n = static_cast<std::size_t>(count);
  const auto axes = static_cast<std::size_t>(space);
  dataset<double>(nodes, "COO", part("nodes"), n, axes, [&](std::size_t first, std::span<const double> part) {
    if (first == 0) reserve_pages(mesh_.coordinates, 3 * n, with_room(3 * n));
    const std::size_t here = part.size() / axes;
    mesh_.coordinates.resize(3 * (first + here));
    double* const to = mesh_.coordinates.data() + 3 * first;
    with_known_size(axes, [&](const auto n_axes) {
      for (std::size_t i = 0; i < here; ++i)
        for (std::size_t k = 0; k < n_axes; ++k) to[3 * i + k] = part[k * here + i];
    });
    for (std::size_t i = 0; i < 3 * here; ++i)
      if (!std::isfinite(to[i]))
        fail("MED_9", {{"mesh", name_}, {"file", root_.path().string()}, {"node", std::to_string(first + i / 3 + 1)}});
  });
  read_members(nodes, part("nodes"), 0, n, node_families_);
}

void MeshReader::read_cells(const H5Group& step) {
  if (!step.is_group("MAI")) damaged(part("mesh_no_cells"));
  const H5Group all = step.open("MAI");
  const std::vector<std::string> present = all.children();
  for (const std::string& type : present) {
    const auto known =
        std::any_of(catalog::cells().begin(), catalog::cells().end(), [&](const auto& row) { return row.med_name == type; });
    if (known) continue;
    std::string list;
    for (const catalog::CellRow& row : catalog::cells()) list += (list.empty() ? "" : ", ") + std::string(row.name);
    const std::string what = type == "POG" || type == "PO2" ? " (" + part("polygons") + ")"
                             : type == "POE"                ? " (" + part("polyhedra") + ")"
                                                            : "";
    fail("MED_6", {{"mesh", name_}, {"file", root_.path().string()}, {"type", type}, {"what", what}, {"known", list}});
  }
  const auto n_nodes = static_cast<std::int32_t>(mesh_.n_nodes());
  for (const catalog::CellRow& row : catalog::cells()) {
    const std::string type(row.med_name);
    if (!all.has(type)) continue;
    const std::string where = part("cells_of_type", {{"type", type}});
    const H5Group group = entities(all, type, where);
    if (!group.has("NOD") || group.is_group("NOD")) damaged(part("med_no_connectivity", {{"what", where}}));
    const std::int64_t count = rows_of(group, "NOD", static_cast<std::size_t>(row.n_nodes));
    if (count < 0) damaged(part("med_dataset_without", {{"dataset", "NOD"}, {"what", where}, {"attribute", "NBR"}}));
    if (count > std::numeric_limits<std::int32_t>::max() / 32)
      unsuitable(part("med_too_many", {{"count", std::to_string(count)}, {"what", where}}));
    const auto n = static_cast<std::size_t>(count);
    const std::size_t size = static_cast<std::size_t>(row.n_nodes), stored = columns_of_cells(group, n, size);
    dataset<std::int32_t>(group, "NOD", where, n, stored, [&](std::size_t first, std::span<const std::int32_t> all_columns) {
      const std::size_t here = all_columns.size() / stored;
      const std::span<const std::int32_t> part = all_columns.first(here * size);
      const std::size_t before = mesh_.cells.values.size();
      const auto column = med::columns(row, here);
      std::uint32_t largest = 0;  // of node - 1, where those below 1 are huge: all at once in vector registers
      for (const std::int32_t node : part) largest = std::max(largest, static_cast<std::uint32_t>(node) - 1);
      const bool sound = largest < static_cast<std::uint32_t>(n_nodes);
      for (std::size_t c = 0; !sound && c < here; ++c)
        for (std::size_t j = 0; j < size; ++j)
          if (const std::int32_t node = part[column[j] + c]; node < 1 || node > n_nodes)
            fail("MED_8", {{"mesh", name_},
                           {"file", root_.path().string()},
                           {"type", type},
                           {"cell", std::to_string(first + c + 1)},
                           {"node", std::to_string(node)},
                           {"nodes", std::to_string(n_nodes)}});
      if (first == 0) reserve_pages(mesh_.cells.values, before + n * size, with_room(before + n * size));
      mesh_.cells.values.resize(before + part.size());
      std::int32_t* const to = mesh_.cells.values.data() + before;
      with_known_size(size, [&](const auto columns) {
        for (std::size_t c = 0; c < here; ++c)
          for (std::size_t j = 0; j < columns; ++j) to[c * columns + j] = part[column[j] + c] - 1;
      });
    });
    read_members(group, where, mesh_.n_cells(), n, cell_families_);
    mesh_.types.insert(mesh_.types.end(), n, row.type);
    std::vector<std::int64_t>& offset = mesh_.cells.offset;
    std::int64_t end = offset.back();
    reserve_pages(offset, offset.size() + n, with_room(offset.size() + n));
    offset.resize(offset.size() + n);
    for (auto own = offset.end() - static_cast<std::ptrdiff_t>(n); own != offset.end(); ++own) *own = end += row.n_nodes;
  }
  if (mesh_.n_cells() == 0) damaged(part("mesh_no_cells"));
}

MeshReader::Families MeshReader::families(const char* kind) {
  Families families;
  const std::string both = "ENS_MAA/" + name_ + "/FAS", path = "FAS/" + name_ + "/" + kind;  // before MED 2.2: of both kinds
  const bool mixed = version_ == 2 && !root_.is_group(path) && root_.is_group(both);
  if (!mixed && !root_.is_group(path)) return families;
  const H5Group all = root_.open(mixed ? both : path);
  for (const std::string& child : all.children()) {
    const H5Group one = all.open(child);
    const std::int64_t number = integer(one, "NUM", part("med_family", {{"family", child}}));
    if (mixed && (number > 0) != (std::string_view(kind) == "NOEUD")) continue;  // those of nodes are positive
    std::vector<std::vector<med::Run>*>& groups = families.groups_of[number];
    groups.clear();
    if (!one.is_group("GRO")) continue;
    const H5Group list = one.open("GRO");
    const std::int64_t count = integer(list, "NBR", part("med_groups_of_family", {{"family", child}}));
    const std::vector<std::string> names = med::read_names(list, "NOM");
    if (static_cast<std::int64_t>(names.size()) != count) damaged(part("med_group_names", {{"family", child}}));
    std::set<std::string> own;  // a family may name a group twice
    for (const std::string& name : names) own.insert(file_names_.read(name));
    for (const std::string& name : own) {
      std::vector<med::Run>& members = families.members[name];
      if (number != 0) groups.push_back(&members);
    }
  }
  return families;
}

/// Put `n` entities, of the numbers from `first` on, into the groups of their families.
void MeshReader::read_members(const H5Group& group, const std::string& where, std::size_t first, std::size_t n,
                              Families& families) {
  if (!group.has("FAM")) return;
  dataset<std::int32_t>(group, "FAM", where, n, 1, [&](std::size_t begin, std::span<const std::int32_t> family) {
    for (std::size_t i = 0, end = 0; i < family.size(); i = end) {  // a run of one family
      while (end < family.size() && family[end] == family[i]) ++end;
      const auto number = static_cast<std::int32_t>(first + begin + i);
      const auto groups = families.groups_of.find(family[i]);
      if (groups == families.groups_of.end())
        damaged(part("med_no_family", {{"family", std::to_string(family[i])},
                                       {"member", &families == &node_families_ ? node_name(number) : cell_name(number)}}));
      const std::uint64_t more = groups->second.size() * (end - i);
      if (more > memberships_left_) damaged(part("too_many_members"));
      memberships_left_ -= more;
      for (std::vector<med::Run>* members : groups->second) members->push_back({number, static_cast<std::int32_t>(end - i)});
    }
  });
}

std::vector<Group> MeshReader::Families::groups() const {
  std::vector<Group> all;
  for (const auto& [name, runs] : members) {
    std::size_t size = 0;
    for (const med::Run& run : runs) size += static_cast<std::size_t>(run.size);
    std::vector<std::int32_t>& list = all.emplace_back(Group{name, {}}).members;
    reserve_pages(list, size, with_room(size));
    for (const med::Run& run : runs)
      for (std::int32_t i = 0; i < run.size; ++i) list.push_back(run.first + i);
  }
  return all;
}

Mesh MeshReader::read() {
  const H5Group group = root_.open("ENS_MAA/" + name_);
  mesh_.name = file_names_.read(name_);
  const std::int64_t space = integer(group, version_ == 2 && !group.has_attribute("ESP") ? "DIM" : "ESP", part("it"));
  if (space != 2 && space != 3) unsuitable(part("med_axes", {{"count", std::to_string(space)}}));
  if (group.has_attribute("TYP") && group.integer("TYP") != 0) unsuitable(part("mesh_is_grid"));
  if (group.has_attribute("REP") && group.integer("REP") != 0) unsuitable(part("mesh_not_cartesian"));
  const H5Group step = first_step(group);
  node_families_ = families("NOEUD");
  cell_families_ = families("ELEME");
  read_nodes(step, space);
  read_cells(step);
  mesh_.node_groups = node_families_.groups();
  mesh_.cell_groups = cell_families_.groups();
  mesh_.dimension = space == 2 ? 2 : least_dimension(mesh_);
  file_names_.tell(root_.path());
  return std::move(mesh_);
}

}  // namespace

namespace med {

Mesh read_mesh(const H5Group& root, const std::string& name) {
  try {
    return MeshReader(root, name).read();
  } catch (const Error& error) {
    if (error.message().id != "BASE_2") throw;
    fail("MED_7", {{"mesh", name}, {"file", root.path().string()}, {"reason", error.message().text}});
  }
}

void check_appendable(const fs::path& file) {
  const H5Group about = open_med(file).open("INFOS_GENERALES");
  if (about.integer("MAJ") != 4 || about.integer("MIN") != 1)
    fail("MED_13", {{"file", file.string()},
                    {"version", std::to_string(about.integer("MAJ")) + "." + std::to_string(about.integer("MIN"))}});
}

}  // namespace med

std::vector<std::string> med_mesh_names(const fs::path& file) { return mesh_names(open_med(file)); }

Mesh read_med_mesh(const fs::path& file, std::string_view name) {
  const hdf5::Reader root = open_med(file);
  const std::vector<std::string> known = mesh_names(root);
  if (known.empty()) fail("MED_4", {{"file", file.string()}});
  std::string chosen(name);
  if (chosen.empty()) {
    chosen = known.front();
    if (known.size() > 1)
      inform("MED_11",
             {{"file", file.string()}, {"count", std::to_string(known.size())}, {"known", joined(known)}, {"mesh", chosen}});
  } else if (const auto at = std::ranges::find(known, chosen, as_utf8); at != known.end()) {
    chosen = *at;
  } else {
    fail("MED_5", {{"file", file.string()}, {"mesh", chosen}, {"known", joined(known)}});
  }
  return med::read_mesh(root, chosen);
}

}  // namespace lacon
