#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "dense.hpp"
#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

using test::Chain;
using test::dense;

/// A chain held at its first node, with multipliers that tie the x displacements of node pairs.
struct SaddlePoint {
  SaddlePoint() : chain(30, 2, held()), matrix(chain.numbering, chain.cliques, couplings()) { fill(matrix); }
  void fill(SparseMatrix& to) const {
    test::add_springs(to, chain);
    for (const Coupling& c : couplings()) {
      const std::vector<std::int64_t> equations{chain.numbering.of_patch(c.a - 30), chain.numbering.of(c.b, 0)};
      to.add(equations, std::vector<double>{0, c.b % 2 ? 1.0 : -0.5, 0});
    }
  }
  static std::vector<std::uint8_t> held() {
    std::vector<std::uint8_t> free(60, 1);
    free[0] = free[1] = 0;
    return free;
  }
  static std::vector<Coupling> couplings() { return {{30, 5}, {30, 16}, {31, 9}, {31, 20}}; }
  Chain chain;
  SparseMatrix matrix;
};

// The solution of a saddle-point system is that of dense LU, and the inertia counts the multipliers.
TEST(MumpsEngine, SolvesSaddlePoints) {
  SaddlePoint system;
  MumpsEngine engine;
  engine.analyse(system.matrix);
  const Factorisation found = engine.factorise(system.matrix);
  EXPECT_EQ(found.negative_pivots, 2);
  EXPECT_TRUE(found.null_pivots.empty());
  Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size()), x = b;
  EXPECT_LE(engine.solve({x.data(), static_cast<std::size_t>(x.size())}), 1e-15);
  const Eigen::VectorXd expected = dense(system.matrix).fullPivLu().solve(b);
  EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());
}

// New values on the same pattern need no new analysis.
TEST(MumpsEngine, FactorisesAgainOnTheSamePattern) {
  SaddlePoint system;
  MumpsEngine engine;
  engine.analyse(system.matrix);
  engine.factorise(system.matrix);
  system.matrix.add_diagonal(system.chain.numbering.of_patch(0), 3.0);
  EXPECT_EQ(engine.factorise(system.matrix).negative_pivots, 1);
  Eigen::VectorXd b = Eigen::VectorXd::Ones(system.matrix.size()), x = b;
  engine.solve({x.data(), static_cast<std::size_t>(x.size())});
  EXPECT_LE((dense(system.matrix) * x - b).cwiseAbs().maxCoeff(), 1e-12);
}

// Random unsymmetric systems with any vertices coupled are solved as dense LU does; they have no inertia to tell. One engine
// takes symmetric and general matrices in turn.
TEST(MumpsEngine, SolvesUnsymmetricSystems) {
  std::mt19937 random(23);
  MumpsEngine engine;
  const SaddlePoint symmetric;
  for (int round = 0; round < 10; ++round) {
    const Chain chain(20, 4);
    std::vector<Coupling> couplings;
    for (std::int32_t p = 20; p < 24; ++p)
      for (int k = 0; k < 3; ++k) couplings.push_back({p, static_cast<std::int32_t>(random() % 20)});
    for (int k = 0; k < 5; ++k)
      couplings.push_back({static_cast<std::int32_t>(random() % 24), static_cast<std::int32_t>(random() % 24)});
    SparseMatrix matrix(chain.numbering, chain.cliques, couplings, Symmetry::general);
    test::fill_unsymmetric(matrix, chain, couplings, random);
    engine.analyse(matrix);
    const Factorisation found = engine.factorise(matrix);
    EXPECT_EQ(found.negative_pivots, std::nullopt);
    EXPECT_TRUE(found.null_pivots.empty());
    Eigen::VectorXd b = Eigen::VectorXd::Random(matrix.size()), x = b;
    EXPECT_LE(engine.solve({x.data(), static_cast<std::size_t>(x.size())}), 1e-14);
    const Eigen::VectorXd expected = dense(matrix).fullPivLu().solve(b);
    const double condition = 1 / dense(matrix).fullPivLu().rcond();
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-14 * condition * expected.cwiseAbs().maxCoeff());
    if (round % 3 > 0) continue;
    engine.analyse(symmetric.matrix);
    EXPECT_EQ(engine.factorise(symmetric.matrix).negative_pivots, 2);
  }
}

// A symmetric matrix that is stored as a general one has the same solution.
TEST(MumpsEngine, SolvesASymmetricSystemInGeneralStorage) {
  const SaddlePoint symmetric;
  SparseMatrix general(symmetric.chain.numbering, symmetric.chain.cliques, SaddlePoint::couplings(), Symmetry::general);
  symmetric.fill(general);
  ASSERT_EQ((dense(general) - dense(symmetric.matrix)).cwiseAbs().maxCoeff(), 0.0);
  std::vector<double> solutions[2];
  for (const SparseMatrix* matrix : {&symmetric.matrix, &std::as_const(general)}) {
    MumpsEngine engine;
    engine.analyse(*matrix);
    engine.factorise(*matrix);
    std::vector<double>& x = solutions[matrix == &general];
    x.assign(matrix->size(), 1.0);
    engine.solve(x);
  }
  for (std::size_t i = 0; i < solutions[0].size(); ++i) EXPECT_NEAR(solutions[1][i], solutions[0][i], 1e-10);
}

// The free motions of an unsymmetric matrix are found too.
TEST(MumpsEngine, FindsFreeMotionsOfAGeneralMatrix) {
  const Chain chain(25);
  SparseMatrix matrix(chain.numbering, chain.cliques, {}, Symmetry::general);
  test::add_springs(matrix, chain);
  MumpsEngine engine;
  engine.analyse(matrix);
  EXPECT_EQ(engine.factorise(matrix).null_pivots.size(), 2u);
}

// A chain that nothing holds has one free motion in each direction: both are found.
TEST(MumpsEngine, FindsFreeMotions) {
  const Chain chain(25);
  SparseMatrix matrix(chain.numbering, chain.cliques, {});
  test::add_springs(matrix, chain);
  MumpsEngine engine;
  engine.analyse(matrix);
  const Factorisation found = engine.factorise(matrix);
  ASSERT_EQ(found.null_pivots.size(), 2u);
  EXPECT_NE(found.null_pivots[0] % 2, found.null_pivots[1] % 2);
}

// A solution that is not one is refused: the right side of a singular system outside its range.
TEST(MumpsEngine, RefusesABadSolution) {
  const Chain chain(25);
  SparseMatrix matrix(chain.numbering, chain.cliques, {});
  test::add_springs(matrix, chain);
  MumpsEngine engine({.residual_tolerance = 1e-10});
  engine.analyse(matrix);
  engine.factorise(matrix);
  std::vector<double> b(matrix.size(), 1.0);
  try {
    engine.solve(b);
    FAIL() << "a system without solution was solved";
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "SOLVER_1");
    EXPECT_EQ(error.message().severity, 'S');
  }
}

}  // namespace
}  // namespace lacon
