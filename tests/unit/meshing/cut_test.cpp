// DECOUPE_LAC: METHOD.md 1.2 to 1.9.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "lacon/catalog/contact.hpp"
#include "lacon/catalog/cuts.hpp"
#include "lacon/operators/modi_maillage/modi_maillage.hpp"
#include "meshes.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;
using testing::HasSubstr;

/// METHOD.md 1.6: new nodes, new skin cells and new body cells of one slave face.
struct Count {
  CellType skin, body;
  std::string option;
  std::size_t nodes, skin_cells, body_cells;
};
const std::vector<Count> counts{
    {CellType::SEG2, CellType::TRIA3, "PYRA", 1, 1, 1},    {CellType::SEG2, CellType::QUAD4, "PYRA", 4, 2, 3},
    {CellType::SEG3, CellType::TRIA6, "PYRA", 0, 0, 0},    {CellType::SEG3, CellType::QUAD8, "PYRA", 0, 0, 0},
    {CellType::SEG3, CellType::QUAD9, "PYRA", 0, 0, 0},    {CellType::TRIA3, CellType::TETRA4, "PYRA", 1, 2, 2},
    {CellType::TRIA6, CellType::TETRA10, "PYRA", 5, 2, 2}, {CellType::QUAD4, CellType::HEXA8, "HEXA", 8, 4, 5},
    {CellType::QUAD8, CellType::HEXA20, "HEXA", 28, 4, 5}, {CellType::QUAD4, CellType::HEXA8, "PYRA", 1, 3, 4},
    {CellType::QUAD8, CellType::HEXA20, "PYRA", 9, 3, 4},  {CellType::QUAD9, CellType::HEXA27, "PYRA", 0, 0, 0},
    {CellType::TRIA3, CellType::PENTA6, "PYRA", 1, 2, 3},  {CellType::QUAD4, CellType::PENTA6, "HEXA", 1, 3, 3},
    {CellType::TRIA6, CellType::PENTA15, "HEXA", 7, 2, 3}, {CellType::QUAD8, CellType::PENTA15, "PYRA", 7, 3, 3},
    {CellType::TRIA3, CellType::PYRAM5, "PYRA", 1, 2, 3},  {CellType::QUAD4, CellType::PYRAM5, "PYRA", 1, 3, 3},
    {CellType::TRIA6, CellType::PYRAM13, "PYRA", 6, 2, 3}, {CellType::QUAD8, CellType::PYRAM13, "PYRA", 6, 3, 3},
};

std::string name_of(const Count& c) {
  return std::string(catalog::cell(c.skin).name) + "_" + std::string(catalog::cell(c.body).name) + "_" + c.option;
}

class Cut : public testing::TestWithParam<Count> {};

// Every facet of the body as the only slave face: the counts of METHOD.md 1.6, a conforming mesh, the same volume.
TEST_P(Cut, of_one_face_has_the_counts_of_the_method) {
  const Count& c = GetParam();
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Mesh all = one_cell(c.body, c.skin, seed);
    for (const std::int32_t slave : all.find_cell_group("SKIN")->members) {
      Mesh mesh = all;
      mesh.cell_groups[0].members = {slave};
      mesh.cell_groups.push_back({"BODY", {0}});
      const Mesh made = cut(mesh, {"SKIN"}, c.option);
      EXPECT_EQ(made.n_nodes(), mesh.n_nodes() + c.nodes);
      EXPECT_EQ(made.n_cells(), mesh.n_cells() + c.skin_cells + c.body_cells);
      EXPECT_EQ(made.find_cell_group("SKIN")->members.size(), 1 + c.skin_cells);
      EXPECT_EQ(made.find_cell_group("BODY")->members.size(), 1 + c.body_cells);
      EXPECT_NEAR(total_measure(made), total_measure(mesh), 1e-13 * total_measure(mesh));
      expect_sound_cut(mesh, made, {"SKIN"});
      if (HasFailure()) FAIL() << name_of(c) << ", slave cell " << cell_name(slave) << ", seed " << seed;
    }
  }
}

// All facets of one type as slave faces: the later ones belong to sub-cells of the earlier cuts.
TEST_P(Cut, of_all_faces_of_a_cell_stays_conforming) {
  const Count& c = GetParam();
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Mesh mesh = one_cell(c.body, c.skin, seed);
    const Mesh made = cut(mesh, {"SKIN"}, c.option);
    EXPECT_NEAR(total_measure(made), total_measure(mesh), 1e-13 * total_measure(mesh));
    expect_sound_cut(mesh, made, {"SKIN"});
    if (HasFailure()) FAIL() << name_of(c) << ", seed " << seed;
  }
}

// An inward slave cell is turned first; what comes out is what the outward one gives, but for the skin's own numbering.
TEST_P(Cut, turns_an_inward_slave_cell) {
  const Count& c = GetParam();
  Mesh mesh = one_cell(c.body, c.skin, 3);
  const auto slave = static_cast<std::size_t>(mesh.cell_groups[0].members[0]);
  mesh.cell_groups[0].members = {static_cast<std::int32_t>(slave)};
  std::ranges::copy(mirrored(c.skin, mesh.cells[slave]), mesh.cells[slave].begin());
  CutReport report;
  const Mesh made = cut(mesh, {"SKIN"}, c.option, &report);
  EXPECT_EQ(report.zones[0].turned, 1);
  EXPECT_NEAR(total_measure(made), total_measure(mesh), 1e-13 * total_measure(mesh));
  expect_sound_cut(mesh, made, {"SKIN"});
}

// A mirror turns every sub-cell inside out, and the patches stay those of the catalogue; so they do where the sub-cells alone
// are turned, and ORIE_PEAU brings them back.
TEST_P(Cut, of_a_skin_that_is_turned_keeps_its_patches) {
  const Count& c = GetParam();
  for (unsigned seed = 0; seed < 4; ++seed) {
    Mesh made = cut(one_cell(c.body, c.skin, seed), {"SKIN"}, c.option);
    const std::vector<std::int32_t> members = made.patches->cells.values;
    modi_maillage(
        made,
        Keywords(nlohmann::json::parse(made.dimension == 3
                                           ? R"({"SYMETRIE": [{"POINT": [1, 0, 0], "AXE_1": [0, 1, 0], "AXE_2": [0, 0, 1]}]})"
                                           : R"({"SYMETRIE": [{"POINT": [1, 0], "AXE_1": [0, 1]}]})"),
                 ""));
    expect_sound_patches(made);
    for (const std::int32_t cell : members) {
      const auto at = static_cast<std::size_t>(cell);
      std::ranges::copy(mirrored(made.types[at], made.cells[at]), made.cells[at].begin());
    }
    modi_maillage(made, Keywords(nlohmann::json::parse(R"({"ORIE_PEAU": [{"GROUP_MA_PEAU": ["SKIN"]}]})"), ""));
    expect_sound_patches(made);
    EXPECT_EQ(sorted(made.patches->cells.values), sorted(members));
    if (HasFailure()) FAIL() << name_of(c) << ", seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Rows, Cut, testing::ValuesIn(counts), [](const auto& row) { return name_of(row.param); });

// The table above holds every row of the catalogue, so that no cut is untested.
TEST(Cuts, all_rows_are_in_the_table_of_counts) {
  for (const catalog::CutRow& row : catalog::cuts())
    EXPECT_TRUE(std::any_of(counts.begin(), counts.end(),
                            [&](const Count& c) { return catalog::find_cut(c.skin, c.body, c.option) == &row; }))
        << catalog::cell(row.skin).name << " on " << catalog::cell(row.body).name;
}

// METHOD.md 1.4, 1.5: the sub-cells of a TRIA3 and a QUAD4, node by node, in their order.
TEST(Cut2d, sub_cells_come_in_the_order_of_the_method) {
  Mesh tria;
  tria.dimension = 2;
  for (const auto& [x, y] : {std::pair{0., 0.}, {2., 0.}, {0., 2.}}) add_node(tria, x, y);
  add(tria, CellType::SEG2, {1, 2});
  add(tria, CellType::TRIA3, {0, 1, 2});
  tria.cell_groups = {{"S", {0}}};
  const Mesh t = cut(tria, {"S"});
  ASSERT_EQ(t.n_cells(), 4u);
  EXPECT_EQ(Nodes(t.cells[0].begin(), t.cells[0].end()), (Nodes{1, 3}));
  EXPECT_EQ(Nodes(t.cells[1].begin(), t.cells[1].end()), (Nodes{3, 2}));
  EXPECT_EQ(Nodes(t.cells[2].begin(), t.cells[2].end()), (Nodes{1, 3, 0}));
  EXPECT_EQ(Nodes(t.cells[3].begin(), t.cells[3].end()), (Nodes{3, 2, 0}));
  EXPECT_THAT(t.point(3), testing::ElementsAre(1, 1, 0));
  EXPECT_EQ(t.patches->kind[0], 7);

  Mesh quad;
  quad.dimension = 2;
  for (const auto& [x, y] : {std::pair{0., 0.}, {3., 0.}, {3., 2.}, {0., 2.}}) add_node(quad, x, y);
  add(quad, CellType::QUAD4, {0, 1, 2, 3});
  add(quad, CellType::SEG2, {2, 3});
  quad.cell_groups = {{"S", {1}}};
  const Mesh q = cut(quad, {"S"});
  ASSERT_EQ(q.n_cells(), 7u);
  const std::vector<Nodes> cells{{2, 4, 6, 1}, {4, 5, 7, 6}, {5, 3, 0, 7}, {0, 1, 6, 7}, {2, 4}, {4, 5}, {5, 3}};
  for (std::size_t c = 0; c < 7; ++c) EXPECT_EQ(Nodes(q.cells[c].begin(), q.cells[c].end()), cells[c]) << c;
  const double points[4][2] = {{2, 2}, {1, 2}, {2, 1}, {1, 1}};
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_NEAR(q.point(4 + n)[0], points[n][0], 1e-15);
    EXPECT_NEAR(q.point(4 + n)[1], points[n][1], 1e-15);
  }
  EXPECT_EQ(q.patches->kind[0], 12);
  EXPECT_EQ(Nodes(q.patches->carriers[0].begin(), q.patches->carriers[0].end()), (Nodes{4, 5}));
}

class Block : public testing::TestWithParam<std::tuple<CellType, unsigned>> {};

// Random blocks whose whole boundary is slave, corner cells owning two slave edges, in one zone or four.
TEST_P(Block, cut_all_around_stays_conforming) {
  const auto [type, seed] = GetParam();
  const Mesh mesh = block(type, 3 + static_cast<int>(seed % 3), 2 + static_cast<int>(seed % 2), seed);
  for (const std::vector<std::string>& groups : {std::vector<std::string>{"AROUND"}, {"LEFT", "TOP", "RIGHT", "BOTTOM"}}) {
    const Mesh made = cut(mesh, groups);
    EXPECT_NEAR(total_measure(made), total_measure(mesh), 1e-13 * total_measure(mesh));
    expect_sound_cut(mesh, made, groups);
    const std::size_t edges = mesh.find_cell_group("AROUND")->members.size();
    const std::size_t nodes = type == CellType::TRIA3 ? 1 : type == CellType::QUAD4 ? 4 : 0;
    const std::size_t cells = type == CellType::TRIA3 ? 2 : type == CellType::QUAD4 ? 5 : 0;
    EXPECT_EQ(made.n_nodes(), mesh.n_nodes() + nodes * edges);
    EXPECT_EQ(made.n_cells(), mesh.n_cells() + cells * edges);
  }
}

INSTANTIATE_TEST_SUITE_P(Random, Block,
                         testing::Combine(testing::Values(CellType::TRIA3, CellType::QUAD4, CellType::TRIA6, CellType::QUAD8,
                                                          CellType::QUAD9),
                                          testing::Range(1u, 7u)));

// Renumbering the cells of the input renumbers the patches, and moves no node (METHOD.md 1.2: no "first found" decides
// anything).
TEST(Cuts, do_not_depend_on_the_order_of_cells) {
  const Mesh mesh = block(CellType::QUAD4, 4, 3, 5);
  Mesh shuffled = mesh;
  Nodes order(mesh.n_cells());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(7));
  Nodes place(order.size());
  shuffled.cells = {};
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
    shuffled.types[i] = mesh.types[static_cast<std::size_t>(order[i])];
    shuffled.cells.push_back(mesh.cells[static_cast<std::size_t>(order[i])]);
  }
  for (Group& group : shuffled.cell_groups)
    for (std::int32_t& c : group.members) c = place[static_cast<std::size_t>(c)];
  const Mesh a = cut(mesh, {"AROUND"}), b = cut(shuffled, {"AROUND"});
  EXPECT_EQ(a.coordinates, b.coordinates);
  std::multiset<Nodes> cells_of_a, cells_of_b;
  for (std::size_t c = 0; c < a.n_cells(); ++c) cells_of_a.insert(Nodes(a.cells[c].begin(), a.cells[c].end()));
  for (std::size_t c = 0; c < b.n_cells(); ++c) cells_of_b.insert(Nodes(b.cells[c].begin(), b.cells[c].end()));
  EXPECT_EQ(cells_of_a, cells_of_b);
}

/// The cells of a mesh by the places of their vertices, turned back by the axes (c, s; -s, c).
std::multiset<std::set<std::pair<double, double>>> shapes(const Mesh& mesh, double c = 1, double s = 0) {
  const auto rounded = [](double x) { return std::round(1e9 * x) / 1e9 + 0.0; };
  std::multiset<std::set<std::pair<double, double>>> found;
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    std::set<std::pair<double, double>> places;
    for (const std::int32_t node : mesh.cells[cell]) {
      const auto x = mesh.point(static_cast<std::size_t>(node));
      places.emplace(rounded(c * x[0] + s * x[1]), rounded(c * x[1] - s * x[0]));
    }
    found.insert(places);
  }
  return found;
}

// A cell with two slave edges is cut twice: in what order goes by geometry, not by the group's, which is that of numbers in a
// file, nor by zones, nor by axes. The last one has edges of one length, at the middle of which no distance tells one from the
// other.
TEST(Cuts, of_a_body_cell_with_several_slave_faces_do_not_depend_on_their_order) {
  for (const CellType type : {CellType::TRIA3, CellType::QUAD4})
    for (unsigned seed = 1; seed < 7; ++seed) {
      const Mesh mesh = block(type, 3, 2, seed);
      const auto expected = shapes(cut(mesh, {"AROUND"}));
      Mesh reversed = mesh, turned = mesh;
      for (Group& group : reversed.cell_groups) std::ranges::reverse(group.members);
      EXPECT_EQ(shapes(cut(reversed, {"AROUND"})), expected);
      EXPECT_EQ(shapes(cut(mesh, {"TOP", "RIGHT", "BOTTOM", "LEFT"})), expected);
      for (std::size_t n = 0; n < mesh.n_nodes(); ++n) {
        const auto x = mesh.point(n);
        turned.coordinates[3 * n] = 0.6 * x[0] - 0.8 * x[1];
        turned.coordinates[3 * n + 1] = 0.8 * x[0] + 0.6 * x[1];
      }
      EXPECT_EQ(shapes(cut(turned, {"AROUND"}), 0.6, 0.8), expected);
    }
  for (const CellType type : {CellType::TRIA3, CellType::QUAD4}) {
    Mesh square = block(type, 1, 1, 1);
    for (std::size_t n = 0; n < square.n_nodes(); ++n)
      for (std::size_t d = 0; d < 2; ++d) square.coordinates[3 * n + d] = std::round(square.coordinates[3 * n + d]);
    Mesh reversed = square;
    for (Group& group : reversed.cell_groups) std::ranges::reverse(group.members);
    EXPECT_EQ(shapes(cut(reversed, {"AROUND"})), shapes(cut(square, {"AROUND"})));
  }
}

// METHOD.md 1.2-3: new nodes are isoparametric images. On the surface z = q(x, y), q of degree 2, which TRIA6 and QUAD8
// represent exactly over a straight (x, y) plan, they lie on the surface.
TEST(Cuts, of_a_curved_quadratic_skin_stay_on_the_curve) {
  const auto surface = [](double x, double y) { return 0.1 * x * x - 0.07 * x * y + 0.05 * y * y; };
  for (const auto& [body, skin, option] : {std::tuple{CellType::TETRA10, CellType::TRIA6, "PYRA"},
                                           {CellType::HEXA20, CellType::QUAD8, "PYRA"},
                                           {CellType::HEXA20, CellType::QUAD8, "HEXA"},
                                           {CellType::PENTA15, CellType::TRIA6, "PYRA"},
                                           {CellType::PYRAM13, CellType::QUAD8, "PYRA"}}) {
    Mesh mesh = one_cell(body, skin, 0);
    // the slave facet that lies in the plane of least z is bent; everything else follows
    double low = 1e300;
    for (std::size_t n = 0; n < mesh.n_nodes(); ++n) low = std::min(low, mesh.point(n)[2]);
    std::int32_t slave = -1;
    for (const std::int32_t c : mesh.cell_groups[0].members)
      if (std::ranges::all_of(mesh.cells[static_cast<std::size_t>(c)],
                              [&](std::int32_t n) { return mesh.point(static_cast<std::size_t>(n))[2] == low; }))
        slave = c;
    ASSERT_GE(slave, 0);
    mesh.cell_groups[0].members = {slave};
    for (std::size_t n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates[3 * n + 2] += surface(mesh.point(n)[0], mesh.point(n)[1]);
    const Mesh made = cut(mesh, {"SKIN"}, option);
    expect_sound_cut(mesh, made, {"SKIN"});
    std::size_t checked = 0;
    for (const std::int32_t c : made.find_cell_group("SKIN")->members)
      for (const std::int32_t n : made.cells[static_cast<std::size_t>(c)]) {
        const auto x = made.point(static_cast<std::size_t>(n));
        EXPECT_NEAR(x[2], low + surface(x[0], x[1]), 1e-14);
        ++checked;
      }
    EXPECT_GT(checked, 6u);
  }
}

// A body cell with straight edges that is no parallelepiped is cut into cells with straight edges: the plane patch test needs
// them, on the skin (a rule over a curved edge is not exact) and in the body (nor is the stiffness). The vertices stay the
// images of their points. Edges of a file in single precision are as straight as they can be.
class StraightEdges : public testing::TestWithParam<bool> {};

TEST_P(StraightEdges, of_a_distorted_quadratic_cell_stay_straight) {
  const bool single = GetParam();
  for (const auto& [body, skin, option] : {std::tuple{CellType::HEXA20, CellType::QUAD8, "PYRA"},
                                           {CellType::HEXA20, CellType::QUAD8, "HEXA"},
                                           {CellType::PENTA15, CellType::QUAD8, "PYRA"},
                                           {CellType::PYRAM13, CellType::QUAD8, "PYRA"}}) {
    Mesh mesh = one_cell(body, skin, 0), linear = one_cell(catalog::cell(body).linear, catalog::cell(skin).linear, 0);
    mesh.cell_groups[0].members.resize(1);
    linear.cell_groups[0].members.resize(1);
    // within planes, so that the skin stays flat
    for (Mesh* m : {&mesh, &linear})
      for (std::size_t n = 0; n < m->n_nodes(); ++n) {
        const double x = m->coordinates[3 * n], y = m->coordinates[3 * n + 1], z = m->coordinates[3 * n + 2];
        const double w = 1 + 0.13 * x + 0.19 * y + 0.11 * z;
        for (std::size_t k = 0; k < 3; ++k) m->coordinates[3 * n + k] /= w;
      }
    for (std::size_t c = 0; c < mesh.n_cells(); ++c)
      for (std::size_t e = 0; e < mesh.row(c).edges.size(); ++e)
        for (std::size_t k = 0; k < 3; ++k) {
          const auto nodes = mesh.cells[c];
          const auto at = [&](int i) { return 3 * static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)]) + k; };
          mesh.coordinates[at(mesh.row(c).n_vertices + static_cast<int>(e))] =
              (mesh.coordinates[at(mesh.row(c).edges[e].first)] + mesh.coordinates[at(mesh.row(c).edges[e].second)]) / 2;
        }
    if (single)
      for (Mesh* m : {&mesh, &linear})
        for (double& x : m->coordinates) x = static_cast<float>(x);
    const Mesh made = cut(mesh, {"SKIN"}, option), plain = cut(linear, {"SKIN"}, option);
    expect_sound_cut(mesh, made, {"SKIN"});
    for (std::size_t c = 0; c < made.n_cells(); ++c)
      for (std::size_t e = 0; e < made.row(c).edges.size(); ++e)
        for (std::size_t k = 0; k < 3; ++k) {
          const auto at = [&](int i) {
            return made.point(static_cast<std::size_t>(made.cells[c][static_cast<std::size_t>(i)]))[k];
          };
          EXPECT_NEAR(at(made.row(c).n_vertices + static_cast<int>(e)),
                      (at(made.row(c).edges[e].first) + at(made.row(c).edges[e].second)) / 2, single ? 1e-6 : 1e-15);
        }
    ASSERT_EQ(made.n_cells(), plain.n_cells());
    for (std::size_t c = 0; c < made.n_cells(); ++c)
      for (int v = 0; v < made.row(c).n_vertices; ++v)
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(made.point(static_cast<std::size_t>(made.cells[c][static_cast<std::size_t>(v)]))[k],
                      plain.point(static_cast<std::size_t>(plain.cells[c][static_cast<std::size_t>(v)]))[k],
                      single ? 1e-6 : 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Cuts, StraightEdges, testing::Bool(),
                         [](const auto& row) { return row.param ? "in_single_precision" : "in_double_precision"; });

// Mid nodes that are on their straight edges but not in the middle stay where they are; the new ones are in the middle all the
// same, and the sub-cells fill the cell.
TEST(Cuts, of_a_cell_with_mid_nodes_off_the_middle_have_straight_edges) {
  for (const auto& [body, skin, option] : {std::tuple{CellType::HEXA20, CellType::QUAD8, "PYRA"},
                                           {CellType::HEXA20, CellType::QUAD8, "HEXA"},
                                           {CellType::PENTA15, CellType::QUAD8, "PYRA"},
                                           {CellType::PYRAM13, CellType::QUAD8, "PYRA"}}) {
    Mesh mesh = one_cell(body, skin, 0);
    mesh.cell_groups[0].members.resize(1);
    for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
      const catalog::CellRow& row = mesh.row(c);
      const auto at = [&](int i) { return mesh.coordinates.data() + 3 * static_cast<std::size_t>(mesh.cells[c][i]); };
      for (std::size_t e = 0; e < row.edges.size(); ++e) {
        auto [first, second] = std::pair(at(row.edges[e].first), at(row.edges[e].second));
        if (std::lexicographical_compare(second, second + 3, first, first + 3)) std::swap(first, second);  // the edge has one
        for (int k = 0; k < 3; ++k) at(row.n_vertices + static_cast<int>(e))[k] = 0.45 * first[k] + 0.55 * second[k];
      }
    }
    const Mesh made = cut(mesh, {"SKIN"}, option);
    expect_sound_cut(mesh, made, {"SKIN"});
    for (std::size_t c = 0; c < made.n_cells(); ++c) {
      const catalog::CellRow& row = made.row(c);
      const auto nodes = made.cells[c];
      for (std::size_t e = 0; e < row.edges.size(); ++e) {
        const auto middle = static_cast<std::size_t>(nodes[row.n_vertices + static_cast<int>(e)]);
        if (middle < mesh.n_nodes()) continue;
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(made.point(middle)[k],
                      (made.point(static_cast<std::size_t>(nodes[row.edges[e].first]))[k] +
                       made.point(static_cast<std::size_t>(nodes[row.edges[e].second]))[k]) /
                          2,
                      1e-15);
      }
    }
  }
}

// METHOD.md 1.2-4, -5: sub-cells stand where the cell stood, in the list and in every group; node groups stay.
TEST(Cuts, replace_cells_in_place) {
  const Mesh mesh = block(CellType::TRIA3, 2, 1, 1);  // skin cells 0 to 5, body 6 to 9
  const Mesh made = cut(mesh, {"BOTTOM"});
  EXPECT_EQ(made.find_cell_group("BOTTOM")->members, (Nodes{0, 1, 2, 3}));
  EXPECT_EQ(made.find_cell_group("RIGHT")->members, (Nodes{4}));
  EXPECT_EQ(made.find_cell_group("AROUND")->members, (Nodes{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(made.find_cell_group("BODY")->members, (Nodes{8, 9, 10, 11, 12, 13}));
  EXPECT_EQ(made.find_node_group("CORNER")->members, (Nodes{0, 2}));
  for (std::size_t c = 0; c < 8; ++c) EXPECT_EQ(made.types[c], CellType::SEG2);
}

// A mesh of more zones than one: a body cell between two zones is cut twice, and each zone has its patches.
TEST(Cuts, of_two_zones_on_one_body_cell) {
  const Mesh mesh = block(CellType::QUAD4, 1, 1, 2);
  CutReport report;
  const Mesh made = cut(mesh, {"LEFT", "BOTTOM"}, "PYRA", &report);
  EXPECT_EQ(made.n_nodes(), 12u);
  EXPECT_EQ(made.n_cells(), 15u);
  EXPECT_EQ(report.new_nodes, 8);
  EXPECT_EQ(report.new_cells, 10);
  EXPECT_EQ(made.patches->zone_offset, (std::vector<std::int64_t>{0, 1, 2}));
  expect_sound_cut(mesh, made, {"LEFT", "BOTTOM"});
}

// ---------------------------------------------------------------------------------------------------- refusals

TEST(CutErrors, a_mesh_that_is_cut_is_not_cut_again) {
  const Mesh made = cut(block(CellType::TRIA3, 2, 2, 1), {"BOTTOM"});
  EXPECT_EQ(error_of([&] { cut(made, {"TOP"}); }).id, "MESH1_12");
}

TEST(CutErrors, a_skin_cell_without_body_is_named) {
  Mesh mesh = block(CellType::TRIA3, 2, 1, 1);
  mesh.cell_groups.push_back({"LONE", {static_cast<std::int32_t>(mesh.n_cells())}});
  add(mesh, CellType::SEG2, {0, 2});
  const Message error = error_of([&] { cut(mesh, {"LONE"}); });
  EXPECT_EQ(error.id, "MESH1_2");
  EXPECT_THAT(error.text, HasSubstr(cell_name(static_cast<std::int64_t>(mesh.n_cells()) - 1)));
  EXPECT_THAT(error.text, HasSubstr("'LONE'"));
}

TEST(CutErrors, a_pair_without_row_is_named) {
  Mesh mesh = block(CellType::TRIA6, 2, 1, 1);
  mesh.cell_groups.push_back({"LOW", {static_cast<std::int32_t>(mesh.n_cells())}});
  add(mesh, CellType::SEG2, {0, 1});
  const Message error = error_of([&] { cut(mesh, {"LOW"}); });
  EXPECT_EQ(error.id, "CREALAC_1");
  EXPECT_THAT(error.text, HasSubstr("SEG2"));
  EXPECT_THAT(error.text, HasSubstr("TRIA6"));
}

TEST(CutErrors, a_skin_with_mid_nodes_of_its_own_is_refused) {
  Mesh mesh = block(CellType::QUAD8, 2, 1, 1);
  const auto slave = static_cast<std::size_t>(mesh.find_cell_group("BOTTOM")->members[0]);
  mesh.cells[slave][2] = add_node(mesh, 0.5, 0);
  EXPECT_EQ(error_of([&] { cut(mesh, {"BOTTOM"}); }).id, "CREALAC_1");
}

TEST(CutErrors, unknown_empty_and_repeated_groups) {
  Mesh mesh = block(CellType::TRIA3, 2, 1, 1);
  mesh.cell_groups.push_back({"NOTHING", {}});
  EXPECT_EQ(error_of([&] { cut(mesh, {"BOTOM"}); }).id, "MESH_1");
  EXPECT_EQ(error_of([&] { cut(mesh, {"NOTHING"}); }).id, "MESH_2");
  EXPECT_EQ(error_of([&] { cut(mesh, {"TOP", "TOP"}); }).id, "DECOUPE_1");
}

TEST(CutErrors, one_cell_in_two_zones) {
  const Mesh mesh = block(CellType::TRIA3, 2, 1, 1);
  const Message error = error_of([&] { cut(mesh, {"BOTTOM", "AROUND"}); });
  EXPECT_EQ(error.id, "DECOUPE_2");
  EXPECT_THAT(error.text, HasSubstr("M1 "));
}

TEST(CutErrors, an_internal_face_has_two_bodies) {
  Mesh mesh = block(CellType::QUAD4, 2, 1, 1);
  mesh.cell_groups.push_back({"INSIDE", {static_cast<std::int32_t>(mesh.n_cells())}});
  add(mesh, CellType::SEG2, {1, 4});
  EXPECT_EQ(error_of([&] { cut(mesh, {"INSIDE"}); }).id, "DECOUPE_3");
}

TEST(CutErrors, body_cells_are_no_skin) {
  const Mesh mesh = block(CellType::QUAD4, 2, 1, 1);
  const Message error = error_of([&] { cut(mesh, {"BODY"}); });
  EXPECT_EQ(error.id, "DECOUPE_4");
  EXPECT_THAT(error.text, HasSubstr("QUAD4"));
}

TEST(CutErrors, two_slave_cells_on_one_facet) {
  Mesh mesh = block(CellType::QUAD8, 2, 1, 1);
  Group twice{"TWICE", {mesh.find_cell_group("BOTTOM")->members[0], static_cast<std::int32_t>(mesh.n_cells())}};
  const Nodes same(mesh.cells[static_cast<std::size_t>(twice.members[0])].begin(),
                   mesh.cells[static_cast<std::size_t>(twice.members[0])].end());
  add(mesh, CellType::SEG3, same);
  mesh.cell_groups.push_back(twice);
  EXPECT_EQ(error_of([&] { cut(mesh, {"TWICE"}); }).id, "DECOUPE_5");
}

TEST(CutErrors, a_body_cell_inside_out_or_mixed_is_named) {
  Mesh mesh = block(CellType::QUAD4, 1, 1, 1);
  const auto body = static_cast<std::size_t>(mesh.find_cell_group("BODY")->members[0]);
  const Nodes nodes(mesh.cells[body].begin(), mesh.cells[body].end());
  std::ranges::copy(mirrored(CellType::QUAD4, nodes), mesh.cells[body].begin());
  Message error = error_of([&] { cut(mesh, {"BOTTOM"}); });
  EXPECT_EQ(error.id, "DECOUPE_6");
  EXPECT_THAT(error.text, HasSubstr(cell_name(static_cast<std::int64_t>(body))));

  mesh = block(CellType::QUAD4, 1, 1, 1);
  mesh.coordinates[3 * 3] = 0.3;  // the corner (1, 1) moves past the diagonal
  mesh.coordinates[3 * 3 + 1] = 0.3;
  EXPECT_EQ(error_of([&] { cut(mesh, {"BOTTOM"}); }).id, "DECOUPE_6");
}

// A quadrangle drawn as a triangle (one corner flat) is sound, and can be cut.
TEST(CutErrors, a_flat_corner_is_not_an_error) {
  Mesh mesh;
  mesh.dimension = 2;
  for (const auto& [x, y] : {std::pair{0., 0.}, {2., 0.}, {1., 1.}, {0., 2.}}) add_node(mesh, x, y);
  add(mesh, CellType::SEG2, {0, 1});
  add(mesh, CellType::QUAD4, {0, 1, 2, 3});
  mesh.cell_groups = {{"S", {0}}};
  EXPECT_EQ(error_of([&] { cut(mesh, {"S"}); }).id, "");
}

}  // namespace
