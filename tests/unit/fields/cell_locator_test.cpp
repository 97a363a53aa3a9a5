// Points in cells: the inverse of the isoparametric map for every kind of cell, straight or curved, among many; points outside.
#include "lacon/operators/fields/cell_locator.hpp"

#include <gtest/gtest.h>

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
      EXPECT_NEAR(found->distance, distance, 1e-7);
      for (std::size_t d = 0; d < 2; ++d) EXPECT_NEAR(image(mesh, 0, found->weights)[d], foot[d], 1e-7);
    }
    EXPECT_FALSE(locator.find(point, distance * 0.999));
  }
  EXPECT_FALSE(locator.find({0.5, 1.2, 0}, std::nullopt));
  EXPECT_TRUE(locator.find({0.5, 1.2, 0}, 0.3));
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
