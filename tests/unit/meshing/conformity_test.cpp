// Do cells of one body share whole edges and faces with their neighbours?
#include "lacon/operators/meshing/conformity.hpp"

#include <numeric>

#include "lacon/operators/meshing/open_facets.hpp"
#include "meshes.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;

std::vector<std::int64_t> numbers_of(const Misfits& all) {
  return {all.middles.count, all.diagonals.count, all.hanging.count, all.coincident.count};
}
const std::vector<std::int64_t> none{0, 0, 0, 0};

/// Nodes by place; every node that is asked for at one layer is the same one.
class Lattice {
 public:
  Mesh mesh;
  explicit Lattice(int dimension) { mesh.dimension = dimension; }
  std::int32_t at(double x, double y, double z = 0, int layer = 0) {
    const auto [found, isnew] = nodes_.try_emplace({x, y, z, static_cast<double>(layer)}, 0);
    if (isnew) found->second = add_node(mesh, x, y, z);
    return found->second;
  }
  /// A quadrangle; corners at its lower end and at its upper end may be of another layer.
  void quad(double x, double y, double w, double h, int low = 0, int high = 0) {
    add(mesh, CellType::QUAD4, {at(x, y, 0, low), at(x + w, y, 0, low), at(x + w, y + h, 0, high), at(x, y + h, 0, high)});
  }
  Nodes box(double x, double y, double z, double w, double h) {
    Nodes nodes;
    for (const double k : {z, z + h}) {
      for (const auto& [i, j] : {std::pair(x, y), {x + w, y}, {x + w, y + w}, {x, y + w}}) nodes.push_back(at(i, j, k));
    }
    return nodes;
  }
  void hexa(double x, double y, double z, double w, double h) { add(mesh, CellType::HEXA8, box(x, y, z, w, h)); }

 private:
  std::map<std::array<double, 4>, std::int32_t> nodes_;
};

class Conforming : public testing::TestWithParam<CellType> {};

// A block is whole, before its skin is cut and afterwards, however its cells are turned and its edges bent.
TEST_P(Conforming, blocks_have_nothing_that_does_not_fit) {
  const Mesh mesh = block(GetParam(), 4, 3, 2);
  EXPECT_EQ(numbers_of(misfits(mesh, 2)), none);
  EXPECT_EQ(open_facets(mesh, 2).size(), 14u);
  EXPECT_EQ(numbers_of(misfits(cut(mesh, {"AROUND"}), 2)), none);
}
INSTANTIATE_TEST_SUITE_P(Cells, Conforming,
                         testing::Values(CellType::TRIA3, CellType::TRIA6, CellType::QUAD4, CellType::QUAD8, CellType::QUAD9),
                         [](const auto& row) { return std::string(catalog::cell(row.param).name); });

TEST(Conformity, hexahedra_are_open_at_their_outside_alone) {
  Lattice all(3);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) all.hexa(i, j, k, 1, 1);
  EXPECT_EQ(open_facets(all.mesh, 3).size(), 54u);
  EXPECT_EQ(numbers_of(misfits(all.mesh, 3)), none);
  std::vector<char> counting(27, 1);
  counting[13] = 0;  // the cell in the middle is no part of the model
  EXPECT_EQ(open_facets(all.mesh, 3, counting).size(), 60u);
}

/// Two wide cells under four narrow ones, three under nine and so on. @param layer of the lower side of the narrow cells, but
/// for the ends of wide edges where `ends_shared`
Mesh narrow_on_wide(int parts, bool ends_shared, double lift = 0) {
  Lattice all(2);
  for (const double x : {0.0, 1.0}) all.quad(x, 0, 1, 1);
  for (int i = 0; i < 2 * parts; ++i) {
    const double w = 1.0 / parts;
    const auto low = [&](int k) {
      const bool end = k % parts == 0;
      const double x = end ? k / parts : k * w;
      return all.at(x, end ? 1 : 1 + lift, 0, end && ends_shared ? 0 : 1);
    };
    const std::int32_t a = low(i), b = low(i + 1);
    add(all.mesh, CellType::QUAD4, {a, b, all.at((i + 1) * w, 2), all.at(i * w, 2)});
  }
  return all.mesh;
}

TEST(Conformity, vertices_hang_where_others_lead_from_end_to_end) {
  for (const int parts : {2, 3, 5}) {
    const Misfits all = misfits(narrow_on_wide(parts, true), 2);
    EXPECT_EQ(numbers_of(all), (std::vector<std::int64_t>{0, 0, 2, 0}));
    EXPECT_EQ(all.hanging.cell, 0);
    EXPECT_EQ(all.hanging.vertices.size(), 2u);
  }
  EXPECT_EQ(numbers_of(misfits(narrow_on_wide(2, true, 1e-6), 2))[2], 2);  // coordinates of single precision
  EXPECT_EQ(numbers_of(misfits(narrow_on_wide(2, true, 0.01), 2)), none);  // a gap that is meant
}

// Skins that touch without a common node are the start of every contact study.
TEST(Conformity, bodies_that_touch_are_no_misfit) { EXPECT_EQ(numbers_of(misfits(narrow_on_wide(2, false), 2)), none); }

// Both faces of a slit between two nodes that they share, 2 cells below and 3 above: a closed crack, meshed as its sides are.
TEST(Conformity, a_closed_slit_is_no_misfit) {
  Lattice all(2);
  all.quad(0, 0, 1.5, 1);
  all.quad(1.5, 0, 1.5, 1);
  const std::int32_t left = all.at(0, 1), right = all.at(3, 1);
  for (int i = 0; i < 3; ++i)
    add(all.mesh, CellType::QUAD4,
        {i == 0 ? left : all.at(i, 1, 0, 1), i == 2 ? right : all.at(i + 1, 1, 0, 1), all.at(i + 1, 2), all.at(i, 2)});
  EXPECT_EQ(numbers_of(misfits(all.mesh, 2)), none);
}

// The same on both sides: information, for this may be a crack, or nodes that were not merged.
TEST(Conformity, facets_at_one_place_in_one_body_are_told) {
  Lattice all(2);
  for (int i = 0; i < 4; ++i) all.quad(i, 0, 1, 1);
  for (int i = 0; i < 4; ++i) {
    const auto low = [&](int k) { return all.at(k, 1, 0, k < 2 ? 0 : 1); };
    add(all.mesh, CellType::QUAD4, {low(i), low(i + 1), all.at(i + 1, 2), all.at(i, 2)});
  }
  const Misfits found = misfits(all.mesh, 2);
  EXPECT_EQ(numbers_of(found), (std::vector<std::int64_t>{0, 0, 0, 3}));
  EXPECT_EQ(found.coincident.vertices.size(), 2u);

  // as a slave skin the upper faces meet what is below in contact, and are cut
  Group slaves{"SLAVE", {}};
  for (int i = 1; i < 4; ++i) {
    slaves.members.push_back(static_cast<std::int32_t>(all.mesh.n_cells()));
    add(all.mesh, CellType::SEG2, {all.at(i + 1, 1, 0, 1), i == 1 ? all.at(1, 1) : all.at(i, 1, 0, 1)});
  }
  all.mesh.cell_groups.push_back(slaves);
  EXPECT_EQ(numbers_of(misfits(cut(all.mesh, {"SLAVE"}), 2)), none);
}

// A slit of one edge whose upper side is a slave skin, cut in two: what is in between is a node of contact.
TEST(Conformity, slave_skins_never_hang) {
  Mesh mesh = narrow_on_wide(2, true);
  Group slaves{"SLAVE", {}};
  for (std::size_t c = 2; c < 6; ++c) {
    const Nodes edge{mesh.cells[c][1], mesh.cells[c][0]};
    slaves.members.push_back(static_cast<std::int32_t>(mesh.n_cells()));
    add(mesh, CellType::SEG2, edge);
  }
  mesh.cell_groups.push_back(slaves);
  EXPECT_EQ(misfits(mesh, 2).hanging.count, 2);
  EXPECT_EQ(numbers_of(misfits(cut(mesh, {"SLAVE"}), 2)), none);
}

// A wide bent edge of a quadratic cell, two narrow ones along it: their vertex in the middle may be its middle node or another.
TEST(Conformity, vertices_hang_on_bent_edges) {
  for (const bool merged : {true, false}) {
    Lattice all(2);
    all.quad(0, 0, 2, 1);
    make_quadratic(all.mesh, Nodes{0});
    const std::int32_t middle = all.mesh.cells[0][6];  // of the upper edge
    all.mesh.coordinates[3 * static_cast<std::size_t>(middle) + 1] = 1.25;
    const std::int32_t vertex = merged ? middle : add_node(all.mesh, 1, 1.25);
    add(all.mesh, CellType::QUAD4, {all.at(0, 1), vertex, all.at(1, 2), all.at(0, 2)});
    add(all.mesh, CellType::QUAD4, {vertex, all.at(2, 1), all.at(2, 2), all.at(1, 2)});
    const Nodes narrow{1, 2};
    make_quadratic(all.mesh, narrow);
    const Misfits found = misfits(all.mesh, 2);
    EXPECT_EQ(numbers_of(found), (std::vector<std::int64_t>{0, 0, 1, 0}));
    EXPECT_EQ(found.hanging.node, vertex);
  }
}

TEST(Conformity, orders_that_differ_across_an_edge_are_found) {
  Lattice all(2);
  all.quad(0, 0, 1, 1);
  all.quad(1, 0, 1, 1);
  all.quad(2, 0, 1, 1);
  make_quadratic(all.mesh, Nodes{1});
  const Misfits found = misfits(all.mesh, 2);
  EXPECT_EQ(numbers_of(found), (std::vector<std::int64_t>{2, 0, 0, 0}));
  EXPECT_EQ(found.middles.cell, 1);
  EXPECT_EQ(found.middles.other, 0);
  EXPECT_EQ(found.middles.vertices, (Nodes{all.at(1, 0), all.at(1, 1)}));
  EXPECT_EQ(numbers_of(misfits(all.mesh, 2, std::vector<char>{0, 1, 0})), none);  // the neighbours have no element
}

TEST(Conformity, four_small_faces_on_a_large_one_hang) {
  Lattice all(3);
  all.hexa(0, 0, 0, 2, 1);
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 1.0}) all.hexa(x, y, 1, 1, 1);
  const Misfits found = misfits(all.mesh, 3);
  EXPECT_EQ(numbers_of(found),
            (std::vector<std::int64_t>{0, 0, 4, 0}));  // its edges; the node in the middle needs no more words
}

TEST(Conformity, a_vertex_in_the_middle_of_a_face_hangs) {
  Lattice all(3);
  all.hexa(0, 0, 0, 2, 1);
  const std::int32_t low = all.at(1, 1, 1), high = all.at(1, 1, 3);
  const Nodes corners{all.at(0, 0, 1), all.at(2, 0, 1), all.at(2, 2, 1), all.at(0, 2, 1)};
  for (std::size_t i = 0; i < 4; ++i) add(all.mesh, CellType::TETRA4, {corners[i], corners[(i + 1) % 4], low, high});
  const Misfits found = misfits(all.mesh, 3);
  EXPECT_EQ(numbers_of(found), (std::vector<std::int64_t>{0, 0, 1, 0}));
  EXPECT_EQ(found.hanging.node, low);
  EXPECT_EQ(found.hanging.vertices.size(), 4u);

  Mesh triangle;  // likewise in a triangle
  for (const double z : {-1.0, 0.0, 1.0}) add_node(triangle, 0, 0, z);
  for (const auto& [x, y] : {std::pair(3.0, 0.0), {-2.0, 2.0}, {-2.0, -2.0}}) add_node(triangle, x, y);
  add(triangle, CellType::TETRA4, {3, 5, 4, 0});
  for (const auto& [a, b] : {std::pair(3, 4), {4, 5}, {5, 3}}) add(triangle, CellType::TETRA4, {a, b, 1, 2});
  EXPECT_EQ(numbers_of(misfits(triangle, 3)), (std::vector<std::int64_t>{0, 0, 1, 0}));
}

// Whether the quadrangle is flat does not matter: it is on the same nodes.
TEST(Conformity, quadrangles_against_triangles_are_found) {
  for (const double warped : {0.0, 0.3}) {
    Lattice all(3);
    const Nodes box = all.box(0, 0, 0, 1, 1);
    add(all.mesh, CellType::HEXA8, box);
    const std::int32_t top = all.at(0.5, 0.5, 2);
    add(all.mesh, CellType::TETRA4, {box[4], box[5], box[6], top});
    add(all.mesh, CellType::TETRA4, {box[4], box[6], box[7], top});
    all.mesh.coordinates[3 * static_cast<std::size_t>(box[6]) + 2] += warped;
    const Misfits found = misfits(all.mesh, 3);
    EXPECT_EQ(numbers_of(found), (std::vector<std::int64_t>{0, 1, 0, 0}));
    EXPECT_EQ(found.diagonals.cell, 0);
    EXPECT_EQ(sorted(found.diagonals.vertices), sorted(std::span(box).last(4)));
  }
}

// A hexahedron that is drawn as a prism has a face of three vertices, and one without any.
TEST(Conformity, cells_drawn_to_simpler_ones_fit) {
  Lattice all(3);
  const Nodes box = all.box(0, 0, 0, 1, 1);
  add(all.mesh, CellType::HEXA8, {box[0], box[1], box[2], box[2], box[4], box[5], box[6], box[6]});
  add(all.mesh, CellType::PENTA6, {box[0], box[2], box[3], box[4], box[6], box[7]});
  const std::int32_t below = all.at(0.7, 0.3, -1);
  add(all.mesh, CellType::TETRA4, {box[0], box[2], box[1], below});
  EXPECT_EQ(numbers_of(misfits(all.mesh, 3)), none);
}

}  // namespace
