// Uniform refinement: catalog/refinements.toml.
#include "lacon/operators/meshing/refine.hpp"

#include "lacon/catalog/refinements.hpp"
#include "meshes.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;
using testing::HasSubstr;

Mesh refined(const Mesh& mesh, const std::vector<std::string>& groups = {}, RefinementReport* report = nullptr) {
  RefinementReport own;
  return refine(mesh, groups, "GROUP_MA", report ? *report : own);
}

/// One cell in a random affine position with every facet of its own as a skin cell (group SKIN) and the body in BODY.
Mesh with_skin(CellType type, unsigned seed) {
  Mesh mesh = one_cell(type, type, seed);
  mesh.cell_groups = {{"BODY", {0}}, {"SKIN", {}}};
  const Nodes body(mesh.cells[0].begin(), mesh.cells[0].end());
  for (const catalog::FacetRow& facet : catalog::cell(type).facets) {
    if (catalog::cell(facet.type).dimension == 0) continue;
    Nodes own;
    for (const std::int8_t n : facet.nodes) own.push_back(body[static_cast<std::size_t>(n)]);
    mesh.cell_groups[1].members.push_back(static_cast<std::int32_t>(mesh.n_cells()));
    add(mesh, facet.type, own);
  }
  return mesh;
}

/// Every facet belongs to two bodies, or to one body and one cell of SKIN; bodies are sound; all nodes are used.
void expect_conforming(const Mesh& mesh) {
  std::set<Nodes> skin;
  for (const std::int32_t c : mesh.find_cell_group("SKIN")->members) {
    EXPECT_TRUE(skin.insert(sorted(mesh.cells[static_cast<std::size_t>(c)])).second);
  }
  for (const auto& [facet, count] : facet_counts(mesh)) {
    EXPECT_EQ(count, skin.contains(facet) ? 1 : 2);
  }
  for (const std::int32_t c : bodies_of(mesh)) {
    const auto at = static_cast<std::size_t>(c);
    EXPECT_GT(jacobian_range(mesh.types[at], mesh.cells[at], mesh.coordinates).least, 0);
  }
  const std::set<std::int32_t> used(mesh.cells.values.begin(), mesh.cells.values.end());
  EXPECT_EQ(used.size(), mesh.n_nodes());
}

class Refinement : public testing::TestWithParam<CellType> {};

// Refined three times: the volume stays, every inner facet has two cells and every outer one lies in the refined skin.
TEST_P(Refinement, keeps_the_volume_and_conforms) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    Mesh mesh = with_skin(GetParam(), seed);
    const double volume = total_measure(mesh);
    std::size_t bodies = 1;
    for (int level = 1; level <= 3; ++level) {
      RefinementReport report;
      const std::size_t cells = mesh.n_cells();
      mesh = refined(mesh, {}, &report);
      EXPECT_EQ(report.refined, static_cast<std::int64_t>(cells));
      EXPECT_NEAR(total_measure(mesh), volume, 1e-13 * volume);
      expect_conforming(mesh);
      const catalog::CellRow& row = catalog::cell(GetParam());
      if (row.family != Family::PYRAM) bodies *= std::size_t{1} << row.dimension;
      if (row.family == Family::PYRAM && level == 1) bodies = 10;
      if (row.family != Family::PYRAM || level == 1) {
        EXPECT_EQ(mesh.find_cell_group("BODY")->members.size(), bodies);
      }
    }
    if (HasFailure()) FAIL() << catalog::cell(GetParam()).name << ", seed " << seed;
  }
}

// One level of a single cell makes the nodes of the same cell of twice the order: no node is there twice.
TEST_P(Refinement, makes_each_node_once) {
  const Mesh mesh = refined(refined(with_skin(GetParam(), 1)));
  std::set<std::array<long, 3>> places;
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n) {
    const auto x = mesh.point(n);
    EXPECT_TRUE(places.insert({std::lround(1e9 * x[0]), std::lround(1e9 * x[1]), std::lround(1e9 * x[2])}).second);
  }
}

// Naming the body alone refines its skin too: the groups are inherited, each in place.
TEST_P(Refinement, of_the_body_takes_its_skin_along) {
  const Mesh mesh = with_skin(GetParam(), 2);
  RefinementReport report;
  const Mesh by_group = refined(mesh, {"BODY"}, &report), all = refined(mesh);
  EXPECT_EQ(report.attached, static_cast<std::int64_t>(mesh.n_cells() - 1));
  EXPECT_EQ(by_group.cells.values, all.cells.values);
  EXPECT_EQ(by_group.coordinates, all.coordinates);
  std::size_t next = 0;
  for (const char* name : {"BODY", "SKIN"})
    for (const std::int32_t c : by_group.find_cell_group(name)->members) EXPECT_EQ(c, static_cast<std::int32_t>(next++));
  EXPECT_EQ(next, by_group.n_cells());
}

INSTANTIATE_TEST_SUITE_P(Cells, Refinement, testing::ValuesIn([] {
                           std::vector<CellType> types;
                           for (const catalog::RefinementRow& row : catalog::refinements())
                             if (catalog::cell(row.cell).dimension > 1) types.push_back(row.cell);
                           return types;
                         }()),
                         [](const auto& type) { return std::string(catalog::cell(type.param).name); });

// Segments: halves and, with mid nodes, quarters; the middle of a SEG3 is the node it has.
TEST(Segments, are_halved) {
  Mesh mesh;
  mesh.dimension = 2;
  for (const double x : {0., 8., 4., 16.}) add_node(mesh, x, 0);
  add(mesh, CellType::SEG3, {0, 1, 2});
  add(mesh, CellType::SEG2, {1, 3});
  const Mesh made = refined(mesh);
  const std::vector<std::vector<double>> places{{0, 4, 2}, {4, 8, 6}, {8, 12}, {12, 16}};
  ASSERT_EQ(made.n_cells(), places.size());
  for (std::size_t c = 0; c < places.size(); ++c) {
    std::vector<double> own;
    for (const std::int32_t n : made.cells[c]) own.push_back(made.point(static_cast<std::size_t>(n))[0]);
    EXPECT_EQ(own, places[c]) << c;
  }
  EXPECT_EQ(made.cells[0][1], 2);
}

// The meshes of the peer's ssnv219g: a hexahedron refined n times, then its lower face cut.
TEST(Refinements, of_a_hexahedron_give_the_documented_cells_once_cut) {
  Mesh mesh = one_cell(CellType::HEXA8, CellType::QUAD4, 0);
  mesh.cell_groups[0].members = {1};
  std::size_t slaves = 2;
  for (const std::size_t bodies : {6, 28, 144, 832, 5376}) {
    const Mesh made = cut(mesh, {"SKIN"}, "HEXA");
    EXPECT_EQ(bodies_of(made).size(), bodies);
    EXPECT_EQ(made.find_cell_group("SKIN")->members.size(), 5 * slaves * slaves / 4);
    slaves *= 2;
    mesh = refined(mesh);
  }
}

// Every cell but the point has a row.
TEST(Refinements, exist_for_every_cell) {
  for (const catalog::CellRow& row : catalog::cells())
    EXPECT_EQ(catalog::find_refinement(row.type) == nullptr, row.type == CellType::POI1) << row.name;
}

class Curved : public testing::TestWithParam<CellType> {};

// Curved quadratic cells keep their area: the sub-cells' map is the cell's own, restricted.
TEST_P(Curved, cells_keep_their_shape) {
  for (unsigned seed = 1; seed < 4; ++seed) {
    Mesh mesh = block(GetParam(), 3, 2, seed);
    const double area = total_measure(mesh);
    for (int level = 0; level < 2; ++level) {
      mesh = refined(mesh);
      EXPECT_NEAR(total_measure(mesh), area, 1e-13 * area);
    }
    std::set<Nodes> skin;
    for (const std::int32_t c : mesh.find_cell_group("AROUND")->members)
      skin.insert(sorted(mesh.cells[static_cast<std::size_t>(c)]));
    EXPECT_EQ(skin.size(), 4u * 10u);
    for (const auto& [facet, count] : facet_counts(mesh)) EXPECT_EQ(count, skin.contains(facet) ? 1 : 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Quadratic, Curved, testing::Values(CellType::TRIA6, CellType::QUAD8, CellType::QUAD9));

/// Least and greatest of (sum of squared edges)^(3/2) / volume over the tetrahedra of a mesh: 1 / quality.
double worst_shape(const Mesh& mesh) {
  double worst = 0;
  for (const std::int32_t c : bodies_of(mesh)) {
    const auto at = static_cast<std::size_t>(c);
    double edges = 0;
    for (const catalog::EdgeRow& edge : mesh.row(at).edges)
      for (std::size_t k = 0; k < 3; ++k) {
        const double d = mesh.point(static_cast<std::size_t>(mesh.cells[at][static_cast<std::size_t>(edge.first)]))[k] -
                         mesh.point(static_cast<std::size_t>(mesh.cells[at][static_cast<std::size_t>(edge.second)]))[k];
        edges += d * d;
      }
    worst = std::max(worst, std::pow(edges, 1.5) / measure(mesh, at));
  }
  return worst;
}

// The shortest diagonal keeps tetrahedra from degenerating: what the first refinement makes is about as bad as it gets.
TEST(Tetrahedra, keep_their_quality_over_repeated_refinement) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    Mesh mesh = refined(with_skin(CellType::TETRA4, seed));
    const double first = worst_shape(mesh);
    for (int level = 2; level <= 4; ++level) {
      mesh = refined(mesh);
      EXPECT_LE(worst_shape(mesh), 1.5 * first) << "seed " << seed << ", level " << level;
    }
  }
}

// The octahedron is cut along its shortest diagonal, and along the first of equal ones: a flat tetrahedron where it is the
// third, and one of Kuhn's, whose second and third are equal.
TEST(Tetrahedra, are_cut_along_the_shortest_diagonal_the_first_of_equal_ones) {
  const auto joins = [](const std::vector<std::array<double, 3>>& corners, const Nodes& a, const Nodes& b) {
    Mesh mesh;
    for (const auto& x : corners) add_node(mesh, x[0], x[1], x[2]);
    add(mesh, CellType::TETRA4, {0, 1, 2, 3});
    const Mesh made = refined(mesh);
    const auto at = [&](const Nodes& ends) {
      for (std::size_t n = 4; n < made.n_nodes(); ++n) {
        bool here = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const double middle =
              (corners[static_cast<std::size_t>(ends[0])][k] + corners[static_cast<std::size_t>(ends[1])][k]) / 2;
          here = here && std::abs(made.point(n)[k] - middle) < 1e-12;
        }
        if (here) return static_cast<std::int32_t>(n);
      }
      return -1;
    };
    const std::int32_t first = at(a), second = at(b);
    int both = 0;
    for (std::size_t c = 0; c < made.n_cells(); ++c)
      both += std::ranges::count(made.cells[c], first) && std::ranges::count(made.cells[c], second);
    return both;
  };
  const std::vector<std::array<double, 3>> flat{{0, 0, 0}, {0, 1, 0.1}, {1, 0, 0.1}, {1, 1, 0}};
  EXPECT_EQ(joins(flat, {0, 3}, {1, 2}), 4);
  EXPECT_EQ(joins(flat, {0, 1}, {2, 3}), 0);
  const std::vector<std::array<double, 3>> kuhn{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  EXPECT_EQ(joins(kuhn, {0, 2}, {1, 3}), 4);
  EXPECT_EQ(joins(kuhn, {0, 3}, {1, 2}), 0);
  const std::vector<std::array<double, 3>> regular{{1, 1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}};
  EXPECT_EQ(joins(regular, {0, 1}, {2, 3}), 4);
}

// Two bodies of which one is refined: the other stays, cell by cell, though they stand in one list.
TEST(Refinements, of_one_body_leave_the_other_as_it_is) {
  Mesh mesh = block(CellType::QUAD8, 2, 1, 1);
  Mesh other = block(CellType::TRIA3, 1, 1, 2);
  const auto shift = static_cast<std::int32_t>(mesh.n_nodes());
  Group lone{"OTHER", {}};
  for (std::size_t c = 0; c < other.n_cells(); ++c) {
    Nodes nodes(other.cells[c].begin(), other.cells[c].end());
    for (std::int32_t& n : nodes) n += shift;
    lone.members.push_back(static_cast<std::int32_t>(mesh.n_cells()));
    add(mesh, other.types[c], nodes);
  }
  mesh.coordinates.insert(mesh.coordinates.end(), other.coordinates.begin(), other.coordinates.end());
  mesh.cell_groups.push_back(lone);
  RefinementReport report;
  const Mesh made = refined(mesh, {"BODY"}, &report);
  const Group& kept = *made.find_cell_group("OTHER");
  ASSERT_EQ(kept.members.size(), lone.members.size());
  for (std::size_t i = 0; i < lone.members.size(); ++i) {
    const auto before = static_cast<std::size_t>(lone.members[i]), after = static_cast<std::size_t>(kept.members[i]);
    EXPECT_EQ(made.types[after], mesh.types[before]);
    EXPECT_TRUE(std::ranges::equal(made.cells[after], mesh.cells[before]));
  }
  EXPECT_EQ(report.refined, 2 + 6);
  EXPECT_EQ(report.attached, 6);
  EXPECT_THAT(report.node_groups, testing::ElementsAre("CORNER"));
}

// A linear skin on a curved body shares the body's nodes: its middle is the body's mid node, wherever that lies.
TEST(Refinements, of_a_linear_skin_use_the_mid_nodes_of_its_body) {
  Mesh mesh = one_cell(CellType::QUAD8, CellType::SEG3, 0);
  mesh.coordinates[3 * 4 + 1] -= 0.2;
  add(mesh, CellType::SEG2, {0, 1});
  const Mesh made = refined(mesh);
  const auto skin = made.n_cells() - 2;
  EXPECT_TRUE(std::ranges::equal(made.cells[skin], Nodes{0, 4}));
  EXPECT_TRUE(std::ranges::equal(made.cells[skin + 1], Nodes{4, 1}));
}

// ---------------------------------------------------------------------------------------------------- refusals

// A neighbour that is not refined would get a hanging node: it is named, with its groups and the edge.
TEST(RefinementErrors, a_hanging_node_is_refused) {
  Mesh mesh = block(CellType::QUAD4, 2, 1, 1);
  const std::int32_t first = mesh.find_cell_group("BODY")->members[0];
  mesh.cell_groups.push_back({"LEFT_CELL", {first}});
  mesh.cell_groups.push_back({"RIGHT_CELL", {first + 1}});
  const Message error = error_of([&] { refined(mesh, {"LEFT_CELL"}); });
  EXPECT_EQ(error.id, "RAFFINE_1");
  EXPECT_THAT(error.text, HasSubstr(cell_name(first + 1)));
  EXPECT_THAT(error.text, HasSubstr("BODY, RIGHT_CELL"));
  EXPECT_THAT(error.text, HasSubstr("N2-N5"));
  EXPECT_EQ(error_of([&] { refined(mesh, {"LEFT_CELL", "RIGHT_CELL"}); }).id, "");
}

TEST(RefinementErrors, a_skin_without_its_body_is_refused) {
  EXPECT_EQ(error_of([&] { refined(with_skin(CellType::HEXA8, 1), {"SKIN"}); }).id, "RAFFINE_1");
}

TEST(RefinementErrors, unknown_groups_and_cut_meshes) {
  const Mesh mesh = block(CellType::TRIA3, 2, 1, 1);
  EXPECT_EQ(error_of([&] { refined(mesh, {"BDOY"}); }).id, "MESH_1");
  EXPECT_EQ(error_of([&] { refined(cut(mesh, {"BOTTOM"})); }).id, "MESH1_12");
}

TEST(RefinementErrors, a_cell_too_curved_is_named) {
  Mesh mesh = one_cell(CellType::QUAD8, CellType::SEG3, 0);
  mesh.coordinates[3 * 4 + 1] += 2.5;  // the mid node of the lower edge lies above the upper edge
  const Message error = error_of([&] { refined(mesh); });
  EXPECT_EQ(error.id, "RAFFINE_2");
  EXPECT_THAT(error.text, HasSubstr("QUAD8 M1"));
}

}  // namespace
