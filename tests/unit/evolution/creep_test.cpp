// Iterations that creep: how their resistance goes up and down, and that it leaves no trace in what they find.
#include "lacon/operators/evolution/newton/creep.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/operators/evolution/newton/newton.hpp"
#include "two_squares.hpp"

namespace lacon::test {
namespace {

TEST(Creep, EasesWhileTheResidualFalls) {
  const StaticProblem problem = pressed_squares();
  Newton solver(problem, {}, std::make_unique<MumpsEngine>());
  solver.initial_state();
  Creep creep(problem, solver.equilibrium().system());
  const std::vector<double> first = creep.resistance();
  const auto share = [&] { return creep.resistance()[0] / first[0]; };
  creep.ease(7.0);  // there is none to compare with yet
  EXPECT_NEAR(share(), 0.3, 1e-15);
  creep.ease(7.0 * 0.2);
  EXPECT_NEAR(share(), 0.3 * 0.2, 1e-15);
  creep.ease(7.0 * 0.2 * 1e-3);
  EXPECT_NEAR(share(), 0.3 * 0.2 * 0.1, 1e-15);
  creep.ease(7.0 * 0.2 * 1e-3 * 1.2);
  EXPECT_NEAR(share(), 0.006 * 1.44, 1e-15);
  creep.ease(1.0);
  EXPECT_NEAR(share(), 0.006 * 1.44 * 2, 1e-15);
  creep.raise();
  EXPECT_NEAR(share(), 0.006 * 1.44 * 2 * 4, 1e-15);
  creep.ease(1e-3);  // where it had to be raised it stays for the next iteration
  EXPECT_NEAR(share(), 0.006 * 1.44 * 2 * 4, 1e-15);
  creep.ease(1e-3 * 0.2);
  EXPECT_NEAR(share(), 0.006 * 1.44 * 2 * 4 * 0.2, 1e-15);
}

// Squares of one cell each, in a model that is two of them high: as long as their stiffness times a quarter.
TEST(Creep, ResistsAsAMassOverTheLengthOfTheModel) {
  const StaticProblem problem = pressed_squares();
  Newton solver(problem, {}, std::make_unique<MumpsEngine>());
  solver.initial_state();
  const System& system = solver.equilibrium().system();
  const Creep creep(problem, system);
  const std::vector<SparseMatrix::RowSize> rows = system.matrix().row_sizes(system.first_multiplier());
  // the nodes of a QUAD8 are 0.7071 and 0.5 from its middle
  const double size = 2 / std::sqrt(2.0) * (std::sqrt(0.5) + 0.5) / 2;
  for (std::size_t e = 0; e < rows.size(); ++e)
    EXPECT_NEAR(creep.resistance()[e], rows[e].sum * size * size / 4, 1e-12 * rows[e].sum) << e;
  std::vector<double> solution(rows.size() + 2, 0.0);
  solution[3] = -0.1 * size;
  solution.back() = 100;  // a multiplier is no motion
  EXPECT_NEAR(creep.over_cells(solution), 0.1, 1e-15);
}

TEST(Creep, FindsTheSameEquilibrium) {
  for (const char* option : {"ELAS/PETIT", "ELAS/GREEN_LAGRANGE"}) {
    const StaticProblem problem = pressed_squares(option);
    std::vector<StaticState> found;
    for (const Effort effort : {Effort::usual, Effort::creeps}) {
      Newton solver(problem, {.criteria = {.resi_glob_rela = 1e-12, .resi_glob_maxi = {}}}, std::make_unique<MumpsEngine>());
      if (effort != Effort::usual) {
        EXPECT_TRUE(solver.take(effort));
      }
      found.push_back(solver.initial_state());
      solver.solve(1.0, found.back(), [](const IterationReport&) {});
      solver.accept(found.back());
    }
    for (std::size_t dof = 0; dof < found[0].displacement.size(); ++dof)
      EXPECT_NEAR(found[1].displacement[dof], found[0].displacement[dof], 1e-12) << option;
    EXPECT_NEAR(found[1].patches.lambda[0], found[0].patches.lambda[0], 1e-8 * pressure) << option;
  }
}

}  // namespace
}  // namespace lacon::test
