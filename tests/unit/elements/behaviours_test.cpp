// Behaviours of solid elements: measures of strain and laws, on every cell of every modelisation.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <tuple>

#include "solid_run.hpp"

namespace {

using Case = std::tuple<const ElementRow*, std::string>;

struct Behaviour : testing::TestWithParam<Case> {
  const ElementRow& row = *std::get<0>(GetParam());
  const std::string option = std::get<1>(GetParam());
  const lacon::catalog::CellRow& cell = lacon::catalog::cell(row.cell);
  const int D = cell.dimension;
  const Numbers x = shaken(cell);
};

/// Among the internal variables of a point that which says that the law flows.
std::size_t place_of_flow(const lacon_kernel& kernel) {
  std::size_t place = 0;
  while (std::string_view(kernel.variables[place]) != "INDIPLAS") ++place;
  return place;
}

/// Further by `size` from a state that the element has been brought to, with stresses and plastic strain.
struct Derivative : Behaviour {
  void check(double size) const;
};

void Derivative::check(double size) const {
  const lacon_kernel& kernel = registry().kernel(row, option, LACON_SOLID);
  const bool whole = kernel.unsymmetric, moves = option.find("PETIT_REAC") != option.npos, plastic = option.starts_with("VMIS");
  State from = run(row, option, x, shaken_displacement(x.size(), 0.05, 1), {}).state;
  Numbers u = from.displacement;
  const Numbers further = shaken_displacement(x.size(), size, 2);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += further[i];
  const auto at = run(row, option, x, u, from);
  ASSERT_EQ(at.error, LACON_FINE);
  if (plastic) {
    std::size_t flowing = 0;
    for (std::size_t i = place_of_flow(kernel); i < at.state.variable.size(); i += z(lacon::n_names(kernel.variables)))
      flowing += at.state.variable[i] == 1;
    if (size > 0.01) {
      ASSERT_GT(flowing, 0) << "no point flows: the tangent of plasticity is not tested";
    }
  }
  const std::size_t n = x.size();
  std::vector<Numbers> derivative(n);  // by the unknowns
  const double step = 1e-6;
  for (std::size_t j = 0; j < n; ++j) {
    Numbers low = u, high = u;
    low[j] -= step;
    high[j] += step;
    const auto before = run(row, option, x, low, from), after = run(row, option, x, high, from);
    for (std::size_t i = 0; i < n; ++i) derivative[j].push_back((after.force[i] - before.force[i]) / (2 * step));
  }
  double largest = 0;
  for (const double entry : at.matrix) largest = std::max(largest, std::abs(entry));
  double asymmetry = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      // round-off of the difference eps force / step, truncation step^2: both near 1e-9 of the largest
      const double exact = (derivative[j][i] + derivative[i][j]) / 2;
      ASSERT_NEAR(at.matrix[i * (i + 1) / 2 + j], exact, 2e-8 * largest) << i << ' ' << j;
      asymmetry = std::max(asymmetry, std::abs(derivative[j][i] - derivative[i][j]));
      if (!whole) continue;
      ASSERT_NEAR(at.whole_matrix[i * n + j], derivative[j][i], 2e-8 * largest) << i << ' ' << j;
      ASSERT_NEAR(at.whole_matrix[j * n + i], derivative[i][j], 2e-8 * largest) << j << ' ' << i;
    }
  if (moves && size > 0.01) {
    EXPECT_GT(asymmetry, 1e-3 * largest) << "nothing that symmetry would not give is tested";
  }
  if (!whole) {
    EXPECT_LT(asymmetry, 4e-8 * largest);
  }
}

TEST_P(Derivative, OfTheForceIsTheMatrix) { check(0.05); }

TEST_P(Derivative, OfTheForceIsTheMatrixWhereOnlySomePointsFlow) { check(0.004); }

TEST_P(Behaviour, InSmallStepsItIsSmallStrainElasticity) {
  // displacements of 1e-7: what the measures of strain differ by is below 1e-6 of the stress, and nothing flows
  const Numbers u = shaken_displacement(x.size(), 1e-7, 5);
  const auto own = run(row, option, x, u, {}), plain = run(row, "ELAS/PETIT", x, u, {});
  ASSERT_EQ(own.error, LACON_FINE);
  double force = 0, entry = 0;
  for (const double f : plain.force) force = std::max(force, std::abs(f));
  for (const double k : plain.matrix) entry = std::max(entry, std::abs(k));
  for (std::size_t i = 0; i < u.size(); ++i) EXPECT_NEAR(own.force[i], plain.force[i], 1e-5 * force);
  for (std::size_t i = 0; i < plain.matrix.size(); ++i) EXPECT_NEAR(own.matrix[i], plain.matrix[i], 1e-5 * entry);
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const ElementRow* row : solids())
    for (const auto& kernel : row->kernels)
      if (kernel.option.starts_with("ELAS/") || kernel.option.starts_with("VMIS_ISOT_LINE/") ||
          kernel.option.starts_with("VMIS_CINE_LINE/"))
        all.emplace_back(row, std::string(kernel.option));
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, Behaviour, testing::ValuesIn(cases()), case_name);
INSTANTIATE_TEST_SUITE_P(All, Derivative, testing::ValuesIn(cases()), case_name);

// ---------------------------------------------------------------------------------------------------- Green-Lagrange

struct GreenLagrange : testing::TestWithParam<const ElementRow*> {
  const ElementRow& row = *GetParam();
  const lacon::catalog::CellRow& cell = lacon::catalog::cell(row.cell);
  const int D = cell.dimension;
  const bool axis = row.geometry == lacon::catalog::Geometry::axis,
             plane_stress = row.stress_state == lacon::catalog::StressState::plane_stress;
  const Numbers x = shaken(cell);
};

struct Turning : GreenLagrange {};  // what the axis of revolution does not allow

TEST_P(Turning, ARigidRotationGivesNoStress) {
  const double c = std::cos(2.0), s = std::sin(2.0);
  double turn[3][3] = {{c - 1, -s, 0}, {s, c - 1, 0}, {0, 0, 0}};
  if (D == 3) {  // about (1, 1, 1), by 2 radians
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) turn[i][k] = (i == k ? c - 1 : 0) + (1 - c) / 3;
    for (int i = 0; i < 3; ++i) turn[i][(i + 1) % 3] -= s / std::sqrt(3), turn[(i + 1) % 3][i] += s / std::sqrt(3);
  }
  for (const char* option : {"ELAS/GREEN_LAGRANGE", "ELAS/PETIT_REAC_MILIEU"}) {
    const auto answer = run(row, option, x, linear_field(x, D, turn), {});
    ASSERT_EQ(answer.error, LACON_FINE);
    for (const double value : answer.force) EXPECT_NEAR(value, 0, 1e-12 * young) << option;
    for (const double value : answer.state.stress) EXPECT_NEAR(value, 0, 1e-12 * young) << option;
  }
}

TEST_P(GreenLagrange, AHomogeneousStretchGivesTheStressOfSaintVenantAndKirchhoff) {
  double stretch[3] = {1.3, 0.8, D == 3 ? 1.15 : axis ? 1.3 : 1};
  const auto answer = run(row, "ELAS/GREEN_LAGRANGE", x,
                          linear_field(x, D, {{stretch[0] - 1, 0, 0}, {0, stretch[1] - 1, 0}, {0, 0, stretch[2] - 1}}), {});
  ASSERT_EQ(answer.error, LACON_FINE);
  double strain[3];
  for (int i = 0; i < 3; ++i) strain[i] = (stretch[i] * stretch[i] - 1) / 2;
  if (plane_stress) {
    strain[2] = -poisson / (1 - poisson) * (strain[0] + strain[1]);
    stretch[2] = std::sqrt(1 + 2 * strain[2]);
  }
  const double volume = stretch[0] * stretch[1] * stretch[2];
  for (std::size_t i = 0; i < answer.state.stress.size(); ++i) {
    const std::size_t c = i % row.stress.size();
    double exact = 0;
    if (c < 3)  // Cauchy's stress F S F^T / J
      exact = (lambda * (strain[0] + strain[1] + strain[2]) + 2 * mu * strain[c]) * stretch[c] * stretch[c] / volume;
    EXPECT_NEAR(answer.state.stress[i], exact, 1e-12 * young) << row.stress[c];
  }
}

TEST_P(Turning, StressTurnsWithTheBody) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const double f[3][3] = {{1.2, 0.3, D == 3 ? 0.1 : 0}, {-0.1, 0.9, 0}, {0, D == 3 ? -0.2 : 0, 1}},
               q[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
  double plain[3][3], turned[3][3];  // gradients of the displacement: F - I, Q F - I
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      plain[i][k] = f[i][k] - (i == k);
      turned[i][k] = q[i][0] * f[0][k] + q[i][1] * f[1][k] + q[i][2] * f[2][k] - (i == k);
    }
  const auto before = run(row, "ELAS/GREEN_LAGRANGE", x, linear_field(x, D, plain), {}),
             after = run(row, "ELAS/GREEN_LAGRANGE", x, linear_field(x, D, turned), {});
  const std::size_t n = row.stress.size();
  for (std::size_t p = 0; p < before.state.stress.size(); p += n) {
    const double* v = before.state.stress.data() + p;
    const double w4 = D == 3 ? v[4] : 0, w5 = D == 3 ? v[5] : 0;
    const double sigma[3][3] = {{v[0], v[3], w4}, {v[3], v[1], w5}, {w4, w5, v[2]}};
    const auto exact = [&](int i, int k) {
      double sum = 0;
      for (int m = 0; m < 3; ++m)
        for (int l = 0; l < 3; ++l) sum += q[i][m] * sigma[m][l] * q[k][l];
      return sum;
    };
    const std::pair<int, int> places[] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_NEAR(after.state.stress[p + i], exact(places[i].first, places[i].second), 1e-12 * young) << row.stress[i];
  }
}

TEST_P(GreenLagrange, ABodyTurnedInsideOutIsSaid) {
  const auto answer = run(row, "ELAS/GREEN_LAGRANGE", x, linear_field(x, D, {{0, 0, 0}, {0, -1.5, 0}, {0, 0, 0}}), {});
  EXPECT_EQ(answer.error, LACON_INSIDE_OUT);
  for (const double f : answer.force) EXPECT_TRUE(std::isfinite(f));  // the iterations may go on
}

std::vector<const ElementRow*> turning() {
  std::vector<const ElementRow*> rows = solids();
  std::erase_if(rows, [](const ElementRow* row) { return row->geometry == lacon::catalog::Geometry::axis; });
  return rows;
}

INSTANTIATE_TEST_SUITE_P(All, Turning, testing::ValuesIn(turning()), [](const auto& row) { return test_name(*row.param); });
INSTANTIATE_TEST_SUITE_P(All, GreenLagrange, testing::ValuesIn(solids()),
                         [](const auto& row) { return test_name(*row.param); });

// ---------------------------------------------------------------------------------------------------- PETIT_REAC

TEST(Updated, AStretchInStepsTendsToTheLogarithmicStrain) {
  // from length a to b the strain is (b - a) / b on the geometry of u, and 2 (b - a) / (a + b) on the one in the middle: their
  // sums tend to log(l / L) with the first and the second order
  const ElementRow& row = *registry().find_element("3D/HEXA8");
  const Numbers x = shaken(lacon::catalog::cell(row.cell));
  const double final = 1.5, uniaxial = lambda + 2 * mu;
  for (const auto& [option, share, order] :
       {std::tuple("ELAS/PETIT_REAC", 1.0, 1), std::tuple("ELAS/PETIT_REAC_MILIEU", 0.5, 2)}) {
    Numbers errors;
    for (const int steps : {10, 20, 40}) {
      State state;
      double strain = 0;
      for (int n = 1; n <= steps; ++n) {
        const double before = 1 + (final - 1) * (n - 1) / steps, now = 1 + (final - 1) * n / steps;
        const auto answer = run(row, option, x, linear_field(x, 3, {{now - 1, 0, 0}, {0, 0, 0}, {0, 0, 0}}), state);
        ASSERT_EQ(answer.error, LACON_FINE);
        state = answer.state;
        strain += (now - before) / (share * now + (1 - share) * before);
        EXPECT_NEAR(state.stress[0], uniaxial * strain, 1e-12 * young);
        EXPECT_NEAR(state.stress[1], lambda * strain, 1e-12 * young);
      }
      errors.push_back(std::abs(state.stress[0] / uniaxial - std::log(final)));
    }
    for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), order, 0.1) << option;
  }
}

TEST(Updated, ForcesAreThoseOfTheCurrentGeometry) {
  // stretched to 1.5 in x, the facet of a unit cube in yz keeps its area: force = stress; in x y it grows: force = 1.5 stress
  const ElementRow& row = *registry().find_element("3D/HEXA8");
  const auto& cell = lacon::catalog::cell(row.cell);
  Numbers x(cell.nodes.begin(), cell.nodes.end());
  for (double& coordinate : x) coordinate = (coordinate + 1) / 2;
  const auto answer = run(row, "ELAS/PETIT_REAC", x, linear_field(x, 3, {{0.5, 0, 0}, {0, 0, 0}, {0, 0, 0}}), {});
  double along = 0, across = 0;
  for (std::size_t a = 0; a < 8; ++a) {
    if (x[3 * a] > 0.5) along += answer.force[3 * a];
    if (x[3 * a + 2] > 0.5) across += answer.force[3 * a + 2];
  }
  EXPECT_NEAR(along, answer.state.stress[0], 1e-12 * young);
  EXPECT_NEAR(across, 1.5 * answer.state.stress[2], 1e-12 * young);
}

// ---------------------------------------------------------------------------------------------------- PETIT_REAC_MILIEU

TEST(Centred, TheHoopStrainOfARingIsTakenInTheMiddleToo) {
  // a ring cell whose radius r grows by the factor 1.2: 2 (1.2 - 1) / (1.2 + 1), and the same along r
  const ElementRow& row = *registry().find_element("AXIS/QUAD4");
  const Numbers x = shaken(lacon::catalog::cell(row.cell));
  const auto answer = run(row, "ELAS/PETIT_REAC_MILIEU", x, linear_field(x, 2, {{0.2, 0, 0}, {0, 0, 0}, {0, 0, 0}}), {});
  ASSERT_EQ(answer.error, LACON_FINE);
  const double strain = 0.4 / 2.2;
  EXPECT_NEAR(answer.state.stress[0], (2 * lambda + 2 * mu) * strain, 1e-12 * young);
  EXPECT_NEAR(answer.state.stress[1], 2 * lambda * strain, 1e-12 * young);
  EXPECT_NEAR(answer.state.stress[2], (2 * lambda + 2 * mu) * strain, 1e-12 * young);
}

TEST(Centred, APathAndItsReversalLeaveNoStress) {
  // each step back is its step there with the other sign: the middle is the same
  const ElementRow& row = *registry().find_element("3D/HEXA20");
  const Numbers x = shaken(lacon::catalog::cell(row.cell));
  State state;
  double largest = 0;
  for (const double size : {0.02, 0.05, 0.08, 0.05, 0.02, 0.0}) {
    Numbers u = shaken_displacement(x.size(), 1, 4);
    for (double& value : u) value *= size;
    const auto answer = run(row, "ELAS/PETIT_REAC_MILIEU", x, u, state);
    ASSERT_EQ(answer.error, LACON_FINE);
    state = answer.state;
    for (const double stress : state.stress) largest = std::max(largest, std::abs(stress));
  }
  EXPECT_GT(largest, 0.01 * young);
  for (const double stress : state.stress) EXPECT_NEAR(stress, 0, 1e-13 * young);
}

// ---------------------------------------------------------------------------------------------------- plasticity

/// The yield stress and its argument of a curve.
double yield(const Numbers& curve, double p) {
  double value = 0;
  for (std::size_t i = 0; i < curve.size(); i += 3)
    if (p >= curve[i]) value = curve[i + 1] + curve[i + 2] * (p - curve[i]);
  return value;
}

/// The path of a stress with one sense: von Mises stress q, plastic strain p. A total "strain" t has q = stiffness (t - p).
struct OneSense {
  double stiffness;
  const Numbers& curve;
  double p = 0, flow = 0;  // flow: signed plastic strain

  double stress(double t) {
    const double trial = stiffness * (t - flow);
    if (std::abs(trial) <= yield(curve, p)) return trial;
    const double dp = root(0, std::abs(t) + std::abs(flow),
                           [&](double d) { return yield(curve, p + d) - (std::abs(trial) - stiffness * d); });
    p += dp;
    flow += std::copysign(dp, trial);
    return std::copysign(yield(curve, p), trial);
  }
};

struct Plastic : testing::TestWithParam<std::tuple<std::string, std::string, const Numbers*>> {
  const ElementRow& row = *registry().find_element(std::get<0>(GetParam()));
  const Numbers& curve = *std::get<2>(GetParam());
  const Numbers x = shaken(lacon::catalog::cell(row.cell));
  const int D = lacon::catalog::cell(row.cell).dimension;
};

const double path[] = {0.003, 0.02, 0.05, 0.03, -0.01, -0.04, 0.01, 0.09};  // load, unload, reload the other way, and back

TEST_P(Plastic, PureShearFollowsTheClosedForm) {
  // q = sqrt(3) tau, tau = mu (gamma - sqrt(3) p): q = 3 mu (gamma / sqrt(3) - p)
  if (row.geometry == lacon::catalog::Geometry::axis) return;  // there is no homogeneous shear
  OneSense exact{3 * mu, curve};
  State state;
  for (const double gamma : path) {
    const auto answer =
        run(row, std::get<1>(GetParam()), x, linear_field(x, D, {{0, gamma, 0}, {0, 0, 0}, {0, 0, 0}}), state, curve);
    ASSERT_EQ(answer.error, LACON_FINE);
    const double before = exact.p, q = exact.stress(gamma / std::sqrt(3));
    state = answer.state;
    const std::size_t n = row.stress.size();
    for (std::size_t i = 0; i < state.stress.size(); ++i)
      EXPECT_NEAR(state.stress[i], i % n == 3 ? q / std::sqrt(3) : 0, 1e-12 * young) << gamma;
    for (std::size_t i = 0; i < state.variable.size(); i += 2) {
      EXPECT_NEAR(state.variable[i], exact.p, 1e-12);
      EXPECT_EQ(state.variable[i + 1], exact.p > before);
    }
  }
}

TEST_P(Plastic, EqualStretchOfTwoDirectionsFollowsTheClosedForm) {
  // two equal principal strains e and the third free or zero: the stress stays on one ray
  const bool plane_stress = row.stress_state == lacon::catalog::StressState::plane_stress;
  State state;
  // C_PLAN: q = |sigma|, e = sigma (1 - nu) / E + p / 2. Others, third strain zero: deviatoric strain e/3 (1, 1, -2), q = 3 mu
  // (2 e / 3 - p)
  OneSense exact{plane_stress ? young / (2 * (1 - poisson)) : 3 * mu, curve};
  for (const double e : path) {
    double gradient[3][3] = {{e, 0, 0}, {0, e, 0}, {0, 0, 0}};
    if (row.geometry == lacon::catalog::Geometry::axis) gradient[1][1] = 0;  // radial and hoop strain
    const auto answer = run(row, std::get<1>(GetParam()), x, linear_field(x, D, gradient), state, curve);
    ASSERT_EQ(answer.error, LACON_FINE);
    const double q = exact.stress(plane_stress ? 2 * e : 2 * e / 3);
    const double mean = (lambda + 2 * mu / 3) * 2 * e;
    state = answer.state;
    const std::size_t n = row.stress.size(), third = row.geometry == lacon::catalog::Geometry::axis ? 1 : 2;
    for (std::size_t i = 0; i < state.stress.size(); ++i) {
      const std::size_t c = i % n;
      const double value = plane_stress ? (c < 2 ? q : 0) : c > 2 ? 0 : mean + (c == third ? -2 * q / 3 : q / 3);
      EXPECT_NEAR(state.stress[i], value, 1e-11 * young) << row.stress[c] << ' ' << e;
    }
    for (std::size_t i = 0; i < state.variable.size(); i += 2) EXPECT_NEAR(state.variable[i], exact.p, 1e-11);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Plastic,
                         testing::Combine(testing::Values("D_PLAN/QUAD4", "C_PLAN/QUAD8", "AXIS/TRIA6", "3D/TETRA10",
                                                          "3D/HEXA8"),
                                          testing::Values("VMIS_ISOT_LINE/PETIT"), testing::Values(&linear_hardening, &pieces)),
                         [](const auto& given) {
                           std::string name = std::get<0>(given.param);
                           name[name.find('/')] = '_';
                           return name + (std::get<2>(given.param) == &pieces ? "_pieces" : "_line");
                         });

/// The same paths with the middle of the criterion moving: the stress t of one sense, from the strain of it, and the middle h
/// times the flow, in pure shear and where two principal strains are equal.
TEST(Plasticity, KinematicHardeningFollowsTheClosedForm) {
  const double yield = linear_hardening[1], h = linear_hardening[2];
  for (const char* const name : {"D_PLAN/QUAD4", "AXIS/TRIA6", "3D/TETRA10", "3D/HEXA8"}) {
    const ElementRow& row = *registry().find_element(name);
    const Numbers x = shaken(lacon::catalog::cell(row.cell));
    const int D = lacon::catalog::cell(row.cell).dimension;
    const bool axis = row.geometry == lacon::catalog::Geometry::axis;
    for (const bool shear : {true, false}) {
      if (axis && shear) continue;  // there is no homogeneous shear
      State state;
      double flow = 0;
      for (const double e : path) {
        double gradient[3][3] = {{0, e, 0}, {0, 0, 0}, {0, 0, 0}};
        if (!shear) gradient[0][0] = e, gradient[0][1] = 0, gradient[1][1] = axis ? 0 : e;
        const double strain = shear ? e / std::sqrt(3) : 2 * e / 3, before = flow;
        const double relative = 3 * mu * (strain - flow) - h * flow;
        if (std::abs(relative) > yield) flow += std::copysign((std::abs(relative) - yield) / (3 * mu + h), relative);
        const double q = 3 * mu * (strain - flow), middle = h * flow, mean = (lambda + 2 * mu / 3) * 2 * e;
        const auto answer = run(row, "VMIS_CINE_LINE/PETIT", x, linear_field(x, D, gradient), state);
        ASSERT_EQ(answer.error, LACON_FINE);
        state = answer.state;
        const std::size_t n = row.stress.size(), third = axis ? 1 : 2;
        const auto along = [&](std::size_t c, double size) {  // component of a deviator of this von Mises stress
          return shear ? (c == 3 ? size / std::sqrt(3) : 0) : c > 2 ? 0 : c == third ? -2 * size / 3 : size / 3;
        };
        for (std::size_t i = 0; i < state.stress.size(); ++i)
          EXPECT_NEAR(state.stress[i], along(i % n, q) + (!shear && i % n < 3 ? mean : 0), 1e-11 * young) << name << ' ' << e;
        for (std::size_t i = 0; i < state.variable.size(); ++i)
          EXPECT_NEAR(state.variable[i], i % 7 == 6 ? flow != before : along(i % 7, middle), 1e-11 * young) << name << ' ' << e;
      }
    }
  }
}

TEST(Plasticity, PlaneStressOfAnyDirectionIsOnTheCriterion) {
  // against the law in space: with the strain across that makes SIZZ zero the stresses must be the same
  const ElementRow &plane = *registry().find_element("C_PLAN/TRIA3"), &space = *registry().find_element("3D/TETRA4");
  const Numbers x = shaken(lacon::catalog::cell(plane.cell)), y = shaken(lacon::catalog::cell(space.cell));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-0.05, 0.05);
  for (int trial = 0; trial < 50; ++trial) {
    State flat, solid;
    for (int step = 0; step < 3; ++step) {
      const double exx = number(random), eyy = number(random), exy = number(random);
      const auto answer =
          run(plane, "VMIS_ISOT_TRAC/PETIT", x, linear_field(x, 2, {{exx, exy, 0}, {exy, eyy, 0}, {0, 0, 0}}), flat, pieces);
      ASSERT_EQ(answer.error, LACON_FINE);
      const auto in_space = [&](double ezz) {
        return run(space, "VMIS_ISOT_TRAC/PETIT", y, linear_field(y, 3, {{exx, exy, 0}, {exy, eyy, 0}, {0, 0, ezz}}), solid,
                   pieces);
      };
      const auto reference = in_space(root(-1, 1, [&](double ezz) { return in_space(ezz).state.stress[2]; }));
      flat = answer.state;
      solid = reference.state;
      for (const std::size_t c : {0, 1, 3}) EXPECT_NEAR(flat.stress[c], solid.stress[c], 1e-10 * young);
      EXPECT_EQ(flat.stress[2], 0);
      EXPECT_NEAR(flat.variable[0], solid.variable[0], 1e-10);
    }
  }
}

TEST(Plasticity, AStepOfNoLengthHasTheTangentOfMoreFlowWhereTheLastStepFlowed) {
  for (const auto& [element, option] : cases()) {
    if (!option.starts_with("VMIS")) continue;
    const ElementRow& row = *element;
    SCOPED_TRACE(test_name(row) + " " + option);
    const Numbers x = shaken(lacon::catalog::cell(row.cell));
    const Numbers u = shaken_displacement(x.size(), 0.05, 1);
    State from = run(row, option, x, u, {}).state;
    const auto rest = run(row, option, x, u, from);
    constexpr double share = 1e-7;  // of the displacement, further
    Numbers further = u;
    for (double& value : further) value *= 1 + share;
    const auto more = run(row, option, x, further, from);
    double largest = 0, stress = 0;
    for (const double entry : more.matrix) largest = std::max(largest, std::abs(entry));
    for (const double component : from.stress) stress = std::max(stress, std::abs(component));
    for (std::size_t i = 0; i < rest.matrix.size(); ++i) EXPECT_NEAR(rest.matrix[i], more.matrix[i], 1e-4 * largest) << i;
    for (std::size_t i = 0; i < from.stress.size(); ++i) EXPECT_NEAR(rest.state.stress[i], from.stress[i], 1e-12 * stress);
    const lacon_kernel& kernel = registry().kernel(row, option, LACON_SOLID);
    const std::size_t width = z(lacon::n_names(kernel.variables));
    for (std::size_t i = place_of_flow(kernel); i < from.variable.size(); i += width) {
      EXPECT_EQ(rest.state.variable[i], 0);  // nothing has grown
      from.variable[i] = 0;
    }
    const auto elastic = run(row, option, x, u, from), asked = run(row, option, x, u, from, linear_hardening, true);
    for (std::size_t i = 0; i < elastic.matrix.size(); ++i) EXPECT_NEAR(elastic.matrix[i], asked.matrix[i], 1e-12 * largest);
  }
}

TEST(Plasticity, BeyondTheEndOfTheCurveIsSaid) {
  const ElementRow& row = *registry().find_element("3D/HEXA8");
  const Numbers x = shaken(lacon::catalog::cell(row.cell));
  const Numbers ends = {0, 1, 10, 0.01, 1.1, std::numeric_limits<double>::quiet_NaN()};
  for (const auto& [gamma, error] : {std::pair{0.01, LACON_FINE}, {0.1, LACON_BEYOND_CURVE}})
    EXPECT_EQ(run(row, "VMIS_ISOT_TRAC/PETIT", x, linear_field(x, 3, {{0, gamma, 0}, {0, 0, 0}, {0, 0, 0}}), {}, ends).error,
              error);
}

/// The matrix of elasticity is summed in another order than that of other laws: pairs of nodes first.
struct ElasticMatrix : testing::TestWithParam<const ElementRow*> {};
TEST_P(ElasticMatrix, IsThatOfElasticityWhateverTheLaw) {
  const ElementRow& row = *GetParam();
  const Numbers x = shaken(lacon::catalog::cell(row.cell)), u = shaken_displacement(x.size(), 0.1, 3);
  const auto plain = run(row, "ELAS/PETIT", x, u, {}),
             flowing = run(row, "VMIS_ISOT_LINE/PETIT", x, u, {}, linear_hardening, true);
  double largest = 0;
  for (const double entry : plain.matrix) largest = std::max(largest, std::abs(entry));
  ASSERT_GT(largest, 0.05 * young);
  // a sum over points of products of sums over nodes
  const double round_off = 10 * std::numeric_limits<double>::epsilon() * table_of(row).n_points * largest;
  for (std::size_t i = 0; i < plain.matrix.size(); ++i) EXPECT_NEAR(flowing.matrix[i], plain.matrix[i], round_off);
  EXPECT_GT(flowing.state.variable[0], 0);
}
INSTANTIATE_TEST_SUITE_P(All, ElasticMatrix, testing::ValuesIn(solids()),
                         [](const auto& row) { return test_name(*row.param); });

/// Deeply compressed, an element buckles by its tangent; the matrix without the terms of the stress is that of small strains on
/// the geometry of u, which has no negative diagonal.
TEST(Stressless, MatrixOfTheUpdatedGeometryIsThatOfSmallStrainsThere) {
  for (const std::string law : {"ELAS", "VMIS_ISOT_LINE"}) {
    const ElementRow& row = *registry().find_element("D_PLAN/QUAD8");
    const Numbers x = shaken(lacon::catalog::cell(row.cell));
    State from = run(row, law + "/PETIT_REAC", x, Numbers(x.size(), 0.0), {}).state;
    for (double& stress : from.stress) stress = -young;              // of all components
    if (law != "ELAS") from.stress.assign(from.stress.size(), 0.0);  // does not flow
    const Numbers u = shaken_displacement(x.size(), 0.05, 1);
    Numbers there = x;
    for (std::size_t i = 0; i < x.size(); ++i) there[i] += u[i];
    from.displacement = u;
    const auto updated = run(row, law + "/PETIT_REAC", x, u, from, linear_hardening, false, true),
               tangent = run(row, law + "/PETIT_REAC", x, u, from),
               small = run(row, "ELAS/PETIT", there, Numbers(x.size(), 0.0), {});
    double stress_terms = 0;
    for (std::size_t i = 0; i < small.matrix.size(); ++i) {
      EXPECT_NEAR(updated.matrix[i], small.matrix[i], 1e-12 * young);
      stress_terms = std::max(stress_terms, std::abs(tangent.matrix[i] - small.matrix[i]));
    }
    if (law == "ELAS") {
      EXPECT_GT(stress_terms, 0.1 * young);
    }
  }
}

/// Forces do not depend on the kind of matrix, and without stress the tangent of Green-Lagrange strains has no term of it.
TEST(Stressless, MatrixOfGreenLagrangeIsTheTangentWhereThereIsNoStress) {
  const ElementRow& row = *registry().find_element("D_PLAN/QUAD8");
  const Numbers x = shaken(lacon::catalog::cell(row.cell)), u = shaken_displacement(x.size(), 0.05, 3);
  const double quarter_turn[3][3] = {{-1, -1, 0}, {1, -1, 0}, {0, 0, 0}};
  const auto matrices = [&](const Numbers& at) {
    return std::pair(run(row, "ELAS/GREEN_LAGRANGE", x, at, {}),
                     run(row, "ELAS/GREEN_LAGRANGE", x, at, {}, linear_hardening, false, true));
  };
  const auto [turned, turned_stressless] = matrices(linear_field(x, 2, quarter_turn));
  const auto [bent, bent_stressless] = matrices(u);
  double stress_terms = 0;
  for (std::size_t i = 0; i < turned.matrix.size(); ++i) {
    EXPECT_NEAR(turned_stressless.matrix[i], turned.matrix[i], 1e-12 * young);
    stress_terms = std::max(stress_terms, std::abs(bent.matrix[i] - bent_stressless.matrix[i]));
  }
  EXPECT_GT(stress_terms, 1e-3 * young);
  EXPECT_EQ(bent.force, bent_stressless.force);
}

}  // namespace
