#include <algorithm>
#include <cstdio>
#include <numeric>
#include <optional>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/formats/med.hpp"
#include "lacon/structures/formats/med_layout.hpp"
#include "lacon/structures/formats/parts.hpp"

namespace lacon {
namespace {

using H5Group = hdf5::Group;
namespace fs = std::filesystem;

// ---------------------------------------------------------------------------------------------- pieces of MED

void set_int(const H5Group& group, const char* name, std::int64_t value) { group.set(name, static_cast<std::int32_t>(value)); }

/// MED keeps text attributes as zero-ended strings of fixed length.
void set_text(const H5Group& group, const char* name, std::string_view value) {
  const hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, value.size() + 1);
  const hdf5::Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  if (group.has_attribute(name)) H5Adelete(group.id(), name);
  const hdf5::Handle attribute(H5Acreate2(group.id(), name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const std::string text(value);
  if (attribute < 0 || H5Awrite(attribute, type, text.c_str()) < 0)
    fail("BASE_3", {{"file", group.path().string()}, {"reason", std::string("the attribute ") + name + " cannot be written"}});
}

void set_mask(const H5Group& group, const char* name, std::uint32_t value) {
  const hdf5::Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  if (group.has_attribute(name)) H5Adelete(group.id(), name);
  const hdf5::Handle attribute(H5Acreate2(group.id(), name, H5T_STD_B32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(attribute, H5T_NATIVE_B32, &value);
}

/// A dataset of `columns` numbers for each of `count` nodes or cells, with the attributes that MED gives it.
/// @param fill as of hdf5::Group::write_columns()
template <class T, class Fill>
void write_numbers(const H5Group& group, const char* name, std::size_t count, std::size_t columns, const Fill& fill) {
  group.write_columns<T>(name, count, columns, fill);
  const hdf5::Handle set(H5Dopen2(group.id(), name, H5P_DEFAULT), H5Dclose);
  const hdf5::Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  for (const auto& [attribute, value] :
       {std::pair("CGT", std::int32_t{1}), std::pair("NBR", static_cast<std::int32_t>(count))}) {
    const hdf5::Handle id(H5Acreate2(set, attribute, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(id, H5T_NATIVE_INT32, &value);
  }
}

/// Rows of 80 characters, as arrays of bytes.
void write_names(const H5Group& group, const std::vector<std::string>& names) {
  const hsize_t width = med::group_name_length, rows = names.size();
  const hdf5::Handle type(H5Tarray_create2(H5T_STD_I8LE, 1, &width), H5Tclose);
  const hdf5::Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
  std::vector<char> bytes(rows * width, '\0');
  for (std::size_t i = 0; i < names.size(); ++i)
    std::copy(names[i].begin(), names[i].end(), bytes.begin() + static_cast<long>(i * width));
  const hdf5::Handle set(H5Dcreate2(group.id(), "NOM", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  if (set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
    fail("BASE_3", {{"file", group.path().string()}, {"reason", "the group names cannot be written"}});
}

/// The group of this name, made where it is not there.
H5Group child(const H5Group& group, const std::string& name) { return group.has(name) ? group.open(name) : group.create(name); }

/// Name in MED files of a computation step.
std::string step_name(std::int64_t ndt, std::int64_t nor) {
  char text[64];
  std::snprintf(text, sizeof text, "%020lld%020lld", static_cast<long long>(ndt), static_cast<long long>(nor));
  return text;
}

/// 16 characters each, one behind the other.
std::string columns(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    std::string column = name.substr(0, 16);
    column.resize(16, ' ');
    text += column;
  }
  return text;
}

/// @param is_link the name becomes that of an HDF5 group, which cannot hold a '/'
void check_name(const H5Group& root, const char* what, std::string_view name, std::size_t length, bool is_link = true) {
  if (name.empty() || name.size() > length || (is_link && name.find('/') != std::string_view::npos))
    fail("MED_12",
         {{"file", root.path().string()}, {"what", what}, {"name", std::string(name)}, {"length", std::to_string(length)}});
}

/// `name`, or `name_2`, `name_3`, ...: the first that `fits`.
template <class Fits>
std::string free_name(const std::string& name, Fits fits) {
  std::string candidate = name;
  for (int k = 2; !fits(candidate); ++k) candidate = name + "_" + std::to_string(k);
  return candidate;
}

// ---------------------------------------------------------------------------------------------- meshes

/// Cells of one type, in the order of the mesh.
struct CellList {
  std::vector<med::Run> runs;
  std::size_t size = 0;
};

/// The cells of each type: what MED keeps together.
std::map<CellType, CellList> by_type(const Mesh& mesh) {
  std::map<CellType, CellList> cells;
  for_each_run(mesh, [&](const catalog::CellRow& row, std::size_t first, std::size_t size) {
    CellList& list = cells[row.type];
    list.runs.push_back({static_cast<std::int32_t>(first), static_cast<std::int32_t>(size)});
    list.size += size;
  });
  return cells;
}

/// Goes through the cells of a list in its order, some at a time.
class CellCursor {
 public:
  explicit CellCursor(const CellList& cells) : run_(cells.runs.begin()) {}

  /// The next `n` cells as runs. @param visit(place among them, first cell, how many)
  template <class Visit>
  void next(std::size_t n, const Visit& visit) {
    for (std::size_t place = 0; place < n;) {
      const std::size_t size = std::min(n - place, static_cast<std::size_t>(run_->size) - done_);
      visit(place, static_cast<std::size_t>(run_->first) + done_, size);
      place += size;
      done_ += size;
      if (done_ == static_cast<std::size_t>(run_->size)) ++run_, done_ = 0;
    }
  }

 private:
  std::vector<med::Run>::const_iterator run_;
  std::size_t done_ = 0;  ///< of this run
};

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

void write_mesh(const H5Group& root, const Mesh& mesh, const std::string& name) {
  for (const Group& group : mesh.cell_groups) check_name(root, "group of cells", group.name, med::group_name_length, false);
  for (const Group& group : mesh.node_groups) check_name(root, "group of nodes", group.name, med::group_name_length, false);
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
  set_text(group, "NOM", columns({axes.begin(), axes.begin() + mesh.dimension}));
  set_text(group, "DES", "written by Lacon");
  const H5Group step = group.create(med::no_step);
  for (const auto& [attribute, value] :
       {std::pair("CGT", 1), {"NDT", -1}, {"NOR", -1}, {"NXT", -1}, {"NXI", -1}, {"PVT", -1}, {"PVI", -1}})
    set_int(step, attribute, value);
  step.set("PDT", -1.0);

  const H5Group families = root.create("FAS/" + name + "/FAMILLE_ZERO");
  set_int(families, "NUM", 0);
  const std::vector<std::int32_t> node_family = write_families(root, name, "NOEUD", 1, mesh.node_groups, mesh.n_nodes());
  const std::vector<std::int32_t> cell_family = write_families(root, name, "ELEME", -1, mesh.cell_groups, mesh.n_cells());

  const H5Group nodes = step.create("NOE");
  set_int(nodes, "CGT", 1);
  set_int(nodes, "CGS", 1);
  set_text(nodes, "PFL", med::no_profile);
  write_numbers<double>(nodes, "COO", mesh.n_nodes(), space, [&](std::size_t first, std::span<double> part) {
    const std::size_t here = part.size() / space;
    const double* const from = mesh.coordinates.data() + 3 * first;
    with_known_size(space, [&](const auto n_axes) {
      for (std::size_t i = 0; i < here; ++i)
        for (std::size_t k = 0; k < n_axes; ++k) part[k * here + i] = from[3 * i + k];
    });
  });
  if (!node_family.empty())
    write_numbers<std::int32_t>(nodes, "FAM", mesh.n_nodes(), 1, [&](std::size_t first, std::span<std::int32_t> part) {
      std::copy_n(node_family.begin() + static_cast<std::ptrdiff_t>(first), part.size(), part.begin());
    });

  const H5Group all = step.create("MAI");
  set_int(all, "CGT", 1);
  for (const auto& [type, cells] : by_type(mesh)) {
    const catalog::CellRow& row = catalog::cell(type);
    const H5Group one = all.create(row.med_name);
    set_int(one, "CGT", 1);
    set_int(one, "CGS", 1);
    set_text(one, "PFL", med::no_profile);
    set_int(one, "GEO", row.dimension == 0 ? 1 : 100 * row.dimension + row.n_nodes);
    const auto size = static_cast<std::size_t>(row.n_nodes);
    write_numbers<std::int32_t>(one, "NOD", cells.size, size,
                                [&, cursor = CellCursor(cells)](std::size_t, std::span<std::int32_t> part) mutable {
                                  const auto column = med::columns(row, part.size() / size);
                                  cursor.next(part.size() / size, [&](std::size_t place, std::size_t first, std::size_t n) {
                                    const std::int32_t* const nodes_of_run = mesh.cells[first].data();
                                    with_known_size(size, [&](const auto n_columns) {
                                      for (std::size_t c = 0; c < n; ++c)
                                        for (std::size_t j = 0; j < n_columns; ++j)
                                          part[column[j] + place + c] = nodes_of_run[c * n_columns + j] + 1;
                                    });
                                  });
                                });
    const auto write_integers = [&](const char* dataset, const auto& of) {
      write_numbers<std::int32_t>(one, dataset, cells.size, 1,
                                  [&, cursor = CellCursor(cells)](std::size_t, std::span<std::int32_t> part) mutable {
                                    cursor.next(part.size(), [&](std::size_t place, std::size_t first, std::size_t n) {
                                      for (std::size_t i = 0; i < n; ++i) part[place + i] = of(first + i);
                                    });
                                  });
    };
    write_integers("NUM", [](std::size_t cell) { return static_cast<std::int32_t>(cell) + 1; });
    if (!cell_family.empty()) write_integers("FAM", [&](std::size_t cell) { return cell_family[cell]; });
  }
}

// ---------------------------------------------------------------------------------------------- fields

/// The geometric types of MED, by which it numbers the bits of its masks: 100 x dimension + nodes, 1 for a point.
constexpr std::int32_t geometries[] = {1,   102, 103, 104, 203, 204, 206, 207, 208, 209, 304,
                                       305, 306, 308, 310, 312, 313, 315, 318, 320, 327};

struct Entity {
  std::string_view prefix;  ///< of its groups in a step: "MAI." + type
  std::uint32_t bit;        ///< in LEN
  const char* geometry;     ///< mask of geometric types
  const char* steps;        ///< of the field: in how many steps that mask is the same
};

constexpr Entity entities[] = {
    {"MAI.", 1u << 0, "LGC", "LCA"}, {"NOE", 1u << 3, "LGN", "LNA"}, {"NOE.", 1u << 4, "LGT", "LTA"}};

std::uint32_t geometry_bit(std::string_view med_name) {
  for (const catalog::CellRow& row : catalog::cells())
    if (row.med_name == med_name) {
      const std::int32_t geometry = row.dimension == 0 ? 1 : 100 * row.dimension + row.n_nodes;
      return 1u << (std::find(std::begin(geometries), std::end(geometries), geometry) - std::begin(geometries));
    }
  return 0;
}

/// MED 4.1 keeps summaries with a field: which entities and geometric types its steps have, and whether all steps agree.
void write_masks(const H5Group& field) {
  std::uint32_t all_kinds = 0, all_types[std::size(entities)] = {};
  std::vector<std::uint32_t> kinds;
  std::vector<std::uint32_t> types[std::size(entities)];
  for (const std::string& name : field.children()) {
    const H5Group step = field.open(name);
    std::uint32_t kind = 0, type[std::size(entities)] = {};
    for (const std::string& one : step.children())
      for (std::size_t e = 0; e < std::size(entities); ++e) {
        const std::string_view prefix = entities[e].prefix;
        const bool of_nodes = prefix == "NOE";
        if (of_nodes ? one != prefix : !one.starts_with(prefix)) continue;
        kind |= entities[e].bit;
        type[e] |= of_nodes ? 1u : geometry_bit(std::string_view(one).substr(prefix.size()));
      }
    set_mask(step, "LEN", kind);
    kinds.push_back(kind);
    all_kinds |= kind;
    for (std::size_t e = 0; e < std::size(entities); ++e)
      if (type[e]) {
        set_mask(step, entities[e].geometry, type[e]);
        types[e].push_back(type[e]);
        all_types[e] |= type[e];
      }
  }
  const auto agreeing = [](const std::vector<std::uint32_t>& masks) {
    return std::adjacent_find(masks.begin(), masks.end(), std::not_equal_to<>()) == masks.end()
               ? static_cast<std::int64_t>(masks.size())
               : 0;
  };
  set_mask(field, "LEN", all_kinds);
  set_int(field, "LAA", agreeing(kinds));
  for (std::size_t e = 0; e < std::size(entities); ++e)
    if (all_types[e]) {
      set_mask(field, entities[e].geometry, all_types[e]);
      set_int(field, entities[e].steps, agreeing(types[e]));
    }
}

}  // namespace

MedFile::MedFile(const hdf5::Group& root) : root_(root) {
  if (!root_.has("INFOS_GENERALES")) {
    const H5Group about = root_.create("INFOS_GENERALES");
    set_int(about, "MAJ", 4);
    set_int(about, "MIN", 1);
    set_int(about, "REL", 0);
  }
}

std::string MedFile::add_mesh(const Mesh& mesh, std::string_view name) {
  check_name(root_, "mesh", name, med::name_length);
  std::optional<Mesh> wanted;
  bool there = false, same = false;
  const std::string chosen = free_name(std::string(name), [&](const std::string& candidate) {
    there = root_.has("ENS_MAA/" + candidate);
    if (!there) return true;
    if (!wanted) wanted = as_read(mesh);
    const Mesh present = med::read_mesh(root_, candidate);
    same = same_groups(present.cell_groups, wanted->cell_groups) && same_groups(present.node_groups, wanted->node_groups);
    return same_geometry(present, *wanted);
  });
  if (there && same) return chosen;
  if (there)
    for (const char* part : {"ENS_MAA/", "FAS/"}) H5Ldelete(root_.id(), (part + chosen).c_str(), H5P_DEFAULT);
  write_mesh(root_, mesh, chosen);
  return chosen;
}

std::string MedFile::field_group(const std::string& name, std::string_view mesh_name,
                                 const std::vector<std::string>& components) {
  const std::string labels = columns(components);
  const std::string chosen = free_name(name, [&](const std::string& candidate) {
    if (!root_.has("CHA/" + candidate)) return true;
    const H5Group group = root_.open("CHA/" + candidate);
    std::string found = group.text("NOM");  // read without its trailing blanks
    found.resize(labels.size(), ' ');
    return group.text("MAI") == mesh_name && group.integer("NCO") == static_cast<std::int64_t>(components.size()) &&
           found == labels;
  });
  check_name(root_, "field", chosen, med::name_length);
  if (root_.has("CHA/" + chosen)) return chosen;
  const H5Group group = root_.create("CHA/" + chosen);
  set_text(group, "MAI", mesh_name);
  set_int(group, "TYP", 6);  // real numbers of 64 bits
  set_int(group, "NCO", static_cast<std::int64_t>(components.size()));
  set_text(group, "NOM", labels);
  set_text(group, "UNI", std::string(labels.size(), ' '));
  set_text(group, "UNT", "");
  return chosen;
}

/// A profile with these 1-based numbers; one that the file has already is used again.
std::string MedFile::profile(const std::string& type, const std::vector<std::int32_t>& numbers) {
  const auto known = profiles_.find(numbers);
  if (known != profiles_.end()) return known->second;
  bool there = false;
  const std::string chosen = free_name("PFL_" + type, [&](const std::string& candidate) {
    there = root_.has("PROFILS/" + candidate);
    return !there || root_.read<std::int32_t>("PROFILS/" + candidate + "/PFL") == numbers;
  });
  if (!there) {
    const H5Group group = root_.create("PROFILS/" + chosen);
    set_int(group, "NBR", static_cast<std::int64_t>(numbers.size()));
    group.write("PFL", numbers);
  }
  return profiles_[numbers] = chosen;
}

/// The integration points in MED's description of a cell type: reference coordinates of its nodes in MED's order, points,
/// weights.
std::string MedFile::localisation(const catalog::CellRow& row, const MedPoints& points) {
  const auto d = static_cast<std::size_t>(row.dimension), n = static_cast<std::size_t>(row.n_nodes);
  std::vector<double> nodes(n * d);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t k = 0; k < d; ++k) nodes[k * n + static_cast<std::size_t>(row.med_permutation[j])] = row.nodes[j * d + k];
  const std::size_t n_points = points.weights.size();
  std::vector<double> by_axis(n_points * d);
  for (std::size_t p = 0; p < n_points; ++p)
    for (std::size_t k = 0; k < d; ++k) by_axis[k * n_points + p] = points.points[p * d + k];
  bool there = false;
  const std::string name = std::string(row.med_name) + "_" + std::to_string(n_points) + "_POINTS";
  const std::string chosen = free_name(name, [&](const std::string& candidate) {
    const std::string path = "GAUSS/" + candidate;
    there = root_.has(path);
    return !there || (root_.read<double>(path + "/GAU") == by_axis && root_.read<double>(path + "/VAL") == points.weights);
  });
  if (there) return chosen;
  const H5Group group = root_.create("GAUSS/" + chosen);
  set_int(group, "NBR", static_cast<std::int64_t>(points.weights.size()));
  set_int(group, "GEO", row.dimension == 0 ? 1 : 100 * row.dimension + row.n_nodes);
  set_int(group, "DIM", row.dimension);
  set_text(group, "INM", "");
  group.write("COO", nodes);
  group.write("GAU", by_axis);
  group.write("VAL", points.weights);
  return chosen;
}

/// The group, made anew, for the values of some nodes, or of some cells of one type.
hdf5::Group MedFile::entity(const hdf5::Group& step, const std::string& name, const std::string& profile_name,
                            const std::string& localisation_name) {
  const H5Group group = child(step, name);
  set_text(group, "GAU", localisation_name);
  set_text(group, "PFL", profile_name);
  if (group.has(profile_name)) H5Ldelete(group.id(), profile_name.c_str(), H5P_DEFAULT);
  H5Group one = group.create(profile_name);
  set_text(one, "GAU", localisation_name);
  return one;
}

std::vector<std::string> MedFile::add_field(const Mesh& mesh, std::string_view mesh_name, const Field& field,
                                            std::string_view name, std::int64_t step, const MedRule& rule) {
  std::vector<std::string> names;
  const std::map<CellType, CellList> cells = by_type(mesh);
  std::vector<std::int32_t> rank(mesh.n_cells());  // of each cell among those of its type
  for (const auto& [type, list] : cells)
    CellCursor(list).next(list.size, [&](std::size_t place, std::size_t first, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) rank[first + i] = static_cast<std::int32_t>(place + i);
    });
  const auto offset = [&](std::size_t i) { return field.offset.empty() ? i : static_cast<std::size_t>(field.offset[i]); };

  for (const FieldPart& part : parts_of(field)) {
    // what the rows of this part belong to: entity name -> (number in MED, place in the support)
    std::map<std::pair<std::string, std::size_t>, std::vector<std::pair<std::int32_t, std::size_t>>> members;
    const bool of_nodes = field.location == Location::nodes;
    const catalog::CellRow* last = nullptr;  // entities of one kind come in runs
    std::size_t last_rows = 0;
    std::vector<std::pair<std::int32_t, std::size_t>>* list = nullptr;
    for (std::size_t i = 0; i < field.support.size(); ++i) {
      const std::size_t n_rows = offset(i + 1) - offset(i);
      if (n_rows == 0 || !part.rows[offset(i)]) continue;
      const auto number = static_cast<std::size_t>(field.support[i]);
      const catalog::CellRow* row = of_nodes ? nullptr : &mesh.row(number);
      if (!list || row != last || n_rows != last_rows) {
        const char* prefix = field.location == Location::cell_nodes ? "NOE." : "MAI.";
        list = &members[{of_nodes ? "NOE" : prefix + std::string(row->med_name), n_rows}];
        last = row;
        last_rows = n_rows;
      }
      list->emplace_back((of_nodes ? field.support[i] : rank[number]) + 1, i);
    }
    std::vector<std::string> labels;
    for (const std::size_t k : part.components) labels.push_back(field.components[k]);
    names.push_back(field_group(part_name(field, part, name), mesh_name, labels));
    const H5Group group = root_.open("CHA/" + names.back());
    const std::int64_t ndt = std::max<std::int64_t>(step, -1);
    const std::string in_file = step_name(ndt, ndt);
    if (!group.has(in_file)) {
      const H5Group made = group.create(in_file);
      set_int(made, "NDT", ndt);
      set_int(made, "NOR", ndt);
      made.set("PDT", field.instant);
      set_int(made, "RDT", -1);
      set_int(made, "ROR", -1);
    }
    const H5Group at = group.open(in_file);
    for (auto& [key, places] : members) {
      const auto& [entity_name, per_entity] = key;
      if (!std::ranges::is_sorted(places)) std::ranges::sort(places);
      const catalog::CellRow* row =
          of_nodes ? nullptr : &mesh.row(static_cast<std::size_t>(field.support[places.front().second]));
      const std::size_t whole = row ? cells.at(row->type).size : mesh.n_nodes();
      std::string profile_name(med::no_profile), points_name;
      if (places.size() != whole) {
        std::vector<std::int32_t> numbers;
        for (const auto& [number, place] : places) numbers.push_back(number);
        profile_name = profile(row ? std::string(row->med_name) : "NOE", numbers);
      }
      if (field.location == Location::gauss_points) {
        if (!rule) throw std::logic_error("a field at integration points needs their rule");
        points_name = localisation(*row, rule(row->type, static_cast<int>(per_entity)));
      }
      const H5Group one = entity(at, entity_name, profile_name, points_name);
      set_int(one, "NBR", static_cast<std::int64_t>(places.size()));
      set_int(one, "NGA", static_cast<std::int64_t>(per_entity));
      std::vector<std::size_t> own(per_entity);  // of an entity's rows, in the file's order
      for (std::size_t p = 0; p < per_entity; ++p)
        own[field.location == Location::cell_nodes ? static_cast<std::size_t>(row->med_permutation[p]) : p] = p;
      one.write_columns<double>(
          "CO", places.size() * per_entity, part.components.size(), [&](std::size_t first, std::span<double> values) {
            const std::size_t here = values.size() / part.components.size();
            for (std::size_t r = 0; r < here; ++r) {
              const std::size_t in_field = offset(places[(first + r) / per_entity].second) + own[(first + r) % per_entity];
              for (std::size_t k = 0; k < part.components.size(); ++k)
                values[k * here + r] = field.at(in_field, part.components[k]);
            }
          });
    }
    write_masks(group);
  }
  return names;
}

void write_med(const fs::path& file, bool append, const std::function<void(MedFile&)>& write) {
  std::error_code error;
  const bool goes_on = append && fs::exists(file, error);
  if (goes_on) med::check_appendable(file);
  hdf5::write_whole(
      file,
      [&](const H5Group& root) {
        MedFile med(root);
        write(med);
      },
      goes_on ? file : fs::path{});
}

}  // namespace lacon
