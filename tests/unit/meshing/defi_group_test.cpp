// DEFI_GROUP: groups from groups, from names, and their removal.
#include "lacon/operators/defi_group/defi_group.hpp"

#include <nlohmann/json.hpp>
#include <numeric>

#include "meshes.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;
using testing::HasSubstr;

Message define(Mesh& mesh, const std::string& keywords) {
  nlohmann::json json = nlohmann::json::parse(keywords);
  if (!json.contains("ALARME")) json["ALARME"] = "OUI";
  return error_of([&] { defi_group(mesh, Keywords(json, "")); });
}

const Nodes& cells_of(const Mesh& mesh, const std::string& group) { return mesh.find_cell_group(group)->members; }
const Nodes& nodes_of(const Mesh& mesh, const std::string& group) { return mesh.find_node_group(group)->members; }

// 2 x 1 quadrangles: skin M1 to M6, body M7 and M8; nodes N1 to N6.
Mesh small() { return block(CellType::QUAD4, 2, 1, 1); }

TEST(CellGroups, by_name_union_intersection_difference_and_all) {
  Mesh mesh = small();
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_MA": [
    {"NOM": "A", "MAILLE": ["M8", "M2"]},
    {"NOM": "B", "UNION": ["BODY", "A"]},
    {"NOM": "C", "INTERSEC": ["AROUND", "B"]},
    {"NOM": "D", "DIFFE": ["AROUND", "C", "TOP"]},
    {"NOM": "E", "TOUT": "OUI", "TYPE_MAILLE": ["2D"]},
    {"NOM": "F", "GROUP_MA": "B", "TYPE_MAILLE": ["SEG2"]}]})")
                .id,
            "");
  EXPECT_EQ(cells_of(mesh, "A"), (Nodes{7, 1}));
  EXPECT_EQ(cells_of(mesh, "B"), (Nodes{6, 7, 1}));
  EXPECT_EQ(cells_of(mesh, "C"), (Nodes{1}));
  EXPECT_EQ(cells_of(mesh, "D"), (Nodes{0, 2, 5}));
  EXPECT_EQ(cells_of(mesh, "E"), (Nodes{6, 7}));
  EXPECT_EQ(cells_of(mesh, "F"), (Nodes{1}));
}

// INVENTORY 14.13: without NOM the group of nodes takes the name of the group of cells.
TEST(NodeGroups, of_cells_take_their_name) {
  Mesh mesh = small();
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_NO": [{"GROUP_MA": ["TOP", "LEFT"]}, {"GROUP_MA": ["BOTTOM"], "NOM": "LOW"}]})").id,
            "");
  EXPECT_EQ(nodes_of(mesh, "TOP"), (Nodes{3, 4, 5}));
  EXPECT_EQ(nodes_of(mesh, "LEFT"), (Nodes{0, 3}));
  EXPECT_EQ(nodes_of(mesh, "LOW"), (Nodes{0, 1, 2}));
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_NO": [
    {"NOM": "A", "NOEUD": ["N6", "N1"]},
    {"NOM": "B", "UNION": ["A", "LOW"]},
    {"NOM": "C", "INTERSEC": ["B", "TOP"]},
    {"NOM": "D", "DIFFE": ["B", "A"]},
    {"NOM": "E", "GROUP_NO": "D"}]})")
                .id,
            "");
  EXPECT_EQ(nodes_of(mesh, "A"), (Nodes{5, 0}));
  EXPECT_EQ(nodes_of(mesh, "B"), (Nodes{5, 0, 1, 2}));
  EXPECT_EQ(nodes_of(mesh, "C"), (Nodes{5}));
  EXPECT_EQ(nodes_of(mesh, "D"), (Nodes{1, 2}));
  EXPECT_EQ(nodes_of(mesh, "E"), (Nodes{1, 2}));
}

TEST(NodeGroups, of_all_cell_groups_keep_those_that_exist) {
  Mesh mesh = small();
  mesh.node_groups.push_back({"TOP", {0}});
  const Listener listener;
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_NO": [{"TOUT_GROUP_MA": "OUI"}]})").id, "");
  EXPECT_EQ(nodes_of(mesh, "TOP"), (Nodes{0}));
  EXPECT_EQ(nodes_of(mesh, "BODY"), (Nodes{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(Listener::ids(), (std::vector<std::string>{"GROUPE_6"}));
}

TEST(Groups, are_removed) {
  Mesh mesh = small();
  EXPECT_EQ(define(mesh, R"({"DETR_GROUP_MA": [{"NOM": ["TOP", "LEFT"]}], "DETR_GROUP_NO": [{"NOM": ["CORNER"]}],
                             "CREA_GROUP_MA": [{"NOM": "TOP", "MAILLE": ["M1"]}]})")
                .id,
            "");
  EXPECT_EQ(mesh.find_cell_group("LEFT"), nullptr);
  EXPECT_EQ(mesh.find_node_group("CORNER"), nullptr);
  EXPECT_EQ(cells_of(mesh, "TOP"), (Nodes{0}));
  const Message error = define(mesh, R"({"DETR_GROUP_MA": [{"NOM": ["BOTOM"]}]})");
  EXPECT_EQ(error.id, "MESH_1");
  EXPECT_THAT(error.text, HasSubstr("'BOTTOM'"));
}

TEST(GroupErrors, names_that_do_not_exist_are_refused_with_the_range) {
  Mesh mesh = small();
  for (const std::string name : {"M0", "M9", "M", "N1", "M01", "M1x", "M-1", "M99999999999999999999", ""}) {
    const Message error = define(mesh, R"({"CREA_GROUP_MA": [{"NOM": "A", "MAILLE": [")" + name + R"("]}]})");
    EXPECT_EQ(error.id, "GROUPE_2") << name;
    EXPECT_THAT(error.advice, HasSubstr("M1 to M8"));
  }
  EXPECT_THAT(define(mesh, R"({"CREA_GROUP_NO": [{"NOM": "A", "NOEUD": ["N7"]}]})").advice, HasSubstr("N1 to N6"));
}

TEST(GroupErrors, a_name_that_is_taken_is_refused) {
  Mesh mesh = small();
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_MA": [{"NOM": "TOP", "MAILLE": ["M1"]}]})").id, "GROUPE_1");
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_NO": [{"NOM": "CORNER", "NOEUD": ["N1"]}]})").id, "GROUPE_1");
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_NO": [{"NOM": "X", "GROUP_MA": ["TOP", "LEFT"]}]})").id, "GROUPE_4");
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_MA": [{"NOM": "X", "TOUT": "OUI", "TYPE_MAILLE": ["QUAD5"]}]})").id, "GROUPE_5");
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_MA": [{"NOM": "X", "UNION": ["NOWHERE"]}]})").id, "MESH_1");
}

// What would be empty is not created; ALARME decides whether that is said.
TEST(GroupErrors, an_empty_group_is_an_alarm) {
  Mesh mesh = small();
  const Listener listener;
  EXPECT_EQ(define(mesh, R"({"CREA_GROUP_MA": [{"NOM": "X", "INTERSEC": ["TOP", "BOTTOM"]}]})").id, "");
  EXPECT_EQ(mesh.find_cell_group("X"), nullptr);
  EXPECT_EQ(Listener::ids(), (std::vector<std::string>{"GROUPE_3"}));
  define(mesh, R"({"ALARME": "NON", "CREA_GROUP_MA": [{"NOM": "X", "INTERSEC": ["TOP", "BOTTOM"]}]})");
  EXPECT_EQ(Listener::ids().size(), 1u);
}

// Names go by final numbers: the second child of a cut cell has the number after the first (INVENTORY 3, ssnp170k's M350).
TEST(CellGroups, name_cells_of_the_cut_mesh) {
  Mesh made = cut(small(), {"BOTTOM"});
  EXPECT_EQ(define(made, R"({"CREA_GROUP_MA": [{"NOM": "CHILD", "MAILLE": ["M2"]}]})").id, "");
  EXPECT_EQ(cells_of(made, "CHILD")[0], made.patches->cells[0][1]);
  ASSERT_TRUE(made.patches);
}

}  // namespace
