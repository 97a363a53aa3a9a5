// ORIE_PEAU: the normals of skin cells leave the body, by geometry.
#include <nlohmann/json.hpp>

#include "lacon/operators/meshing/orientation.hpp"
#include "lacon/operators/modi_maillage/modi_maillage.hpp"
#include "meshes.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;
using testing::HasSubstr;

/// Turn the cells of a group that `pick` chooses.
template <class Pick>
std::int64_t turn(Mesh& mesh, const std::string& group, const Pick& pick) {
  std::int64_t turned = 0;
  for (const std::int32_t c : mesh.find_cell_group(group)->members) {
    if (!pick(c)) continue;
    const auto s = static_cast<std::size_t>(c);
    std::ranges::copy(mirrored(mesh.types[s], mesh.cells[s]), mesh.cells[s].begin());
    ++turned;
  }
  return turned;
}

class Orient : public testing::TestWithParam<std::pair<CellType, CellType>> {};

// Whatever skin cells are turned, ORIE_PEAU brings back a skin of outward normals, and counts them.
TEST_P(Orient, turns_what_looks_inward) {
  const auto [body, skin] = GetParam();
  for (unsigned seed = 0; seed < 8; ++seed) {
    Mesh mesh = one_cell(body, skin, seed);
    std::mt19937 random(seed);
    const std::int64_t turned = turn(mesh, "SKIN", [&](std::int32_t) { return random() % 2 == 0; });
    EXPECT_EQ(orient_skin(mesh, "SKIN", {}, "K").turned, turned);
    EXPECT_EQ(orient_skin(mesh, "SKIN", {}, "K").turned, 0);
    const NodeCells around(mesh);
    for (const std::int32_t c : mesh.find_cell_group("SKIN")->members) {
      const auto bodies = body_cells(mesh, around, static_cast<std::size_t>(c));
      ASSERT_EQ(bodies.size(), 1u);
      EXPECT_TRUE(bodies[0].match.outward);
      // the mid nodes go with their edges: still the facet's nodes
      EXPECT_EQ(facet_counts(mesh).at(sorted(mesh.cells[static_cast<std::size_t>(c)])), 1);
    }
  }
}

// The outside is where the body is not, also when the body cell is numbered inside out.
TEST_P(Orient, goes_by_geometry_and_not_by_the_order_of_the_body) {
  const auto [body, skin] = GetParam();
  const Mesh right = one_cell(body, skin, 5);
  Mesh mesh = right;
  std::ranges::copy(mirrored(body, right.cells[0]), mesh.cells[0].begin());
  EXPECT_EQ(orient_skin(mesh, "SKIN", {}, "K").turned, 0);
  const std::int64_t turned = turn(mesh, "SKIN", [](std::int32_t) { return true; });
  EXPECT_EQ(orient_skin(mesh, "SKIN", {}, "K").turned, turned);
}

INSTANTIATE_TEST_SUITE_P(
    Cells, Orient,
    testing::Values(std::pair{CellType::TRIA3, CellType::SEG2}, std::pair{CellType::QUAD4, CellType::SEG2},
                    std::pair{CellType::TRIA6, CellType::SEG3}, std::pair{CellType::QUAD8, CellType::SEG3},
                    std::pair{CellType::QUAD9, CellType::SEG3}, std::pair{CellType::TETRA4, CellType::TRIA3},
                    std::pair{CellType::TETRA10, CellType::TRIA6}, std::pair{CellType::HEXA8, CellType::QUAD4},
                    std::pair{CellType::HEXA20, CellType::QUAD8}, std::pair{CellType::HEXA27, CellType::QUAD9},
                    std::pair{CellType::PENTA6, CellType::TRIA3}, std::pair{CellType::PENTA15, CellType::QUAD8},
                    std::pair{CellType::PYRAM5, CellType::TRIA3}, std::pair{CellType::PYRAM13, CellType::QUAD8}),
    [](const auto& row) {
      return std::string(catalog::cell(row.param.second).name) + "_" + std::string(catalog::cell(row.param.first).name);
    });

// In the plane, an outward normal is (t_y, -t_x) of the edge's tangent t: checked against the body's centre, with numbers.
TEST(Orient2d, normals_leave_the_body_s_centre) {
  Mesh mesh = block(CellType::TRIA6, 4, 3, 3);
  std::mt19937 random(1);
  turn(mesh, "AROUND", [&](std::int32_t) { return random() % 2 == 0; });
  orient_skin(mesh, "AROUND", {}, "K");
  for (const std::int32_t c : mesh.find_cell_group("AROUND")->members) {
    const auto nodes = mesh.cells[static_cast<std::size_t>(c)];
    const auto a = mesh.point(static_cast<std::size_t>(nodes[0])), b = mesh.point(static_cast<std::size_t>(nodes[1]));
    const double outward = (b[1] - a[1]) * ((a[0] + b[0]) / 2 - 2) - (b[0] - a[0]) * ((a[1] + b[1]) / 2 - 1.5);
    EXPECT_GT(outward, 0) << cell_name(c);
  }
}

// INVENTORY 14.6: a skin cell without body stays as it is.
TEST(Orient2d, a_lone_skin_cell_is_left) {
  Mesh mesh = block(CellType::TRIA3, 2, 1, 1);
  const auto lone = static_cast<std::int32_t>(mesh.n_cells());
  add(mesh, CellType::SEG2, {5, 0});
  mesh.cell_groups.push_back({"LONE", {lone, 0}});
  const OrientationReport report = orient_skin(mesh, "LONE", {}, "K");
  EXPECT_EQ(report.without_body, (Nodes{lone}));
  EXPECT_EQ(report.turned, 0);
  EXPECT_EQ(mesh.cells[static_cast<std::size_t>(lone)][0], 5);
}

// Between two bodies the outside is unknown until GROUP_MA_INTERNE names the body; nothing changes before the error.
TEST(Orient2d, between_two_bodies_it_needs_the_inside) {
  Mesh mesh = block(CellType::QUAD4, 2, 1, 1);
  const Nodes body = mesh.find_cell_group("BODY")->members;
  turn(mesh, "BOTTOM", [](std::int32_t) { return true; });
  Group inside{"INSIDE", mesh.find_cell_group("BOTTOM")->members};
  inside.members.push_back(static_cast<std::int32_t>(mesh.n_cells()));
  add(mesh, CellType::SEG2, {1, 4});
  mesh.cell_groups.push_back(inside);
  const std::vector<std::int32_t> before = mesh.cells.values;
  const Message error = error_of([&] { orient_skin(mesh, "INSIDE", {}, "K"); });
  EXPECT_EQ(error.id, "ORIE_2");
  EXPECT_THAT(error.text, HasSubstr(cell_name(static_cast<std::int64_t>(mesh.n_cells()) - 1)));
  EXPECT_EQ(mesh.cells.values, before);

  mesh.cell_groups.push_back({"EDGE", {static_cast<std::int32_t>(mesh.n_cells()) - 1}});
  const auto of_left = orient_skin(mesh, "EDGE", {body.data(), 1}, "K").turned;
  EXPECT_EQ(orient_skin(mesh, "EDGE", {body.data(), 1}, "K").turned, 0);
  EXPECT_EQ(of_left, 0);  // node 1 to node 4: from bottom to top, and the left body lies to its left
  EXPECT_EQ(orient_skin(mesh, "EDGE", {body.data() + 1, 1}, "K").turned, 1);
}

TEST(OrientErrors, a_body_cell_is_no_skin) {
  Mesh mesh = block(CellType::QUAD4, 2, 1, 1);
  EXPECT_EQ(error_of([&] { orient_skin(mesh, "BODY", {}, "K"); }).id, "ORIE_1");
  EXPECT_EQ(error_of([&] { orient_skin(mesh, "SOUTH", {}, "K"); }).id, "MESH_1");
}

// Every group of every occurrence is oriented, on a mesh that is cut for contact too.
TEST(ModiMaillage, orients_every_group_of_every_occurrence) {
  Mesh mesh = block(CellType::QUAD4, 2, 2, 1);
  turn(mesh, "AROUND", [](std::int32_t) { return true; });
  const Keywords keywords(
      nlohmann::json::parse(R"({"ORIE_PEAU": [{"GROUP_MA_PEAU": ["TOP", "LEFT"]}, {"GROUP_MA_PEAU": ["BOTTOM"]}]})"), "");
  modi_maillage(mesh, keywords);
  EXPECT_EQ(orient_skin(mesh, "TOP", {}, "K").turned + orient_skin(mesh, "LEFT", {}, "K").turned +
                orient_skin(mesh, "BOTTOM", {}, "K").turned,
            0);
  EXPECT_EQ(orient_skin(mesh, "RIGHT", {}, "K").turned, 2);
  Mesh made = cut(mesh, {"TOP"});
  turn(made, "BOTTOM", [](std::int32_t) { return true; });
  modi_maillage(made, keywords);
  EXPECT_EQ(orient_skin(made, "BOTTOM", {}, "K").turned, 0);
  expect_sound_patches(made);
}

// A part of a patch does not turn alone: what it is a part of is said, and nothing has changed.
TEST(ModiMaillage, a_patch_turns_as_a_whole) {
  Mesh made = cut(block(CellType::QUAD4, 2, 2, 1), {"TOP"});
  turn(made, "TOP", [&](std::int32_t cell) { return cell == made.patches->cells[1][0]; });
  const std::vector<std::int32_t> before = made.cells.values;
  const Message error = error_of([&] { orient_skin(made, "TOP", {}, "K"); });
  EXPECT_EQ(error.id, "ORIE_5");
  EXPECT_THAT(error.text, HasSubstr("'TOP'"));
  EXPECT_EQ(made.cells.values, before);
}

}  // namespace
