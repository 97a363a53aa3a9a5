#pragma once
// Meshes for the tests, and what must hold for every mesh that was cut.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>

#include "lacon/catalog/contact.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/operators/crea_maillage/order_change.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/cut.hpp"
#include "lacon/operators/meshing/quality.hpp"

namespace lacon::test {

using Nodes = std::vector<std::int32_t>;

/// Collects what is said while it lives.
class Listener {
 public:
  Listener() {
    heard().clear();
    set_message_sink([](const Message& m) { heard().push_back(m); });
  }
  ~Listener() { set_message_sink(nullptr); }
  static std::vector<Message>& heard() {
    static std::vector<Message> messages;
    return messages;
  }
  static std::vector<std::string> ids() {
    std::vector<std::string> all;
    for (const Message& m : heard()) all.push_back(m.id);
    return all;
  }
};

/// The identifier and the text of the error that `work` throws; "" where it throws none.
template <class Work>
Message error_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.message();
  }
  return {'-', "", "", ""};
}

inline Mesh cut(const Mesh& mesh, const std::vector<std::string>& groups, std::string_view option = "PYRA",
                CutReport* report = nullptr) {
  CutReport own;
  return cut_lac(mesh, groups, option, "DECOUPE_LAC/GROUP_MA_ESCL", report ? *report : own);
}

inline std::int32_t add_node(Mesh& mesh, double x, double y, double z = 0) {
  mesh.coordinates.insert(mesh.coordinates.end(), {x, y, z});
  return static_cast<std::int32_t>(mesh.n_nodes() - 1);
}

inline void add(Mesh& mesh, CellType type, const Nodes& nodes) { mesh.add_cell(type, nodes); }

/// The mesh's cells of the greatest dimension.
inline Nodes bodies_of(const Mesh& mesh) {
  Nodes cells;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    if (mesh.row(c).dimension == mesh.dimension) cells.push_back(static_cast<std::int32_t>(c));
  return cells;
}

/// The measure of a cell of the mesh's dimension, with a rule that is exact for the cells of these tests.
inline double measure(const Mesh& mesh, std::size_t c) {
  static const std::map<Family, int> points{{Family::TRIA, 7},   {Family::QUAD, 16},  {Family::TETRA, 15},
                                            {Family::PENTA, 21}, {Family::PYRAM, 64}, {Family::HEXA, 64}};
  const catalog::CellRow& row = mesh.row(c);
  const Tabulation table = tabulate(row.type, integration_rule(row.family, points.at(row.family)));
  const int d = row.dimension;
  double total = 0;
  for (int p = 0; p < table.n_points; ++p) {
    double j[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < d; ++i)
      for (int k = 0; k < d; ++k) {
        j[i][k] = 0;
        for (int a = 0; a < table.n_nodes; ++a)
          j[i][k] +=
              table.gradient[static_cast<std::size_t>((p * table.n_nodes + a) * d + i)] *
              mesh.point(static_cast<std::size_t>(mesh.cells[c][static_cast<std::size_t>(a)]))[static_cast<std::size_t>(k)];
      }
    total += table.weight[static_cast<std::size_t>(p)] *
             (j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) - j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
              j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]));
  }
  return total;
}

inline double total_measure(const Mesh& mesh) {
  double total = 0;
  for (const std::int32_t c : bodies_of(mesh)) total += measure(mesh, static_cast<std::size_t>(c));
  return total;
}

/// How often each facet (all its nodes, sorted) belongs to a body cell.
inline std::map<Nodes, int> facet_counts(const Mesh& mesh) {
  std::map<Nodes, int> counts;
  for (const std::int32_t c : bodies_of(mesh))
    for (const catalog::FacetRow& facet : mesh.row(static_cast<std::size_t>(c)).facets) {
      Nodes nodes;
      for (const std::int8_t n : facet.nodes)
        nodes.push_back(mesh.cells[static_cast<std::size_t>(c)][static_cast<std::size_t>(n)]);
      std::sort(nodes.begin(), nodes.end());
      ++counts[nodes];
    }
  return counts;
}

inline Nodes sorted(std::span<const std::int32_t> nodes) {
  Nodes all(nodes.begin(), nodes.end());
  std::sort(all.begin(), all.end());
  return all;
}

/// What holds for every patch: its sub-cells are those of its kind, rank by rank, they look outward, and LAGS_C is carried
/// where the catalogue says; no node is a carrier of two.
inline void expect_sound_patches(const Mesh& mesh) {
  ASSERT_TRUE(mesh.patches);
  const Patches& patches = *mesh.patches;
  const NodeCells around(mesh);
  std::set<std::int32_t> carriers_so_far;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const catalog::PatchRow* row = catalog::find_patch(patches.kind[p]);
    ASSERT_TRUE(row);
    ASSERT_EQ(row->cells.size(), patches.cells[p].size());
    std::set<std::int32_t> carriers;
    for (std::size_t rank = 0; rank < row->cells.size(); ++rank) {
      const auto c = static_cast<std::size_t>(patches.cells[p][rank]);
      EXPECT_EQ(mesh.types[c], row->cells[rank]);
      const auto bodies = body_cells(mesh, around, c);
      ASSERT_EQ(bodies.size(), 1u) << "sub-cell " << cell_name(static_cast<std::int64_t>(c));
      EXPECT_TRUE(bodies[0].match.outward);
      for (const std::int8_t local : catalog::find_slave(patches.kind[p], static_cast<int>(rank))->carriers)
        carriers.insert(mesh.cells[c][static_cast<std::size_t>(local)]);
    }
    EXPECT_EQ(carriers, std::set<std::int32_t>(patches.carriers[p].begin(), patches.carriers[p].end()));
    for (const std::int32_t n : carriers) EXPECT_TRUE(carriers_so_far.insert(n).second) << "a carrier of two patches";
  }
}

/// What holds for every cut: interior facets belong to two cells and boundary facets to one; the boundary is what it was, but
/// for the slave facets, whose sub-cells are boundary facets seen from outside; every Jacobian is positive; nothing is used or
/// left that should not be; patches, groups and the catalogue agree.
inline void expect_sound_cut(const Mesh& before, const Mesh& after, const std::vector<std::string>& groups) {
  std::set<std::int32_t> slaves;
  std::set<Nodes> slave_facets, boundary_before, boundary_after, sub_facets;
  for (const std::string& group : groups)
    for (const std::int32_t c : before.find_cell_group(group)->members) {
      slaves.insert(c);
      slave_facets.insert(sorted(before.cells[static_cast<std::size_t>(c)]));
    }
  for (const auto& [facet, count] : facet_counts(before))
    if (count == 1) boundary_before.insert(facet);
  for (const auto& [facet, count] : facet_counts(after)) {
    EXPECT_LE(count, 2);
    if (count == 1) boundary_after.insert(facet);
  }

  ASSERT_TRUE(after.patches);
  const Patches& patches = *after.patches;
  EXPECT_EQ(patches.zone_group, groups);
  ASSERT_EQ(patches.zone_offset.size(), groups.size() + 1);
  std::size_t p = 0;
  for (std::size_t z = 0; z < groups.size(); ++z) {
    EXPECT_EQ(patches.zone_offset[z], static_cast<std::int64_t>(p));
    Nodes in_zone;
    for (const std::int32_t parent : before.find_cell_group(groups[z])->members) {  // METHOD 1.8: in the order of consumption
      ASSERT_LT(p, patches.size());
      EXPECT_EQ(patches.parent[p], parent);
      in_zone.insert(in_zone.end(), patches.cells[p].begin(), patches.cells[p].end());
      ++p;
    }
    EXPECT_EQ(after.find_cell_group(groups[z])->members, in_zone);
  }
  EXPECT_EQ(p, patches.size());
  EXPECT_EQ(patches.zone_offset.back(), static_cast<std::int64_t>(p));

  expect_sound_patches(after);
  for (const std::int32_t c : patches.cells.values) sub_facets.insert(sorted(after.cells[static_cast<std::size_t>(c)]));
  for (const Nodes& facet : slave_facets) EXPECT_TRUE(boundary_before.erase(facet));
  for (const Nodes& facet : sub_facets) EXPECT_TRUE(boundary_after.erase(facet)) << "a sub-cell is no boundary facet";
  EXPECT_EQ(boundary_before, boundary_after);

  for (const std::int32_t c : bodies_of(after)) {
    const auto range =
        jacobian_range(after.types[static_cast<std::size_t>(c)], after.cells[static_cast<std::size_t>(c)], after.coordinates);
    EXPECT_GT(range.least, 0) << cell_name(c);
  }
  std::set<std::int32_t> used(after.cells.values.begin(), after.cells.values.end());
  for (std::size_t n = before.n_nodes(); n < after.n_nodes(); ++n)
    EXPECT_TRUE(used.contains(static_cast<std::int32_t>(n))) << node_name(static_cast<std::int64_t>(n));
  EXPECT_TRUE(std::equal(before.coordinates.begin(), before.coordinates.end(), after.coordinates.begin()));
  ASSERT_EQ(before.node_groups.size(), after.node_groups.size());
  for (std::size_t g = 0; g < before.node_groups.size(); ++g)
    EXPECT_EQ(before.node_groups[g].members, after.node_groups[g].members);
}

/// One cell of this type in an affine position drawn from `random` (the reference cell: seed 0), as cell 0 of a mesh, and its
/// facets of the type `skin`, each begun at a random vertex, in the group SKIN.
inline Mesh one_cell(CellType body, CellType skin, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  const catalog::CellRow& row = catalog::cell(body);
  Mesh mesh;
  mesh.name = std::string(row.name);
  mesh.dimension = row.dimension;
  double a[3][3], b[3];
  for (int i = 0; i < 3; ++i) {
    b[i] = seed == 0 ? 0 : uniform(random);
    for (int k = 0; k < 3; ++k) a[i][k] = (i == k ? 1 : 0) + (seed == 0 ? 0 : uniform(random));
  }
  Nodes nodes;
  for (int n = 0; n < row.n_nodes; ++n) {
    double x[3] = {};
    for (int i = 0; i < row.dimension; ++i) {
      x[i] = b[i];
      for (int k = 0; k < row.dimension; ++k) x[i] += a[i][k] * row.nodes[static_cast<std::size_t>(n * row.dimension + k)];
    }
    nodes.push_back(add_node(mesh, x[0], x[1], x[2]));
  }
  add(mesh, body, nodes);
  Group group{"SKIN", {}};
  for (const catalog::FacetRow& facet : row.facets) {
    if (facet.type != skin) continue;
    const auto v = static_cast<std::size_t>(catalog::cell(skin).n_vertices);
    const std::size_t start = v < 3 ? 0 : random() % v;
    Nodes own;
    for (std::size_t i = 0; i < facet.nodes.size(); ++i) {  // vertices, then the mids of edges, then the centre
      const std::size_t ring = i / v, turned = ring < 2 ? ring * v + (i % v + start) % v : i;
      own.push_back(nodes[static_cast<std::size_t>(facet.nodes[v < 3 ? i : turned])]);
    }
    group.members.push_back(static_cast<std::int32_t>(mesh.n_cells()));
    add(mesh, skin, own);
  }
  mesh.cell_groups.push_back(group);
  mesh.node_groups.push_back({"SOME", {0, 1}});
  return mesh;
}

/// A jittered n x m block of plane cells with its skin all around: BOTTOM, RIGHT, TOP, LEFT (outward), AROUND (all of them),
/// BODY; cells of the corners own two edges of the skin. Quadratic cells get curved edges.
inline Mesh block(CellType type, int n, int m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  const bool triangles = catalog::cell(type).family == Family::TRIA;
  Mesh mesh;
  mesh.name = "BLOCK";
  mesh.dimension = 2;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) add_node(mesh, i + uniform(random), j + uniform(random));
  const auto at = [&](int i, int j) { return static_cast<std::int32_t>(j * (n + 1) + i); };
  Group names[4] = {{"BOTTOM", {}}, {"RIGHT", {}}, {"TOP", {}}, {"LEFT", {}}};
  const auto edge = [&](Group& group, std::int32_t a, std::int32_t b) {
    group.members.push_back(static_cast<std::int32_t>(mesh.n_cells()));
    add(mesh, CellType::SEG2, {a, b});
  };
  for (int i = 0; i < n; ++i) edge(names[0], at(i, 0), at(i + 1, 0));
  for (int j = 0; j < m; ++j) edge(names[1], at(n, j), at(n, j + 1));
  for (int i = n; i > 0; --i) edge(names[2], at(i, m), at(i - 1, m));
  for (int j = m; j > 0; --j) edge(names[3], at(0, j), at(0, j - 1));
  Group around{"AROUND", {}}, body{"BODY", {}};
  for (const Group& side : names) around.members.insert(around.members.end(), side.members.begin(), side.members.end());
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const Nodes quad{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      const std::size_t turn = random() % 4;  // any vertex may come first
      const auto q = [&](std::size_t k) { return quad[(k + turn) % 4]; };
      body.members.push_back(static_cast<std::int32_t>(mesh.n_cells()));
      if (!triangles) {
        add(mesh, CellType::QUAD4, {q(0), q(1), q(2), q(3)});
        continue;
      }
      add(mesh, CellType::TRIA3, {q(0), q(1), q(2)});
      body.members.push_back(static_cast<std::int32_t>(mesh.n_cells()));
      add(mesh, CellType::TRIA3, {q(2), q(3), q(0)});
    }
  for (const Group& side : names) mesh.cell_groups.push_back(side);
  mesh.cell_groups.push_back(around);
  mesh.cell_groups.push_back(body);
  mesh.node_groups.push_back({"CORNER", {0, n}});
  if (catalog::cell(type).order == 2) {
    const std::size_t straight = mesh.n_nodes();
    Nodes all(mesh.n_cells());
    for (std::size_t c = 0; c < all.size(); ++c) all[c] = static_cast<std::int32_t>(c);
    make_quadratic(mesh, all);
    for (std::size_t k = straight; k < mesh.n_nodes(); ++k)
      for (std::size_t x = 0; x < 2; ++x) mesh.coordinates[3 * k + x] += 0.2 * uniform(random);
    if (type == CellType::QUAD9) {
      Mesh nine = mesh;
      nine.cells = {};
      for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
        Nodes own(mesh.cells[c].begin(), mesh.cells[c].end());
        if (mesh.types[c] == CellType::QUAD8) {
          double x = 0, y = 0;
          for (std::size_t v = 0; v < 4; ++v) {
            x += mesh.point(static_cast<std::size_t>(own[v]))[0] / 4;
            y += mesh.point(static_cast<std::size_t>(own[v]))[1] / 4;
          }
          own.push_back(add_node(nine, x, y));
          nine.types[c] = CellType::QUAD9;
        }
        nine.cells.push_back(own);
      }
      mesh = nine;
    }
  }
  return mesh;
}

}  // namespace lacon::test
