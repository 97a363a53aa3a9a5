// A MED file that is written, and its fields; its meshes: med_write_mesh.cpp.
#include <algorithm>
#include <cstdio>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/formats/file_names.hpp"
#include "lacon/structures/formats/med.hpp"
#include "lacon/structures/formats/med_pieces.hpp"
#include "lacon/structures/formats/parts.hpp"

namespace lacon {
namespace {

using namespace med;
using H5Group = hdf5::Group;
namespace fs = std::filesystem;

void set_mask(const H5Group& group, const char* name, std::uint32_t value) {
  const hdf5::Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  if (group.has_attribute(name)) H5Adelete(group.id(), name);
  const hdf5::Handle attribute(H5Acreate2(group.id(), name, H5T_STD_B32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(attribute, H5T_NATIVE_B32, &value);
}

/// The group of this name, made where it is not there.
H5Group child(const H5Group& group, const std::string& name) { return group.has(name) ? group.open(name) : group.create(name); }

/// Name in MED files of a computation step.
std::string step_name(std::int64_t ndt, std::int64_t nor) {
  char text[64];
  std::snprintf(text, sizeof text, "%020lld%020lld", static_cast<long long>(ndt), static_cast<long long>(nor));
  return text;
}

/// The geometric types of MED, by which it numbers the bits of its masks: 100 x dimension + nodes, 1 for a point.
constexpr std::int32_t geometries[] = {1,   102, 103, 104, 203, 204, 206, 207, 208, 209, 304,
                                       305, 306, 308, 310, 312, 313, 315, 318, 320, 327};

/// Says of a field in the file whose it is; no other program looks for it.
constexpr const char* owner_attribute = "OWNER";

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

std::string MedFile::field_group(const std::string& name, std::string_view mesh_name,
                                 const std::vector<std::string>& components, std::string_view owner) {
  const std::string labels = in_columns(components);
  bool is_anothers = false;
  const std::string chosen = free_name(name, [&](const std::string& candidate) {
    if (!root_.has("CHA/" + candidate)) return true;
    const H5Group group = root_.open("CHA/" + candidate);
    if ((group.has_attribute(owner_attribute) ? group.text(owner_attribute) : "") != owner) {
      is_anothers = true;
      return false;
    }
    std::string found = group.text("NOM");  // read without its trailing blanks
    found.resize(labels.size(), ' ');
    return group.text("MAI") == mesh_name && group.integer("NCO") == static_cast<std::int64_t>(components.size()) &&
           found == labels;
  });
  check_name(root_, part("field"), chosen, name_length);
  if (root_.has("CHA/" + chosen)) return chosen;
  const H5Group group = root_.create("CHA/" + chosen);
  set_text(group, "MAI", mesh_name);
  set_int(group, "TYP", 6);  // real numbers of 64 bits
  set_int(group, "NCO", static_cast<std::int64_t>(components.size()));
  set_text(group, "NOM", labels);
  set_text(group, "UNI", std::string(labels.size(), ' '));
  set_text(group, "UNT", "");
  if (!owner.empty()) set_text(group, owner_attribute, owner);
  if (is_anothers) inform("FORMAT_2", {{"file", root_.path().string()}, {"name", name}, {"own", chosen}});
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
                                            std::string_view name, std::int64_t step, const MedRule& rule,
                                            std::string_view owner) {
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
    names.push_back(field_group(part_name(field, part, name), mesh_name, labels, owner));
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
      std::string profile_name(no_profile), points_name;
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
      set_int(one, "NBR", static_cast<std::int64_t>(whole));  // of all entities, also where a profile picks some
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
  if (goes_on) check_appendable(file);
  hdf5::write_whole(
      file,
      [&](const H5Group& root) {
        MedFile med(root);
        write(med);
      },
      goes_on ? file : fs::path{});
}

}  // namespace lacon
