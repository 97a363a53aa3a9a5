// MED files: what is written reads back the same; every file that is not as it should be is refused with its own message.
#include <gmock/gmock.h>

#include <fstream>
#include <numeric>

#include "formats_fixture.hpp"
#include "lacon/structures/formats/med_layout.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* step = "ENS_MAA/M/-0000000000000000001-0000000000000000001/";

class Med : public InFolder {
 protected:
  void SetUp() override {
    InFolder::SetUp();
    file = folder / "mesh.med";
  }
  std::filesystem::path file;
};

/// Two triangles and their skin, with groups.
Mesh small_mesh() {
  Mesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  for (const auto& nodes : {std::vector<std::int32_t>{0, 1}, {1, 2}}) mesh.add_cell(CellType::SEG2, nodes);
  for (const auto& nodes : {std::vector<std::int32_t>{0, 1, 2}, {0, 2, 3}}) mesh.add_cell(CellType::TRIA3, nodes);
  mesh.cell_groups = {{"BODY", {2, 3}}, {"SKIN", {0, 1}}};
  mesh.node_groups = {{"BODY", {0, 3}}};
  return mesh;
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_EQ(a.coordinates, b.coordinates);
  EXPECT_EQ(a.types, b.types);
  EXPECT_EQ(a.cells.offset, b.cells.offset);
  EXPECT_EQ(a.cells.values, b.cells.values);
  for (const auto& [x, y] : {std::pair(&a.cell_groups, &b.cell_groups), std::pair(&a.node_groups, &b.node_groups)}) {
    ASSERT_EQ(x->size(), y->size());
    for (std::size_t i = 0; i < x->size(); ++i) {
      EXPECT_EQ((*x)[i].name, (*y)[i].name);
      EXPECT_EQ((*x)[i].members, (*y)[i].members) << (*x)[i].name;
    }
  }
}

// ---------------------------------------------------------------------------------------------- identity

TEST_F(Med, keeps_every_cell_type) {
  const Mesh mesh = mesh_of_all_types();
  write_mesh(file, mesh, "M");
  const Mesh back = read_med_mesh(file);
  EXPECT_EQ(back.name, "M");
  expect_same(back, mesh);
}

TEST_F(Med, keeps_groups_that_overlap_are_empty_or_have_long_names) {
  Mesh mesh = mesh_of_all_types();
  const std::string longest(80, 'G');
  mesh.cell_groups = {{"A", {0, 1, 2, 3}}, {"B", {2, 3, 4}}, {"EMPTY", {}}, {longest, {4}}};
  mesh.node_groups = {{"A", {7}}, {"A B/C", {5, 7, 9}}};
  write_mesh(file, mesh, "M");
  expect_same(read_med_mesh(file), mesh);
}

TEST_F(Med, keeps_a_mesh_of_the_plane_plane) {
  write_mesh(file, small_mesh(), "M");
  const Mesh back = read_med_mesh(file);
  EXPECT_EQ(back.dimension, 2);
  EXPECT_EQ(hdf5::Reader(file).shape(std::string(step) + "NOE/COO"), std::vector<hsize_t>{8});
  expect_same(back, small_mesh());
}

/// Cells are numbered by type on reading, whatever order they had; NUM tells the number they had.
TEST_F(Med, tells_the_numbers_of_a_mesh_whose_types_interleave) {
  const Mesh mesh = mesh_of({CellType::TRIA3, CellType::SEG2, CellType::TRIA3, CellType::SEG2});
  write_mesh(file, mesh, "M");
  const hdf5::Reader root(file);
  EXPECT_THAT(root.read<std::int32_t>(std::string(step) + "MAI/SE2/NUM"), ElementsAre(2, 4));
  EXPECT_THAT(root.read<std::int32_t>(std::string(step) + "MAI/TR3/NUM"), ElementsAre(1, 3));
  const Mesh back = read_med_mesh(file);
  EXPECT_THAT(back.types, ElementsAre(CellType::SEG2, CellType::SEG2, CellType::TRIA3, CellType::TRIA3));
  const std::size_t now_of[] = {2, 0, 3, 1};
  for (std::size_t c = 0; c < 4; ++c) {
    const auto now = back.cells[now_of[c]];
    EXPECT_THAT(std::vector<std::int32_t>(now.begin(), now.end()), testing::ElementsAreArray(mesh.cells[c]));
  }
}

/// MED's node order of solids is the mirror of ours (METHOD.md, appendix A): the first cells' nodes as they stand in the file.
TEST_F(Med, writes_solids_in_the_node_order_of_med) {
  write_mesh(file, mesh_of({CellType::TETRA4, CellType::HEXA8}), "M");
  const hdf5::Reader root(file);
  EXPECT_THAT(root.read<std::int32_t>(std::string(step) + "MAI/TE4/NOD"), ElementsAre(1, 3, 2, 4));
  EXPECT_THAT(root.read<std::int32_t>(std::string(step) + "MAI/HE8/NOD"), ElementsAre(5, 8, 7, 6, 9, 12, 11, 10));
}

// ---------------------------------------------------------------------------------------------- what other programs write

TEST_F(Med, reads_64_bit_integers) {
  write_mesh(file, small_mesh(), "M");
  edit(file, [&](const hdf5::Group& root) {
    for (const char* type : {"SE2", "TR3"}) {
      const hdf5::Group group = root.open(std::string(step) + "MAI/" + type);
      for (const char* set : {"NOD", "FAM"}) replace(group, set, group.read<std::int64_t>(set), 2);
    }
  });
  expect_same(read_med_mesh(file), small_mesh());
}

TEST_F(Med, reads_versions_3_and_4_only) {
  write_mesh(file, small_mesh(), "M");
  const auto stamp = [&](std::int32_t major, std::int32_t minor) {
    edit(file, [&](const hdf5::Group& root) {
      root.open("INFOS_GENERALES").set("MAJ", major);
      root.open("INFOS_GENERALES").set("MIN", minor);
    });
  };
  for (const auto& [major, minor] : {std::pair(3, 0), {3, 3}, {4, 0}, {4, 1}}) {
    stamp(major, minor);
    expect_same(read_med_mesh(file), small_mesh());
  }
  stamp(1, 9);
  const Message old = message_of([&] { read_med_mesh(file); });
  EXPECT_EQ(old.id, "MED_3");
  EXPECT_THAT(old.text, HasSubstr("1.9.0"));
  stamp(5, 0);
  EXPECT_EQ(message_of([&] { read_med_mesh(file); }).id, "MED_3");
}

TEST_F(Med, reads_files_without_families) {
  write_mesh(file, small_mesh(), "M");
  edit(file, [&](const hdf5::Group& root) {
    remove_link(root, "FAS");
    for (const char* place : {"NOE/FAM", "MAI/SE2/FAM", "MAI/TR3/FAM"}) remove_link(root, std::string(step) + place);
  });
  Mesh bare = small_mesh();
  bare.cell_groups.clear();
  bare.node_groups.clear();
  expect_same(read_med_mesh(file), bare);
}

TEST_F(Med, reads_the_first_of_several_computation_steps) {
  write_mesh(file, small_mesh(), "M");
  edit(file, [&](const hdf5::Group& root) {
    const hdf5::Group later = root.create("ENS_MAA/M/0000000000000000000100000000000000000001");
    later.set("NDT", 1);
    later.set("NOR", 1);
  });
  expect_same(read_med_mesh(file), small_mesh());
}

TEST_F(Med, reads_a_named_mesh_or_the_first_and_says_so) {
  static std::vector<std::string> told;
  told.clear();
  write_med(file, true, [](MedFile& med) {
    med.add_mesh(small_mesh(), "SECOND");
    med.add_mesh(mesh_of({CellType::QUAD4}), "FIRST");
  });
  EXPECT_THAT(med_mesh_names(file), ElementsAre("FIRST", "SECOND"));
  expect_same(read_med_mesh(file, "SECOND"), small_mesh());
  set_message_sink([](const Message& m) { told.push_back(m.id); });
  EXPECT_EQ(read_med_mesh(file).name, "FIRST");
  set_message_sink(nullptr);
  EXPECT_THAT(told, ElementsAre("MED_11"));
  const Message unknown = message_of([&] { read_med_mesh(file, "THIRD"); });
  EXPECT_EQ(unknown.id, "MED_5");
  EXPECT_THAT(unknown.text, HasSubstr("'FIRST', 'SECOND'"));
}

TEST_F(Med, takes_a_flat_mesh_with_three_coordinates_as_plane) {
  Mesh mesh = small_mesh();
  mesh.dimension = 3;
  write_mesh(file, mesh, "M");
  EXPECT_EQ(read_med_mesh(file).dimension, 2);
  mesh.coordinates[2] = 1e-3;
  write_mesh(folder / "not_flat.med", mesh, "M");
  EXPECT_EQ(read_med_mesh(folder / "not_flat.med").dimension, 3);
}

// ---------------------------------------------------------------------------------------------- bad files

TEST_F(Med, refuses_what_is_not_a_med_file) {
  EXPECT_EQ(message_of([&] { read_med_mesh(folder / "missing.med"); }).id, "MED_1");
  EXPECT_EQ(message_of([&] { read_med_mesh(folder); }).id, "MED_1");
  std::ofstream(folder / "empty.med").close();
  EXPECT_EQ(message_of([&] { read_med_mesh(folder / "empty.med"); }).id, "MED_1");
  std::ofstream(folder / "text.med") << "this is a text, not a mesh";
  EXPECT_EQ(message_of([&] { read_med_mesh(folder / "text.med"); }).id, "MED_2");
  hdf5::write_whole(folder / "other.h5", [](const hdf5::Group& root) { root.create("something"); });
  EXPECT_EQ(message_of([&] { read_med_mesh(folder / "other.h5"); }).id, "MED_2");
}

TEST_F(Med, refuses_a_file_that_is_cut_off_anywhere) {
  write_mesh(file, mesh_of_all_types(), "M");
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::filesystem::path cut = folder / "cut.med";
  for (std::size_t part = 1; part < 20; ++part) {
    std::ofstream(cut, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size() * part / 20));
    EXPECT_EQ(message_of([&] { read_med_mesh(cut); }).id, "MED_1") << part;
  }
}

TEST_F(Med, refuses_a_file_without_mesh) {
  write_med(file, true, [](MedFile&) {});
  EXPECT_EQ(message_of([&] { read_med_mesh(file); }).id, "MED_4");
}

struct Damage {
  std::string name;
  std::function<void(const hdf5::Group& step, const hdf5::Group& root)> spoil;
  std::string id, words;
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

class DamagedMed : public InFolder, public testing::WithParamInterface<Damage> {};

TEST_P(DamagedMed, is_refused_with_a_message) {
  const std::filesystem::path file = folder / "bad.med";
  write_mesh(file, small_mesh(), "M");
  edit(file, [&](const hdf5::Group& root) { GetParam().spoil(root.open(step), root); });
  const Message message = message_of([&] { read_med_mesh(file); });
  EXPECT_EQ(message.id, GetParam().id) << message.text;
  EXPECT_THAT(message.text, HasSubstr(GetParam().words));
  EXPECT_THAT(message.text, HasSubstr("bad.med"));
}

using H5 = hdf5::Group;
INSTANTIATE_TEST_SUITE_P(
    all, DamagedMed,
    testing::Values(
        Damage{"polygons", [](const H5& s, const H5&) { s.create("MAI/POG"); }, "MED_6", "POG (polygons)"},
        Damage{"polyhedra", [](const H5& s, const H5&) { s.create("MAI/POE"); }, "MED_6", "POE (polyhedra)"},
        Damage{"unknown_type", [](const H5& s, const H5&) { s.create("MAI/TR7"); }, "MED_6", "TR7"},
        Damage{"short_connectivity",
               [](const H5& s, const H5&) {
                 replace<std::int32_t>(s, "MAI/TR3/NOD", {1, 2, 3}, 2);
               },
               "MED_7", "NOD of its cells TR3 has 3 values instead of 6"},
        Damage{"text_for_connectivity",
               [](const H5& s, const H5&) {
                 remove_link(s, "MAI/TR3/NOD");
                 s.write_strings("MAI/TR3/NOD", {"a", "b", "c", "d", "e", "f"});
                 set_dataset_integer(s, "MAI/TR3/NOD", "NBR", 2);
               },
               "MED_7", "NOD of its cells TR3 cannot be read"},
        Damage{"no_connectivity", [](const H5& s, const H5&) { remove_link(s, "MAI/TR3/NOD"); }, "MED_7",
               "no nodal connectivity"},
        Damage{"short_families", [](const H5& s, const H5&) { replace<std::int32_t>(s, "MAI/TR3/FAM", {-1}, 1); }, "MED_7",
               "FAM"},
        Damage{"negative_count", [](const H5& s, const H5&) { set_dataset_integer(s, "MAI/TR3/NOD", "NBR", -3); }, "MED_7",
               "NBR"},
        Damage{"wrong_count", [](const H5& s, const H5&) { set_dataset_integer(s, "MAI/TR3/NOD", "NBR", 3); }, "MED_7", "NOD"},
        Damage{"node_0",
               [](const H5& s, const H5&) {
                 replace<std::int32_t>(s, "MAI/TR3/NOD", {1, 1, 2, 0, 3, 4}, 2);
               },
               "MED_8", "TR3 number 2 names the node 0, but the nodes are 1 to 4"},
        Damage{"node_5",
               [](const H5& s, const H5&) {
                 replace<std::int32_t>(s, "MAI/TR3/NOD", {1, 1, 2, 3, 5, 4}, 2);
               },
               "MED_8", "TR3 number 1 names the node 5"},
        Damage{"nan",
               [](const H5& s, const H5&) {
                 replace<double>(s, "NOE/COO", {0, 1, 1, 0, 0, 0, NAN, 1}, 4);
               },
               "MED_9", "N3"},
        Damage{"infinite",
               [](const H5& s, const H5&) {
                 replace<double>(s, "NOE/COO", {0, -INFINITY, 1, 0, 0, 0, 1, 1}, 4);
               },
               "MED_9", "N2"},
        Damage{"no_coordinates", [](const H5& s, const H5&) { remove_link(s, "NOE/COO"); }, "MED_7", "coordinates"},
        Damage{"short_coordinates",
               [](const H5& s, const H5&) {
                 replace<double>(s, "NOE/COO", {0, 1, 1, 0}, 4);
               },
               "MED_7", "COO"},
        Damage{"huge_coordinates",
               [](const H5& s, const H5&) {
                 remove_link(s, "NOE/COO");
                 const hsize_t size = hsize_t{1} << 50;
                 const hdf5::Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
                 hdf5::Handle(H5Dcreate2(s.id(), "NOE/COO", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                              H5Dclose);
                 set_dataset_integer(s, "NOE/COO", "NBR", 4);
               },
               "MED_7", "1125899906842624 values instead of 8"},
        Damage{"no_cells", [](const H5& s, const H5&) { remove_link(s, "MAI"); }, "MED_7", "no cells"},
        Damage{"no_nodes", [](const H5& s, const H5&) { remove_link(s, "NOE"); }, "MED_7", "no nodes"},
        Damage{"no_step", [](const H5&, const H5& r) { remove_link(r, "ENS_MAA/M/" + std::string(med::no_step)); }, "MED_7",
               "step"},
        Damage{"family_missing", [](const H5&, const H5& r) { remove_link(r, "FAS/M/ELEME/FAM_-1"); }, "MED_7", "number -1"},
        Damage{"family_without_number",
               [](const H5&, const H5& r) { H5Adelete_by_name(r.id(), "FAS/M/ELEME/FAM_-1", "NUM", H5P_DEFAULT); }, "MED_7",
               "NUM"},
        Damage{"group_names_missing", [](const H5&, const H5& r) { remove_link(r, "FAS/M/ELEME/FAM_-1/GRO/NOM"); }, "MED_7",
               "FAM_-1"},
        Damage{"structured", [](const H5&, const H5& r) { r.open("ENS_MAA/M").set("TYP", std::int32_t{1}); }, "MED_10",
               "structured"},
        Damage{"cylindrical", [](const H5&, const H5& r) { r.open("ENS_MAA/M").set("REP", std::int32_t{1}); }, "MED_10",
               "Cartesian"},
        Damage{"on_a_line", [](const H5&, const H5& r) { r.open("ENS_MAA/M").set("ESP", std::int32_t{1}); }, "MED_10",
               "1 coordinates"},
        Damage{"no_version", [](const H5&, const H5& r) { H5Adelete_by_name(r.id(), "INFOS_GENERALES", "MIN", H5P_DEFAULT); },
               "MED_2", "version"}),
    [](const auto& parameter) { return parameter.param.name; });

TEST_F(Med, refuses_group_names_that_med_cannot_hold) {
  Mesh mesh = small_mesh();
  mesh.cell_groups[0].name = std::string(81, 'G');
  EXPECT_EQ(message_of([&] { write_mesh(file, mesh, "M"); }).id, "MED_12");
  EXPECT_EQ(message_of([&] { write_mesh(file, small_mesh(), std::string(65, 'M')); }).id, "MED_12");
  EXPECT_FALSE(std::filesystem::exists(file));
}

// ---------------------------------------------------------------------------------------------- adding to a file

TEST_F(Med, holds_a_mesh_once_and_another_of_the_same_name_beside_it) {
  const auto add = [&](const Mesh& mesh) {
    std::string name;
    write_med(file, true, [&](MedFile& med) { name = med.add_mesh(mesh, "M"); });
    return name;
  };
  EXPECT_EQ(add(small_mesh()), "M");
  EXPECT_EQ(add(small_mesh()), "M");
  EXPECT_EQ(add(mesh_of({CellType::QUAD4})), "M_2");
  EXPECT_EQ(add(mesh_of({CellType::QUAD4})), "M_2");
  Mesh richer = small_mesh();
  richer.node_groups.push_back({"NEW", {1}});
  EXPECT_EQ(add(richer), "M");
  EXPECT_THAT(med_mesh_names(file), ElementsAre("M", "M_2"));
  expect_same(read_med_mesh(file, "M"), richer);
  expect_same(read_med_mesh(file, "M_2"), mesh_of({CellType::QUAD4}));
}

TEST_F(Med, stays_as_it_was_when_writing_fails) {
  write_mesh(file, small_mesh(), "M");
  const auto size = std::filesystem::file_size(file);
  EXPECT_THROW(write_med(file, true,
                         [&](MedFile& med) {
                           med.add_mesh(mesh_of({CellType::QUAD4}), "OTHER");
                           throw std::runtime_error("killed");
                         }),
               std::runtime_error);
  EXPECT_EQ(std::filesystem::file_size(file), size);
  EXPECT_THAT(med_mesh_names(file), ElementsAre("M"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST_F(Med, does_not_add_to_what_is_not_med_4_1) {
  std::ofstream(file) << "a text that somebody needs";
  EXPECT_EQ(message_of([&] { write_mesh(file, small_mesh(), "M"); }).id, "MED_2");
  EXPECT_EQ(std::filesystem::file_size(file), 26u);
  write_mesh(folder / "old.med", small_mesh(), "M");
  edit(folder / "old.med", [](const hdf5::Group& root) { root.open("INFOS_GENERALES").set("MAJ", std::int32_t{3}); });
  EXPECT_EQ(message_of([&] { write_mesh(folder / "old.med", small_mesh(), "N"); }).id, "MED_13");
}

// ---------------------------------------------------------------------------------------------- fields

Field nodal_field(const std::vector<std::int32_t>& nodes, const std::vector<std::string>& components) {
  Field field;
  field.name = "DEPL";
  field.components = components;
  field.support = nodes;
  for (std::size_t i = 0; i < nodes.size() * components.size(); ++i) field.values.push_back(0.5 + static_cast<double>(i));
  field.order = 3;
  field.instant = 0.25;
  return field;
}

const std::string at_3 = "/0000000000000000000300000000000000000003/";

class MedFields : public Med {
 protected:
  std::vector<std::string> add(const Field& field, const std::string& name, std::int64_t order = 3, const MedRule& rule = {}) {
    std::vector<std::string> names;
    write_med(file, true,
              [&](MedFile& med) { names = med.add_field(mesh, med.add_mesh(mesh, "M"), field, name, order, rule); });
    return names;
  }
  std::vector<double> values(const std::string& path) { return hdf5::Reader(file).read<double>("CHA/" + path + "/CO"); }
  std::vector<std::int32_t> numbers(const std::string& entity, const std::string& field) {
    const hdf5::Reader root(file);
    return root.read<std::int32_t>("PROFILS/" + root.open("CHA/" + field + at_3 + entity).text("PFL") + "/PFL");
  }

  Mesh mesh = small_mesh();
  const std::string all = "/" + std::string(med::no_profile);
};

TEST_F(MedFields, nodes_component_by_component) {
  add(nodal_field({0, 1, 2, 3}, {"DX", "DY"}), "R_______DEPL");
  EXPECT_THAT(values("R_______DEPL" + at_3 + "NOE" + all), ElementsAre(0.5, 2.5, 4.5, 6.5, 1.5, 3.5, 5.5, 7.5));
  const hdf5::Reader root(file);
  const hdf5::Group field = root.open("CHA/R_______DEPL");
  EXPECT_EQ(field.text("MAI"), "M");
  EXPECT_EQ(field.text("NOM"), "DX              DY");
  EXPECT_EQ(field.integer("NCO"), 2);
  EXPECT_EQ(field.open("0000000000000000000300000000000000000003").real("PDT"), 0.25);
}

TEST_F(MedFields, part_of_the_nodes_with_a_profile_in_rising_order) {
  add(nodal_field({3, 1}, {"DX"}), "F");
  EXPECT_THAT(numbers("NOE", "F"), ElementsAre(2, 4));
  EXPECT_THAT(values("F" + at_3 + "NOE/PFL_NOE"), ElementsAre(1.5, 0.5));
}

/// LAGS_C lives on its carriers only: it gets a field of its own with a profile, and DEPL stays a vector on every node.
TEST_F(MedFields, components_that_exist_elsewhere_make_a_field_of_their_own) {
  Field field = nodal_field({0, 1, 2, 3}, {"DX", "DY", "LAGS_C"});
  field.present = {1, 1, 0, 1, 1, 1, 1, 1, 0, 1, 1, 0};
  EXPECT_THAT(add(field, "F"), ElementsAre("F", "F_LAGS_C"));
  EXPECT_EQ(values("F" + at_3 + "NOE" + all).size(), 8u);
  EXPECT_THAT(numbers("NOE", "F_LAGS_C"), ElementsAre(2));
  EXPECT_THAT(values("F_LAGS_C" + at_3 + "NOE/PFL_NOE"), ElementsAre(5.5));
}

TEST_F(MedFields, cells_of_a_part_by_their_rank_in_the_type) {
  mesh = mesh_of({CellType::TRIA3, CellType::SEG2, CellType::TRIA3, CellType::SEG2});
  Field field = nodal_field({2, 1, 3}, {"PRES"});
  field.location = Location::cells;
  add(field, "F");
  EXPECT_THAT(numbers("MAI.TR3", "F"), ElementsAre(2));
  EXPECT_THAT(values("F" + at_3 + "MAI.TR3/PFL_TR3"), ElementsAre(0.5));
  EXPECT_THAT(values("F" + at_3 + "MAI.SE2" + all), ElementsAre(1.5, 2.5));
}

TEST_F(MedFields, nodes_of_cells_in_the_node_order_of_med) {
  mesh = mesh_of({CellType::TETRA4});
  Field field = nodal_field({0}, {"SIXX"});
  field.location = Location::cell_nodes;
  field.offset = {0, 4};
  field.values = {1, 2, 3, 4};
  add(field, "F");
  EXPECT_THAT(values("F" + at_3 + "NOE.TE4" + all), ElementsAre(1, 3, 2, 4));
}

/// A megabyte holds 20833 rows of six components: the cell that is there when it ends, 2604, is in two parts.
TEST_F(MedFields, of_several_parts) {
  constexpr std::size_t n_cells = 6000, n = 8, n_components = 6;
  mesh = mesh_of(std::vector<CellType>(n_cells, CellType::HEXA8));
  std::vector<std::int32_t> cells(n_cells);
  std::iota(cells.rbegin(), cells.rend(), 0);  // from the last to the first
  Field field = nodal_field(cells, {"SIXX", "SIYY", "SIZZ", "SIXY", "SIXZ", "SIYZ"});
  field.location = Location::cell_nodes;
  field.offset = {0};
  field.values.clear();
  const auto value = [](std::size_t cell, std::size_t node, std::size_t component) {
    return static_cast<double>(100 * cell + 10 * node + component);
  };
  for (const std::int32_t cell : cells) {
    field.offset.push_back(field.offset.back() + static_cast<std::int64_t>(n));
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n_components; ++k) field.values.push_back(value(static_cast<std::size_t>(cell), j, k));
  }
  add(field, "F");
  const auto& order = catalog::cell(CellType::HEXA8).med_permutation;
  std::vector<double> expected(field.values.size());
  for (std::size_t cell = 0; cell < n_cells; ++cell)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n_components; ++k)
        expected[k * n * n_cells + cell * n + static_cast<std::size_t>(order[j])] = value(cell, j, k);
  EXPECT_EQ(values("F" + at_3 + "NOE.HE8" + all), expected);
}

TEST_F(MedFields, integration_points_with_their_localisation) {
  Field field = nodal_field({2, 3}, {"SIXX", "SIYY"});
  field.location = Location::gauss_points;
  field.offset = {0, 2, 4};
  field.values = {1, 10, 2, 20, 3, 30, 4, 40};
  const MedRule rule = [](CellType, int) { return MedPoints{{0.25, 0.25, 0.5, 0.25}, {0.25, 0.25}}; };
  add(field, "F", 3, rule);
  EXPECT_THAT(values("F" + at_3 + "MAI.TR3" + all), ElementsAre(1, 2, 3, 4, 10, 20, 30, 40));
  const hdf5::Reader root(file);
  const hdf5::Group points = root.open("GAUSS/" + root.open("CHA/F" + at_3 + "MAI.TR3").text("GAU"));
  EXPECT_EQ(points.integer("GEO"), 203);
  EXPECT_EQ(points.integer("NBR"), 2);
  EXPECT_THAT(points.read<double>("COO"), ElementsAre(0, 1, 0, 0, 0, 1));
  EXPECT_THAT(points.read<double>("GAU"), ElementsAre(0.25, 0.5, 0.25, 0.25));
  EXPECT_EQ(root.open("CHA/F" + at_3 + "MAI.TR3" + all).integer("NGA"), 2);
}

TEST_F(MedFields, a_step_written_again_is_replaced_and_another_is_added) {
  add(nodal_field({0, 1, 2, 3}, {"DX"}), "F");
  Field again = nodal_field({0, 1, 2, 3}, {"DX"});
  again.values = {9, 8, 7, 6};
  add(again, "F");
  add(again, "F", 4);
  EXPECT_THAT(values("F" + at_3 + "NOE" + all), ElementsAre(9, 8, 7, 6));
  EXPECT_EQ(hdf5::Reader(file).open("CHA/F").children().size(), 2u);
}

TEST_F(MedFields, the_same_name_with_other_components_or_on_another_mesh_gets_a_number) {
  EXPECT_THAT(add(nodal_field({0, 1, 2, 3}, {"DX"}), "F"), ElementsAre("F"));
  EXPECT_THAT(add(nodal_field({0, 1, 2, 3}, {"DY"}), "F"), ElementsAre("F_2"));
  mesh = mesh_of({CellType::QUAD4});
  EXPECT_THAT(add(nodal_field({0, 1, 2, 3}, {"DX"}), "F"), ElementsAre("F_3"));
}

std::uint32_t mask(const hdf5::Group& group, const char* name) {
  const hdf5::Handle id(H5Aopen(group.id(), name, H5P_DEFAULT), H5Aclose);
  std::uint32_t bits = 0;
  EXPECT_GE(H5Aread(id, H5T_NATIVE_B32, &bits), 0);
  return bits;
}

/// The masks that the MED library 4.1 itself writes for such fields.
TEST_F(MedFields, carry_the_summaries_of_med_4_1) {
  Field cells = nodal_field({2, 3}, {"A"});
  cells.location = Location::cells;
  add(cells, "F", 1);
  cells.support = {0, 1};
  add(cells, "F", 2);
  const hdf5::Reader root(file);
  const hdf5::Group field = root.open("CHA/F");
  EXPECT_EQ(mask(field, "LEN"), 1u);
  EXPECT_EQ(mask(field, "LGC"), 16u + 2u);
  EXPECT_EQ(field.integer("LAA"), 2);
  EXPECT_EQ(field.integer("LCA"), 0);
  EXPECT_EQ(mask(field.open("0000000000000000000200000000000000000002"), "LGC"), 2u);
}

}  // namespace
