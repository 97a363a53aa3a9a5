// The scaled Jacobian: 1 for ideal cells, closed forms for others, and what a cut does to it.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "lacon/operators/crea_maillage/crea_maillage.hpp"
#include "meshes.hpp"

namespace lacon::test {
namespace {

double quality(CellType type, const std::vector<double>& coordinates) {
  Nodes nodes(coordinates.size() / 3);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = static_cast<std::int32_t>(i);
  return scaled_jacobian(type, nodes, coordinates);
}

const double h = std::sqrt(0.75);

TEST(Quality, of_cells_of_equal_edges_is_one) {
  EXPECT_NEAR(quality(CellType::TRIA3, {0, 0, 0, 1, 0, 0, 0.5, h, 0}), 1, 1e-15);
  EXPECT_NEAR(quality(CellType::QUAD4, {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0}), 1, 1e-15);
  EXPECT_NEAR(quality(CellType::TETRA4, {0, 0, 0, 1, 0, 0, 0.5, h, 0, 0.5, h / 3, std::sqrt(2.0 / 3)}), 1, 1e-15);
  EXPECT_NEAR(quality(CellType::PYRAM5, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, std::sqrt(0.5)}), 1, 1e-15);
  EXPECT_NEAR(quality(CellType::PENTA6, {0, 0, 0, 1, 0, 0, 0.5, h, 0, 0, 0, 1, 1, 0, 1, 0.5, h, 1}), 1, 1e-15);
  EXPECT_NEAR(quality(CellType::HEXA8, {0, 0, 0, 3, 0, 0, 3, 3, 0, 0, 3, 0, 0, 0, 3, 3, 0, 3, 3, 3, 3, 0, 3, 3}), 1, 1e-15);
}

// Without its apex, a needle would be better than the ideal pyramid: its base has right angles on all sides.
TEST(Quality, of_a_pyramid_sees_its_apex) {
  const auto of_height = [](double z) { return quality(CellType::PYRAM5, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, z}); };
  for (const double z : {0.1, 0.5, 1.0, 3.0, 30.0}) {
    const double edge = std::hypot(z, std::sqrt(0.5));  // any three edges at the apex span the volume z / 6
    EXPECT_NEAR(of_height(z), std::sqrt(2.0) * std::min(z / edge, z / (edge * edge * edge)), 1e-14);
  }
}

TEST(Quality, of_straight_cells_is_one_at_most) {
  std::mt19937 random(7);
  std::normal_distribution<double> shift(0, 0.2);
  for (const catalog::CellRow& row : catalog::cells()) {
    if (row.dimension < 2 || row.order == 2) continue;
    for (int sample = 0; sample < 2000; ++sample) {
      std::vector<double> coordinates;
      for (int n = 0; n < row.n_nodes; ++n)
        for (int k = 0; k < 3; ++k)
          coordinates.push_back(
              k < row.dimension ? row.nodes[n * row.dimension + k] * (k == 2 ? 0.5 + sample % 4 : 1) + shift(random) : 0);
      EXPECT_LE(quality(row.type, coordinates), 1 + 1e-14) << row.name;
    }
  }
}

TEST(Quality, does_not_depend_on_size_and_changes_its_sign_with_the_cell) {
  const double sheared = quality(CellType::QUAD4, {0, 0, 0, 1, 0, 0, 2, 1, 0, 1, 1, 0});
  EXPECT_NEAR(sheared, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(quality(CellType::QUAD4, {0, 0, 0, 1e-3, 0, 0, 2e-3, 1e-3, 0, 1e-3, 1e-3, 0}), sheared, 1e-15);
  EXPECT_NEAR(quality(CellType::QUAD4, {1, 1, 0, 2, 1, 0, 1, 0, 0, 0, 0, 0}), -sheared, 1e-15);
  EXPECT_EQ(quality(CellType::TRIA3, {0, 0, 0, 1, 0, 0, 2, 0, 0}), 0);
  EXPECT_EQ(quality(CellType::TRIA3, {0, 0, 0, 0, 0, 0, 1, 1, 0}), 0);  // an edge of no length
}

TEST(Quality, of_quadratic_cells_sees_the_bent_edge) {
  // the lower edge of the unit square bulges by b: its tangents at the ends are (1, 4b), (1, -4b)
  const double b = 0.1;
  const std::vector<double> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, b, 0, 1, 0.5, 0, 0.5, 1, 0, 0, 0.5, 0};
  EXPECT_NEAR(quality(CellType::QUAD8, square), 1 / std::hypot(1, 4 * b), 1e-15);
  std::vector<double> straight = square;
  straight[13] = 0;
  EXPECT_NEAR(quality(CellType::QUAD8, straight), 1, 1e-15);
}

TEST(Quality, of_every_cell_has_the_sign_of_its_volume) {
  for (const catalog::CellRow& row : catalog::cells()) {
    if (row.dimension < 2) continue;
    std::vector<double> coordinates;
    for (int n = 0; n < row.n_nodes; ++n)
      for (int k = 0; k < 3; ++k) coordinates.push_back(k < row.dimension ? row.nodes[n * row.dimension + k] : 0);
    EXPECT_GT(quality(row.type, coordinates), 0.5) << row.name;
    Nodes nodes(static_cast<std::size_t>(row.n_nodes));
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = static_cast<std::int32_t>(i);
    EXPECT_LT(scaled_jacobian(row.type, mirrored(row.type, nodes), coordinates), 0) << row.name;
  }
}

// Cells of every type, their nodes moved at random: gradients of shape functions, one after the other.
TEST(JacobianRange, is_that_of_the_determinants_in_the_middle_and_at_the_nodes) {
  std::mt19937 random(3);
  std::normal_distribution<double> shift(0, 0.3);
  for (const catalog::CellRow& row : catalog::cells()) {
    if (row.dimension < 2) continue;
    const auto d = static_cast<std::size_t>(row.dimension), n = static_cast<std::size_t>(row.n_nodes);
    Nodes nodes(n);
    std::iota(nodes.begin(), nodes.end(), 2);  // behind two that no cell has
    std::vector<double> coordinates(6, 77.0);
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t k = 0; k < 3; ++k) coordinates.push_back(k < d ? row.nodes[a * d + k] + shift(random) : 0);
    const auto determinant = [&](std::span<const double> xi) {
      std::vector<double> gradients(n * d);
      shape_gradients(row.type, xi, gradients);
      double j[3][3] = {};
      if (d == 2) j[2][2] = 1;
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t i = 0; i < d; ++i)
          for (std::size_t k = 0; k < d; ++k) j[i][k] += gradients[a * d + i] * coordinates[3 * (a + 2) + k];
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += j[0][k] * (j[1][(k + 1) % 3] * j[2][(k + 2) % 3] - j[1][(k + 2) % 3] * j[2][(k + 1) % 3]);
      return sum;
    };
    std::vector<double> middle(d, 0.0);
    for (std::size_t v = 0; v < static_cast<std::size_t>(row.n_vertices); ++v)
      for (std::size_t k = 0; k < d; ++k) middle[k] += row.nodes[v * d + k] / row.n_vertices;
    const double centre = determinant(middle);
    EXPECT_NEAR(central_jacobian(row.type, nodes, coordinates), centre, 1e-12) << row.name;
    if (row.family == Family::PYRAM) continue;  // at its apex there is none
    double least = centre, greatest = centre;
    for (std::size_t a = 0; a < n; ++a) {
      const double here = determinant(row.nodes.subspan(a * d, d));
      least = std::min(least, here);
      greatest = std::max(greatest, here);
    }
    const JacobianRange range = jacobian_range(row.type, nodes, coordinates);
    EXPECT_NEAR(range.least, least, 1e-12) << row.name;
    EXPECT_NEAR(range.greatest, greatest, 1e-12) << row.name;
  }
}

TEST(InvertedCells, are_those_whose_jacobian_is_negative_in_their_middle) {
  std::mt19937 random(4);
  std::normal_distribution<double> shift(0, 0.1);
  for (const int dimension : {2, 3}) {
    Mesh mesh;
    mesh.dimension = dimension;
    Nodes expected;
    for (const catalog::CellRow& row : catalog::cells())
      for (int k = 0; k < 10; ++k) {
        if (row.dimension < 2 || row.dimension > dimension) continue;
        Nodes nodes;
        for (int a = 0; a < row.n_nodes; ++a) {
          std::array<double, 3> x{};
          for (int i = 0; i < row.dimension; ++i) x[i] = row.nodes[a * row.dimension + i] + shift(random);
          nodes.push_back(add_node(mesh, x[0], x[1], x[2]));
        }
        if (random() % 2 == 0) std::ranges::copy(mirrored(row.type, nodes), nodes.begin());
        if (row.dimension == dimension && central_jacobian(row.type, nodes, mesh.coordinates) < 0)
          expected.push_back(static_cast<std::int32_t>(mesh.n_cells()));
        add(mesh, row.type, nodes);
      }
    EXPECT_GT(expected.size(), mesh.n_cells() / 8);
    EXPECT_EQ(inverted_cells(mesh), expected);
  }
}

TEST(Quality, of_a_cube_cut_into_hexahedra_is_that_of_the_method) {
  // METHOD.md 1.5: laterals 2 / sqrt(17), bottom 3 / sqrt(17), centre 1
  Mesh cube;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(1.0, 0.0), std::pair(1.0, 1.0), std::pair(0.0, 1.0)})
      add_node(cube, x, y, z);
  add(cube, CellType::QUAD4, {4, 5, 6, 7});
  add(cube, CellType::HEXA8, {0, 1, 2, 3, 4, 5, 6, 7});
  cube.cell_groups = {{"TOP", {0}}};
  CutReport report;
  const Mesh after = cut(cube, {"TOP"}, "HEXA", &report);
  EXPECT_EQ(report.zones[0].bodies, Nodes{1});
  EXPECT_EQ(report.before.n_cells, 1u);
  EXPECT_NEAR(report.before.mean, 1, 1e-14);
  const Quality& all = report.after;
  EXPECT_EQ(all.n_cells, 6u);
  EXPECT_NEAR(all.least(), 2 / std::sqrt(17.0), 1e-14);
  EXPECT_NEAR(all.quantiles[3], 2 / std::sqrt(17.0), 1e-14);
  EXPECT_NEAR(all.quantiles.back(), 1, 1e-14);
  EXPECT_NEAR(all.mean, (4 * 2 / std::sqrt(17.0) + 3 / std::sqrt(17.0) + 1) / 6, 1e-14);
  ASSERT_EQ(all.worst.size(), 5u);
  EXPECT_EQ(after.types[static_cast<std::size_t>(all.worst[0].second)], CellType::HEXA8);
}

TEST(NodeGroups, get_the_new_nodes_of_a_skin_they_hold) {
  // two squares side by side, both under the skin
  Mesh mesh;
  mesh.dimension = 2;
  for (const double y : {0.0, 1.0})
    for (const double x : {0.0, 1.0, 2.0}) add_node(mesh, x, y);
  add(mesh, CellType::SEG2, {4, 3});
  add(mesh, CellType::SEG2, {5, 4});
  add(mesh, CellType::QUAD4, {0, 1, 4, 3});
  add(mesh, CellType::QUAD4, {1, 2, 5, 4});
  mesh.cell_groups = {{"TOP", {0, 1}}};
  mesh.node_groups = {{"SKIN", {3, 4, 5}}, {"HALF", {3, 4}}, {"MORE", {5, 4, 3, 0}}, {"ALL", {0, 1, 2, 3, 4, 5}}};
  CutReport report;
  Mesh after = cut(mesh, {"TOP"}, "PYRA", &report);
  complete_node_groups(report, after);
  // each face: its two nodes on the skin, then the two inside
  EXPECT_EQ(after.node_groups[0].members, (Nodes{3, 4, 5, 6, 7, 10, 11}));
  EXPECT_EQ(after.node_groups[1].members, (Nodes{3, 4}));
  EXPECT_EQ(after.node_groups[2].members, (Nodes{5, 4, 3, 0, 6, 7, 10, 11}));
  EXPECT_EQ(after.node_groups[3].members, (Nodes{0, 1, 2, 3, 4, 5, 6, 7, 10, 11, 8, 9, 12, 13}));
}

// What the cut says of shapes: quantiles and the worst cells with INFO=2 alone, a badly shaped cell whatever INFO is.
TEST(Quality, of_a_cut_is_told_with_details_where_they_are_asked_for_and_with_an_alarm_where_it_is_poor) {
  for (const double height : {2.0, 0.1})
    for (const int info : {1, 2}) {
      Mesh mesh = one_cell(CellType::HEXA8, CellType::QUAD4, 0);
      for (std::size_t i = 2; i < mesh.coordinates.size(); i += 3) mesh.coordinates[i] *= height / 2;
      mesh.cell_groups[0].members.resize(1);
      const Keywords keywords(
          nlohmann::json{{"INFO", info}, {"DECOUPE_LAC", {{{"GROUP_MA_ESCL", {"SKIN"}}, {"DECOUPE_HEXA", "PYRA"}}}}}, "");
      const Listener listener;
      testing::internal::CaptureStdout();
      const Mesh made = crea_maillage(mesh, keywords);
      std::fflush(stdout);
      const std::string said = testing::internal::GetCapturedStdout();
      double least = INFINITY;
      for (const std::int32_t c : bodies_of(made)) {
        const auto cell = static_cast<std::size_t>(c);
        least = std::min(least, scaled_jacobian(made.types[cell], made.cells[cell], made.coordinates));
      }
      EXPECT_EQ(said.find("the worst after the cut") != std::string::npos, info == 2) << said;
      EXPECT_EQ(least < 0.1, height < 1) << least;
      const std::vector<std::string> ids = Listener::ids();
      EXPECT_EQ(std::ranges::count(ids, "DECOUPE_9"), least < 0.1 ? 1 : 0) << least;
    }
}

}  // namespace
}  // namespace lacon::test
