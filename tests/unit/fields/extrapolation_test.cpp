// From integration points to nodes: linear fields are exact, single points are constant, shared nodes have the mean.
#include "lacon/operators/fields/extrapolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

#include "lacon/elements/reference.hpp"

namespace {

using namespace lacon;

struct Case {
  const char* cell;
  int points;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.cell << " with " << c.points << " points"; }

class Extrapolation : public testing::TestWithParam<Case> {
 protected:
  const CellType type_ = *catalog::find_cell(GetParam().cell);
  const catalog::CellRow& cell_ = catalog::cell(type_);
  const int n_points_ = GetParam().points;
  const std::vector<double> matrix_ = extrapolation_matrix(type_, n_points_);

  double at_node(int node, const std::vector<double>& point_values) const {
    return std::inner_product(point_values.begin(), point_values.end(), matrix_.begin() + node * n_points_, 0.0);
  }
};

/// a + b . x at the nodes or points of reference coordinates `at`.
double linear(std::span<const double> at) {
  double value = 0.7;
  for (std::size_t d = 0; d < at.size(); ++d) value += (1.0 + 0.5 * static_cast<double>(d)) * at[d];
  return value;
}

TEST_P(Extrapolation, A_constant_stays_as_it_is) {
  for (int a = 0; a < cell_.n_nodes; ++a)
    EXPECT_NEAR(at_node(a, std::vector<double>(static_cast<std::size_t>(n_points_), 3.0)), 3.0, 1e-14);
}

TEST_P(Extrapolation, A_linear_field_is_exact_at_every_node_given_enough_points) {
  if (n_points_ < cell_.n_vertices) {
    EXPECT_EQ(n_points_, 1) << "the one case in which the mean is what is left";
    return;
  }
  const auto d = static_cast<std::size_t>(cell_.dimension);
  const Rule& rule = integration_rule(cell_.family, n_points_);
  std::vector<double> values;
  for (std::size_t p = 0; p < static_cast<std::size_t>(n_points_); ++p)
    values.push_back(linear(std::span(rule.points).subspan(p * d, d)));
  for (int a = 0; a < cell_.n_nodes; ++a)
    EXPECT_NEAR(at_node(a, values), linear(cell_.nodes.subspan(static_cast<std::size_t>(a) * d, d)), 1e-13) << "node " << a;
}

TEST_P(Extrapolation, A_middle_node_has_the_mean_of_its_edge) {
  if (cell_.order == 1) {
    EXPECT_EQ(cell_.n_nodes, cell_.n_vertices);
    return;
  }
  std::vector<double> values;
  for (int p = 0; p < n_points_; ++p) values.push_back(std::sin(1.0 + 3.0 * p));
  for (std::size_t e = 0; e < cell_.edges.size(); ++e)
    EXPECT_NEAR(at_node(cell_.n_vertices + static_cast<int>(e), values),
                0.5 * (at_node(cell_.edges[e].first, values) + at_node(cell_.edges[e].second, values)), 1e-14);
}

TEST_P(Extrapolation, The_fit_leaves_a_residual_that_no_linear_shape_function_sees) {
  if (n_points_ < cell_.n_vertices) {
    EXPECT_EQ(n_points_, 1);
    return;
  }
  const auto d = static_cast<std::size_t>(cell_.dimension);
  const Rule& rule = integration_rule(cell_.family, n_points_);
  std::vector<double> values, shape(static_cast<std::size_t>(cell_.n_vertices)), moment(shape.size(), 0.0);
  for (int p = 0; p < n_points_; ++p) values.push_back(std::cos(2.0 + 5.0 * p));
  for (std::size_t p = 0; p < static_cast<std::size_t>(n_points_); ++p) {
    shape_functions(cell_.linear, std::span(rule.points).subspan(p * d, d), shape);
    double residual = values[p];
    for (int a = 0; a < cell_.n_vertices; ++a) residual -= shape[static_cast<std::size_t>(a)] * at_node(a, values);
    for (std::size_t a = 0; a < moment.size(); ++a) moment[a] += shape[a] * residual;
  }
  for (const double m : moment) EXPECT_NEAR(m, 0.0, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(All, Extrapolation,
                         testing::Values(Case{"SEG2", 2}, Case{"SEG3", 4}, Case{"TRIA3", 1}, Case{"TRIA6", 3}, Case{"TRIA6", 6},
                                         Case{"QUAD4", 4}, Case{"QUAD8", 9}, Case{"QUAD9", 9}, Case{"TETRA4", 1},
                                         Case{"TETRA10", 5}, Case{"PENTA6", 6}, Case{"PENTA15", 21}, Case{"PYRAM5", 5},
                                         Case{"PYRAM13", 27}, Case{"HEXA8", 8}, Case{"HEXA20", 27}, Case{"HEXA27", 27}),
                         [](const auto& tested) {
                           return std::string(tested.param.cell) + "_" + std::to_string(tested.param.points);
                         });

/// Two squares side by side, (0, 0) to (2, 1), the second one cut into two triangles.
Mesh three_cells() {
  Mesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0};
  mesh.add_cell(CellType::QUAD4, std::vector<std::int32_t>{0, 1, 4, 3});
  mesh.add_cell(CellType::TRIA3, std::vector<std::int32_t>{1, 2, 5});
  mesh.add_cell(CellType::TRIA3, std::vector<std::int32_t>{1, 5, 4});
  return mesh;
}

Field stresses(std::vector<std::int32_t> support, std::vector<std::int64_t> offset, std::vector<double> values) {
  Field field;
  field.name = "SIEF_ELGA";
  field.quantity = "SIEF_R";
  field.location = Location::gauss_points;
  field.components = {"SIXX"};
  field.support = std::move(support);
  field.offset = std::move(offset);
  field.values = std::move(values);
  field.order = 3;
  field.instant = 0.5;
  return field;
}

TEST(Nodes, A_shared_node_has_the_mean_over_its_cells) {
  const Mesh mesh = three_cells();
  const Field points = stresses({0, 1, 2}, {0, 4, 5, 6}, {1, 1, 1, 1, 4, 10});
  const Field cells = gauss_points_to_cell_nodes(mesh, points, "SIEF_ELNO");
  EXPECT_EQ(cells.offset, (std::vector<std::int64_t>{0, 4, 7, 10}));
  const Field nodes = cell_nodes_to_nodes(mesh, cells, "SIEF_NOEU");
  EXPECT_EQ(nodes.name, "SIEF_NOEU");
  EXPECT_EQ(nodes.location, Location::nodes);
  EXPECT_EQ(nodes.order, 3);
  EXPECT_EQ(nodes.instant, 0.5);
  EXPECT_EQ(nodes.support, (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5}));
  const std::vector<double> mean{1, 5, 4, 1, 5.5, 7};
  for (std::size_t n = 0; n < mean.size(); ++n) EXPECT_NEAR(nodes.values[n], mean[n], 1e-14) << "node " << n;
}

TEST(Nodes, Only_nodes_of_the_fields_cells_have_values) {
  const Mesh mesh = three_cells();
  const Field points = restrict_to_cells(stresses({0, 1, 2}, {0, 4, 5, 6}, {1, 1, 1, 1, 4, 10}), {0, 1, 0});
  EXPECT_EQ(points.support, (std::vector<std::int32_t>{1}));
  EXPECT_EQ(points.offset, (std::vector<std::int64_t>{0, 1}));
  const Field nodes = cell_nodes_to_nodes(mesh, gauss_points_to_cell_nodes(mesh, points, "SIEF_ELNO"), "SIEF_NOEU");
  EXPECT_EQ(nodes.support, (std::vector<std::int32_t>{1, 2, 5}));
  for (const double value : nodes.values) EXPECT_EQ(value, 4);
}

TEST(Nodes, A_component_that_a_cell_lacks_does_not_count) {
  const Mesh mesh = three_cells();
  Field points = stresses({0, 1}, {0, 4, 5}, {1, 1, 1, 1, 0});
  points.present = {1, 1, 1, 1, 0};
  const Field nodes = cell_nodes_to_nodes(mesh, gauss_points_to_cell_nodes(mesh, points, "SIEF_ELNO"), "SIEF_NOEU");
  ASSERT_EQ(nodes.support, (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_NEAR(nodes.values[1], 1.0, 1e-14) << "shared with the cell that has no value";
  EXPECT_EQ(nodes.present, (std::vector<std::uint8_t>{1, 1, 0, 1, 1, 0}));
}

}  // namespace
