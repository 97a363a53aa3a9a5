// Loops over elements: what a set gives is what its elements give one by one, in any number of threads.
#include "lacon/assembly/element_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "lacon/assembly/sparse_matrix.hpp"
#include "lacon/catalog/messages.hpp"

namespace {

using namespace lacon;

/// A bar of shaken HEXA8, more of them than a few batches hold.
struct Bar : testing::Test {
  static constexpr std::int32_t n = 700;
  Mesh mesh;
  Model model;
  MaterialField field;
  Registry registry;
  std::vector<double> displacement;

  Bar() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shake(-0.1, 0.1);
    constexpr int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (std::int32_t layer = 0; layer <= n; ++layer)
      for (const auto& [x, y] : corner)
        for (const double coordinate : {1.0 * x, 1.0 * y, 1.0 * layer}) {
          mesh.coordinates.push_back(coordinate + shake(random));
          displacement.push_back(0.2 * shake(random));
        }
    std::vector<std::int32_t> nodes(8);
    for (std::int32_t cell = 0; cell < n; ++cell) {
      for (std::int32_t i = 0; i < 8; ++i) nodes[static_cast<std::size_t>(i)] = 4 * cell + i;
      mesh.add_cell(CellType::HEXA8, nodes);
    }
    model.elements = {"3D/HEXA8"};
    model.element.assign(n, 0);
    field.materials = {"material_1"};
    field.material.assign(n, 0);
  }
  void TearDown() override { unsetenv("LACON_THREADS"); }

  ElementSet set_of(const std::string& option) {
    const MaterialTable materials(
        field, {{{{"ELAS", {{"E", 200.0}, {"NU", 0.3}}}, {"ECRO_LINE", {{"SY", 1.0}, {"D_SIGM_EPSI", 20.0}}}}}}, {"STEEL"});
    return solid_sets(mesh, model, registry, materials, {{option}, std::vector<std::int32_t>(n, 0)}).front();
  }

  struct Sums {
    std::vector<double> matrix, force, stress, variable;
    std::vector<std::int32_t> cells, columns;  // of the matrix: its pattern
    std::optional<std::int32_t> inside_out;
    bool operator==(const Sums&) const = default;
  };
  /// What sets give together.
  Sums sums(const std::vector<ElementSet>& sets, SolidMatrix wanted = SolidMatrix::tangent) const {
    const Numbering numbering = number_equations(static_cast<std::int64_t>(mesh.n_nodes()), 3,
                                                 std::vector<std::uint8_t>(mesh.coordinates.size(), 1), 0);
    SparseMatrix matrix(numbering, mesh.cells, {});
    Sums all;
    all.force.assign(displacement.size(), 0.0);
    std::vector<std::int64_t> equations;
    for (const ElementSet& set : sets) {
      std::vector<double> stress(set.cells.size() * set.n_stress()), variable(set.cells.size() * set.n_variables());
      const auto inside_out = evaluate_solids(set, mesh, {.displacement = displacement}, wanted, {stress, variable},
                                              [&](const ElementValues& element) {
                                                equations.clear();
                                                for (const std::int32_t node : mesh.cells[element.cell])
                                                  for (int d = 0; d < 3; ++d) equations.push_back(numbering.of(node, d));
                                                if (!element.matrix.empty()) matrix.add(equations, element.matrix);
                                                for (std::size_t i = 0; i < equations.size(); ++i)
                                                  all.force[equations[i]] += element.force[i];
                                                all.cells.push_back(element.cell);
                                              });
      if (!all.inside_out) all.inside_out = inside_out;
      all.stress.insert(all.stress.end(), stress.begin(), stress.end());
      all.variable.insert(all.variable.end(), variable.begin(), variable.end());
    }
    all.matrix.assign(matrix.values().begin(), matrix.values().end());
    all.columns.assign(matrix.columns().begin(), matrix.columns().end());
    return all;
  }
};

TEST_F(Bar, TheBitsAreThoseOfTheElementsOneByOneForAnyNumberOfThreads) {
  for (const char* option : {"ELAS/PETIT", "ELAS/GREEN_LAGRANGE", "VMIS_ISOT_LINE/PETIT"}) {
    const std::vector<ElementSet> whole = {set_of(option)};
    std::vector<ElementSet> one_by_one;
    for (const std::int32_t cell : whole[0].cells) {
      one_by_one.push_back(whole[0]);
      one_by_one.back().cells = {cell};
      one_by_one.back().parameters.resize(2);  // all elements have the same
    }
    const Sums expected = sums(one_by_one);
    EXPECT_GT(*std::max_element(expected.matrix.begin(), expected.matrix.end()), 10);
    EXPECT_NE(expected.stress, std::vector<double>(expected.stress.size(), 0.0));
    for (const char* threads : {"1", "2", "3", "5"}) {
      setenv("LACON_THREADS", threads, 1);
      EXPECT_TRUE(sums(whole) == expected) << option << ", " << threads << " threads";
      Sums forces = sums(whole, SolidMatrix::none);
      EXPECT_EQ(forces.matrix, std::vector<double>(expected.matrix.size(), 0.0));
      forces.matrix = expected.matrix;
      EXPECT_TRUE(forces == expected) << option << ", forces alone, " << threads << " threads";
    }
    unsetenv("LACON_THREADS");
  }
}

// Where all nodes are moved by one affine map, points are those of the reference cell, moved by it.
TEST_F(Bar, PointsOfAffineCellsAreMovedAsTheirNodes) {
  for (std::int32_t cell = 0; cell <= n; ++cell)
    for (std::int32_t i = 0; i < 4; ++i) {
      const double x = i == 1 || i == 2, y = i > 1, z = cell;
      double* const at = mesh.coordinates.data() + 3 * (4 * cell + i);
      at[0] = 2 * x + 0.5 * z, at[1] = y - 0.3 * x, at[2] = z + 0.1 * y + 7;
    }
  const ElementSet set = set_of("ELAS/PETIT");
  const std::vector<double> points = integration_points(set, mesh, mesh.coordinates);
  const Rule& rule = integration_rule(Family::HEXA, set.tabulation.n_points);
  ASSERT_EQ(points.size(), static_cast<std::size_t>(3 * n * rule.size()));
  for (std::int32_t cell = 0, at = 0; cell < n; ++cell)
    for (int p = 0; p < rule.size(); ++p, at += 3) {
      const double x = (1 + rule.points[3 * p]) / 2, y = (1 + rule.points[3 * p + 1]) / 2,
                   z = cell + (1 + rule.points[3 * p + 2]) / 2;
      EXPECT_NEAR(points[at], 2 * x + 0.5 * z, 1e-12);
      EXPECT_NEAR(points[at + 1], y - 0.3 * x, 1e-13);
      EXPECT_NEAR(points[at + 2], z + 0.1 * y + 7, 1e-12);
    }
}

TEST_F(Bar, TheFirstCellThatTurnsInsideOutIsNamed) {
  const std::vector<ElementSet> set = {set_of("ELAS/GREEN_LAGRANGE")};
  for (const std::int32_t cell : {650, 333})  // in batches of their own
    for (std::size_t i = 12 * static_cast<std::size_t>(cell); i < 12 * static_cast<std::size_t>(cell) + 12; i += 3)
      displacement[i + 2] = 1.5;  // the lower face above the upper one
  for (const char* threads : {"1", "2", "3", "5"}) {
    setenv("LACON_THREADS", threads, 1);
    EXPECT_EQ(sums(set).inside_out, 333) << threads << " threads";
  }
}

TEST_F(Bar, ThePlainErrorOfTheFirstBadCellsIsTold) {
  const std::vector<ElementSet> set = {set_of("ELAS/PETIT")};
  for (const std::int32_t cell : {660, 334, 333})
    for (std::size_t i = 12 * static_cast<std::size_t>(cell); i < 12 * static_cast<std::size_t>(cell) + 12; i += 3)
      mesh.coordinates[i + 2] = mesh.coordinates[i + 12 + 2] + 0.5;
  std::string first;
  for (const char* threads : {"1", "2", "3", "5"}) {
    setenv("LACON_THREADS", threads, 1);
    try {
      sums(set);
      FAIL() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.message().id, "ELEMENT_1");
      EXPECT_NE(error.message().text.find(cell_name(333)), std::string::npos) << error.message().text;
      EXPECT_NE(error.message().text.find("the Jacobian is zero, negative or of mixed sign"), std::string::npos)
          << error.message().text;
      if (first.empty()) first = error.message().text;
      EXPECT_EQ(error.message().text, first) << threads << " threads";
    }
  }
}

}  // namespace
