// Kernels of solid and load elements.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include "lacon/elements/reference.hpp"
#include "lacon/elements/registry.hpp"
#include "solids.hpp"

namespace {

using lacon::CellType;
using Numbers = std::vector<double>;

/// Values of elements, one vector each, in blocks of lanes; the last block is filled up by repeating the last element.
Numbers in_lanes(const std::vector<Numbers>& values) {
  const std::size_t n = values.size(), size = values.front().size(), blocks = (n + LACON_LANES - 1) / LACON_LANES;
  Numbers packed(blocks * size * LACON_LANES);
  for (std::size_t e = 0; e < blocks * LACON_LANES; ++e)
    for (std::size_t i = 0; i < size; ++i)
      packed[(e / LACON_LANES * size + i) * LACON_LANES + e % LACON_LANES] = values[std::min(e, n - 1)][i];
  return packed;
}

std::vector<Numbers> out_of_lanes(const Numbers& packed, std::size_t n) {
  const std::size_t size = packed.size() / ((n + LACON_LANES - 1) / LACON_LANES * LACON_LANES);
  std::vector<Numbers> values(n, Numbers(size));
  for (std::size_t e = 0; e < n; ++e)
    for (std::size_t i = 0; i < size; ++i) values[e][i] = packed[(e / LACON_LANES * size + i) * LACON_LANES + e % LACON_LANES];
  return values;
}

// ---------------------------------------------------------------------------------------------------- plane strain

struct SolidResult {
  std::vector<Numbers> matrix, force, stress;
  std::vector<int> error;
};

/// Runs the kernel of D_PLAN on elements given by coordinates, displacements (n_nodes, 2) and (E, nu).
SolidResult run_solid(CellType type, const std::vector<Numbers>& coordinates, const std::vector<Numbers>& displacements,
                      const std::vector<Numbers>& parameters, bool all_outputs = true) {
  const auto& element = *registry().find_element("D_PLAN", type);
  const auto& kernel = registry().kernel(element, "ELAS/PETIT", LACON_SOLID);
  const auto table = lacon::tabulate(type, lacon::integration_rule(lacon::catalog::cell(type).family, element.points));
  const Numbers x = in_lanes(coordinates), u = in_lanes(displacements), p = in_lanes(parameters);
  const std::size_t n = coordinates.size(), lanes = (n + LACON_LANES - 1) / LACON_LANES * LACON_LANES,
                    dofs = coordinates[0].size();
  Numbers matrix(lanes * dofs * (dofs + 1) / 2, garbage), force(lanes * dofs, garbage),
      stress(lanes * z(table.n_points) * 4, garbage);
  std::vector<std::int32_t> error(lanes, -1);
  lacon_solid_batch batch{sizeof(lacon_solid_batch),
                          static_cast<int>(lanes) / LACON_LANES,
                          table.n_nodes,
                          2,
                          table.n_points,
                          4,
                          2,
                          table.shape.data(),
                          table.gradient.data(),
                          table.weight.data(),
                          x.data(),
                          u.data(),
                          p.data(),
                          matrix.data(),
                          force.data(),
                          stress.data(),
                          error.data()};
  if (!all_outputs) batch.matrix = batch.stress = nullptr;
  kernel.solid(&batch);
  return {out_of_lanes(matrix, n),
          out_of_lanes(force, n),
          out_of_lanes(stress, n),
          {error.begin(), error.begin() + static_cast<long>(n)}};
}

const Numbers steel = {2.1e5, 0.3};

/// A map that bends every straight line, with a positive Jacobian on [0, 2]^2.
std::array<double, 2> bend(double x, double y) {
  return {x + 0.1 * y * y - 0.05 * x * y, y + 0.2 * std::sin(x) + 0.07 * x * y};
}

/// Four bent cells (eight triangles) that fill a bent square. Nodes are known by their place in the square.
struct Patch {
  using Place = std::array<double, 2>;
  std::vector<std::vector<Place>> cells;

  explicit Patch(CellType type) {
    const auto& cell = lacon::catalog::cell(type);
    const bool triangle = cell.family == lacon::Family::TRIA;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        for (int half = 0; half < (triangle ? 2 : 1); ++half) {
          std::vector<Place> places;
          for (int a = 0; a < cell.n_nodes; ++a) {
            const double r = cell.nodes[z(2 * a)], s = cell.nodes[z(2 * a + 1)];
            if (!triangle)
              places.push_back({i + (1 + r) / 2, j + (1 + s) / 2});
            else if (half == 0)
              places.push_back({i + r, j + s});
            else
              places.push_back({i + 1 - r, j + 1 - s});
          }
          cells.push_back(places);
        }
  }
  std::vector<Numbers> field(const std::function<std::array<double, 2>(double, double)>& of_bent_point) const {
    std::vector<Numbers> values;
    for (const auto& cell : cells) {
      Numbers of_cell;
      for (const Place& place : cell) {
        const auto point = bend(place[0], place[1]);
        const auto value = of_bent_point(point[0], point[1]);
        of_cell.insert(of_cell.end(), value.begin(), value.end());
      }
      values.push_back(of_cell);
    }
    return values;
  }
  std::vector<Numbers> coordinates() const {
    return field([](double x, double y) { return std::array<double, 2>{x, y}; });
  }
};

struct PlaneStrain : testing::TestWithParam<CellType> {
  Patch patch{GetParam()};
  std::vector<Numbers> x = patch.coordinates();
  std::vector<Numbers> material = std::vector<Numbers>(x.size(), steel);
};

TEST_P(PlaneStrain, ConstantStrainGivesConstantStressAndNoForceInside) {
  const double exx = 1.3e-3, eyy = -0.7e-3, exy = 0.45e-3, turn = 2e-3;
  const auto u = patch.field([&](double px, double py) {
    return std::array<double, 2>{0.1 + exx * px + (exy - turn) * py, -0.2 + (exy + turn) * px + eyy * py};
  });
  const auto result = run_solid(GetParam(), x, u, material);
  const double shear = steel[0] / (1 + steel[1]), bulk = shear * steel[1] / (1 - 2 * steel[1]) * (exx + eyy);  // Hooke's law
  const double exact[4] = {shear * exx + bulk, shear * eyy + bulk, bulk, shear * exy};
  // displacements of 0.2 known to eps, differentiated over sizes of 1/2, times a modulus below 2 E
  const double tolerance = 40 * eps * steel[0];
  std::map<Patch::Place, std::array<double, 2>> sum;
  for (std::size_t e = 0; e < x.size(); ++e) {
    EXPECT_EQ(result.error[e], LACON_FINE);
    for (std::size_t i = 0; i < result.stress[e].size(); ++i) EXPECT_NEAR(result.stress[e][i], exact[i % 4], tolerance);
    for (std::size_t a = 0; a < patch.cells[e].size(); ++a)
      for (std::size_t i = 0; i < 2; ++i) sum[patch.cells[e][a]][i] += result.force[e][2 * a + i];
  }
  int inside = 0;
  double outer = 0;
  for (const auto& [place, force] : sum) {
    const bool boundary = place[0] == 0 || place[0] == 2 || place[1] == 0 || place[1] == 2;
    inside += !boundary;
    for (const double component : force) {
      if (boundary) outer = std::max(outer, std::abs(component));
      if (!boundary) {
        EXPECT_NEAR(component, 0, 10 * tolerance);
      }
    }
  }
  EXPECT_GE(inside, 1);
  EXPECT_GT(outer, 50);  // the test sees forces where there are some
}

TEST_P(PlaneStrain, RigidMotionsGiveNoForceAndNoStress) {
  for (int motion = 0; motion < 3; ++motion) {
    const auto u = patch.field([&](double px, double py) {
      return motion == 0   ? std::array<double, 2>{1, 0}
             : motion == 1 ? std::array<double, 2>{0, 1}
                           : std::array<double, 2>{-py, px};
    });
    const auto result = run_solid(GetParam(), x, u, material);
    for (std::size_t e = 0; e < x.size(); ++e) {
      for (const double f : result.force[e]) EXPECT_NEAR(f, 0, 200 * eps * steel[0]);
      for (const double s : result.stress[e]) EXPECT_NEAR(s, 0, 200 * eps * steel[0]);
    }
  }
}

TEST_P(PlaneStrain, StiffnessIsTheDerivativeOfTheForce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Numbers> u = x;
  for (auto& of_cell : u)
    for (double& value : of_cell) value = number(random);
  const auto result = run_solid(GetParam(), x, u, material);
  for (std::size_t j = 0; j < u[0].size(); ++j) {
    auto low = u, high = u;
    for (std::size_t e = 0; e < u.size(); ++e) {  // forces are linear: a step of 1 has no truncation error
      low[e][j] -= 1;
      high[e][j] += 1;
    }
    const auto before = run_solid(GetParam(), x, low, material), after = run_solid(GetParam(), x, high, material);
    for (std::size_t e = 0; e < u.size(); ++e)
      for (std::size_t i = 0; i < u[0].size(); ++i) {
        const std::size_t entry = std::max(i, j) * (std::max(i, j) + 1) / 2 + std::min(i, j);
        EXPECT_NEAR((after.force[e][i] - before.force[e][i]) / 2, result.matrix[e][entry], 1000 * eps * steel[0])
            << i << ' ' << j;
      }
  }
}

TEST_P(PlaneStrain, ForceIsTheVirtualWorkOfTheStress) {  // sum f v = int sigma : eps(v), with eps(v) by another way
  const auto u = patch.field([](double px, double py) {
    return std::array<double, 2>{0.01 * px * px - 0.02 * py, 0.015 * px * py};
  });
  const auto result = run_solid(GetParam(), x, u, material);
  const auto& cell = lacon::catalog::cell(GetParam());
  const auto table =
      lacon::tabulate(GetParam(), lacon::integration_rule(cell.family, registry().find_element("D_PLAN", GetParam())->points));
  for (std::size_t e = 0; e < x.size(); ++e)
    for (int dof = 0; dof < 2 * cell.n_nodes; ++dof) {
      double work = 0;
      for (int p = 0; p < table.n_points; ++p) {
        double j[2][2] = {}, slope[2] = {};
        for (int a = 0; a < cell.n_nodes; ++a)
          for (int r = 0; r < 2; ++r)
            for (int s = 0; s < 2; ++s) j[r][s] += x[e][z(2 * a + r)] * table.gradient[z((p * cell.n_nodes + a) * 2 + s)];
        const double det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        const double* g = &table.gradient[z((p * cell.n_nodes + dof / 2) * 2)];
        slope[0] = (g[0] * j[1][1] - g[1] * j[1][0]) / det;
        slope[1] = (g[1] * j[0][0] - g[0] * j[0][1]) / det;
        const double* sigma = &result.stress[e][z(4 * p)];
        work += table.weight[z(p)] * det *
                (dof % 2 == 0 ? sigma[0] * slope[0] + sigma[3] * slope[1] : sigma[3] * slope[0] + sigma[1] * slope[1]);
      }
      EXPECT_NEAR(result.force[e][z(dof)], work, 200 * eps * steel[0]);
    }
}

TEST_P(PlaneStrain, ResultsOfAnElementDependNeitherOnItsLaneNorOnThePadding) {
  const auto u = patch.field([](double px, double py) { return std::array<double, 2>{0.01 * px * px, 0.02 * px * py}; });
  std::vector<Numbers> many_x, many_u;
  for (std::size_t i = 0; i < 11; ++i) {
    many_x.push_back(x[i % x.size()]);
    many_u.push_back(u[i % x.size()]);
  }
  const auto many = run_solid(GetParam(), many_x, many_u, std::vector<Numbers>(11, steel));
  for (std::size_t i = 0; i < 11; ++i) {
    const auto one = run_solid(GetParam(), {many_x[i]}, {many_u[i]}, {steel});
    EXPECT_EQ(one.matrix[0], many.matrix[i]);
    EXPECT_EQ(one.force[0], many.force[i]);
    EXPECT_EQ(one.stress[0], many.stress[i]);
  }
  EXPECT_EQ(run_solid(GetParam(), many_x, many_u, std::vector<Numbers>(11, steel), false).force,
            many.force);  // other outputs unwanted
}

TEST_P(PlaneStrain, ACellTurnedInsideOutIsCaughtAndLeavesItsNeighboursAlone) {
  const auto mirror = lacon::catalog::cell(GetParam()).mirror;
  auto wrong = x;
  for (std::size_t a = 0; a < mirror.size(); ++a)
    for (std::size_t i = 0; i < 2; ++i) wrong[1][2 * a + i] = x[1][z(2 * mirror[a]) + i];
  const auto u = patch.field([](double px, double py) { return std::array<double, 2>{0.01 * px, 0.02 * px * py}; });
  const auto good = run_solid(GetParam(), x, u, material), bad = run_solid(GetParam(), wrong, u, material);
  for (std::size_t e = 0; e < x.size(); ++e) {
    EXPECT_EQ(bad.error[e], e == 1 ? LACON_BAD_JACOBIAN : LACON_FINE);
    if (e != 1) {
      EXPECT_EQ(good.matrix[e], bad.matrix[e]);
    }
  }
}

TEST_P(PlaneStrain, ACellOfMixedOrNoJacobianIsCaught) {
  const std::size_t nodes = x[0].size() / 2;
  auto mixed = x[0];
  if (nodes == 3) {
    mixed = {0, 0, 1, 1, 2, 2};
  } else {  // a vertex beyond the cell's other end: the Jacobian changes sign inside
    for (std::size_t i = 0; i < 2; ++i) mixed[i] += 2.5 * (x[0][4 + i] - x[0][i]);
  }
  const Numbers flat(x[0].size(), 0.3), zero(x[0].size(), 0.0);
  Numbers line = x[0];
  for (std::size_t a = 0; a < nodes; ++a) line[2 * a + 1] = 0.7 * line[2 * a] + 10;  // all nodes on a line, up to round-off
  const auto result = run_solid(GetParam(), {mixed, flat, line}, {zero, zero, zero}, {steel, steel, steel});
  for (const int error : result.error) EXPECT_EQ(error, LACON_BAD_JACOBIAN);
}

TEST_P(PlaneStrain, ACellFarFromTheOriginKeepsItsStiffness) {
  Numbers here = x[0], far = x[0];
  for (double& coordinate : here) coordinate = std::round(coordinate * 1024) / 1024;  // so that moving it is exact
  for (std::size_t i = 0; i < far.size(); ++i) far[i] = here[i] + 1e6;
  const Numbers zero(far.size(), 0.0);
  const auto result = run_solid(GetParam(), {here, far}, {zero, zero}, {steel, steel});
  EXPECT_EQ(result.matrix[0], result.matrix[1]);
}

TEST_P(PlaneStrain, ASliverIsNotTakenForABadCell) {
  Numbers sliver = x[0];
  for (std::size_t a = 0; a < sliver.size() / 2; ++a) sliver[2 * a + 1] *= 1e-6;
  EXPECT_EQ(run_solid(GetParam(), {sliver}, {Numbers(sliver.size(), 0.0)}, {steel}).error[0], LACON_FINE);
}

TEST_P(PlaneStrain, ParametersOutOfRangeAndNumbersThatAreNoneAreCaught) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Numbers> wrong = {{0, 0.3}, {-1, 0.3}, {nan, 0.3}, {inf, 0.3}, {1, 0.5}, {1, -1}, {1, nan}, {1, 2}};
  const Numbers zero(x[0].size(), 0.0);
  for (const int error : run_solid(GetParam(), std::vector(wrong.size(), x[0]), std::vector(wrong.size(), zero), wrong).error)
    EXPECT_EQ(error, LACON_BAD_PARAMETER);
  const std::vector<Numbers> fine = {{1e-3, 0}, {1e12, 0.4999}, {1, -0.99}};
  for (const int error : run_solid(GetParam(), std::vector(3, x[0]), std::vector(3, zero), fine).error)
    EXPECT_EQ(error, LACON_FINE);
  for (const double value : {nan, inf}) {
    auto u = zero;
    u[3] = value;
    const auto result = run_solid(GetParam(), {x[0], x[0]}, {u, zero}, {steel, steel});
    EXPECT_EQ(result.error[0], LACON_NOT_FINITE);
    EXPECT_EQ(result.error[1], LACON_FINE);
  }
}

INSTANTIATE_TEST_SUITE_P(All, PlaneStrain,
                         testing::Values(CellType::TRIA3, CellType::TRIA6, CellType::QUAD4, CellType::QUAD8, CellType::QUAD9),
                         [](const auto& cell) { return std::string(lacon::catalog::cell(cell.param).name); });

TEST(SolidKernel, RefusesElementsOfAKindThatItDoesNotServe) {
  const auto& kernel = registry().kernel(*registry().find_element("D_PLAN/TRIA3"), "ELAS/PETIT", LACON_SOLID);
  for (const auto& [nodes, dimension, stress, parameters] :
       {std::array{27, 3, 6, 2}, {28, 2, 4, 2}, {3, 2, 6, 2}, {3, 2, 4, 1}}) {
    std::vector<std::int32_t> error(2 * LACON_LANES, 0);
    lacon_solid_batch batch{};
    batch.n_blocks = 2;
    batch.n_nodes = nodes;
    batch.dimension = dimension;
    batch.n_stress = stress;
    batch.n_parameters = parameters;
    batch.error = error.data();
    kernel.solid(&batch);
    EXPECT_EQ(error, std::vector<std::int32_t>(2 * LACON_LANES, LACON_BAD_BATCH));
  }
}

// ---------------------------------------------------------------------------------------------------- pressure

struct LoadResult {
  std::vector<Numbers> force, matrix;
  std::vector<int> error;
};

/// The same values at every integration point of each element.
std::vector<Numbers> at_points(const std::vector<Numbers>& values, int n_points) {
  std::vector<Numbers> repeated;
  for (const Numbers& own : values) {
    repeated.emplace_back();
    for (int p = 0; p < n_points; ++p) repeated.back().insert(repeated.back().end(), own.begin(), own.end());
  }
  return repeated;
}

/// Runs a load kernel on elements given by coordinates (n_nodes, dimension) and values that are constant in each of them.
LoadResult run_load(const std::string& name, const std::string& option, const std::vector<Numbers>& coordinates,
                    const std::vector<Numbers>& values, int dimension) {
  const auto& element = *registry().find_element(name);
  const auto& kernel = registry().kernel(element, option, LACON_LOAD);
  const auto& cell = lacon::catalog::cell(element.cell);
  const auto table = lacon::tabulate(element.cell, lacon::integration_rule(cell.family, element.points));
  const Numbers x = in_lanes(coordinates), v = in_lanes(at_points(values, table.n_points));
  const std::size_t n = coordinates.size(), lanes = (n + LACON_LANES - 1) / LACON_LANES * LACON_LANES,
                    dofs = coordinates[0].size();
  std::vector<std::int32_t> error(lanes, -1);
  Numbers force(x.size(), garbage), matrix(lanes * dofs * (dofs + 1) / 2, garbage);
  const lacon_load_batch batch{sizeof(lacon_load_batch),
                               static_cast<int>(lanes) / LACON_LANES,
                               table.n_nodes,
                               dimension,
                               table.n_points,
                               cell.dimension,
                               static_cast<int>(values[0].size()),
                               table.shape.data(),
                               table.gradient.data(),
                               table.weight.data(),
                               x.data(),
                               v.data(),
                               force.data(),
                               matrix.data(),
                               error.data()};
  kernel.load(&batch);
  return {out_of_lanes(force, n), out_of_lanes(matrix, n), {error.begin(), error.begin() + static_cast<long>(n)}};
}

/// Pressures on edges, without shear.
LoadResult run_pressure(CellType type, const std::vector<Numbers>& coordinates, std::vector<Numbers> values,
                        int dimension = 2) {
  for (Numbers& value : values) value.push_back(0);
  return run_load("D_PLAN/" + std::string(lacon::catalog::cell(type).name), "CHAR_MECA_PRES", coordinates, values, dimension);
}

/// A closed contour of bent edges around a body on its left.
std::vector<Numbers> contour(CellType type, int edges) {
  const auto at = [&](double t) {
    const double angle = 2 * std::acos(-1.0) * t / edges, radius = 2 + 0.3 * std::cos(3 * angle);
    return std::array{radius * std::cos(angle) + 5, radius * std::sin(angle) - 1};
  };
  std::vector<Numbers> x;
  for (int e = 0; e < edges; ++e) {
    const auto a = at(e), b = at((e + 1) % edges), m = at(e + 0.5);
    x.push_back({a[0], a[1], b[0], b[1]});
    if (type == CellType::SEG3) x.back().insert(x.back().end(), m.begin(), m.end());
  }
  return x;
}

/// The area in a closed contour: 1/2 sum int x dy - y dx, exact for edges of degree 2.
double area(CellType type, const std::vector<Numbers>& x) {
  const auto table = lacon::tabulate(type, lacon::gauss_rule(3));
  double sum = 0;
  for (const auto& edge : x)
    for (int p = 0; p < 3; ++p) {
      double v[2] = {}, t[2] = {};
      for (int a = 0; a < table.n_nodes; ++a)
        for (int i = 0; i < 2; ++i) {
          v[i] += table.shape[z(p * table.n_nodes + a)] * edge[z(2 * a + i)];
          t[i] += table.gradient[z(p * table.n_nodes + a)] * edge[z(2 * a + i)];
        }
      sum += table.weight[z(p)] * (v[0] * t[1] - v[1] * t[0]) / 2;
    }
  return sum;
}

struct Pressure : testing::TestWithParam<CellType> {};

TEST_P(Pressure, IsMinusTheDerivativeOfTheAreaThatItActsOn) {
  const double p = 3.5, h = 1e-3;
  const auto x = contour(GetParam(), 9);
  const auto result = run_pressure(GetParam(), x, std::vector<Numbers>(9, {p}));
  for (std::size_t e = 0; e < x.size(); ++e) {
    EXPECT_EQ(result.error[e], LACON_FINE);
    for (std::size_t i = 0; i < x[e].size(); ++i) {
      // a node of its own for this edge's end: the contour opens by h, and the area of the closing piece is added
      auto low = x, high = x;
      low[e][i] -= h;
      high[e][i] += h;
      double closing = 0;
      const std::size_t node = i / 2, next = (e + 1) % x.size(), previous = (e + x.size() - 1) % x.size();
      if (node < 2) {
        const Numbers& other = node == 1 ? x[next] : x[previous];
        const double ox = other[node == 1 ? 0 : 2], oy = other[node == 1 ? 1 : 3];
        const auto piece = [&](const Numbers& edge) {  // from the edge's end to the next one's start, or the other way round
          const double w = (edge[2 * node] * oy - edge[2 * node + 1] * ox) / 2;
          return node == 1 ? w : -w;
        };
        closing = (piece(high[e]) - piece(low[e])) / (2 * h);
      }
      // the area is quadratic in each coordinate alone: no truncation error
      const double derivative = (area(GetParam(), high) - area(GetParam(), low)) / (2 * h) + closing;
      EXPECT_NEAR(result.force[e][i], -p * derivative, p * 100 * eps * 40 / h);
    }
  }
}

TEST_P(Pressure, OnAClosedContourIsInEquilibrium) {
  const auto x = contour(GetParam(), 9);
  const auto result = run_pressure(GetParam(), x, std::vector<Numbers>(9, {3.5}));
  double fx = 0, fy = 0, moment = 0;
  for (std::size_t e = 0; e < x.size(); ++e)
    for (std::size_t a = 0; a < x[e].size() / 2; ++a) {
      fx += result.force[e][2 * a];
      fy += result.force[e][2 * a + 1];
      moment += x[e][2 * a] * result.force[e][2 * a + 1] - x[e][2 * a + 1] * result.force[e][2 * a];
    }
  EXPECT_NEAR(fx, 0, 1000 * eps);
  EXPECT_NEAR(fy, 0, 1000 * eps);
  EXPECT_NEAR(moment, 0, 10000 * eps);
}

TEST_P(Pressure, PushesTowardsTheBodyOnTheLeft) {
  // the lower side of a body above: the outward normal is -y, the pressure pushes up
  const Numbers edge = GetParam() == CellType::SEG2 ? Numbers{0, 0, 2, 0} : Numbers{0, 0, 2, 0, 1, 0};
  const auto f = run_pressure(GetParam(), {edge}, {{6}}).force[0];
  const Numbers exact = GetParam() == CellType::SEG2 ? Numbers{0, 6, 0, 6} : Numbers{0, 2, 0, 2, 0, 8};
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_NEAR(f[i], exact[i], 20 * eps);
}

TEST_P(Pressure, BadElementsAndValuesAreCaughtAndOthersAreNot) {
  const Numbers good = contour(GetParam(), 5)[0], point(good.size(), 1.7);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto result = run_pressure(GetParam(), {good, point, good, good}, {{1}, {1}, {nan}, {1}});
  EXPECT_EQ(result.error, (std::vector<int>{LACON_FINE, LACON_BAD_JACOBIAN, LACON_NOT_FINITE, LACON_FINE}));
  EXPECT_EQ(result.force[0], result.force[3]);
  EXPECT_EQ(run_pressure(GetParam(), {good}, {{1}}).force[0], result.force[0]);
  EXPECT_EQ(run_pressure(GetParam(), {good}, {{1}}, 3).error[0], LACON_BAD_BATCH);
}

INSTANTIATE_TEST_SUITE_P(All, Pressure, testing::Values(CellType::SEG2, CellType::SEG3),
                         [](const auto& cell) { return std::string(lacon::catalog::cell(cell.param).name); });

// ---------------------------------------------------------------------------------------------------- every load

/// Coordinates of a cell whose edges and faces are bent; in axisymmetry all radii are positive.
Numbers bent_cell(const lacon::catalog::ElementRow& row) {
  const auto& cell = lacon::catalog::cell(row.cell);
  const int D = static_cast<int>(row.dofs.size());
  Numbers x;
  for (int a = 0; a < cell.n_nodes; ++a) {
    double r[3] = {};
    for (int k = 0; k < cell.dimension; ++k) r[k] = cell.nodes[z(a * cell.dimension + k)];
    const double bent[3] = {3 + r[0] + 0.1 * r[1] * r[1] + 0.2 * r[2], r[1] + 0.15 * r[0] * r[0] - 0.1 * r[2] * r[0],
                            r[2] + 0.2 * r[0] * r[1]};
    for (int d = 0; d < D; ++d) x.push_back(bent[d]);
  }
  return x;
}

struct EveryLoad : testing::TestWithParam<const lacon::catalog::ElementRow*> {
  const lacon::catalog::ElementRow& row = *GetParam();
  const int D = static_cast<int>(row.dofs.size());
  const bool skin = lacon::catalog::cell(row.cell).dimension == D - 1;
};

/// A pressure p and a shear c on a flat skin are the traction -p n + c t; nodes weigh alike.
TEST_P(EveryLoad, PressureAndShearAreATraction) {
  if (!skin) return;
  const auto& cell = lacon::catalog::cell(row.cell);
  // an affine image, in the plane across n: two tangents of different lengths
  const double t[2][3] = {{0.3, 1.2, 0}, {0.4, -0.1, 0.9}};
  Numbers x;
  for (int a = 0; a < cell.n_nodes; ++a)
    for (int d = 0; d < D; ++d) {
      double value = d == 0 ? 4 : 0;
      for (int k = 0; k < D - 1; ++k) value += t[k][d] * cell.nodes[z(a * (D - 1) + k)];
      x.push_back(value);
    }
  const double p = 2.5, c = D == 2 ? -0.7 : 0;
  Numbers n = D == 2 ? Numbers{t[0][1], -t[0][0]}
                     : Numbers{t[0][1] * t[1][2] - t[0][2] * t[1][1], t[0][2] * t[1][0] - t[0][0] * t[1][2],
                               t[0][0] * t[1][1] - t[0][1] * t[1][0]};
  const double length = std::hypot(n[0], n[1], D == 3 ? n[2] : 0.0),
               along = std::hypot(t[0][0], t[0][1], D == 3 ? t[0][2] : 0.0);
  Numbers traction;
  for (int d = 0; d < D; ++d) traction.push_back(-p * n[z(d)] / length + c * t[0][d] / along);
  const auto name = std::string(row.name);
  const auto pressed = run_load(name, "CHAR_MECA_PRES", {x}, {D == 2 ? Numbers{p, c} : Numbers{p}}, D);
  const auto pulled = run_load(name, "CHAR_MECA_FORC", {x}, {traction}, D);
  ASSERT_EQ(pressed.error[0] + pulled.error[0], LACON_FINE);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(pressed.force[0][i], pulled.force[0][i], 1e-14 * 20);
}

/// The symmetric part of the derivative of a following pressure, against differences of the force.
TEST_P(EveryLoad, MatrixOfAPressureIsTheSymmetricPartOfItsDerivative) {
  if (!skin) return;
  const Numbers x = bent_cell(row), value = D == 2 ? Numbers{2.5, -0.7} : Numbers{2.5};
  const std::size_t n = x.size();
  const double h = 1e-5;
  std::vector<Numbers> moved;
  for (std::size_t j = 0; j < n; ++j)
    for (const double side : {h, -h}) {
      moved.push_back(x);
      moved.back()[j] += side;
    }
  const auto name = std::string(row.name);
  const auto at = run_load(name, "CHAR_MECA_PRES", {x}, {value}, D);
  const auto around = run_load(name, "CHAR_MECA_PRES", moved, std::vector<Numbers>(moved.size(), value), D);
  ASSERT_EQ(at.error[0], LACON_FINE);
  const auto derivative = [&](std::size_t i, std::size_t j) {
    return (around.force[2 * j][i] - around.force[2 * j + 1][i]) / (2 * h);
  };
  std::size_t entry = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j, ++entry)
      EXPECT_NEAR(at.matrix[0][entry], (derivative(i, j) + derivative(j, i)) / 2, 1e-8) << i << " " << j;
}

/// The work of a constant force in a rigid motion is that of its resultant; in axisymmetry it has the factor r.
TEST_P(EveryLoad, ForcesAddUpToTheMeasureOfTheCell) {
  const Numbers x = bent_cell(row);
  Numbers value;
  for (int d = 0; d < D; ++d) value.push_back(1.5 - d);
  const auto name = std::string(row.name);
  const auto result = run_load(name, "CHAR_MECA_FORC", {x}, {value}, D);
  ASSERT_EQ(result.error[0], LACON_FINE);
  // the measure by the same rule: from tangents alone
  const auto& cell = lacon::catalog::cell(row.cell);
  const auto table = lacon::tabulate(row.cell, lacon::integration_rule(cell.family, row.points));
  double measure = 0;
  for (int p = 0; p < table.n_points; ++p) {
    double t[3][3] = {}, r = 0, gram[3][3] = {};
    for (int a = 0; a < table.n_nodes; ++a) {
      r += table.shape[z(p * table.n_nodes + a)] * x[z(a * D)];
      for (int k = 0; k < cell.dimension; ++k)
        for (int d = 0; d < D; ++d)
          t[k][d] += table.gradient[z((p * table.n_nodes + a) * cell.dimension + k)] * x[z(a * D + d)];
    }
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) {
        for (int d = 0; d < D; ++d) gram[k][l] += t[k][d] * t[l][d];
        if (k == l && k >= cell.dimension) gram[k][l] = 1;
      }
    const double determinant = gram[0][0] * (gram[1][1] * gram[2][2] - gram[1][2] * gram[2][1]) -
                               gram[0][1] * (gram[1][0] * gram[2][2] - gram[1][2] * gram[2][0]) +
                               gram[0][2] * (gram[1][0] * gram[2][1] - gram[1][1] * gram[2][0]);
    measure += table.weight[z(p)] * std::sqrt(determinant) * (row.geometry == lacon::catalog::Geometry::axis ? r : 1);
  }
  for (int d = 0; d < D; ++d) {
    double sum = 0;
    for (std::size_t i = z(d); i < x.size(); i += z(D)) sum += result.force[0][i];
    EXPECT_NEAR(sum, value[z(d)] * measure, 1e-13 * 40);
  }
}

TEST_P(EveryLoad, BadElementsAndValuesAreCaught) {
  const Numbers good = bent_cell(row), point(good.size(), 1.7);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto name = std::string(row.name);
  const Numbers one(z(D), 1.0);
  const auto result = run_load(name, "CHAR_MECA_FORC", {good, point, good}, {one, one, Numbers(z(D), nan)}, D);
  EXPECT_EQ(result.error, (std::vector<int>{LACON_FINE, LACON_BAD_JACOBIAN, LACON_NOT_FINITE}));
  EXPECT_EQ(run_load(name, "CHAR_MECA_FORC", {good}, {Numbers(z(D) + 1, 1.0)}, D).error[0], LACON_BAD_BATCH);
}

std::vector<const lacon::catalog::ElementRow*> loaded_rows() {
  return rows_where([](const auto& row) {
    return std::ranges::any_of(row.kernels, [](const auto& kernel) { return kernel.option == "CHAR_MECA_FORC"; });
  });
}

INSTANTIATE_TEST_SUITE_P(All, EveryLoad, testing::ValuesIn(loaded_rows()), [](const auto& row) {
  std::string name(row.param->name);
  std::replace(name.begin(), name.end(), '/', '_');
  return "of_" + name;
});

}  // namespace
