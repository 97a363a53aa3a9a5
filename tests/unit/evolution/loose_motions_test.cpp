// Motions of bodies that a matrix does not resist.
#include "lacon/assembly/loose_motions.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "lacon/operators/evolution/newton/equilibrium.hpp"
#include "lacon/operators/evolution/problem/free_bodies.hpp"
#include "two_squares.hpp"

namespace lacon {
namespace {

using namespace test;

LooseMotions motions_of(const StaticProblem& problem) {
  return {RigidMotions(geometry_of(problem, Bodies(problem.mesh))), problem.numbering};
}

/// The lower one of two squares held.
StaticProblem held(StaticProblem problem) {
  problem.loads.push_back(hold(bottom, 1));
  problem.loads.push_back(hold(bottom, 0));
  number(problem);
  return problem;
}

/// Of two squares apart, the lower one held, at rest.
std::vector<LooseMotion> loose(StaticProblem squares) {
  const StaticProblem problem = held(std::move(squares));
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
  LooseMotions motions = motions_of(problem);
  for (const Status status : {Status::active, Status::open}) {
    state.patches.status = {status};
    equilibrium.assemble(state, state, {});
    EXPECT_EQ(motions.of(equilibrium.system().matrix()).size(), status == Status::active ? 0U : 1U);
  }
}

TEST(LooseMotions, AreKnownByWhatTheyMove) {
  const StaticProblem problem = held(two_squares("ELAS/PETIT", false));
  Equilibrium equilibrium(problem);
  const StaticState rest = equilibrium.natural_state();
  equilibrium.assemble(rest, rest, {});
  LooseMotions motions = motions_of(problem);
  EXPECT_EQ(motions.work(std::vector<double>(16, 1.0)).size(), 0);
  ASSERT_EQ(motions.of(equilibrium.system().matrix()).size(), 3U);
  const auto n_dofs = std::ssize(problem.numbering.equation);
  const auto n_equations = static_cast<std::size_t>(equilibrium.system().matrix().size());
  Eigen::MatrixXd moved(n_dofs, 3);
  Eigen::VectorXd work = Eigen::VectorXd::Zero(3);
  std::vector<double> side(n_equations);
  for (std::size_t i = 0; i < n_equations; ++i) side[i] = std::sin(static_cast<double>(i));
  for (std::int64_t dof = 0; dof < n_dofs; ++dof) {
    moved.row(dof) = motions.by(dof).transpose();
    if (const std::int64_t equation = problem.numbering.equation[static_cast<std::size_t>(dof)]; equation >= 0)
      work += side[static_cast<std::size_t>(equation)] * motions.by(dof);
    if (dof < 16) {
      EXPECT_EQ(moved.row(dof).norm(), 0) << dof;  // the lower square
    }
  }
  EXPECT_TRUE(motions.work(side).isApprox(work, 1e-13));
  EXPECT_EQ(Eigen::FullPivLU<Eigen::MatrixXd>(moved).rank(), 3);
  for (Eigen::Index motion = 0; motion < 3; ++motion) {
    std::vector<double> x(n_equations, 0.0), product(n_equations);
    for (std::int64_t dof = 0; dof < n_dofs; ++dof)
      if (const std::int64_t equation = problem.numbering.equation[static_cast<std::size_t>(dof)]; equation >= 0)
        x[static_cast<std::size_t>(equation)] = moved(dof, motion);
    equilibrium.system().matrix().multiply(x, product);
    for (const double force : product) EXPECT_NEAR(force, 0, 1e-9 * young);
  }
}

/// A matrix as other processes have it, and how often they are asked.
class Elsewhere : public RowsElsewhere {
 public:
  explicit Elsewhere(const SparseMatrix& matrix) : matrix_(matrix) {}
  std::int64_t version() const override { return now; }
  std::span<const double> product(std::span<const double> x, bool magnitudes) const override {
    ++asked;
    multiply(x, magnitudes);
    return y_;
  }
  void products(int n_columns, const std::function<void(std::span<double>)>& fill,
                const std::function<void(std::span<const double>)>& use) const override {
    ++asked;
    const std::size_t n = matrix_.numbering().equation.size();
    std::vector<double> x(n * static_cast<std::size_t>(n_columns), 0.0), y(x.size()), own(n);
    fill(x);
    for (int c = 0; c < n_columns; ++c) {
      for (std::size_t i = 0; i < n; ++i) own[i] = x[i * static_cast<std::size_t>(n_columns) + static_cast<std::size_t>(c)];
      multiply(own, c + 1 == n_columns);
      for (std::size_t i = 0; i < n; ++i) y[i * static_cast<std::size_t>(n_columns) + static_cast<std::size_t>(c)] = y_[i];
    }
    use(y);
  }
  Sizes row_sizes() const override { return {}; }
  std::span<const double> diagonal() const override { return {}; }
  std::span<const double> row_maxima(std::span<const double>) const override { return {}; }
  void remember() const override {}
  double change() const override { return 0; }
  Ragged<std::int32_t> graph(const SparseMatrix&) const override { return matrix_.neighbours(); }
  SparseMatrix whole(const SparseMatrix&) const override { return matrix_; }

  mutable int asked = 0;
  std::int64_t now = 0;

 private:
  void multiply(std::span<const double> x, bool magnitudes) const {
    const std::vector<std::int64_t>& equation = matrix_.numbering().equation;
    std::vector<double> own(static_cast<std::size_t>(matrix_.size())), image(own.size());
    for (std::size_t i = 0; i < equation.size(); ++i)
      if (equation[i] >= 0) own[static_cast<std::size_t>(equation[i])] = x[i];
    magnitudes ? matrix_.multiply_magnitudes(own, image) : matrix_.multiply(own, image);
    y_.assign(equation.size(), 0.0);
    for (std::size_t i = 0; i < equation.size(); ++i)
      if (equation[i] >= 0) y_[i] = image[static_cast<std::size_t>(equation[i])];
  }
  const SparseMatrix& matrix_;
  mutable std::vector<double> y_;
};

// Processes that have rows are asked once, whatever the motions are and however often they are looked for, until their values
// change; what is here changes without them.
TEST(LooseMotions, OtherProcessesAreAskedOnceUntilTheirValuesChange) {
  for (const bool held : {false, true}) {
    StaticProblem problem = two_squares("ELAS/PETIT", false);
    problem.loads.push_back(hold(bottom, 1));
    problem.loads.push_back(hold(bottom, 0));
    if (held) problem.loads.push_back(hold(axis, 0));
    number(problem);
    Equilibrium equilibrium(problem);
    const StaticState rest = equilibrium.natural_state();
    equilibrium.assemble(rest, rest, {});
    SparseMatrix whole = equilibrium.system().matrix();
    Elsewhere elsewhere(whole);
    SparseMatrix here(problem.numbering, {}, {});
    here.add_elsewhere(&elsewhere);
    LooseMotions motions = motions_of(problem), motions_of_whole = motions_of(problem);
    const auto compare = [&](std::size_t n, int asked) {
      const std::vector<LooseMotion> expected = motions_of_whole.of(whole), found = motions.of(here);
      EXPECT_EQ(elsewhere.asked, asked);
      ASSERT_EQ(found.size(), expected.size());
      EXPECT_EQ(found.size(), n);
      for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].bodies, expected[i].bodies);
    };
    compare(held ? 1U : 3U, 1);
    EXPECT_EQ(motions.of(here, 1e-6).size(), held ? 1U : 3U);
    const auto spring = problem.numbering.equation[25];  // of node 12, vertical
    here.add_diagonal(spring, young);
    const auto with_spring = motions.of(here);
    EXPECT_EQ(with_spring.size(), held ? 0U : 2U);
    EXPECT_EQ(elsewhere.asked, 1);
    here.set_zero();
    whole.add_diagonal(spring, young);
    ++elsewhere.now;
    compare(held ? 0U : 2U, 2);
  }
}

}  // namespace
}  // namespace lacon
