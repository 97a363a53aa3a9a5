// RESI_REFE_RELA: the force by which a degree of freedom is measured.
#include "lacon/operators/evolution/problem/reference_forces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "two_squares.hpp"

namespace lacon {
namespace {

/// One stress component of one point at a time, put into the kernels of the elements.
std::vector<double> by_kernels(const StaticProblem& problem, double stress) {
  std::vector<double> forces(problem.n_dofs(), 0.0);
  const std::vector<double> at_rest(problem.n_dofs(), 0.0);
  for (const ElementSet& set : problem.solids) {
    const std::size_t n_values = set.n_stress();  // of a cell
    std::vector<double> stresses(set.cells.size() * n_values), result(stresses.size());
    for (std::size_t value = 0; value < n_values; ++value) {
      for (std::size_t i = 0; i < stresses.size(); ++i) stresses[i] = i % n_values == value ? stress : 0;
      const SolidInput input{.displacement = at_rest, .previous_displacement = at_rest, .previous_stress = stresses};
      evaluate_solids(set, problem.mesh, input, SolidMatrix::none, {result, {}}, [&](const ElementValues& element) {
        for (std::size_t i = 0; i < element.dofs.size(); ++i)
          forces[static_cast<std::size_t>(element.dofs[i])] += std::abs(element.force[i]) / set.tabulation.n_points;
      });
    }
  }
  return forces;
}

TEST(ReferenceForces, TheyAreThoseOfEachComponentAtEachPointByItself) {
  const StaticProblem problem = test::pressed_squares();
  const std::vector<double> found = reference_forces(problem, 8.0, {}), expected = by_kernels(problem, 8.0);
  for (std::size_t dof = 0; dof < found.size(); ++dof) EXPECT_NEAR(found[dof], expected[dof], 1e-13);
}

TEST(ReferenceForces, StressesOfOneSizeAreSummedUpToAllOfTheirPoints) {
  const StaticProblem problem = test::pressed_squares();
  StaticState state;
  for (const ElementSet& set : problem.solids)
    state.points.push_back({.stress = std::vector<double>(set.cells.size() * set.n_stress())});
  EXPECT_TRUE(summed_forces(problem, state).empty());
  for (PointValues& values : state.points) std::fill(values.stress.begin(), values.stress.end(), -8.0);
  const std::vector<double> found = summed_forces(problem, state), of_one = reference_forces(problem, 8.0, {});
  const int n_points = problem.solids[0].tabulation.n_points;
  for (std::size_t dof = 0; dof < found.size(); ++dof) EXPECT_NEAR(found[dof], n_points * of_one[dof], 1e-12);
}

TEST(ReferenceForces, SpringsNeedAForceOfTheirOwn) {
  StaticProblem problem = test::pressed_squares();
  const std::vector<double> without = reference_forces(problem, 8.0, {});
  problem.springs.push_back({.first = 1, .second = 2, .stiffness = {1, 0, 1, 0, 0, 0}});
  EXPECT_THROW(reference_forces(problem, 8.0, {}), Error);
  const std::vector<double> forces = reference_forces(problem, 8.0, 3.0);
  for (std::size_t dof = 0; dof < forces.size(); ++dof)
    EXPECT_NEAR(forces[dof] - without[dof], dof / 2 == 1 || dof / 2 == 2 ? 3.0 : 0.0, 1e-14);
}

}  // namespace
}  // namespace lacon
