// Files that a user or another program hands in: whatever is in them, readers return or refuse.
#include <nlohmann/json.hpp>

#include "fuzz.hpp"
#include "h5_text.hpp"
#include "lacon/elements/plugin_rows.hpp"
#include "lacon/structures/field.hpp"
#include "lacon/structures/formats/gmsh.hpp"
#include "lacon/structures/formats/med.hpp"
#include "lacon/structures/order.hpp"
#include "lacon/structures/storage/storage.hpp"
#include "lacon/structures/table.hpp"

namespace lacon::fuzz {
namespace {

/// What every mesh promises that a reader returns.
void expect_sound(const Mesh& mesh) {
  const auto below = [](std::span<const std::int32_t> numbers, std::size_t n) {
    for (const std::int32_t number : numbers)
      if (number < 0 || static_cast<std::size_t>(number) >= n) return false;
    return true;
  };
  expect(mesh.dimension == 2 || mesh.dimension == 3, "the dimension of a mesh is 2 or 3");
  expect(mesh.coordinates.size() % 3 == 0, "a node has three coordinates");
  expect(mesh.cells.size() == mesh.n_cells(), "each cell has its nodes");
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    expect(mesh.cells[c].size() == static_cast<std::size_t>(mesh.row(c).n_nodes), "a cell has as many nodes as its type");
    expect(below(mesh.cells[c], mesh.n_nodes()), "the nodes of a cell exist");
  }
  for (const Group& group : mesh.cell_groups) expect(below(group.members, mesh.n_cells()), "the cells of a group exist");
  for (const Group& group : mesh.node_groups) expect(below(group.members, mesh.n_nodes()), "the nodes of a group exist");
  if (!mesh.patches) return;
  const Patches& patches = *mesh.patches;
  expect(patches.zone_offset.size() == patches.zone_group.size() + 1, "each zone has its patches");
  expect(patches.zone_offset.back() == static_cast<std::int64_t>(patches.size()), "each patch is of a zone");
  expect(patches.parent.size() == patches.size() && patches.cells.size() == patches.size() &&
             patches.carriers.size() == patches.size(),
         "each patch has its cells");
  expect(below(patches.cells.values, mesh.n_cells()), "the cells of a patch exist");
  expect(below(patches.carriers.values, mesh.n_nodes()), "the carriers of a patch exist");
}

void expect_sound(const Field& field) {
  const std::size_t n = field.n_components(), rows = field.n_rows();
  expect(field.values.size() == n * rows, "a field has whole rows");
  expect(field.first_row(field.support.size()) == rows || n == 0, "the rows of a field are those of its support");
  for (std::size_t i = 0; i < field.support.size(); ++i)
    expect(field.first_row(i) <= field.first_row(i + 1), "rows follow each other");
  expect(field.present.empty() || field.present.size() == field.values.size(), "each value of a field is there or not");
}

/// Read one concept or field file of the type that it says.
void read_concept(const hdf5::Group& root, const std::filesystem::path& file) {
  const std::string type = root.text("lacon_type");
  const auto read = [&](std::string_view own, const auto& reader) {
    if (type == own) storage::read_whatever(root, reader);
  };
  if (type == "mesh") expect_sound(storage::read_whatever(root, storage::read_mesh));
  read("model", storage::read_model);
  read("material", storage::read_material);
  read("material_field", storage::read_material_field);
  read("load", storage::read_load);
  read("contact", storage::read_contact);
  read("function", storage::read_function);
  read("formula", storage::read_formula);
  read("list_of_reals", storage::read_list_of_reals);
  read("time_steps", storage::read_time_steps);
  read("result", storage::read_result);
  read("table", read_table);
  if (type == "field") {
    expect_sound(read_field(file));
    read_field_head(file);
  }
}

/// Ask the keywords of an order for everything, as operators do.
void ask(const Keywords& keywords) {
  for (const auto& [name, value] : keywords.values().items()) {
    may_refuse([&, &key = name] { keywords.real(key); });
    may_refuse([&, &key = name] { keywords.integer(key); });
    may_refuse([&, &key = name] { keywords.text(key); });
    may_refuse([&, &key = name] { keywords.reals(key); });
    may_refuse([&, &key = name] { keywords.vector(key, 3); });
    may_refuse([&, &key = name] { keywords.integers(key); });
    may_refuse([&, &key = name] { keywords.texts(key); });
    may_refuse([&, &key = name] { keywords.concept_id(key); });
    may_refuse([&, &key = name] { keywords.concept_ids(key); });
    if (!value.is_array()) continue;
    may_refuse([&, &key = name] {
      for (const Keywords& occurrence : keywords.factors(key))
        if (occurrence.values().is_object()) ask(occurrence);
    });
  }
}

}  // namespace

void med(Bytes input) {
  const TemporaryFile file(h5_from_text(text_of(input)));
  may_refuse([&] {
    for (const std::string& name : med_mesh_names(file.path()))
      may_refuse([&] { expect_sound(read_med_mesh(file.path(), name)); });
  });
}

void msh(Bytes input) {
  const TemporaryFile file(text_of(input));
  may_refuse([&] { expect_sound(read_gmsh_mesh(file.path())); });
}

void order(Bytes input) {
  const TemporaryFile file(text_of(input));
  may_refuse([&] {
    const Order read = read_order(file.path());
    ask(read.keywords);
  });
}

void plugin(Bytes input) {
  const TemporaryFile file(text_of(input));
  PluginRows rows;
  may_refuse([&] { read_plugin_rows(file.path(), {"solid", "own"}, rows); });
}

void concepts(Bytes input) {
  const TemporaryFile file(h5_from_text(text_of(input)));
  may_refuse([&] { read_concept(hdf5::Reader(file.path()), file.path()); });
}

}  // namespace lacon::fuzz
