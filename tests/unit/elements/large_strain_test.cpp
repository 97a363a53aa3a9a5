// Measures of large strain, on every cell that has them: objectivity, closed forms, and what they have in common with each
// other.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <tuple>

#include "solid_run.hpp"

namespace {

using Tensor = std::array<std::array<double, 3>, 3>;
constexpr double bulk = lambda + 2 * mu / 3;
const Numbers never_flows = {0, 1e9, 20};

Tensor product(const Tensor& a, const Tensor& b) {
  Tensor c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t m = 0; m < 3; ++m) c[i][k] += a[i][m] * b[m][k];
  return c;
}

Numbers moved_by(const Numbers& x, int dimension, const Tensor& f) {
  double gradient[3][3];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) gradient[i][k] = f[i][k] - (i == k);
  return linear_field(x, dimension, gradient);
}

constexpr std::pair<std::size_t, std::size_t> places[] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

using Case = std::tuple<const ElementRow*, std::string>;
struct LargeStrain : testing::TestWithParam<Case> {
  const ElementRow& row = *std::get<0>(GetParam());
  const std::string option = std::get<1>(GetParam());
  const int D = lacon::catalog::cell(row.cell).dimension;
  const Numbers x = shaken(lacon::catalog::cell(row.cell));
};
struct Objectivity : LargeStrain {};  // what the axis of revolution does not allow

TEST_P(Objectivity, StressTurnsWithTheBodyAndNothingElseChanges) {
  // stretched in two steps, the second with a rotation by 1.2 radians on it or without
  const double c = std::cos(1.2), s = std::sin(1.2);
  const Tensor turn{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
  const double across = D == 3 ? 0.1 : 0;
  const Tensor first{{{1.1, 0.05, across}, {-0.02, 0.95, 0}, {0, across, 1}}},
      second{{{1.3, 0.2, across}, {-0.1, 0.9, 0}, {0, 2 * across, 1}}};
  const State start = run(row, option, x, moved_by(x, D, first), {}).state;
  const auto plain = run(row, option, x, moved_by(x, D, second), start),
             turned = run(row, option, x, moved_by(x, D, product(turn, second)), start);
  ASSERT_EQ(plain.error, LACON_FINE);
  ASSERT_EQ(turned.error, LACON_FINE);
  const std::size_t n = row.stress.size();
  for (std::size_t p = 0; p < plain.state.stress.size(); p += n) {
    Tensor sigma{}, back{};
    for (std::size_t i = 0; i < n; ++i)
      sigma[places[i].first][places[i].second] = sigma[places[i].second][places[i].first] = plain.state.stress[p + i];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) back[i][k] = turn[k][i];
    const Tensor exact = product(product(turn, sigma), back);
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_NEAR(turned.state.stress[p + i], exact[places[i].first][places[i].second], 1e-12 * young);
  }
  const std::size_t width = option.ends_with("SIMO_MIEHE") ? 8 : 2;
  for (std::size_t i = 0; i < plain.state.variable.size(); i += width)
    EXPECT_NEAR(turned.state.variable[i], plain.state.variable[i], 1e-12);  // plastic strain
  if (option.starts_with("VMIS")) {
    EXPECT_GT(plain.state.variable[0], 0.01);
  }
}

TEST_P(LargeStrain, AHomogeneousStretchGivesTheStressOfTheLaw) {
  const double stretch[3] = {1.3, 0.8, D == 3 ? 1.15 : row.geometry == lacon::catalog::Geometry::axis ? 1.3 : 1};
  const auto answer =
      run(row, option, x, moved_by(x, D, {{{stretch[0], 0, 0}, {0, stretch[1], 0}, {0, 0, stretch[2]}}}), {}, never_flows);
  ASSERT_EQ(answer.error, LACON_FINE);
  const double volume = stretch[0] * stretch[1] * stretch[2];
  double tau[3];  // Kirchhoff's stress
  for (int i = 0; i < 3; ++i) {
    if (option.ends_with("GDEF_LOG")) {
      tau[i] = lambda * std::log(volume) + 2 * mu * std::log(stretch[i]);
    } else if (option.ends_with("GROT_GDEP")) {
      double trace = 0;
      for (const double l : stretch) trace += (l * l - 1) / 2;
      tau[i] = (lambda * trace + mu * (stretch[i] * stretch[i] - 1)) * stretch[i] * stretch[i];
    } else {
      double trace = 0;
      for (const double l : stretch) trace += l * l;
      tau[i] = bulk / 2 * (volume * volume - 1) + mu * std::pow(volume, -2.0 / 3) * (stretch[i] * stretch[i] - trace / 3);
    }
  }
  const std::size_t n = row.stress.size();
  for (std::size_t i = 0; i < answer.state.stress.size(); ++i)
    EXPECT_NEAR(answer.state.stress[i], i % n < 3 ? tau[i % n] / volume : 0, 1e-12 * young) << row.stress[i % n];
}

TEST_P(LargeStrain, ABodyTurnedInsideOutIsSaid) {
  const auto answer = run(row, option, x, moved_by(x, D, {{{1, 0, 0}, {0, -0.5, 0}, {0, 0, 1}}}), {});
  EXPECT_TRUE(answer.error == LACON_INSIDE_OUT) << answer.error;
  for (const double f : answer.force) EXPECT_TRUE(std::isfinite(f));  // the iterations may go on
}

std::vector<Case> cases(bool with_axis) {
  std::vector<Case> all;
  for (const ElementRow* row : solids())
    for (const std::string law : {"ELAS", "VMIS_ISOT_LINE"})
      for (const std::string measure : {"GDEF_LOG", "SIMO_MIEHE", "GROT_GDEP"})
        if (row->stress_state != lacon::catalog::StressState::plane_stress &&
            (with_axis || row->geometry != lacon::catalog::Geometry::axis))
          all.emplace_back(row, law + "/" + measure);
  return all;
}
INSTANTIATE_TEST_SUITE_P(All, LargeStrain, testing::ValuesIn(cases(true)), case_name);
INSTANTIATE_TEST_SUITE_P(All, Objectivity, testing::ValuesIn(cases(false)), case_name);

// ---------------------------------------------------------------------------------------------------- thermal strains

/// The stretch that a thermal strain makes where nothing resists.
double free_stretch(const std::string& option, double strain) {
  if (option.ends_with("GDEF_LOG")) return std::exp(strain);
  if (!option.ends_with("SIMO_MIEHE")) return std::sqrt(1 + 2 * strain);
  double volume = 1;  // J^2 - 1 = 3 e (J + 1 / J)
  for (int i = 0; i < 200; ++i) volume = std::sqrt(1 + 3 * strain * (volume + 1 / volume));
  return std::cbrt(volume);
}

struct Heated {
  const char* element;
  std::string option;
};
std::vector<Heated> heated() {
  std::vector<Heated> all;
  for (const char* element : {"3D/TETRA4", "AXIS/QUAD4", "D_PLAN/TRIA6", "C_PLAN/QUAD4"})
    for (const auto& kernel : registry().find_element(element)->kernels)
      if (kernel.option.find('/') != kernel.option.npos && !kernel.option.starts_with("VMIS_ISOT_TRAC") &&
          registry().kernel(*registry().find_element(element), kernel.option, LACON_SOLID).takes_thermal_strain)
        all.push_back({element, std::string(kernel.option)});
  return all;
}

TEST(ThermalStrain, ABodyThatNothingHoldsExpandsWithoutStress) {
  for (const auto& [element, option] : heated()) {
    if (std::string_view(element).starts_with("D_PLAN")) continue;  // it is held across
    const ElementRow& row = *registry().find_element(element);
    const Numbers x = shaken(lacon::catalog::cell(row.cell));
    const double l = free_stretch(option, 0.02);
    const auto answer = run(row, option, x, moved_by(x, static_cast<int>(row.dofs.size()), {{{l, 0, 0}, {0, l, 0}, {0, 0, l}}}),
                            {}, linear_hardening, false, false, 0.02);
    ASSERT_EQ(answer.error, LACON_FINE);
    for (const double stress : answer.state.stress) EXPECT_NEAR(stress, 0, 1e-12 * young) << element << ' ' << option;
    for (const double force : answer.force) EXPECT_NEAR(force, 0, 1e-12 * young) << element << ' ' << option;
  }
}

TEST(ThermalStrain, TheMatrixIsTheDerivativeOfTheForce) {
  for (const auto& [element, option] : heated()) {
    const ElementRow& row = *registry().find_element(element);
    const Numbers x = shaken(lacon::catalog::cell(row.cell));
    State from = run(row, option, x, shaken_displacement(x.size(), 0.02, 3), {}, linear_hardening, false, false, 0.01).state;
    const Numbers u = shaken_displacement(x.size(), 0.05, 4);
    const auto force_at = [&](const Numbers& v) { return run(row, option, x, v, from, linear_hardening, false, false, 0.03); };
    const Answer at = force_at(u);
    ASSERT_EQ(at.error, LACON_FINE);
    const std::size_t n = x.size();
    std::vector<Numbers> derivative(n);
    constexpr double step = 1e-6;
    for (std::size_t j = 0; j < n; ++j) {
      Numbers low = u, high = u;
      low[j] -= step;
      high[j] += step;
      const Numbers before = force_at(low).force, after = force_at(high).force;
      for (std::size_t i = 0; i < n; ++i) derivative[j].push_back((after[i] - before[i]) / (2 * step));
    }
    double largest = 0;
    for (const double entry : at.matrix) largest = std::max(largest, std::abs(entry));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        EXPECT_NEAR(at.matrix[i * (i + 1) / 2 + j], (derivative[j][i] + derivative[i][j]) / 2, 2e-8 * largest)
            << element << option;
        if (at.whole_matrix.empty()) continue;
        EXPECT_NEAR(at.whole_matrix[i * n + j], derivative[j][i], 2e-8 * largest) << element << option;
      }
  }
}

TEST(ThermalStrain, OfPlaneStressIsThatOfABodyThatIsFreeAcross) {
  const ElementRow &plate = *registry().find_element("C_PLAN/QUAD4"), &body = *registry().find_element("3D/HEXA8");
  const Numbers x = shaken(lacon::catalog::cell(plate.cell)), y = shaken(lacon::catalog::cell(body.cell));
  const auto at = [&](double across) {
    return run(body, "ELAS/GREEN_LAGRANGE", y, moved_by(y, 3, {{{1.1, 0.05, 0}, {-0.02, 0.95, 0}, {0, 0, across}}}), {},
               linear_hardening, false, false, 0.04);
  };
  double low = 0.5, high = 1.5;
  for (int i = 0; i < 100; ++i) (at((low + high) / 2).state.stress[2] > 0 ? high : low) = (low + high) / 2;
  const Numbers exact = at(low).state.stress,
                found = run(plate, "ELAS/GREEN_LAGRANGE", x, moved_by(x, 2, {{{1.1, 0.05, 0}, {-0.02, 0.95, 0}, {0, 0, 1}}}),
                            {}, linear_hardening, false, false, 0.04)
                            .state.stress;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found[i], exact[i], 1e-12 * young);
}

TEST(ThermalStrain, AddsUpFromStateToState) {
  // heated in one step or in two, at rest: the same stress
  for (const std::string option : {"VMIS_ISOT_LINE/GDEF_LOG", "VMIS_ISOT_LINE/GROT_GDEP", "VMIS_ISOT_LINE/SIMO_MIEHE"}) {
    const ElementRow& row = *registry().find_element("3D/HEXA8");
    const Numbers x = shaken(lacon::catalog::cell(row.cell)),
                  u = moved_by(x, 3, {{{1.02, 0.01, 0}, {0, 0.99, 0}, {0, 0, 1.01}}});
    const auto heat = [&](double strain, const State& from) {
      return run(row, option, x, u, from, never_flows, false, false, strain).state;
    };
    const Numbers once = heat(0.03, {}).stress, twice = heat(0.03, heat(0.01, {})).stress;
    for (std::size_t i = 0; i < once.size(); ++i) EXPECT_NEAR(twice[i], once[i], 1e-12 * young) << option;
  }
}

// ---------------------------------------------------------------------------------------------------- uniaxial tension

/// Tension to the stretch 1.5 in steps, free across. @return true stress along
double tension(const std::string& option, int steps, State& state) {
  const ElementRow& row = *registry().find_element("3D/HEXA8");
  const Numbers x = shaken(lacon::catalog::cell(row.cell));
  double stress = 0;
  for (int n = 1; n <= steps; ++n) {
    const double along = std::pow(1.5, static_cast<double>(n) / steps);
    const auto at = [&](double across) {
      return run(row, option, x, moved_by(x, 3, {{{along, 0, 0}, {0, across, 0}, {0, 0, across}}}), state);
    };
    const double across = root(0.5, 1.1, [&](double a) { return at(a).state.stress[1]; });
    const auto answer = at(across);
    EXPECT_EQ(answer.error, LACON_FINE);
    EXPECT_NEAR(answer.state.stress[1], 0, 1e-10 * young);
    stress = answer.state.stress[0];
    state = answer.state;
  }
  return stress;
}

TEST(Tension, OfLogarithmicStrainsIsTheClosedFormWhateverTheSteps) {
  // tau = R(p), ln(stretch) = tau / E + p, and ln J = (1 - 2 nu) tau / E
  const double tau = (1 + 20 * std::log(1.5)) / (1 + 20 / young), volume = std::exp((1 - 2 * poisson) * tau / young);
  for (const int steps : {1, 7}) {
    State state;
    EXPECT_NEAR(tension("VMIS_ISOT_LINE/GDEF_LOG", steps, state), tau / volume, 1e-10 * young);
    EXPECT_NEAR(state.variable[0], std::log(1.5) - tau / young, 1e-10);
  }
}

TEST(Tension, OfSimoAndMiehesLawTendsToTheSame) {
  // elastic strains are small beside the plastic ones: what the laws differ by is their square, and the step
  const double tau = (1 + 20 * std::log(1.5)) / (1 + 20 / young), volume = std::exp((1 - 2 * poisson) * tau / young);
  Numbers errors;
  for (const int steps : {10, 20, 40}) {
    State state;
    errors.push_back(std::abs(tension("VMIS_ISOT_LINE/SIMO_MIEHE", steps, state) * volume / tau - 1));
  }
  EXPECT_LT(errors.back(), 2 * (tau / young));
  EXPECT_LT(std::abs(errors[2] - errors[1]), 0.6 * std::abs(errors[1] - errors[0]) + 1e-9);  // of the first order in the step
}

}  // namespace
