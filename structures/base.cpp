#include "lacon/structures/base.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {
namespace {

using nlohmann::json;

// ---------------------------------------------------------------------------------------------- common pieces

template <class T>
void write_ragged(const hdf5::Group& group, const std::string& name, const Ragged<T>& rows) {
  group.write(name + "/offset", rows.offset);
  group.write(name + "/values", rows.values);
}

template <class T>
Ragged<T> read_ragged(const hdf5::Group& group, const std::string& offset, const std::string& values,
                      std::size_t (*capacity)(std::size_t) = nullptr) {
  Ragged<T> rows;
  rows.offset = group.read<std::int64_t>(offset, capacity);
  rows.values = group.read<T>(values, capacity);
  bool sound =
      !rows.offset.empty() && rows.offset.front() == 0 && rows.offset.back() == static_cast<std::int64_t>(rows.values.size());
  for (std::size_t i = 1; sound && i < rows.offset.size(); ++i) sound = rows.offset[i] >= rows.offset[i - 1];
  if (!sound) fail("BASE_2", {{"file", group.path().string()}, {"reason", "'" + offset + "' does not fit '" + values + "'"}});
  return rows;
}

template <class T>
Ragged<T> read_ragged(const hdf5::Group& group, const std::string& name) {
  return read_ragged<T>(group, name + "/offset", name + "/values");
}

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
  if (members.size() != names.size())
    fail("BASE_2", {{"file", root.path().string()}, {"reason", "'" + name + "' is inconsistent"}});
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const std::int32_t m : members[i])
      if (m < 0 || static_cast<std::size_t>(m) >= n_entities)
        fail("BASE_2",
             {{"file", root.path().string()}, {"reason", "the group '" + names[i] + "' names member " + std::to_string(m)}});
    groups.push_back({names[i], {members[i].begin(), members[i].end()}});
  }
  return groups;
}

/// Attributes that every concept has.
void write_head(const hdf5::Group& root, const Order& order, std::string_view type, std::int64_t version,
                const std::vector<std::string>& references) {
  json list = json::array();
  for (const std::string& id : references)
    if (!id.empty()) list.push_back(id);
  root.set("lacon_type", type);
  root.set("format", std::int64_t{1});
  root.set("version", version);
  root.set("id", order.result_id);
  root.set("label", order.result_label);
  root.set("command", order.command);
  root.set("keywords", order.keywords.values().dump());
  root.set("references", list.dump());
}

/// Open a concept and check its type.
hdf5::Reader open_concept(const Base& base, std::string_view id, std::string_view type) {
  hdf5::Reader root(base.file(id));
  if (const std::string found = root.text("lacon_type"); found != type)
    fail("BASE_4", {{"id", std::string(id)}, {"found", found}, {"expected", std::string(type)}});
  return root;
}

}  // namespace

// ---------------------------------------------------------------------------------------------- base

std::filesystem::path Base::file(std::string_view id) const {
  const std::filesystem::path single = folder_ / (std::string(id) + ".h5");
  const std::filesystem::path index = folder_ / std::string(id) / "index.h5";
  std::error_code error;
  if (std::filesystem::exists(single, error)) return single;
  if (std::filesystem::exists(index, error)) return index;
  fail("BASE_1", {{"id", std::string(id)}, {"base", folder_.string()}});
}

std::string Base::type(std::string_view id) const { return hdf5::Reader(file(id)).text("lacon_type"); }

std::string Base::label(std::string_view id) const { return hdf5::Reader(file(id)).text("label"); }

namespace {

/// Write the order's result as a concept in one file, with the next version where it enriches an existing one.
template <class Write>
void store_concept(const Base& base, const Order& order, const std::filesystem::path& file, std::string_view type,
                   const std::vector<std::string>& references, Write write) {
  std::int64_t version = 1;
  if (order.reuse) version = hdf5::Reader(base.file(order.result_id)).integer("version") + 1;
  hdf5::write_whole(file, [&](const hdf5::Group& root) {
    write_head(root, order, type, version, references);
    write(root);
  });
}

std::filesystem::path concept_file(const Base& base, const Order& order) { return base.folder() / (order.result_id + ".h5"); }

}  // namespace

// ---------------------------------------------------------------------------------------------- mesh

Mesh Base::mesh(std::string_view id) const {
  const hdf5::Reader root = open_concept(*this, id, "mesh");
  const auto refuse = [&](const std::string& reason) { fail("BASE_2", {{"file", root.path().string()}, {"reason", reason}}); };
  Mesh mesh;
  mesh.name = root.text("name");
  mesh.dimension = static_cast<int>(root.integer("dimension"));
  mesh.coordinates = root.read<double>("coordinates", with_room);
  const hdf5::Group cells = root.open("cells");
  std::vector<CellType> types;
  for (const std::string& name : cells.attribute_strings("types")) {
    const auto type = catalog::find_cell(name);
    if (!type) refuse("there is no cell type " + name);
    types.push_back(*type);
  }
  mesh.cells = read_ragged<std::int32_t>(cells, "offset", "nodes", with_room);
  const std::vector<std::int8_t> codes = cells.read<std::int8_t>("type");
  mesh.types.reserve(with_room(codes.size()));
  for (const std::int8_t code : codes) {
    if (code < 0 || static_cast<std::size_t>(code) >= types.size()) refuse("a cell has the type " + std::to_string(code));
    mesh.types.push_back(types[static_cast<std::size_t>(code)]);
  }
  if (mesh.types.size() != mesh.cells.size()) refuse("'cells/type' does not fit 'cells/offset'");
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    if (mesh.cells[c].size() != static_cast<std::size_t>(mesh.row(c).n_nodes))
      refuse("cell " + cell_name(static_cast<std::int64_t>(c)) + " has a wrong number of nodes");
    for (const std::int32_t n : mesh.cells[c])
      if (n < 0 || static_cast<std::size_t>(n) >= mesh.n_nodes())
        refuse("cell " + cell_name(static_cast<std::int64_t>(c)) + " names a node that does not exist");
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
  }
  return mesh;
}

void Base::store(const Mesh& mesh) const {
  store_concept(*this, *order_, concept_file(*this, *order_), "mesh", {}, [&](const hdf5::Group& root) {
    root.set("name", mesh.name);
    root.set("dimension", std::int64_t{mesh.dimension});
    root.write("coordinates", mesh.coordinates, {mesh.n_nodes(), 3});
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
  });
}

// ---------------------------------------------------------------------------------------------- model, material

Model Base::model(std::string_view id) const {
  const hdf5::Reader root = open_concept(*this, id, "model");
  Model model;
  model.mesh = root.text("mesh");
  model.phenomenon = root.text("phenomenon");
  model.dimension = static_cast<int>(root.integer("dimension"));
  model.elements = root.read_strings("elements");
  model.element = root.read<std::int32_t>("cells/element");
  return model;
}

void Base::store(const Model& model) const {
  store_concept(*this, *order_, concept_file(*this, *order_), "model", {model.mesh}, [&](const hdf5::Group& root) {
    root.set("mesh", model.mesh);
    root.set("phenomenon", model.phenomenon);
    root.set("dimension", std::int64_t{model.dimension});
    root.write_strings("elements", model.elements);
    root.write("cells/element", model.element);
  });
}

Material Base::material(std::string_view id) const {
  const hdf5::Reader root = open_concept(*this, id, "material");
  Material material;
  for (const std::string& law : root.children()) {
    const hdf5::Group group = root.open(law);
    auto& parameters = material.laws[law];
    for (const std::string& name : group.attributes()) {
      if (group.attribute_is_text(name))
        parameters[name] = group.text(name);
      else
        parameters[name] = group.real(name);
    }
  }
  return material;
}

MaterialField Base::material_field(std::string_view id) const {
  const hdf5::Reader root = open_concept(*this, id, "material_field");
  return {root.text("mesh"), root.text("model"), root.read_strings("materials"), root.read<std::int32_t>("cells/material")};
}

void Base::store(const MaterialField& field) const {
  std::vector<std::string> references{field.mesh, field.model};
  references.insert(references.end(), field.materials.begin(), field.materials.end());
  store_concept(*this, *order_, concept_file(*this, *order_), "material_field", references, [&](const hdf5::Group& root) {
    root.set("mesh", field.mesh);
    root.set("model", field.model);
    root.write_strings("materials", field.materials);
    root.write("cells/material", field.material);
  });
}

// ---------------------------------------------------------------------------------------------- load

namespace {

/// The lists of a load: group in the file, dataset of its places, member.
struct LoadGroup {
  const char* name;
  const char* place;
  std::vector<LoadTerm> Load::*terms;
};
constexpr LoadGroup load_groups[] = {{"imposed", "node", &Load::imposed},
                                     {"nodal_force", "node", &Load::nodal},
                                     {"pressure", "cell", &Load::pressure},
                                     {"force", "cell", &Load::force},
                                     {"gravity", "cell", &Load::gravity}};

/// Texts that repeat, as a list of the different ones and a number into it.
class Names {
 public:
  std::int32_t number(const std::string& name) {
    const auto at = std::find(names_.begin(), names_.end(), name);
    if (at == names_.end()) names_.push_back(name);
    return static_cast<std::int32_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }
  const std::vector<std::string>& all() const { return names_; }

 private:
  std::vector<std::string> names_;
};

/// `value` and, where some are functions, `function` and `function_index`.
void write_load_values(const hdf5::Group& group, const std::vector<LoadValue>& values) {
  Names functions;
  std::vector<double> number;
  std::vector<std::int32_t> index;
  for (const LoadValue& v : values) {
    number.push_back(v.value);
    index.push_back(v.function.empty() ? -1 : functions.number(v.function));
  }
  group.write("value", number);
  if (functions.all().empty()) return;
  group.write_strings("function", functions.all());
  group.write("function_index", index);
}

std::vector<LoadValue> read_load_values(const hdf5::Group& group) {
  std::vector<LoadValue> values;
  for (const double number : group.read<double>("value")) values.push_back({number, ""});
  if (!group.has("function_index")) return values;
  const auto functions = group.read_strings("function");
  const auto index = group.read<std::int32_t>("function_index");
  for (std::size_t i = 0; i < values.size(); ++i)
    if (index.at(i) >= 0) values[i].function = functions.at(static_cast<std::size_t>(index[i]));
  return values;
}

}  // namespace

Load Base::load(std::string_view id) const {
  const hdf5::Reader root = open_concept(*this, id, "load");
  Load load;
  load.model = root.text("model");
  load.kind = root.text("kind");
  for (const LoadGroup& kind : load_groups) {
    if (!root.has(kind.name)) continue;
    const hdf5::Group group = root.open(kind.name);
    const auto names = group.read_strings("component");
    const auto place = group.read<std::int32_t>(kind.place), index = group.read<std::int32_t>("component_index");
    const std::vector<LoadValue> values = read_load_values(group);
    for (std::size_t i = 0; i < place.size(); ++i)
      (load.*kind.terms).push_back({place[i], names.at(static_cast<std::size_t>(index.at(i))), values.at(i)});
  }
  if (root.has("relations")) {
    const hdf5::Group group = root.open("relations");
    const auto names = group.read_strings("component"), source = group.read_strings("source");
    const auto node = read_ragged<std::int32_t>(group, "offset", "node");
    const auto index = group.read<std::int32_t>("component_index");
    const auto coefficient = group.read<double>("coefficient");
    const std::vector<LoadValue> values = read_load_values(group);
    for (std::size_t r = 0, at = 0; r < node.size(); ++r) {
      Relation relation{source.at(r), {}, values.at(r)};
      for (const std::int32_t n : node[r]) {
        relation.terms.push_back({n, names.at(static_cast<std::size_t>(index.at(at))), coefficient.at(at)});
        ++at;
      }
      load.relations.push_back(std::move(relation));
    }
  }
  return load;
}

void Base::store(const Load& load) const {
  std::vector<std::string> references{load.model};
  const auto refer = [&](const LoadValue& value) {
    if (!value.function.empty() && std::find(references.begin(), references.end(), value.function) == references.end())
      references.push_back(value.function);
  };
  for (const LoadGroup& kind : load_groups)
    for (const LoadTerm& term : load.*kind.terms) refer(term.value);
  for (const Relation& relation : load.relations) refer(relation.value);
  store_concept(*this, *order_, concept_file(*this, *order_), "load", references, [&](const hdf5::Group& root) {
    root.set("model", load.model);
    root.set("kind", load.kind);
    for (const LoadGroup& kind : load_groups) {
      if ((load.*kind.terms).empty()) continue;
      Names names;
      std::vector<std::int32_t> place, index;
      std::vector<LoadValue> values;
      for (const LoadTerm& term : load.*kind.terms) {
        place.push_back(term.place);
        index.push_back(names.number(term.component));
        values.push_back(term.value);
      }
      const hdf5::Group group = root.create(kind.name);
      group.write_strings("component", names.all());
      group.write(kind.place, place);
      group.write("component_index", index);
      write_load_values(group, values);
    }
    if (!load.relations.empty()) {
      Names names;
      Ragged<std::int32_t> node;
      std::vector<std::int32_t> index;
      std::vector<double> coefficient;
      std::vector<std::string> source;
      std::vector<LoadValue> values;
      for (const Relation& relation : load.relations) {
        source.push_back(relation.source);
        values.push_back(relation.value);
        for (const RelationTerm& term : relation.terms) {
          node.values.push_back(term.node);
          index.push_back(names.number(term.component));
          coefficient.push_back(term.coefficient);
        }
        node.offset.push_back(static_cast<std::int64_t>(node.values.size()));
      }
      const hdf5::Group group = root.create("relations");
      group.write_strings("source", source);
      group.write_strings("component", names.all());
      group.write("offset", node.offset);
      group.write("node", node.values);
      group.write("component_index", index);
      group.write("coefficient", coefficient);
      write_load_values(group, values);
    }
  });
}

// ---------------------------------------------------------------------------------------------- contact

namespace {

/// The zone's members that are plain texts, by the name of their dataset.
const std::pair<const char*, std::string ContactZone::*> zone_texts[] = {
    {"zones/slave_group", &ContactZone::slave_group},
    {"zones/master_group", &ContactZone::master_group},
    {"zones/jacobian", &ContactZone::jacobian},
    {"zones/search", &ContactZone::search},
    {"zones/initial_status", &ContactZone::initial_status}};

/// The zone's members that are a number.
const std::pair<const char*, double ContactZone::*> zone_numbers[] = {{"zones/tolerance", &ContactZone::tolerance},
                                                                      {"zones/distance_limit", &ContactZone::distance_limit}};

/// The zone's members that are lists of numbers.
const std::pair<const char*, std::vector<std::int32_t> ContactZone::*> zone_lists[] = {
    {"zones/slave", &ContactZone::slave}, {"zones/master", &ContactZone::master}, {"zones/patches", &ContactZone::patches}};

}  // namespace

Contact Base::contact(std::string_view id) const {
  const hdf5::Reader root = open_concept(*this, id, "contact");
  Contact contact;
  contact.model = root.text("model");
  contact.mesh = root.text("mesh");
  contact.algorithm = root.text("algorithm");
  contact.smoothing = root.integer("smoothing") != 0;
  contact.verify_normals = root.integer("verify_normals") != 0;
  contact.resi_geom = root.real("resi_geom");
  contact.zones.resize(root.read<double>("zones/tolerance").size());
  for (const auto& [name, member] : zone_numbers) {
    if (!root.has(name)) continue;  // a base older than the number
    const auto values = root.read<double>(name);
    for (std::size_t z = 0; z < contact.zones.size(); ++z) contact.zones[z].*member = values.at(z);
  }
  for (const auto& [name, member] : zone_texts) {
    const auto values = root.read_strings(name);
    for (std::size_t z = 0; z < contact.zones.size(); ++z) contact.zones[z].*member = values.at(z);
  }
  for (const auto& [name, member] : zone_lists) {
    const auto values = read_ragged<std::int32_t>(root, name);
    for (std::size_t z = 0; z < contact.zones.size(); ++z)
      (contact.zones[z].*member).assign(values[z].begin(), values[z].end());
  }
  const hdf5::Group slave = root.open("slave");
  const auto cell = slave.read<std::int32_t>("cell"), patch = slave.read<std::int32_t>("patch"),
             rank = slave.read<std::int32_t>("rank");
  const auto element = slave.read_strings("element");
  for (std::size_t i = 0; i < cell.size(); ++i) contact.slaves.push_back({cell[i], patch.at(i), rank.at(i), element.at(i)});
  return contact;
}

void Base::store(const Contact& contact) const {
  store_concept(*this, *order_, concept_file(*this, *order_), "contact", {contact.model, contact.mesh},
                [&](const hdf5::Group& root) {
                  root.set("model", contact.model);
                  root.set("mesh", contact.mesh);
                  root.set("algorithm", contact.algorithm);
                  root.set("smoothing", std::int64_t{contact.smoothing});
                  root.set("verify_normals", std::int64_t{contact.verify_normals});
                  root.set("resi_geom", contact.resi_geom);
                  for (const auto& [name, member] : zone_numbers) {
                    std::vector<double> values;
                    for (const ContactZone& zone : contact.zones) values.push_back(zone.*member);
                    root.write(name, values);
                  }
                  for (const auto& [name, member] : zone_texts) {
                    std::vector<std::string> values;
                    for (const ContactZone& zone : contact.zones) values.push_back(zone.*member);
                    root.write_strings(name, values);
                  }
                  for (const auto& [name, member] : zone_lists) {
                    Ragged<std::int32_t> values;
                    for (const ContactZone& zone : contact.zones) values.push_back(zone.*member);
                    write_ragged(root, name, values);
                  }
                  std::vector<std::int32_t> cell, patch, rank;
                  std::vector<std::string> element;
                  for (const SlaveElement& slave : contact.slaves) {
                    cell.push_back(slave.cell);
                    patch.push_back(slave.patch);
                    rank.push_back(slave.rank);
                    element.push_back(slave.element);
                  }
                  root.write("slave/cell", cell);
                  root.write("slave/patch", patch);
                  root.write("slave/rank", rank);
                  root.write_strings("slave/element", element);
                });
}

// ---------------------------------------------------------------------------------------------- functions, lists

Function Base::function(std::string_view id) const {
  const hdf5::Reader root = open_concept(*this, id, "function");
  Function function;
  function.parameter = root.text("parameter");
  const auto interpolation = root.attribute_strings("interpolation");
  function.interpolation[0] = interpolation.at(0);
  function.interpolation[1] = interpolation.at(1);
  function.extension_left = root.text("extension_left");
  function.extension_right = root.text("extension_right");
  function.x = root.read<double>("x");
  function.y = root.read<double>("y");
  if (function.x.empty() || function.x.size() != function.y.size())
    fail("BASE_2", {{"file", root.path().string()}, {"reason", "'x' and 'y' do not fit"}});
  return function;
}

Formula Base::formula(std::string_view id) const {
  const hdf5::Reader root = open_concept(*this, id, "formula");
  return {root.attribute_strings("parameters"), root.text("expression")};
}

std::vector<double> Base::list_of_reals(std::string_view id) const {
  return open_concept(*this, id, "list_of_reals").read<double>("values");
}

TimeSteps Base::time_steps(std::string_view id) const {
  if (type(id) == "list_of_reals") return {.values = list_of_reals(id)};
  const hdf5::Reader root = open_concept(*this, id, "time_steps");
  TimeSteps steps{.values = root.read<double>("values"),
                  .action = {.cut = root.integer("cut") != 0,
                             .cut_into = static_cast<int>(root.integer("cut_into")),
                             .cut_levels = static_cast<int>(root.integer("cut_levels")),
                             .smallest = root.real("smallest")},
                  .more_iterations = root.has_attribute("more_iterations") ? root.integer("more_iterations") : 0,
                  .events = {},
                  .adaptation = {}};
  if (root.has_attribute("events"))
    for (const json& event : json::parse(root.text("events")))
      steps.events.push_back({.event = event.at("event"),
                              .limit = event.at("limit"),
                              .place = event.at("place").dump(),
                              .action = {.cut = event.at("cut"),
                                         .cut_into = event.at("cut_into"),
                                         .cut_levels = event.at("cut_levels"),
                                         .smallest = event.at("smallest")}});
  if (root.has_attribute("adaptation")) {
    const json a = json::parse(root.text("adaptation"));
    steps.adaptation = StepAdaptation{.event = a.at("event"),
                                      .easy_steps = a.at("easy_steps"),
                                      .easy_iterations = a.at("easy_iterations"),
                                      .rule = a.at("rule"),
                                      .percent = a.at("percent"),
                                      .reference = a.at("reference"),
                                      .smallest = a.at("smallest"),
                                      .largest = a.at("largest"),
                                      .most = a.at("most")};
  }
  return steps;
}

// ---------------------------------------------------------------------------------------------- table

Table Base::table(std::string_view id) const { return read_table(open_concept(*this, id, "table")); }

void Base::store(const Table& table) const {
  store_concept(*this, *order_, concept_file(*this, *order_), "table", {},
                [&](const hdf5::Group& root) { write_table(root, table); });
}

// ---------------------------------------------------------------------------------------------- result

Result Base::result(std::string_view id) const {
  const hdf5::Reader root = open_concept(*this, id, "result");
  Result result;
  result.label = root.text("label");
  result.model = root.text("model");
  result.mesh = root.text("mesh");
  result.material_field = root.text("material_field");
  result.contact = root.text("contact");
  for (const json& load : json::parse(root.text("loads")))
    result.loads.push_back({load.at("load"), load.at("function"), load.value("type", "FIXE_CSTE")});
  result.behaviour = root.text("behaviour");
  result.orders = root.read<std::int64_t>("order");
  result.instants = root.read<double>("instant");
  const hdf5::Group fields = root.open("fields");
  for (const std::string& name : fields.children()) {
    const hdf5::Group field = fields.open(name);
    const auto orders = field.read<std::int64_t>("order");
    const auto files = field.read_strings("file");
    for (std::size_t i = 0; i < orders.size(); ++i) result.fields[name][orders[i]] = files.at(i);
  }
  const hdf5::Group parameters = root.open("parameters");
  for (const std::string& name : parameters.children()) result.parameters[name] = parameters.read<double>(name);
  if (root.has("tables"))
    for (const std::string& name : root.open("tables").children())
      result.tables[name] = read_table(root.open("tables/" + name));
  return result;
}

void Base::store(const Result& result) const {
  json loads = json::array();
  std::vector<std::string> references{result.model, result.mesh, result.material_field, result.contact};
  for (const ResultLoad& load : result.loads) {
    loads.push_back({{"load", load.load}, {"function", load.function}, {"type", load.type}});
    references.push_back(load.load);
    references.push_back(load.function);
  }
  std::filesystem::create_directories(folder_ / order_->result_id);
  store_concept(*this, *order_, folder_ / order_->result_id / "index.h5", "result", references, [&](const hdf5::Group& root) {
    root.set("model", result.model);
    root.set("mesh", result.mesh);
    root.set("material_field", result.material_field);
    root.set("contact", result.contact);
    root.set("loads", loads.dump());
    root.set("behaviour", result.behaviour);
    root.write("order", result.orders);
    root.write("instant", result.instants);
    const hdf5::Group fields = root.create("fields");
    for (const auto& [name, files] : result.fields) {
      const hdf5::Group field = fields.create(name);
      std::vector<std::int64_t> orders;
      std::vector<std::string> paths;
      for (const auto& [order, file] : files) {
        orders.push_back(order);
        paths.push_back(file);
      }
      field.write("order", orders);
      field.write_strings("file", paths);
    }
    const hdf5::Group parameters = root.create("parameters");
    for (const auto& [name, values] : result.parameters) parameters.write(name, values);
    for (const auto& [name, table] : result.tables) write_table(root.create("tables/" + name), table);
  });
}

Field Base::field(const Result& result, std::string_view name, std::int64_t order) const {
  const auto named = result.fields.find(std::string(name));
  if (named != result.fields.end())
    if (const auto file = named->second.find(order); file != named->second.end()) return read_field(folder_ / file->second);
  std::string known;
  for (const auto& [field, files] : result.fields)
    if (files.contains(order)) known += (known.empty() ? "" : ", ") + field;
  fail("RESULT_1", {{"label", result.label},
                    {"field", std::string(name)},
                    {"order", std::to_string(order)},
                    {"known", known.empty() ? "none" : known}});
}

Field Base::field(std::string_view id) const {
  open_concept(*this, id, "field");
  return read_field(file(id));
}

Field Base::field_head(std::string_view id) const {
  open_concept(*this, id, "field");
  return read_field_head(file(id));
}

void Base::store(const Field& field) const {
  std::vector<std::string> references{field.mesh};
  references.insert(references.end(), field.functions.begin(), field.functions.end());
  store_concept(*this, *order_, concept_file(*this, *order_), "field", references,
                [&](const hdf5::Group& root) { write_field_content(root, field); });
}

void Base::add_field(Result& result, Field field) const {
  field.mesh = result.mesh;
  // the file of an earlier version stays as it is: a field computed again gets the next free name
  const std::string stem = order_->result_id + "/" + field.name + "_" + std::to_string(field.order);
  std::string file = stem + ".h5";
  std::error_code error;
  for (int again = 2; std::filesystem::exists(folder_ / file, error); ++again)
    file = stem + "_" + std::to_string(again) + ".h5";
  std::filesystem::create_directories(folder_ / order_->result_id);
  write_field(folder_ / file, field);
  result.fields[field.name][field.order] = file;
}

void Base::discard(const Result& result) const {
  std::error_code error;
  for (const auto& [name, files] : result.fields)
    for (const auto& [order, file] : files) std::filesystem::remove(folder_ / file, error);
  std::filesystem::remove(folder_ / order_->result_id, error);  // only where it is empty
}

}  // namespace lacon
