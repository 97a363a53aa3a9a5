// Points in cells: the inverse of the isoparametric map for every kind of cell, straight or curved, among many; points outside.
#include "lacon/operators/fields/cell_locator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "lacon/elements/reference.hpp"

namespace {

using namespace lacon;

constexpr int n_cells = 12;

std::vector<CellType> body_types() {
  std::vector<CellType> types;
  for (const catalog::CellRow& row : catalog::cells())
    if (row.dimension >= 2) types.push_back(row.type);
  return types;
}

/// Cells of one kind in a row, each distorted in its own way; `curved` moves nodes between vertices, else edges are straight.
Mesh cells_in_a_row(CellType type, bool curved, double distortion) {
  const catalog::CellRow& row = catalog::cell(type);
  Mesh mesh;
  mesh.dimension = row.dimension;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-distortion, distortion);
  std::vector<double> shape(static_cast<std::size_t>(row.n_vertices));
  for (int c = 0; c < n_cells; ++c) {
    std::vector<std::int32_t> nodes;
    std::vector<std::array<double, 3>> vertices;
    for (int a = 0; a < row.n_nodes; ++a) {
      const auto xi = row.nodes.subspan(static_cast<std::size_t>(a * row.dimension), static_cast<std::size_t>(row.dimension));
      std::array<double, 3> x{};
      if (a < row.n_vertices) {
        for (std::size_t d = 0; d < xi.size(); ++d) x[d] = xi[d] + jitter(random) + (d == 0 ? 2.6 * c : 0.3 * c);
        vertices.push_back(x);
      } else {
        shape_functions(row.linear, xi, shape);
        for (std::size_t v = 0; v < vertices.size(); ++v)
          for (std::size_t d = 0; d < xi.size(); ++d) x[d] += shape[v] * vertices[v][d];
        for (std::size_t d = 0; d < xi.size() && curved; ++d) x[d] += 0.3 * jitter(random);
      }
      nodes.push_back(static_cast<std::int32_t>(mesh.n_nodes()));
      mesh.coordinates.insert(mesh.coordinates.end(), x.begin(), x.end());
    }
    mesh.add_cell(type, nodes);
  }
  return mesh;
}

std::vector<std::int32_t> all_cells(const Mesh& mesh) {
  std::vector<std::int32_t> all(mesh.n_cells());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::array<double, 3> image(const Mesh& mesh, std::size_t cell, std::span<const double> weights) {
  std::array<double, 3> x{};
  for (std::size_t a = 0; a < weights.size(); ++a)
    for (std::size_t d = 0; d < 3; ++d) x[d] += weights[a] * mesh.point(static_cast<std::size_t>(mesh.cells[cell][a]))[d];
  return x;
}

class Locator : public testing::TestWithParam<CellType> {
 protected:
  const catalog::CellRow& row_ = catalog::cell(GetParam());

  /// A reference point: a mean of the vertices with random weights.
  std::vector<double> reference_point(std::mt19937& random) const {
    std::uniform_real_distribution<double> uniform(0.02, 1.0);
    std::vector<double> xi(static_cast<std::size_t>(row_.dimension), 0.0);
    double sum = 0;
    for (int v = 0; v < row_.n_vertices; ++v) {
      const double w = std::pow(uniform(random), 3);
      sum += w;
      for (std::size_t d = 0; d < xi.size(); ++d) xi[d] += w * row_.nodes[static_cast<std::size_t>(v * row_.dimension) + d];
    }
    for (double& x : xi) x /= sum;
    return xi;
  }
};

// The shape functions at the point that was mapped come back, so that every nodal field has its finite element value there.
TEST_P(Locator, gives_back_cell_and_shape_functions_of_distorted_and_curved_cells) {
  for (const bool curved : {false, true}) {
    const Mesh mesh = cells_in_a_row(GetParam(), curved, 0.12);
    const CellLocator locator(mesh, all_cells(mesh));
    std::mt19937 random(3);
    std::vector<double> shape(static_cast<std::size_t>(row_.n_nodes));
    for (std::size_t c = 0; c < mesh.n_cells(); ++c)
      for (int repeat = 0; repeat < 10; ++repeat) {
        shape_functions(GetParam(), reference_point(random), shape);
        const auto found = locator.find(image(mesh, c, shape), 0.0);
        ASSERT_TRUE(found);
        EXPECT_FALSE(found->outside);
        EXPECT_EQ(found->cell, static_cast<std::int32_t>(c));
        EXPECT_LT(found->distance, 1e-14 * 40);
        for (std::size_t a = 0; a < shape.size(); ++a) EXPECT_NEAR(found->weights[a], shape[a], 1e-12);
      }
  }
}

// Nodes, on the border of the reference cell (a pyramid's apex among them), belong to their cell.
TEST_P(Locator, finds_every_node) {
  const Mesh mesh = cells_in_a_row(GetParam(), true, 0.12);
  const CellLocator locator(mesh, all_cells(mesh));
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    for (std::size_t a = 0; a < mesh.cells[c].size(); ++a) {
      const auto p = mesh.point(static_cast<std::size_t>(mesh.cells[c][a]));
      const auto found = locator.find({p[0], p[1], p[2]}, 0.0);
      ASSERT_TRUE(found) << "node " << a << " of cell " << c;
      EXPECT_EQ(found->cell, static_cast<std::int32_t>(c));
      EXPECT_NEAR(found->weights[a], 1.0, 1e-9);
    }
}

// On affine quadratic cells every quadratic field, on distorted cells every linear one, is reproduced.
TEST_P(Locator, reproduces_fields_of_the_cells_degree) {
  for (const double distortion : {0.0, 0.12}) {
    const Mesh mesh = cells_in_a_row(GetParam(), distortion > 0, distortion);
    const CellLocator locator(mesh, all_cells(mesh));
    const double square = distortion == 0 && row_.order == 2 ? 1.0 : 0.0;
    const auto field = [&](std::span<const double> x) {
      return 0.3 + x[0] - 2 * x[1] + 0.7 * x[2] + square * (x[0] * x[0] - 3 * x[0] * x[1] + x[1] * x[2] + 0.5 * x[2] * x[2]);
    };
    std::mt19937 random(5);
    std::vector<double> shape(static_cast<std::size_t>(row_.n_nodes));
    for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
      shape_functions(GetParam(), reference_point(random), shape);
      const auto point = image(mesh, c, shape);
      const auto found = locator.find(point, 0.0);
      ASSERT_TRUE(found);
      double value = 0, scale = 1;
      for (std::size_t a = 0; a < shape.size(); ++a) {
        const double nodal = field(mesh.point(static_cast<std::size_t>(mesh.cells[static_cast<std::size_t>(found->cell)][a])));
        value += found->weights[a] * nodal;
        scale = std::max(scale, std::abs(nodal));
      }
      EXPECT_NEAR(value, field(point), 1e-12 * scale);
    }
  }
}

/// Points around the row of cells, most of them in no cell.
std::vector<std::array<double, 3>> points_around(const Mesh& mesh) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-1.0, 1.0), along(-1.0, 2.6 * n_cells);
  std::vector<std::array<double, 3>> points;
  for (int i = 0; i < 60; ++i) {
    const double x = along(random);
    points.push_back({x, 1.5 * place(random) + 0.3 / 2.6 * x, mesh.dimension == 3 ? 1.5 * place(random) + 0.3 / 2.6 * x : 0.0});
  }
  return points;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Points of the reference cell, on its facets among them: means of the vertices with weights of so many parts.
std::vector<std::vector<double>> samples_of(const catalog::CellRow& row, int parts) {
  std::vector<std::vector<double>> samples;
  std::vector<int> part(static_cast<std::size_t>(row.n_vertices));
  const auto add = [&](const auto& self, int vertex, int left) -> void {
    part[static_cast<std::size_t>(vertex)] = left;
    if (vertex + 1 == row.n_vertices) {
      std::vector<double> xi(static_cast<std::size_t>(row.dimension), 0.0);
      for (int v = 0; v < row.n_vertices; ++v)
        for (std::size_t d = 0; d < xi.size(); ++d)
          xi[d] += row.nodes[static_cast<std::size_t>(v * row.dimension) + d] * part[static_cast<std::size_t>(v)] / parts;
      samples.push_back(std::move(xi));
      return;
    }
    for (int here = 0; here <= left; ++here) {
      part[static_cast<std::size_t>(vertex)] = here;
      self(self, vertex + 1, left - here);
    }
  };
  add(add, 0, parts);
  return samples;
}

// No sample of any cell is nearer than what is found, and what is found is where its weights, shape functions of a point of the
// cell, put it: so it is the nearest point.
TEST_P(Locator, finds_the_nearest_point_of_space_for_points_outside) {
  const Mesh mesh = cells_in_a_row(GetParam(), true, 0.2);
  const CellLocator locator(mesh, all_cells(mesh));
  std::vector<std::array<double, 3>> places;
  std::vector<double> shape(static_cast<std::size_t>(row_.n_nodes));
  for (const auto& xi : samples_of(row_, row_.dimension == 2 ? 24 : 8)) {
    shape_functions(GetParam(), xi, shape);
    for (std::size_t c = 0; c < mesh.n_cells(); ++c) places.push_back(image(mesh, c, shape));
  }
  int outside = 0;
  for (const auto& point : points_around(mesh)) {
    const auto found = locator.find(point, HUGE_VAL);
    ASSERT_TRUE(found);
    outside += found->outside;
    EXPECT_NEAR(distance(image(mesh, static_cast<std::size_t>(found->cell), found->weights), point), found->distance, 1e-13);
    EXPECT_NEAR(std::accumulate(found->weights.begin(), found->weights.end(), 0.0), 1, 1e-13);
    double least = HUGE_VAL;
    for (const auto& place : places) least = std::min(least, distance(place, point));
    EXPECT_LE(found->distance, least + 1e-13);
    if (!found->outside) continue;
    EXPECT_FALSE(locator.find(point, found->distance * (1 - 1e-9)));
    EXPECT_TRUE(locator.find(point, found->distance * (1 + 1e-9)));
  }
  EXPECT_GT(outside, 20);
}

/// The other numberings of a kind of cell: where rotations of its reference cell bring each node.
std::vector<std::vector<int>> rotations(const catalog::CellRow& row) {
  const auto node = [&](int a) -> Eigen::VectorXd {
    return Eigen::Map<const Eigen::VectorXd>(row.nodes.data() + static_cast<std::ptrdiff_t>(a) * row.dimension, row.dimension);
  };
  std::vector<std::vector<int>> found;
  Eigen::MatrixXd from(row.dimension, row.dimension), to(row.dimension, row.dimension);
  std::vector<int> base{0};  // vertices that span the cell, and where they go
  for (int v = 1; v < row.n_vertices && static_cast<int>(base.size()) <= row.dimension; ++v) {
    from.col(static_cast<Eigen::Index>(base.size()) - 1) = node(v) - node(0);
    if (from.leftCols(static_cast<Eigen::Index>(base.size())).fullPivLu().rank() == static_cast<Eigen::Index>(base.size()))
      base.push_back(v);
  }
  std::vector<int> images(base.size());
  const auto choose = [&](const auto& self, std::size_t next) -> void {
    if (next < base.size()) {
      for (images[next] = 0; images[next] < row.n_vertices; ++images[next]) self(self, next + 1);
      return;
    }
    for (std::size_t i = 1; i < base.size(); ++i) to.col(static_cast<Eigen::Index>(i) - 1) = node(images[i]) - node(images[0]);
    const Eigen::MatrixXd turn = to * from.inverse();
    if (turn.determinant() < 1e-9) return;
    std::vector<int> goes;
    for (int a = 0; a < row.n_nodes; ++a)
      for (int b = 0; b < row.n_nodes; ++b)
        if ((node(images[0]) + turn * (node(a) - node(0)) - node(b)).norm() < 1e-9) goes.push_back(b);
    if (static_cast<int>(goes.size()) == row.n_nodes) found.push_back(goes);
  };
  choose(choose, 0);
  return found;
}

// The same cells with their vertices counted from elsewhere, in another order: the same points with the same values.
TEST_P(Locator, does_not_depend_on_how_nodes_and_cells_are_numbered) {
  const auto turned = rotations(row_);
  ASSERT_GE(turned.size(), 3u);
  for (const bool curved : {false, true}) {
    const Mesh mesh = cells_in_a_row(GetParam(), curved, 0.12);
    Mesh other;
    other.dimension = mesh.dimension;
    other.coordinates = mesh.coordinates;
    for (std::size_t c = mesh.n_cells(); c-- > 0;) {
      const auto& order = turned[(5 * c + 1) % turned.size()];
      std::vector<std::int32_t> nodes;
      for (const int a : order) nodes.push_back(mesh.cells[c][static_cast<std::size_t>(a)]);
      other.add_cell(GetParam(), nodes);
    }
    const CellLocator one(mesh, all_cells(mesh)), two(other, all_cells(other));
    for (const auto& point : points_around(mesh)) {
      const auto a = one.find(point, HUGE_VAL), b = two.find(point, HUGE_VAL);
      ASSERT_TRUE(a && b);
      EXPECT_EQ(a->cell, static_cast<std::int32_t>(mesh.n_cells()) - 1 - b->cell);
      EXPECT_EQ(a->outside, b->outside);
      EXPECT_NEAR(a->distance, b->distance, 1e-13);
      std::vector<double> weights(mesh.n_nodes(), 0.0);
      for (std::size_t i = 0; i < a->weights.size(); ++i) {
        weights[static_cast<std::size_t>(mesh.cells[static_cast<std::size_t>(a->cell)][i])] += a->weights[i];
        weights[static_cast<std::size_t>(other.cells[static_cast<std::size_t>(b->cell)][i])] -= b->weights[i];
      }
      for (const double w : weights) EXPECT_NEAR(w, 0, 1e-11);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cells, Locator, testing::ValuesIn(body_types()),
                         [](const auto& one) { return std::string(catalog::cell(one.param).name); });

Mesh unit_square() {
  Mesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  mesh.add_cell(CellType::QUAD4, std::vector<std::int32_t>{0, 1, 2, 3});
  return mesh;
}

// Of a point outside the nearest one counts: within DISTANCE_MAX, or within a tenth of the diagonal.
TEST(LocatorOutside, takes_the_nearest_point_within_the_limit) {
  const Mesh mesh = unit_square();
  const CellLocator locator(mesh, all_cells(mesh));
  for (const auto& [point, foot] : std::vector<std::pair<std::array<double, 3>, std::array<double, 3>>>{
           {{0.25, 1.1, 0}, {0.25, 1, 0}}, {{-0.05, -0.1, 0}, {0, 0, 0}}, {{1.125, 0.5, 0}, {1, 0.5, 0}}}) {
    const double distance = std::hypot(point[0] - foot[0], point[1] - foot[1]);
    for (const std::optional<double> limit : {std::optional<double>{}, std::optional<double>{distance * 1.001}}) {
      const auto found = locator.find(point, limit);
      ASSERT_TRUE(found);
      EXPECT_TRUE(found->outside);
      EXPECT_NEAR(found->distance, distance, 1e-14);
      for (std::size_t d = 0; d < 2; ++d) EXPECT_NEAR(image(mesh, 0, found->weights)[d], foot[d], 1e-14);
    }
    EXPECT_FALSE(locator.find(point, distance * 0.999));
  }
  EXPECT_FALSE(locator.find({0.5, 1.2, 0}, std::nullopt));
  EXPECT_TRUE(locator.find({0.5, 1.2, 0}, 0.3));
}

// A point in a notch that is as far from two facets has the same nearest point whatever the order of the cells.
TEST(LocatorOutside, takes_the_same_of_two_nearest_points_in_any_order) {
  Mesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0, 1, 2, 0, 0, 2, 0};
  mesh.add_cell(CellType::QUAD4, std::vector<std::int32_t>{0, 1, 2, 3});
  mesh.add_cell(CellType::QUAD4, std::vector<std::int32_t>{1, 4, 5, 2});
  mesh.add_cell(CellType::QUAD4, std::vector<std::int32_t>{3, 2, 6, 7});
  std::vector<std::int32_t> order{0, 1, 2};
  do {
    const auto found = CellLocator(mesh, order).find({1.25, 1.25, 0}, HUGE_VAL);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->cell, 2);
    const auto place = image(mesh, static_cast<std::size_t>(found->cell), found->weights);
    EXPECT_NEAR(place[0], 1, 1e-14);
    EXPECT_NEAR(place[1], 1.25, 1e-14);
  } while (std::next_permutation(order.begin(), order.end()));
}

// Cells that are not given are not searched: points of an interface belong to the side that is asked.
TEST(LocatorOutside, searches_the_given_cells_only) {
  Mesh mesh = unit_square();
  mesh.coordinates.insert(mesh.coordinates.end(), {0, 1, 0, 1, 1, 0, 1, 2, 0, 0, 2, 0});
  mesh.add_cell(CellType::QUAD4, std::vector<std::int32_t>{4, 5, 6, 7});
  const std::int32_t upper = 1;
  EXPECT_EQ(CellLocator(mesh, all_cells(mesh)).find({0.5, 1, 0}, 0.0)->cell, 0);
  EXPECT_EQ(CellLocator(mesh, {&upper, 1}).find({0.5, 1, 0}, 0.0)->cell, 1);
  EXPECT_FALSE(CellLocator(mesh, {&upper, 1}).find({0.5, 0.5, 0}, std::nullopt));
}

}  // namespace
