#include <gtest/gtest.h>

#include "dense.hpp"
#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

using test::Chain;
using test::dense;

/// A chain held at its first node, with multipliers that tie the x displacements of node pairs.
struct SaddlePoint {
  SaddlePoint() : chain(30, 2, held()), matrix(chain.numbering, chain.cliques, couplings()) {
    test::add_springs(matrix, chain);
    for (const Coupling& c : couplings()) {
      const std::vector<std::int64_t> equations{chain.numbering.of_patch(c.a - 30), chain.numbering.of(c.b, 0)};
      matrix.add(equations, std::vector<double>{0, c.b % 2 ? 1.0 : -0.5, 0});
    }
  }
  static std::vector<std::uint8_t> held() {
    std::vector<std::uint8_t> free(60, 1);
    free[0] = free[1] = 0;
    return free;
  }
  static std::vector<Coupling> couplings() { return {{30, 5}, {30, 16}, {31, 9}, {31, 20}}; }
  Chain chain;
  SymmetricMatrix matrix;
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

// A chain that nothing holds has one free motion in each direction: both are found.
TEST(MumpsEngine, FindsFreeMotions) {
  const Chain chain(25);
  SymmetricMatrix matrix(chain.numbering, chain.cliques, {});
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
  SymmetricMatrix matrix(chain.numbering, chain.cliques, {});
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
