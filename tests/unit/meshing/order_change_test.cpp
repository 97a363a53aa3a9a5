// LINE_QUAD, QUAD_LINE and HEXA20_27.
#include <nlohmann/json.hpp>
#include <numeric>

#include "lacon/elements/reference.hpp"
#include "lacon/operators/crea_maillage/crea_maillage.hpp"
#include "meshes.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;

Nodes all_cells(const Mesh& mesh) {
  Nodes all(mesh.n_cells());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

class LineQuad : public testing::TestWithParam<CellType> {};

// Every mid node is half-way on its edge; back to linear, the mesh is what it was.
TEST_P(LineQuad, and_back_is_the_identity) {
  const CellType type = GetParam();
  const catalog::CellRow& row = catalog::cell(type);
  Mesh mesh = row.dimension == 2 ? block(type, 3, 2, 4) : one_cell(type, row.facets[0].type, 4);
  const Mesh before = mesh;
  EXPECT_EQ(make_quadratic(mesh, all_cells(mesh)), static_cast<std::int64_t>(mesh.n_cells()));
  std::map<Nodes, std::int32_t> middle;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    EXPECT_EQ(mesh.types[c], catalog::cell(before.types[c]).quadratic);
    const catalog::CellRow& own = mesh.row(c);
    for (std::size_t e = 0; e < own.edges.size(); ++e) {
      const auto a = static_cast<std::size_t>(mesh.cells[c][static_cast<std::size_t>(own.edges[e].first)]);
      const auto b = static_cast<std::size_t>(mesh.cells[c][static_cast<std::size_t>(own.edges[e].second)]);
      const std::int32_t m = mesh.cells[c][static_cast<std::size_t>(own.n_vertices) + e];
      const Nodes key = sorted(Nodes{static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
      EXPECT_EQ(middle.emplace(key, m).first->second, m) << "an edge with two mid nodes";
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(mesh.point(static_cast<std::size_t>(m))[k], (mesh.point(a)[k] + mesh.point(b)[k]) / 2);
    }
  }
  EXPECT_EQ(mesh.n_nodes(), before.n_nodes() + middle.size());
  EXPECT_EQ(make_linear(mesh, all_cells(mesh)), static_cast<std::int64_t>(mesh.n_cells()));
  EXPECT_EQ(mesh.coordinates, before.coordinates);
  EXPECT_EQ(mesh.cells.values, before.cells.values);
  EXPECT_EQ(mesh.types, before.types);
}

INSTANTIATE_TEST_SUITE_P(Cells, LineQuad,
                         testing::Values(CellType::TRIA3, CellType::QUAD4, CellType::TETRA4, CellType::PENTA6, CellType::PYRAM5,
                                         CellType::HEXA8),
                         [](const auto& row) { return std::string(catalog::cell(row.param).name); });

// zzzz383a: one QUAD4 with its four edges becomes 8 nodes and 5 cells; cutting its SEG3 adds nothing.
TEST(LineQuadCut, of_a_square_has_the_counts_of_the_peer) {
  Mesh mesh = block(CellType::QUAD4, 1, 1, 1);
  make_quadratic(mesh, all_cells(mesh));
  const Mesh made = cut(mesh, {"BOTTOM"});
  EXPECT_EQ(made.n_nodes(), 8u);
  EXPECT_EQ(made.n_cells(), 5u);
  EXPECT_EQ(made.patches->kind[0], 14);
}

// A quadratic neighbour gives its (curved) mid node to a cell that becomes quadratic.
TEST(LineQuadGroup, uses_the_mid_nodes_that_are_there) {
  Mesh mesh = block(CellType::TRIA6, 2, 1, 3);
  const Nodes bottom = mesh.find_cell_group("BOTTOM")->members;
  const Mesh before = mesh;
  make_linear(mesh, bottom);
  EXPECT_EQ(mesh.n_nodes(), before.n_nodes());  // the body still uses their mid nodes
  EXPECT_EQ(mesh.types[0], CellType::SEG2);
  make_quadratic(mesh, bottom);
  EXPECT_EQ(mesh.cells.values, before.cells.values);
  EXPECT_EQ(mesh.coordinates, before.coordinates);
}

// INVENTORY 5.2: QUAD_LINE by groups leaves the other body quadratic; what nobody uses goes, and the other nodes keep their
// order.
TEST(QuadLineGroup, removes_the_mid_nodes_that_nobody_uses) {
  Mesh mesh = block(CellType::TRIA6, 1, 1, 3);  // 4 vertices, 5 mid nodes
  const std::int32_t first = add_node(mesh, 5, 0);
  add_node(mesh, 6, 0);
  add_node(mesh, 5.5, 0.1);
  add(mesh, CellType::SEG3, {first, first + 1, first + 2});
  const std::int32_t mid = mesh.cells[0][2];
  mesh.node_groups = {{"MIDS", {mid}}, {"MIX", {0, mid, first + 2}}};
  Nodes block_cells = all_cells(mesh);
  block_cells.pop_back();
  const Listener listener;
  EXPECT_EQ(make_linear(mesh, block_cells), 6);
  EXPECT_EQ(mesh.n_nodes(), 7u);
  EXPECT_EQ(mesh.types.back(), CellType::SEG3);
  EXPECT_EQ(Nodes(mesh.cells[6].begin(), mesh.cells[6].end()), (Nodes{4, 5, 6}));
  EXPECT_EQ(mesh.point(6)[0], 5.5);
  ASSERT_EQ(mesh.node_groups.size(), 1u);
  EXPECT_EQ(mesh.node_groups[0].members, (Nodes{0, 6}));
  EXPECT_EQ(Listener::ids(), (std::vector<std::string>{"ORDRE_2", "ORDRE_1"}));
}

TEST(LineQuadErrors, a_mesh_that_is_cut_is_refused) {
  const Mesh made = cut(block(CellType::TRIA3, 2, 1, 1), {"TOP"});
  for (const std::string name : {"LINE_QUAD", "QUAD_LINE"}) {
    const Keywords keywords(nlohmann::json{{name, {{{"TOUT", "OUI"}}}}}, "");
    EXPECT_EQ(error_of([&] { crea_maillage(made, keywords); }).id, "MESH1_12");
  }
}

/// Two hexahedra side by side, bent, with the face between them and one on the left as QUAD4; quadratic.
Mesh bent_pair() {
  Mesh mesh;
  mesh.dimension = 3;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        for (const double value : {x + 0.2 * y * z, y + 0.1 * x * x, z + 0.1 * x * y}) mesh.coordinates.push_back(value);
  const auto node = [](int x, int y, int z) { return x + 3 * (y + 2 * z); };
  for (int x = 0; x < 2; ++x)
    mesh.add_cell(CellType::HEXA8, Nodes{node(x, 0, 0), node(x + 1, 0, 0), node(x + 1, 1, 0), node(x, 1, 0), node(x, 0, 1),
                                         node(x + 1, 0, 1), node(x + 1, 1, 1), node(x, 1, 1)});
  for (int x = 0; x < 2; ++x) mesh.add_cell(CellType::QUAD4, Nodes{node(x, 0, 0), node(x, 0, 1), node(x, 1, 1), node(x, 1, 0)});
  make_quadratic(mesh, all_cells(mesh));
  // a curved edge: the nodes in the middle of faces follow it
  mesh.coordinates[3 * static_cast<std::size_t>(mesh.cells[2][4])] -= 0.2;
  return mesh;
}

// HEXA20_27: 20 and 20 nodes with 8 in common become 27 and 27 with 9 in common; skins share the node of their face, and each
// new node lies where its cell's own geometry has it.
TEST(Hexa20To27, gives_each_face_one_node_on_the_cells_own_geometry) {
  Mesh mesh = bent_pair();
  const Mesh before = mesh;
  EXPECT_EQ(mesh.n_nodes(), 32u);
  EXPECT_EQ(make_complete(mesh, all_cells(mesh)), 4);
  EXPECT_EQ(mesh.n_nodes(), 45u);
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_EQ(mesh.types[c], c < 2 ? CellType::HEXA27 : CellType::QUAD9);
    const catalog::CellRow &row = mesh.row(c), &old = before.row(c);
    std::vector<double> shape(old.n_nodes);
    for (int local = 0; local < row.n_nodes; ++local) {
      shape_functions(old.type, row.nodes.subspan(local * row.dimension, row.dimension), shape);
      for (std::size_t k = 0; k < 3; ++k) {
        double x = 0;
        for (int n = 0; n < old.n_nodes; ++n) x += shape[n] * before.point(before.cells[c][n])[k];
        EXPECT_NEAR(mesh.point(mesh.cells[c][local])[k], x, 1e-14);
      }
    }
  }
  const auto has = [&](std::size_t c, std::int32_t node) {
    return std::count(mesh.cells[c].begin(), mesh.cells[c].end(), node) == 1;
  };
  EXPECT_TRUE(has(0, mesh.cells[2][8]));
  EXPECT_TRUE(has(0, mesh.cells[3][8]));
  EXPECT_TRUE(has(1, mesh.cells[3][8]));
  EXPECT_FALSE(has(1, mesh.cells[2][8]));
}

// By groups: a neighbour that is complete already gives the node of the common face; the others stay as they are.
TEST(Hexa20To27, by_groups_uses_the_nodes_that_are_there) {
  Mesh mesh = bent_pair();
  EXPECT_EQ(make_complete(mesh, Nodes{0}), 1);
  EXPECT_EQ(mesh.n_nodes(), 39u);
  EXPECT_EQ(make_complete(mesh, Nodes{1, 3}), 2);
  EXPECT_EQ(mesh.n_nodes(), 45u);
  EXPECT_EQ(mesh.types[2], CellType::QUAD8);
}

// A part of a conforming mesh that changes leaves nodes in the middle of its neighbours' edges or faces: they are counted.
TEST(OrderChange, tells_what_hangs) {
  const auto told = [](const Mesh& mesh) {
    const Listener listener;
    tell_what_hangs(mesh);
    return Listener::heard().empty() ? std::string() : Listener::heard()[0].text;
  };
  Mesh mesh = bent_pair();
  EXPECT_EQ(told(mesh), "");
  make_complete(mesh, Nodes{0, 2});
  EXPECT_THAT(told(mesh), testing::HasSubstr("1 edges or faces"));  // the face between the two, which the QUAD8 M4 has too
  EXPECT_THAT(told(mesh), testing::HasSubstr("between HEXA27 M1 and HEXA20 M2"));
  make_complete(mesh, Nodes{1, 3});
  EXPECT_EQ(told(mesh), "");
  make_linear(mesh, Nodes{1, 3});
  EXPECT_THAT(told(mesh), testing::HasSubstr("5 edges or faces"));  // and the four edges around it
  make_linear(mesh, all_cells(mesh));
  EXPECT_EQ(told(mesh), "");
}

}  // namespace
