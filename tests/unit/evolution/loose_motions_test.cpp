// Motions of bodies that a matrix does not resist.
#include "lacon/assembly/loose_motions.hpp"

#include <gtest/gtest.h>

#include "lacon/operators/evolution/equilibrium.hpp"
#include "lacon/operators/evolution/free_bodies.hpp"
#include "two_squares.hpp"

namespace lacon {
namespace {

using namespace test;

LooseMotions motions_of(const StaticProblem& problem) {
  return {RigidMotions(geometry_of(problem, Bodies(problem.mesh))), problem.numbering};
}

/// Of two squares apart, the lower one held, at rest.
std::vector<LooseMotion> loose(StaticProblem problem) {
  problem.loads.push_back(hold(bottom, 1));
  problem.loads.push_back(hold(bottom, 0));
  number(problem);
  Equilibrium equilibrium(problem);
  const StaticState rest = equilibrium.natural_state();
  equilibrium.assemble(rest, rest, {});
  return motions_of(problem).of(equilibrium.system().matrix());
}

TEST(LooseMotions, OfABodyThatNothingHoldsAreAllThatThereAre) {
  const std::vector<LooseMotion> found = loose(two_squares("ELAS/PETIT", false));
  ASSERT_EQ(found.size(), 3U);
  std::set<std::int64_t> dofs;
  for (const LooseMotion& motion : found) {
    EXPECT_EQ(motion.bodies, std::set<std::int32_t>{8});
    EXPECT_GE(motion.dof, 16);
    dofs.insert(motion.dof);
  }
  EXPECT_EQ(dofs.size(), 3U);  // springs at them hold it
  StaticProblem on_axis = two_squares("ELAS/GREEN_LAGRANGE", false);
  on_axis.loads.push_back(hold(axis, 0));
  const std::vector<LooseMotion> vertical = loose(std::move(on_axis));
  ASSERT_EQ(vertical.size(), 1U);
  EXPECT_EQ(vertical[0].dof % 2, 1);
}

// A factorisation would not tell a pivot of 1e-13 of the matrix from one of round-off.
TEST(LooseMotions, WeakSpringsResist) {
  for (const double stiffness : {1e-6, 1e-10}) {
    StaticProblem problem = two_squares("ELAS/PETIT", false);
    problem.loads.push_back(hold(axis, 0));
    problem.springs.push_back({.first = 12, .second = -1, .stiffness = {}});
    problem.springs[0].stiffness[2] = stiffness * young;
    EXPECT_TRUE(loose(std::move(problem)).empty()) << stiffness;
  }
}

TEST(LooseMotions, ThereAreNoneWhereContactHolds) {
  const StaticProblem problem = pressed_squares();
  Equilibrium equilibrium(problem);
  StaticState state = equilibrium.natural_state();
  equilibrium.pair(state.displacement);
  state.patches = equilibrium.contact()->initial();
  const LooseMotions motions = motions_of(problem);
  for (const Status status : {Status::active, Status::open}) {
    state.patches.status = {status};
    equilibrium.assemble(state, state, {});
    EXPECT_EQ(motions.of(equilibrium.system().matrix()).size(), status == Status::active ? 0U : 1U);
  }
}

}  // namespace
}  // namespace lacon
