// One instant: two squares pressed together, and a body at large strains.
#include "lacon/operators/evolution/newton/newton.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/newton/instant_failure.hpp"
#include "lacon/operators/evolution/state_fields.hpp"
#include "lacon/structures/hdf5.hpp"
#include "two_squares.hpp"

namespace lacon {
namespace {

using namespace test;

Newton newton(const StaticProblem& problem, double tolerance, int iterations = 20) {
  return {problem,
          {.criteria = {.resi_glob_rela = tolerance, .resi_glob_maxi = {}}, .iterations = iterations},
          std::make_unique<MumpsEngine>()};
}

constexpr double exx = poisson * (1 + poisson) * pressure / young, eyy = -(1 - poisson * poisson) * pressure / young;

void expect_uniform(const StaticProblem& problem, const StaticState& state) {
  for (std::size_t node = 0; node < problem.mesh.n_nodes(); ++node) {
    EXPECT_NEAR(state.displacement[2 * node], exx * problem.mesh.coordinates[3 * node], 1e-14);
    EXPECT_NEAR(state.displacement[2 * node + 1], eyy * (problem.mesh.coordinates[3 * node + 1] + 1), 1e-14);
  }
  EXPECT_NEAR(state.patches.lambda[0], -pressure, 1e-11);
}

TEST(Newton, SquaresPressedTogetherAreUniform) {
  const StaticProblem problem = pressed_squares();
  Newton solver = newton(problem, 1e-12);
  StaticState state = solver.initial_state();
  EXPECT_EQ(state.patches.status[0], Status::active);  // touching: INTERPENETRE
  std::vector<IterationReport> lines;
  const int iterations = solver.solve(1.0, state, [&](const IterationReport& line) { lines.push_back(line); });
  EXPECT_EQ(static_cast<int>(lines.size()), iterations + 1);
  EXPECT_TRUE(lines.back().converged());
  expect_uniform(problem, state);
  EXPECT_EQ(solver.equilibrium().n_constraints(state), 1);
}

TEST(Newton, IterationsBeyondTheLastLeadToTheEnd) {
  const StaticProblem problem = pressed_squares("ELAS/GREEN_LAGRANGE");
  const auto iterations = [&](int most) {
    Newton solver = newton(problem, 1e-13, most);
    StaticState state = solver.initial_state();
    return solver.solve(1.0, state, [](const IterationReport&) {});
  };
  const int needed = iterations(20);
  EXPECT_EQ(iterations(needed - 1), needed);
  EXPECT_THROW(iterations(needed / 2), Error);
}

// What no iteration meets fails in steps of any length.
TEST(Newton, RoundOffIsNotCut) {
  const StaticProblem problem = pressed_squares();
  NewtonOptions options{.criteria = {.resi_glob_rela = {}, .resi_glob_maxi = 1e-30}, .iterations = 8};
  Newton solver(problem, options, std::make_unique<MumpsEngine>());
  StaticState state = solver.initial_state();
  try {
    solver.solve(1.0, state, [](const IterationReport&) {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_FALSE(nature_of(error).depends_on_step);
  }
}

TEST(Newton, SearchesIncrementsUnlessItDoesAnyhow) {
  const StaticProblem problem = pressed_squares();
  NewtonOptions options{.criteria = {.resi_glob_rela = 1e-12, .resi_glob_maxi = {}}};
  Newton solver(problem, options, std::make_unique<MumpsEngine>());
  EXPECT_TRUE(solver.take(Effort::searches));
  EXPECT_FALSE(solver.take(Effort::searches));
  EXPECT_TRUE(solver.take(Effort::usual));
  EXPECT_FALSE(solver.take(Effort::usual));
  options.line_search = LineSearch{};
  Newton searching(problem, options, std::make_unique<MumpsEngine>());
  EXPECT_FALSE(searching.take(Effort::searches));
}

TEST(Newton, LastsForManyMoreIterations) {
  const StaticProblem problem = pressed_squares();
  for (const auto& [iterations, lasting] : {std::pair(2, 8), std::pair(20, 60), std::pair(70, 0)}) {
    // nothing is in balance to less than round-off
    const NewtonOptions options{.criteria = {.resi_glob_rela = {}, .resi_glob_maxi = 1e-300}, .iterations = iterations};
    Newton solver(problem, options, std::make_unique<MumpsEngine>());
    EXPECT_EQ(solver.take(Effort::lasts), lasting > 0);
    StaticState state = solver.initial_state();
    int last = 0;
    EXPECT_THROW(solver.solve(1.0, state, [&](const IterationReport& report) { last = report.iteration; }), Error);
    EXPECT_EQ(last, std::max(iterations, lasting));
  }
}

/// What elements, pressures, contact and the criteria make of displacements does not depend on what stands beside them.
TEST(Newton, UnknownsBesideTheDisplacementsChangeNothing) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("lacon_wide_" + std::to_string(::getpid()));
  for (const char* option : {"ELAS/PETIT", "ELAS/GREEN_LAGRANGE"})
    for (const bool following : {false, true}) {
      const StaticProblem narrow = pressed_squares(option, following), wide = wide_squares(folder, option, following);
      EXPECT_EQ(wide.components, (std::vector<std::string>{"DX", "DY", "TEMP"}));
      EXPECT_EQ(wide.dof_name(8), "N3 TEMP");
      EXPECT_EQ(wide.numbering.n_equations(), narrow.numbering.n_equations());
      Newton of_narrow = newton(narrow, 1e-12), of_wide = newton(wide, 1e-12);
      StaticState state = of_narrow.initial_state(), with_more = of_wide.initial_state();
      std::vector<IterationReport> lines, more_lines;
      of_narrow.solve(1.0, state, [&](const IterationReport& line) { lines.push_back(line); });
      of_wide.solve(1.0, with_more, [&](const IterationReport& line) { more_lines.push_back(line); });
      ASSERT_EQ(lines.size(), more_lines.size());
      for (std::size_t i = 0; i < lines.size(); ++i) {
        EXPECT_EQ(lines[i].maxi, more_lines[i].maxi);
        EXPECT_EQ(lines[i].rela, more_lines[i].rela);
        EXPECT_EQ(lines[i].geometry, more_lines[i].geometry);
      }
      for (std::size_t node = 0; node < narrow.mesh.n_nodes(); ++node) {
        for (std::size_t d = 0; d < 2; ++d)
          EXPECT_EQ(state.displacement[2 * node + d], with_more.displacement[3 * node + d]) << node;
        EXPECT_EQ(with_more.displacement[3 * node + 2], temperature);
      }
      EXPECT_EQ(state.patches.lambda, with_more.patches.lambda);
      const Field moved = displacement_field(wide, with_more);
      EXPECT_EQ(moved.components, (std::vector<std::string>{"DX", "DY", "TEMP", "LAGS_C"}));
      EXPECT_EQ(moved.at(12, 2), temperature);
      EXPECT_EQ(moved.at(12, 3), state.patches.lambda[0]);
      EXPECT_FALSE(moved.has(11, 3));
    }
  std::filesystem::remove_all(folder);
}

TEST(Newton, GoingBackLeavesNoTrace) {
  const StaticProblem problem = pressed_squares();
  Newton solver = newton(problem, 1e-12);
  const StaticState start = solver.initial_state();
  StaticState once = start, again = start;
  solver.solve(1.0, once, [](const IterationReport&) {});
  // given up in the middle: what the user's limit throws, for one
  EXPECT_THROW(solver.solve(1.0, once, [](const IterationReport&) { throw std::runtime_error("enough"); }), std::runtime_error);
  solver.restart(start);
  solver.solve(1.0, again, [](const IterationReport&) {});
  expect_uniform(problem, again);
}

// What was solved, and is not accepted (a step's event refuses it), is no motion that later instants go on with.
TEST(Newton, RemembersInstantsThatAreAccepted) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / ("lacon_newton_" + std::to_string(::getpid()));
  const StaticProblem problem = pressed_squares();
  Newton solver = newton(problem, 1e-12);
  const auto known = [&] {
    hdf5::write_whole(file, [&](const hdf5::Group& root) { solver.save(root); });
    return hdf5::Reader(file).open("prediction").integer("states");
  };
  StaticState state = solver.initial_state();
  solver.solve(1.0, state, [](const IterationReport&) {});
  EXPECT_EQ(known(), 0);
  solver.restart(solver.initial_state());
  state = solver.initial_state();
  solver.solve(1.0, state, [](const IterationReport&) {});
  solver.accept(state);
  EXPECT_EQ(known(), 2);  // where it began, and where it ended
  std::filesystem::remove(file);
}

TEST(Newton, ConvergesQuadraticallyAtLargeStrains) {
  StaticProblem problem = two_squares("ELAS/GREEN_LAGRANGE", false);
  problem.loads.push_back(hold(bottom, 1));
  problem.loads.push_back(hold(bottom, 0));
  problem.loads.push_back(hold({8, 9, 12}, 0));
  problem.loads.push_back(hold({8, 9, 12}, 1));
  problem.loads.push_back(press(problem, -0.2 * young, false));
  number(problem);
  Newton solver = newton(problem, 1e-13);
  StaticState state = solver.initial_state();
  std::vector<double> residuals;
  solver.solve(1.0, state, [&](const IterationReport& line) { residuals.push_back(line.rela); });
  // the last three above round-off
  while (residuals.size() > 3 && residuals.back() < 1e-12) residuals.pop_back();
  ASSERT_GE(residuals.size(), 3U);
  const double* const last = residuals.data() + residuals.size() - 3;
  EXPECT_GE(std::log(last[2] / last[1]) / std::log(last[1] / last[0]), 1.7) << last[0] << ' ' << last[1] << ' ' << last[2];
}

TEST(Newton, SaysWhatIsNotMetAndWhatIsLoose) {
  StaticProblem problem = pressed_squares("ELAS/GREEN_LAGRANGE");
  Newton hurried = newton(problem, 1e-30, 1);
  StaticState state = hurried.initial_state();
  try {
    hurried.solve(1.0, state, [](const IterationReport&) {});
    FAIL() << "nothing falls below 1e-30";
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "EVOLUTION_4");
    EXPECT_NE(error.message().text.find("RESI_GLOB_RELA"), std::string::npos) << error.message().text;
    EXPECT_NE(error.message().text.find("the residual changes by the factor"), std::string::npos) << error.message().text;
  }
  StaticProblem loose = two_squares("ELAS/PETIT", false);
  loose.loads.push_back(hold(bottom, 1));
  loose.loads.push_back(hold(axis, 0));
  number(loose);
  Newton solver = newton(loose, 1e-6);
  StaticState rest = solver.initial_state();
  try {
    solver.solve(1.0, rest, [](const IterationReport&) {});
    FAIL() << "the upper square is held by nothing";
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "SOLVER_3");
    EXPECT_NE(error.message().text.find("DY of the body of M5"), std::string::npos) << error.message().text;
  }
}

TEST(Newton, SaysWhatIsLooseSinceAnIteration) {
  // the upper square is pushed beyond the end of the lower one, which holds it until then
  StaticProblem problem = two_squares("ELAS/PETIT", true);
  problem.loads.push_back(hold(bottom, 1));
  problem.loads.push_back(hold(bottom, 0));
  problem.loads.push_back(hold({8, 9, 10, 11}, 0, 5.0));
  problem.loads.push_back(press(problem, pressure, false));
  number(problem);
  Newton solver = newton(problem, 1e-10);
  StaticState state = solver.initial_state();
  try {
    solver.solve(1.0, state, [](const IterationReport&) {});
    FAIL() << "nothing holds the upper square";
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "EVOLUTION_42");
    EXPECT_NE(error.message().text.find("DY of the body of M5"), std::string::npos) << error.message().text;
  }
}

TEST(StateFields, AreTheStateThatTheyCameFrom) {
  const StaticProblem problem = pressed_squares("VMIS_ISOT_LINE/PETIT");
  Newton solver = newton(problem, 1e-10);
  StaticState state = solver.initial_state();
  solver.solve(1.0, state, [](const IterationReport&) {});
  const FieldMakers fields = fields_of({problem, state, solver.contact()});
  const Field moved = fields.at("DEPL")().whole();
  EXPECT_EQ(moved.components, (std::vector<std::string>{"DX", "DY", "LAGS_C"}));
  for (std::size_t row = 0; row < moved.support.size(); ++row) {
    for (std::size_t d = 0; d < 2; ++d)
      EXPECT_EQ(moved.at(row, d), state.displacement[2 * static_cast<std::size_t>(moved.support[row]) + d]);
    const std::int32_t node = moved.support[row];
    EXPECT_EQ(moved.counts(row, 2), node == 12);                                 // the carrier alone
    EXPECT_EQ(moved.has(row, 2), node == 8 || node == 9 || node == 12) << node;  // the others of the skin stand in
    if (moved.has(row, 2)) {
      EXPECT_EQ(moved.at(row, 2), state.patches.lambda[0]);
    }
  }
  EXPECT_EQ(fields.at("SIEF_ELGA")().whole().n_rows(), 18U);
  const Field variables = fields.at("VARI_ELGA")().whole();
  EXPECT_GT(variables.at(0, 0), 0);  // it flows: 25 above 10
  EXPECT_FALSE(fields_of({pressed_squares(), state, nullptr}).contains("VARI_ELGA"));
  EXPECT_TRUE(fields.contains("CONT_ELEM"));
  EXPECT_TRUE(fields.contains("CONT_NOEU"));
}

}  // namespace
}  // namespace lacon
