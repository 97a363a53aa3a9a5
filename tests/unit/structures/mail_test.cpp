// Meshes in code_aster's text files: what they say, what they give back, what is refused and where.
#include "lacon/structures/formats/mail.hpp"

#include <fstream>

#include "formats_fixture.hpp"
#include "lacon/structures/names.hpp"

namespace lacon {
namespace {

struct Mail : test::InFolder {
  std::filesystem::path write(const std::string& text) const {
    const std::filesystem::path file = folder / "plate.mail";
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  Mesh read(const std::string& text) const { return read_mail_mesh(write(text)); }
  Message refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& error) {
      return error.message();
    }
    return {};
  }
};

const std::string plate =
    "TITRE\n"
    " a plate, COOR_3D FINSF in a title\n"
    "FINSF\n"
    "% a comment with FIN in it\n"
    "COOR_2D  NOM=INDEFINI  NBOBJ=6  NBLIGE=2\n"
    "         AUTEUR = SOMEBODY  DATE=01/02/1993\n"
    " A  0.  0.0D+00\r\n"
    " B  1   +0.0e0  C 1.0 1.0d0   % two nodes in a line\n"
    " D  0. 1.\n"
    " N1 .5 -2.5E-1\n"
    " LONELY 2. 2.\n"
    "FINSF\n"
    "SEG2\n"
    " S1 A B\n"
    "FINSF\n"
    "QUAD4\n"
    " Q1 A B\n"
    "    C D\n"
    "FINSF\n"
    "GROUP_MA NOM = BASE\n"
    " S1\n"
    "FINSF\n"
    "GROUP_NO\n"
    " CORNERS A B C A D\n"
    "FINSF\n"
    "GROUP_NO BASE D FINSF\n"
    "FIN\n"
    "what stands behind FIN is not read\n";

TEST_F(Mail, PartsNamesCommentsAndGroupsAreWhatTheFormatSays) {
  const Mesh mesh = read(plate);
  EXPECT_EQ(mesh.dimension, 2);
  ASSERT_EQ(mesh.n_nodes(), 6u);
  EXPECT_EQ(mesh.coordinates, (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, -0.25, 0, 2, 2, 0}));
  EXPECT_EQ(mesh.types, (std::vector<CellType>{CellType::SEG2, CellType::QUAD4}));
  EXPECT_EQ(mesh.cells.values, (std::vector<std::int32_t>{0, 1, 0, 1, 2, 3}));
  ASSERT_TRUE(mesh.find_cell_group("BASE"));
  EXPECT_EQ(mesh.find_cell_group("BASE")->members, std::vector<std::int32_t>{0});
  EXPECT_EQ(mesh.find_node_group("CORNERS")->members, (std::vector<std::int32_t>{0, 1, 2, 3}));
}

TEST_F(Mail, ANodeOrCellIsFoundByTheNameThatTheFileGaveIt) {
  const Mesh mesh = read(plate);
  EXPECT_EQ(find_by_name(mesh, "C", Entity::node), 2);
  EXPECT_EQ(find_by_name(mesh, "N1", Entity::node), 4);  // not the first node
  EXPECT_EQ(find_by_name(mesh, "LONELY", Entity::node), 5);
  EXPECT_EQ(find_by_name(mesh, "N7", Entity::node), std::nullopt);
  EXPECT_EQ(find_by_name(mesh, "Q1", Entity::cell), 1);
}

TEST_F(Mail, NamesThatCountNodesAndCellsInAnyOrderGiveThemTheirNumbers) {
  const Mesh mesh = read(
      "COOR_3D NO2 0 0 2  NO3 0 0 3  NO1 0 0 1 FINSF\n"
      "SEG2 M3 NO1 NO3 FINSF SEG3 M1 NO1 NO2 NO3 FINSF SEG2 M2 NO1 NO2 FINSF GROUP_MA A M2 M3 FINSF FIN");
  EXPECT_EQ(mesh.coordinates, (std::vector<double>{0, 0, 1, 0, 0, 2, 0, 0, 3}));
  EXPECT_EQ(mesh.types, (std::vector<CellType>{CellType::SEG3, CellType::SEG2, CellType::SEG2}));
  EXPECT_EQ(mesh.cells.values, (std::vector<std::int32_t>{0, 1, 2, 0, 1, 0, 2}));
  EXPECT_EQ(mesh.find_cell_group("A")->members, (std::vector<std::int32_t>{1, 2}));
  EXPECT_TRUE(mesh.node_groups.empty());
  EXPECT_EQ(find_by_name(mesh, "NO2", Entity::node), 1);
  EXPECT_EQ(find_by_name(mesh, "N2", Entity::node), 1);
  EXPECT_EQ(find_by_name(mesh, "MA3", Entity::cell), 2);
  EXPECT_EQ(mesh.dimension, 3);
}

TEST_F(Mail, TooManyNamesThatCountNothingAreToldInsteadOfKept) {
  std::vector<std::string> told;
  static std::vector<std::string>* sink = nullptr;
  sink = &told;
  set_message_sink([](const Message& said) { sink->push_back(said.id); });
  std::string nodes = "COOR_2D\n";
  for (int i = 0; i < 300; ++i) nodes += " N" + std::to_string(10 * i + 10) + " " + std::to_string(i) + " 0\n";
  const Mesh mesh = read(nodes + "FINSF SEG2 S N10 N20 FINSF FIN");
  set_message_sink(nullptr);
  EXPECT_TRUE(mesh.node_groups.empty());
  EXPECT_EQ(told, (std::vector<std::string>{"MAIL_5", "MAIL_4"}));  // the cell S, the nodes
}

TEST_F(Mail, EveryKindOfCellComesBackToTheBit) {
  Mesh mesh = test::mesh_of_all_types();
  mesh.coordinates[1] = 1.0 / 3.0;
  mesh.node_groups = {{"NONE", {}}, {"SOME", {0, 5, 11, 2, 3, 4, 6, 7, 8, 9}}};
  mesh.cell_groups = {{"ALL", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}};
  const Mesh back = read(mail_text(mesh, "every kind"));
  EXPECT_EQ(back.coordinates, mesh.coordinates);
  EXPECT_EQ(back.types, mesh.types);
  EXPECT_EQ(back.cells.values, mesh.cells.values);
  EXPECT_EQ(back.find_node_group("SOME")->members, mesh.node_groups[1].members);
  EXPECT_TRUE(back.find_node_group("NONE")->members.empty());
  EXPECT_EQ(back.find_cell_group("ALL")->members, mesh.cell_groups[0].members);
}

TEST_F(Mail, GroupsWhoseNamesWouldBeOneStayApart) {
  Mesh mesh = test::mesh_of_all_types();
  mesh.node_groups = {{"FINSF", {0}}, {"A B", {1}}};
  mesh.cell_groups = {{"LOW A", {1}}, {"LOW_A", {0}}, {"LOW=A", {2}}, {"UP", {3}}};
  static std::string told;
  set_message_sink([](const Message& message) { told += message.id + message.text; });
  const std::string text = mail_text(mesh, "M");
  set_message_sink(nullptr);
  EXPECT_NE(told.find("MAIL_6"), std::string::npos);
  EXPECT_NE(told.find("'FINSF' -> 'FINSF_2', 'A B' -> 'A_B', 'LOW A' -> 'LOW_A_2', 'LOW=A' -> 'LOW_A_3'"), std::string::npos)
      << told;
  const Mesh back = read(text);
  for (const auto& [name, cell] : {std::pair("LOW_A", 0), {"LOW_A_2", 1}, {"LOW_A_3", 2}, {"UP", 3}})
    EXPECT_EQ(back.find_cell_group(name)->members, std::vector<std::int32_t>{cell});
  EXPECT_EQ(back.find_node_group("FINSF_2")->members, std::vector<std::int32_t>{0});
  EXPECT_EQ(back.find_node_group("A_B")->members, std::vector<std::int32_t>{1});
}

TEST_F(Mail, WhatIsDamagedIsRefusedWithItsLine) {
  const std::string nodes = "COOR_2D\n A 0. 0.\n B 1. 0.\nFINSF\n";
  struct Case {
    std::string text, id, line, word;
  };
  for (const auto& [text, id, line, word] : {
           Case{"COOR_2D\n A 0. 0.\n B 1.\nFINSF\nFIN\n", "MAIL_1", "4", "FINSF where a coordinate of the node 'B'"},
           Case{"COOR_2D\n A 0. zero\nFINSF\nFIN\n", "MAIL_1", "2", "'zero'"},
           Case{"COOR_2D\n A 0. nan\nFINSF\nFIN\n", "MAIL_1", "2", "'nan'"},
           Case{"COOR_2D\n A 0. 0.\n A 1. 0.\nFINSF\nFIN\n", "MAIL_1", "3", "'A' is there twice"},
           Case{nodes + "GROUP_NO\n X A\nFINSF\nGROUP_MA\n X\nFINSF\nGROUP_NO NOM=X\n B\nFINSF\nFIN\n", "MAIL_1", "11",
                "GROUP_NO 'X' is there twice"},
           Case{"COOR_2D\n A 0. 0.\n", "MAIL_1", "3", "without FINSF"},
           Case{nodes, "MAIL_1", "5", "without FIN"},
           Case{nodes + "FIN\n", "MAIL_1", "5", "no cells"},
           Case{"SEG2 S A B FINSF\nFIN\n", "MAIL_1", "2", "no nodes"},
           Case{nodes + "COOR_3D\n C 0 0 0\nFINSF\nFIN\n", "MAIL_1", "5", "COOR_2D and COOR_3D"},
           Case{nodes + "SEG2\n S A\nFINSF\nFIN\n", "MAIL_1", "7", "1 of its 2 nodes"},
           Case{nodes + "SEG2\n S A C\nFINSF\nFIN\n", "MAIL_3", "6", "'C'"},
           Case{nodes + "SEG2\n S A B\nFINSF\nGROUP_MA\n G S T\nFINSF\nFIN\n", "MAIL_3", "9", "'T'"},
           Case{nodes + "SEG4\n S A B C D\nFINSF\nFIN\n", "MAIL_2", "5", "SEG4"},
           Case{nodes + "SEG2\n S A B\nFINSF\nGROUP_NO\nFINSF\nFIN\n", "MAIL_1", "9", "no name"},
           Case{"\x89HDF\r\n", "MAIL_1", "1", "HDF"},
           Case{"$MeshFormat\n", "MAIL_1", "1", "$MeshFormat"},
       }) {
    const Message message = refusal(text);
    EXPECT_EQ(message.id, id) << text;
    EXPECT_NE(message.text.find("line " + line + ":"), std::string::npos) << message.text;
    EXPECT_NE(message.text.find(word), std::string::npos) << message.text;
  }
}

TEST_F(Mail, AFileThatIsCutOffAnywhereIsRefused) {
  const std::size_t end = plate.find("FIN\nwhat") + 3;
  for (std::size_t length = 1; length < end; ++length)
    EXPECT_NE(refusal(plate.substr(0, length)).id, "") << "cut off after " << length;
}

}  // namespace
}  // namespace lacon
