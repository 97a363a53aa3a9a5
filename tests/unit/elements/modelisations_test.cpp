// Solid and load kernels of every modelisation: what holds for all of them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

#include "solids.hpp"

namespace {

using lacon::CellType;
using Numbers = std::vector<double>;

constexpr double steel_young = 2.1e5, steel_poisson = 0.3;

struct Result {
  Numbers matrix, force, stress;
  int error = -1;
};

/// One element, in every lane. @param x, u (n_nodes, dimension)
Result run_solid(const lacon::catalog::ElementRow& row, const Numbers& x, const Numbers& u,
                 std::string_view option = "ELAS/PETIT") {
  const auto table = table_of(row);
  const auto spread = [](const Numbers& values) {
    Numbers all;
    for (const double value : values) all.insert(all.end(), LACON_LANES, value);
    return all;
  };
  const Numbers xs = spread(x), us = spread(u), material = spread({steel_young, steel_poisson});
  const std::size_t n = x.size();
  Numbers matrix(n * (n + 1) / 2 * LACON_LANES, garbage), force(n * LACON_LANES, garbage),
      stress(z(table.n_points) * row.stress.size() * LACON_LANES, garbage);
  std::vector<std::int32_t> error(LACON_LANES, -1);
  const lacon_solid_batch batch{sizeof(lacon_solid_batch),
                                1,
                                table.n_nodes,
                                static_cast<int>(row.dofs.size()),
                                table.n_points,
                                static_cast<int>(row.stress.size()),
                                2,
                                table.shape.data(),
                                table.gradient.data(),
                                table.weight.data(),
                                xs.data(),
                                us.data(),
                                material.data(),
                                matrix.data(),
                                force.data(),
                                stress.data(),
                                error.data()};
  registry().kernel(row, option, LACON_SOLID).solid(&batch);
  const auto first = [](const Numbers& lanes) {
    Numbers values;
    for (std::size_t i = 3; i < lanes.size(); i += LACON_LANES) values.push_back(lanes[i]);  // of lane 3
    return values;
  };
  return {first(matrix), first(force), first(stress), error[3]};
}

Result run_pressure(const lacon::catalog::ElementRow& row, const Numbers& x, double value) {
  const auto table = table_of(row);
  const int n_values = row.dofs.size() == 2 ? 2 : 1;  // pressure, and shear in the plane
  Numbers xs, values(z(table.n_points * n_values) * LACON_LANES, 0.0), force(x.size() * LACON_LANES, garbage);
  for (const double coordinate : x) xs.insert(xs.end(), LACON_LANES, coordinate);
  for (int p = 0; p < table.n_points; ++p) std::fill_n(values.begin() + p * n_values * LACON_LANES, LACON_LANES, value);
  std::vector<std::int32_t> error(LACON_LANES, -1);
  const lacon_load_batch batch{sizeof(lacon_load_batch),
                               1,
                               table.n_nodes,
                               static_cast<int>(row.dofs.size()),
                               table.n_points,
                               table.dimension,
                               n_values,
                               table.shape.data(),
                               table.gradient.data(),
                               table.weight.data(),
                               xs.data(),
                               values.data(),
                               force.data(),
                               nullptr,
                               error.data()};
  registry().kernel(row, "CHAR_MECA_PRES", LACON_LOAD).load(&batch);
  Numbers own;
  for (std::size_t i = 3; i < force.size(); i += LACON_LANES) own.push_back(force[i]);
  return {{}, own, {}, error[3]};
}

struct Modelisation : testing::TestWithParam<const lacon::catalog::ElementRow*> {
  const lacon::catalog::ElementRow& row = *GetParam();
  const lacon::catalog::CellRow& cell = lacon::catalog::cell(row.cell);
  const int D = cell.dimension;
  const bool axis = row.geometry == lacon::catalog::Geometry::axis,
             plane_stress = row.stress_state == lacon::catalog::StressState::plane_stress;
  Numbers x = shaken(cell);
  /// u = gradient x
  Numbers linear(const double (&gradient)[3][3]) const {
    Numbers u;
    for (int a = 0; a < cell.n_nodes; ++a)
      for (int i = 0; i < D; ++i) {
        double value = 0;
        for (int k = 0; k < D; ++k) value += gradient[i][k] * x[z(a * D + k)];
        u.push_back(value);
      }
    return u;
  }
};

TEST_P(Modelisation, ConstantStrainGivesTheStressOfHookesLaw) {
  double g[3][3] = {{1.3e-3, 4e-4, -3e-4}, {8e-4, -0.7e-3, 6e-4}, {-1e-4, 2e-4, 0.5e-3}};
  if (axis) g[0][1] = 0;  // u_r / r is constant for u_r = c r alone
  double e[6] = {g[0][0], g[1][1], 0, g[0][1] + g[1][0], g[0][2] + g[2][0], g[1][2] + g[2][1]};
  if (D == 3) e[2] = g[2][2];
  if (axis) e[2] = g[0][0];
  if (plane_stress) e[2] = -steel_poisson / (1 - steel_poisson) * (e[0] + e[1]);
  const auto result = run_solid(row, x, linear(g));
  ASSERT_EQ(result.error, LACON_FINE);
  const double twice_mu = steel_young / (1 + steel_poisson), lambda = twice_mu * steel_poisson / (1 - 2 * steel_poisson);
  for (std::size_t i = 0; i < result.stress.size(); ++i) {
    const std::size_t c = i % row.stress.size();
    const double exact = c < 3 ? lambda * (e[0] + e[1] + e[2]) + twice_mu * e[c] : twice_mu / 2 * e[c];
    EXPECT_NEAR(result.stress[i], exact, 1e-12 * steel_young * 1e-2) << row.stress[c];
  }
}

TEST_P(Modelisation, AHydrostaticStateIsInBalanceWithThePressureOnItsFacets) {
  // int div(N_a e_i) = boundary int N_a n_i: with every rule exact this is the patch test of any constant stress
  const double strain = 1e-3, p = -(plane_stress      ? steel_young / (1 - steel_poisson)
                                    : D == 2 && !axis ? steel_young / ((1 + steel_poisson) * (1 - 2 * steel_poisson))
                                                      : steel_young / (1 - 2 * steel_poisson)) *
                                  strain;
  const auto result = run_solid(row, x, linear({{strain, 0, 0}, {0, strain, 0}, {0, 0, strain}}));
  ASSERT_EQ(result.error, LACON_FINE);
  Numbers sum = result.force;
  for (const auto& facet : cell.facets) {
    Numbers points;
    for (const auto a : facet.nodes)
      for (int i = 0; i < D; ++i) points.push_back(x[z(a * D + i)]);
    const auto* skin = registry().find_element(row.modelisation, facet.type);
    ASSERT_NE(skin, nullptr);
    const auto load = run_pressure(*skin, points, p);
    ASSERT_EQ(load.error, LACON_FINE);
    for (std::size_t k = 0; k < facet.nodes.size(); ++k)
      for (int i = 0; i < D; ++i) sum[z(facet.nodes[k] * D + i)] -= load.force[k * z(D) + z(i)];
  }
  double largest = 0;
  for (const double f : result.force) largest = std::max(largest, std::abs(f));
  EXPECT_GT(largest, 1);
  for (const double f : sum) EXPECT_NEAR(f, 0, 1e-12 * std::abs(p) * 10);
}

TEST_P(Modelisation, RigidMotionsGiveNoForce) {
  std::vector<Numbers> motions;
  for (int i = axis ? 1 : 0; i < D; ++i) {
    Numbers u(x.size(), 0.0);
    for (std::size_t k = z(i); k < u.size(); k += z(D)) u[k] = 1;
    motions.push_back(u);
  }
  if (!axis) motions.push_back(linear({{0, -1, 0}, {1, 0, 0}, {0, 0, 0}}));
  if (D == 3) {
    motions.push_back(linear({{0, 0, 1}, {0, 0, 0}, {-1, 0, 0}}));
    motions.push_back(linear({{0, 0, 0}, {0, 0, -1}, {0, 1, 0}}));
  }
  for (const Numbers& u : motions)
    for (const double f : run_solid(row, x, u).force) EXPECT_NEAR(f, 0, 1e-12 * steel_young * 10);
  if (axis) {  // moving away from the axis is none: the hoop is stretched
    Numbers u(x.size(), 0.0);
    for (std::size_t k = 0; k < u.size(); k += 2) u[k] = 1;
    EXPECT_GT(std::abs(run_solid(row, x, u).force[0]), 1e-3 * steel_young);
  }
}

TEST_P(Modelisation, StiffnessIsTheDerivativeOfTheForce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  Numbers u(x.size());
  for (double& value : u) value = number(random);
  const auto result = run_solid(row, x, u);
  double largest = 0;
  for (const double entry : result.matrix) largest = std::max(largest, std::abs(entry));
  for (std::size_t j = 0; j < u.size(); ++j) {
    Numbers low = u, high = u;
    low[j] -= 1;  // forces are linear: a step of 1 has no truncation error
    high[j] += 1;
    const auto before = run_solid(row, x, low), after = run_solid(row, x, high);
    for (std::size_t i = 0; i < u.size(); ++i) {
      const std::size_t entry = std::max(i, j) * (std::max(i, j) + 1) / 2 + std::min(i, j);
      EXPECT_NEAR((after.force[i] - before.force[i]) / 2, result.matrix[entry], 1e-12 * largest * 10) << i << ' ' << j;
    }
  }
}

TEST_P(Modelisation, BadCellsAreCaught) {
  const Numbers zero(x.size(), 0.0);
  Numbers wrong = x, flat = x;
  for (std::size_t a = 0; a < cell.mirror.size(); ++a)
    for (int i = 0; i < D; ++i) wrong[a * z(D) + z(i)] = x[z(cell.mirror[a] * D + i)];
  EXPECT_EQ(run_solid(row, wrong, zero).error, LACON_BAD_JACOBIAN);
  for (std::size_t k = z(D - 1); k < flat.size(); k += z(D)) flat[k] = 0.3 * flat[k - 1] + 5;  // all nodes in a plane or line
  EXPECT_EQ(run_solid(row, flat, zero).error, LACON_BAD_JACOBIAN);
  Numbers sliver = x;
  for (std::size_t k = z(D - 1); k < sliver.size(); k += z(D)) sliver[k] *= 1e-6;
  EXPECT_EQ(run_solid(row, sliver, zero).error, LACON_FINE);
  Numbers nan = zero;
  nan[1] = std::nan("");
  EXPECT_EQ(run_solid(row, x, nan).error, LACON_NOT_FINITE);
  if (!axis) return;
  Numbers over = x, touching = x;
  double least = x[0];
  for (std::size_t k = 0; k < x.size(); k += 2) least = std::min(least, x[k]);
  for (std::size_t k = 0; k < x.size(); k += 2) over[k] -= least + 0.01, touching[k] -= least;
  EXPECT_EQ(run_solid(row, over, zero).error, LACON_BAD_RADIUS);
  EXPECT_EQ(run_solid(row, touching, zero).error, LACON_FINE);
  for (double& coordinate : touching) coordinate -= 1e-7;  // round-off of a file in single precision
  EXPECT_EQ(run_solid(row, touching, zero).error, LACON_FINE);
}

/// Where no load holds the nodes of the axis they move by the error of the discretisation, to either side.
TEST_P(Modelisation, ADisplacedNodeMayBeBeyondTheAxisWhileTheIntegrationPointsAreNot) {
  if (!axis) return;
  Numbers u(x.size(), 0.0);
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < x.size(); k += 2)
    if (x[k] < x[nearest]) nearest = k;
  const double least = x[nearest];
  for (std::size_t k = 0; k < x.size(); k += 2) x[k] -= least;
  for (const char* option : {"ELAS/PETIT_REAC", "ELAS/GREEN_LAGRANGE"}) {
    u[nearest] = -1e-3;
    EXPECT_EQ(run_solid(row, x, u, option).error, LACON_FINE) << option;
    for (std::size_t k = 0; k < u.size(); k += 2) u[k] = -5;
    EXPECT_NE(run_solid(row, x, u, option).error, LACON_FINE) << option;
    std::fill(u.begin(), u.end(), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Modelisation, testing::ValuesIn(solids()), [](const auto& row) { return test_name(*row.param); });

/// Resultant (r, z) of the pressure 2 on a disc.
std::array<double, 2> thrust(const lacon::catalog::ElementRow& row, const Numbers& disc) {
  const auto result = run_pressure(row, disc, 2.0);
  EXPECT_EQ(result.error, LACON_FINE);
  std::array<double, 2> sum = {};
  for (std::size_t i = 0; i < result.force.size(); ++i) sum[i % 2] += result.force[i];
  return sum;
}

TEST(AxisPressure, IsThatOfOneRadianAndStopsAtTheAxis) {
  // on a disc of radius 3, body below: f_z sums up to -p r^2 / 2
  for (const CellType type : {CellType::SEG2, CellType::SEG3}) {
    const auto& row = *registry().find_element("AXIS", type);
    Numbers disc = type == CellType::SEG2 ? Numbers{3, 1, 0, 1} : Numbers{3, 1, 0, 1, 1.5, 1};
    EXPECT_NEAR(thrust(row, disc)[0], 0, 1e-14);
    EXPECT_NEAR(thrust(row, disc)[1], -9, 1e-13);
    // beyond the axis by round-off, and by what the error of the discretisation moves a node that no load holds: the integral
    // of -p r dr is a polynomial all the same
    for (const double beyond : {1e-9, 1e-7, 1e-3, 0.1}) {
      disc[2] = -beyond;
      if (type == CellType::SEG3) disc[4] = (3 - beyond) / 2;
      EXPECT_NEAR(thrust(row, disc)[1], -9 + beyond * beyond, 1e-13) << beyond;
    }
    disc[2] = -0.5;
    EXPECT_EQ(run_pressure(row, disc, 2.0).error, LACON_BAD_RADIUS);
  }
}

TEST(AxisPressure, ASkinThatLiesOnTheAxisBearsNothing) {
  const auto& row = *registry().find_element("AXIS", CellType::SEG3);
  for (const double r : {0.0, -1e-12, -1e-3}) {
    const auto sum = thrust(row, {r, 0, r, 2, r, 1});
    EXPECT_EQ(sum[0], 0) << r;
    EXPECT_EQ(sum[1], 0) << r;
  }
}

TEST(AxisPressure, AMidNodeNearTheAxisMakesNoNegativeRadius) {
  // from the axis to r = 3 with the mid node at 0.2 of the way: -0.05 at the least between nodes that are all at r >= 0
  const auto& row = *registry().find_element("AXIS", CellType::SEG3);
  EXPECT_LT(thrust(row, {3, 1, 0, 1, 0.6, 1})[1], 0);
}

}  // namespace
