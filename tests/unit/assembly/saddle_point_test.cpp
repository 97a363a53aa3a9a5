#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "blurred_engine.hpp"
#include "columns.hpp"
#include "dense.hpp"
#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

using test::Chain;
using test::columns;
using test::dense;

constexpr int chain_nodes = 60, chain_rows = 8;

/// A chain held at its first node, with rows of multipliers that are on (coefficients, zero diagonal) or off (diagonal alone).
struct Sequence {
  explicit Sequence(bool held_end = true)
      : chain(chain_nodes, chain_rows, free(held_end)), matrix(chain.numbering, chain.cliques, couplings()) {
    fill();
  }
  static std::vector<std::uint8_t> free(bool held) {
    std::vector<std::uint8_t> flags(2 * chain_nodes, 1);
    if (held) flags[0] = flags[1] = 0;
    return flags;
  }
  static std::vector<Coupling> couplings() {
    std::vector<Coupling> all;
    for (int r = 0; r < chain_rows; ++r)
      for (int k = 0; k < 3; ++k) all.push_back({chain_nodes + r, 3 + 7 * r + 2 * k});
    return all;
  }
  static std::vector<Coupling> more_couplings() {
    std::vector<Coupling> all = couplings();
    for (int r = 0; r < chain_rows; ++r) all.push_back({chain_nodes + r, 40 + r});
    return all;
  }
  void fill() {
    matrix.set_zero();
    test::add_springs(matrix, chain);
    for (int r = 0; r < chain_rows; ++r) {
      if (!on[r]) {
        matrix.add_diagonal(chain.numbering.of_patch(r), off);
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        const std::vector<std::int64_t> equations{chain.numbering.of_patch(r), chain.numbering.of(3 + 7 * r + 2 * k, k % 2)};
        matrix.add(equations, std::vector<double>{0, unit * (k != 1 ? 0.5 : r % 2 ? -1.0 : 0.7) * (1 + drift * (k + 1)), 0});
      }
    }
  }
  std::int64_t first_multiplier() const { return chain.numbering.first[chain_nodes]; }
  /// How far the solver is from dense LU, of the largest entry.
  double error(SaddlePointSolver& solver, SolutionReport& report) {
    Eigen::VectorXd b = Eigen::VectorXd::Random(matrix.size()), x = b;
    report = solver.solve(matrix, first_multiplier(), {x.data(), static_cast<std::size_t>(x.size())});
    const Eigen::VectorXd expected = dense(matrix).fullPivLu().solve(b);
    return (x - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
  }
  Chain chain;
  SparseMatrix matrix;
  std::array<bool, chain_rows> on{};
  double drift = 0;
  double unit = 1;  ///< of coefficients of rows that are on
  double off = 1;   ///< diagonal of rows that are off
};

/// A solver that takes every chance to keep its factor: its cost model would factorise so small a matrix again.
SaddlePointSolver eager(std::unique_ptr<Engine> engine = std::make_unique<MumpsEngine>()) {
  return SaddlePointSolver(std::move(engine), {.work_limit = 1e6, .column_memory = 1e6});
}

// Rows switched on and off, in any order, are solved with the first factor, exactly as by dense LU.
TEST(SaddlePointSolver, SwitchesRowsWithOneFactor) {
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  system.on[2] = system.on[5] = true;
  system.fill();
  EXPECT_LE(system.error(solver, report), 1e-11);
  EXPECT_TRUE(report.factorised);
  EXPECT_EQ(report.factorisation.negative_pivots, 2);
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    for (bool& row : system.on) row = random() % 2;
    system.off = 1.0 + static_cast<double>(random() % 3);
    system.fill();
    EXPECT_LE(system.error(solver, report), 1e-11) << "round " << round;
    EXPECT_FALSE(report.factorised);
    EXPECT_LE(report.iterations, 4) << "switching is exact but for the single precision of the columns";
  }
}

// Coefficients that drift are left to GMRES: few iterations, to full accuracy; with a large drift columns are made anew.
TEST(SaddlePointSolver, FollowsDriftingCoefficients) {
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  system.on[0] = system.on[1] = system.on[4] = true;
  system.fill();
  system.error(solver, report);
  for (const double drift : {0.01, 0.05, 0.1, 0.5}) {
    system.drift = drift;
    for (bool& row : system.on) row = !row;
    system.fill();
    EXPECT_LE(system.error(solver, report), 1e-11) << drift;
    EXPECT_FALSE(report.factorised);
  }
}

// How far the coefficients of a row have drifted is a share of these: no unit makes of it more or less.
TEST(SaddlePointSolver, MakesColumnsAnewInAnyUnit) {
  for (const double unit : {1e-4, 1.0, 1e4}) {
    Sequence system;
    SaddlePointSolver solver = eager();
    SolutionReport report;
    system.unit = unit;
    system.fill();
    system.error(solver, report);
    system.on[0] = system.on[4] = true;
    for (const auto& [drift, columns] : {std::pair(0.0, 2), std::pair(0.5, 2), std::pair(0.51, 0)}) {
      system.drift = drift;
      system.fill();
      EXPECT_LE(system.error(solver, report), 1e-11) << unit << ' ' << drift;
      EXPECT_FALSE(report.factorised);
      EXPECT_EQ(report.columns, columns) << unit << ' ' << drift;
    }
  }
}

// A right side of a step that failed, 1e17 times as large, is no measure of those behind it.
TEST(SaddlePointSolver, ForgetsTheRightSidesOfAFailedStep) {
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  system.on[0] = system.on[1] = system.on[4] = true;
  system.fill();
  Eigen::VectorXd huge = 1e17 * Eigen::VectorXd::Random(system.matrix.size());
  solver.solve(system.matrix, system.first_multiplier(), {huge.data(), static_cast<std::size_t>(huge.size())});
  system.drift = 0.1;
  system.fill();
  EXPECT_GT(system.error(solver, report), 1e-9);  // GMRES goes no further than it has to
  solver.forget_right_sides();
  EXPECT_LE(system.error(solver, report), 1e-11);
  EXPECT_FALSE(report.factorised);
}

// Where a rough solution will do, it is one, and says so.
TEST(SaddlePointSolver, SolvesRoughlyWhereThatWillDo) {
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  system.on[0] = system.on[1] = system.on[4] = true;
  system.fill();
  system.error(solver, report);
  system.drift = 0.1;
  system.fill();
  Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size()), x = b;
  report =
      solver.solve(system.matrix, system.first_multiplier(), {x.data(), static_cast<std::size_t>(x.size())}, {.rough = true});
  EXPECT_TRUE(report.rough);
  const int few = report.iterations;
  const double left = (dense(system.matrix) * x - b).norm() / b.norm();
  EXPECT_LE(left, 1e-2);
  EXPECT_GE(left, 1e-12);
  EXPECT_LE(system.error(solver, report), 1e-11);
  EXPECT_FALSE(report.rough);
  EXPECT_GT(report.iterations, few);
}

// What further right sides give, of nodes and of multipliers, switched or not: to single precision, and nothing is factorised.
TEST(SaddlePointSolver, GivesColumnsOfTheInverse) {
  std::mt19937 random(11);
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  EXPECT_EQ(solver.affordable_columns(system.matrix), 0U);  // there is no factor
  system.on[2] = system.on[5] = true;
  for (int round = 0; round < 10; ++round) {
    system.off = 1.0 + static_cast<double>(random() % 3);
    system.fill();
    system.error(solver, report);
    EXPECT_EQ(report.factorised, round == 0);
    SparseSides sides;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(system.matrix.size(), 4 + chain_rows);
    for (Eigen::Index c = 0; c < right.cols(); ++c, sides.end_side()) {
      if (c < chain_rows)
        right(system.first_multiplier() + c, c) = 1;
      else
        for (int k = 0; k < 3; ++k) right(static_cast<Eigen::Index>(random() % system.matrix.size()), c) = k - 0.5;
      for (Eigen::Index i = 0; i < right.rows(); ++i)
        if (right(i, c) != 0) sides.add_entry(i, right(i, c));
    }
    const Eigen::MatrixXd expected = dense(system.matrix).fullPivLu().solve(right);
    std::vector<float> found;
    EXPECT_EQ(columns(solver, system.matrix, sides, found).columns, 4 + chain_rows);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(expected.size()));
    const Eigen::MatrixXd difference =
        Eigen::Map<const Eigen::MatrixXf>(found.data(), expected.rows(), expected.cols()).cast<double>() - expected;
    EXPECT_LE(difference.cwiseAbs().maxCoeff(), 1e-5 * expected.cwiseAbs().maxCoeff()) << "round " << round;
    for (bool& row : system.on) row = random() % 2;
  }
}

// A row that had no column yet costs one; one that has does not.
TEST(SaddlePointSolver, KeepsItsColumns) {
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  system.error(solver, report);
  const auto columns_after = [&](int row, bool on) {
    system.on[row] = on;
    system.fill();
    system.error(solver, report);
    return report.columns;
  };
  EXPECT_EQ(columns_after(1, true), 1);
  EXPECT_EQ(columns_after(3, true), 1);
  EXPECT_EQ(columns_after(1, false), 0);
  EXPECT_EQ(columns_after(1, true), 0);
}

// A stiffness that changed a little is left to GMRES.
TEST(SaddlePointSolver, FollowsASlightlyChangedStiffness) {
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  system.on[1] = true;
  system.fill();
  system.error(solver, report);
  system.on[2] = true;
  system.fill();
  test::add_springs(system.matrix, system.chain, 0.01, 3);
  EXPECT_LE(system.error(solver, report), 1e-11);
  EXPECT_FALSE(report.factorised);
}

// Another stiffness needs another factor.
TEST(SaddlePointSolver, FactorisesWhenTheStiffnessChanges) {
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  system.error(solver, report);
  system.matrix.add_diagonal(7, 0.25);
  EXPECT_LE(system.error(solver, report), 1e-11);
  EXPECT_TRUE(report.factorised);
}

// A chain that its rows alone hold: once they are off, the kept factor must not hide that it floats.
TEST(SaddlePointSolver, FindsThatABodyCameLoose) {
  Sequence system(false);
  for (int r = 0; r < chain_rows; ++r) system.on[r] = true;
  system.fill();
  SaddlePointSolver solver = eager();
  SolutionReport report;
  EXPECT_LE(system.error(solver, report), 1e-11);
  EXPECT_TRUE(report.factorisation.null_pivots.empty());
  system.on.fill(false);
  system.fill();
  std::vector<double> b(system.matrix.size(), 1.0);
  report = solver.solve(system.matrix, system.first_multiplier(), b);
  EXPECT_TRUE(report.factorised);
  EXPECT_EQ(report.factorisation.null_pivots.size(), 2u);
}

// Likewise where no force pulls at what came loose, so that the system has solutions: one row alone held it, in each direction.
TEST(SaddlePointSolver, FindsALooseBodyThatNothingPulls) {
  Sequence system(false);
  system.on[0] = system.on[1] = true;
  system.fill();
  SaddlePointSolver solver = eager();
  SolutionReport report;
  system.error(solver, report);
  ASSERT_TRUE(report.factorisation.null_pivots.empty());
  system.on[1] = false;
  system.fill();
  std::vector<double> b(system.matrix.size(), 0.0);
  report = solver.solve(system.matrix, system.first_multiplier(), b);
  EXPECT_TRUE(report.factorised);
  EXPECT_EQ(report.factorisation.null_pivots.size(), 1u);
}

// With a factor in single precision, or of low rank, GMRES still comes to all digits, and what came loose is still found.
TEST(SaddlePointSolver, NeedsNoExactFactor) {
  for (const MumpsOptions::Use low_rank : {MumpsOptions::Use::never, MumpsOptions::Use::always}) {
    Sequence system(false);
    for (int r = 0; r < chain_rows; ++r) system.on[r] = true;
    system.fill();
    SaddlePointSolver solver = eager(std::make_unique<MumpsEngine>(
        MumpsOptions{.single_precision = MumpsOptions::Use::always, .low_rank = low_rank, .low_rank_threshold = 1e-4}));
    SolutionReport report;
    EXPECT_LE(system.error(solver, report), 1e-11);
    EXPECT_TRUE(report.factorisation.single_precision);
    std::mt19937 random(3);
    for (int round = 0; round < 20; ++round) {
      for (int r = 2; r < chain_rows; ++r) system.on[r] = random() % 2;
      system.drift = 0.01 * round;
      system.fill();
      EXPECT_LE(system.error(solver, report), 1e-11) << "round " << round;
      EXPECT_FALSE(report.factorised);
    }
    system.on.fill(false);
    system.fill();
    std::vector<double> b(system.matrix.size(), 0.0);
    report = solver.solve(system.matrix, system.first_multiplier(), b);
    EXPECT_TRUE(report.factorised);
    EXPECT_EQ(report.factorisation.null_pivots.size(), 2u);
    EXPECT_FALSE(report.factorisation.single_precision);
  }
}

// With a factor so inexact that the complement's condition says nothing, the factor is kept all the same while rows hold the
// chain, and not where they let it go: with a force that pulls at it or none, in one direction or both.
TEST(SaddlePointSolver, AsksTheMatrixWhatABlurredFactorHides) {
  for (const double share : {1e-4, 1e-3, 1e-2}) {
    Sequence system(false);
    for (int r = 0; r < chain_rows; ++r) system.on[r] = true;
    system.fill();
    SaddlePointSolver solver =
        eager(std::make_unique<test::BlurredEngine>(share, [&](Factorisation& found) { found.error = 30 * share; }));
    SolutionReport report;
    EXPECT_LE(system.error(solver, report), 1e-11);
    std::mt19937 random(3);
    for (int round = 0; round < 20; ++round) {
      for (int r = 2; r < chain_rows; ++r) system.on[r] = random() % 2;
      system.fill();
      EXPECT_LE(system.error(solver, report), 1e-11) << "round " << round;
      EXPECT_FALSE(report.factorised) << "share " << share << ", round " << round;
    }
    for (const double pull : {0.0, 1.0})
      for (const std::size_t loose : {1u, 2u}) {
        system.on.fill(true);
        system.fill();
        SaddlePointSolver other =
            eager(std::make_unique<test::BlurredEngine>(share, [&](Factorisation& found) { found.error = 30 * share; }));
        system.error(other, report);
        system.on.fill(false);
        system.on[0] = loose == 1;
        system.fill();
        std::vector<double> b(system.matrix.size(), pull);
        report = other.solve(system.matrix, system.first_multiplier(), b);
        ASSERT_TRUE(report.factorised) << "share " << share;
        EXPECT_EQ(report.factorisation.null_pivots.size(), loose);
      }
  }
}

// A matrix that is not symmetric is factorised each time, before, between and behind symmetric ones.
TEST(SaddlePointSolver, FactorisesUnsymmetricMatrices) {
  std::mt19937 random(29);
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  const std::vector<Coupling> couplings = Sequence::couplings();
  SparseMatrix general(system.chain.numbering, system.chain.cliques, couplings, Symmetry::general);
  for (int round = 0; round < 6; ++round) {
    system.on[round] = true;
    system.fill();
    EXPECT_LE(system.error(solver, report), 1e-11);
    if (round % 2) continue;
    for (int again = 0; again < 2; ++again) {
      test::fill_unsymmetric(general, system.chain, couplings, random);
      Eigen::VectorXd b = Eigen::VectorXd::Random(general.size()), x = b;
      report = solver.solve(general, system.first_multiplier(), {x.data(), static_cast<std::size_t>(x.size())});
      EXPECT_TRUE(report.factorised);
      EXPECT_EQ(report.analysis_seconds > 0, again == 0) << "the analysis stands while the pattern does";
      EXPECT_LE((dense(general) * x - b).cwiseAbs().maxCoeff(), 1e-11);
      x = 2 * b;
      report = solver.solve_again(general, {x.data(), static_cast<std::size_t>(x.size())});
      EXPECT_FALSE(report.factorised);
      EXPECT_LE((dense(general) * x - 2 * b).cwiseAbs().maxCoeff(), 1e-11);
      SparseSides side;
      for (Eigen::Index i = 0; i < b.size(); ++i) side.add_entry(i, b[i]);
      side.end_side();
      std::vector<float> column;
      columns(solver, general, side, column);
      EXPECT_LE((2 * Eigen::Map<const Eigen::VectorXf>(column.data(), b.size()).cast<double>() - x).norm(), 1e-5 * x.norm());
    }
  }
}

// Multipliers that are coupled with each other, and nodes with nodes: solved all the same.
TEST(SaddlePointSolver, TakesCouplesOfAnyVertices) {
  Sequence system;
  SaddlePointSolver solver = eager();
  SolutionReport report;
  system.error(solver, report);
  std::vector<Coupling> couplings = Sequence::couplings();
  for (const Coupling& c :
       {Coupling{chain_nodes, chain_nodes + 1}, Coupling{chain_nodes + 1, chain_nodes + 2}, Coupling{2, 50}})
    couplings.push_back(c);
  system.matrix = SparseMatrix(system.chain.numbering, system.chain.cliques, couplings);
  const auto patch = [&](int p) { return system.chain.numbering.of_patch(p); };
  for (const double coupled : {0.0, 0.3, -0.2, 0.0}) {
    system.on[0] = system.on[1] = !system.on[0];
    system.fill();
    system.matrix.add(std::vector<std::int64_t>{patch(0), patch(1)}, std::vector<double>{0, coupled, 0});
    system.matrix.add(std::vector<std::int64_t>{system.chain.numbering.of(2, 0), system.chain.numbering.of(50, 1)},
                      std::vector<double>{0.01, 0.1 * coupled, 0.01});
    EXPECT_LE(system.error(solver, report), 1e-11) << coupled;
  }
}

/// MUMPS, but for one call that fails. Works on nothing that a failure has left behind.
class FailingEngine : public FactorEngine {
 public:
  enum Call { none, analysis, factorisation, solution, substitution, block };

  void analyse(const SparseMatrix& matrix) override {
    ready_ = none;
    fail_at(analysis);
    engine_.analyse(matrix);
    ready_ = analysis;
  }
  Factorisation factorise(const SparseMatrix& matrix) override {
    require(analysis);
    ready_ = none;
    fail_at(factorisation);
    const Factorisation found = engine_.factorise(matrix);
    ready_ = factorisation;
    return found;
  }
  Solution solve(std::span<double> right_side) override {
    require(factorisation);
    fail_at(solution);
    return engine_.solve(right_side);
  }
  void substitute(std::span<double> right_side) override {
    require(factorisation);
    fail_at(substitution);
    engine_.substitute(right_side);
  }
  std::vector<float> substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                std::span<const double> value) override {
    require(factorisation);
    fail_at(block);
    return engine_.substitute(offset, index, value);
  }

  Call next = none;    ///< fails when it comes
  bool loses = false;  ///< with its factor: until it analyses again, as where processes that shared it have ended

 private:
  void fail_at(Call call) {
    if (next == call) {
      next = none;
      if (loses) ready_ = none;
      fail("SOLVER_2", {{"phase", "test"}, {"equations", "0"}});
    }
  }
  void require(Call done) const {
    if (ready_ < done) throw std::logic_error("an engine that failed is used on");
  }

  MumpsEngine engine_;
  Call ready_ = none;  ///< the last of analysis and factorisation that stands
};

// Wherever the engine fails between two solutions (a step is cut and tried again), the error comes through, the right side is
// as it was, and the next solution is right, of the same matrix and of the one before.
TEST(SaddlePointSolver, GoesOnAfterAFailure) {
  struct Way {
    FailingEngine::Call call;
    const char* what;
    std::function<void(Sequence&)> change;
  };
  const Way ways[] = {
      {FailingEngine::analysis, "another pattern",
       [](Sequence& system) {
         system.matrix = SparseMatrix(system.chain.numbering, system.chain.cliques, Sequence::more_couplings());
         system.fill();
         system.matrix.add_diagonal(7, 0.25);
       }},
      {FailingEngine::factorisation, "another stiffness", [](Sequence& system) { system.matrix.add_diagonal(7, 0.25); }},
      {FailingEngine::solution, "another stiffness", [](Sequence& system) { system.matrix.add_diagonal(7, 0.25); }},
      {FailingEngine::block, "switched rows", [](Sequence& system) { system.on[1] = system.on[6] = true, system.fill(); }},
      {FailingEngine::substitution, "moved coefficients", [](Sequence& system) { system.drift = 0.05, system.fill(); }},
  };
  for (const Way& way : ways)
    for (const auto& [back, loses] : {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
      SCOPED_TRACE(way.what + std::string(back ? ", and back" : "") + (loses ? ", without its factor" : ""));
      Sequence system;
      system.on[2] = true;
      system.fill();
      auto owned = std::make_unique<FailingEngine>();
      FailingEngine& engine = *owned;
      SaddlePointSolver solver = eager(std::move(owned));
      SolutionReport report;
      EXPECT_LE(system.error(solver, report), 1e-11);
      const SparseMatrix before = system.matrix;
      way.change(system);
      engine.next = way.call;
      engine.loses = loses;
      std::vector<double> side(system.matrix.size(), 1.0);
      EXPECT_THROW(solver.solve(system.matrix, system.first_multiplier(), side), Error);
      EXPECT_EQ(engine.next, FailingEngine::none) << "the call did not come";
      EXPECT_EQ(side, std::vector<double>(side.size(), 1.0));
      if (back) system.matrix = before;
      EXPECT_LE(system.error(solver, report), 1e-11);
      EXPECT_LE(system.error(solver, report), 1e-11);
    }
}

/// An engine without factor and inertia, which gives up where it is told to.
class IterativeEngine : public Engine {
 public:
  void analyse(const SparseMatrix& matrix) override { engine_.analyse(matrix); }
  Factorisation factorise(const SparseMatrix& matrix) override {
    engine_.factorise(matrix);
    return {};
  }
  Solution solve(std::span<double> right_side) override {
    if (stagnates) throw Error({.severity = 'S', .id = "TEST_1", .text = "no progress in 30 iterations", .advice = ""});
    return engine_.solve(right_side);
  }
  bool stagnates = false;

 private:
  MumpsEngine engine_;
};

// An engine that keeps no factor is made ready for every matrix; why it fails is what the caller hears.
TEST(SaddlePointSolver, TakesEnginesWithoutFactor) {
  Sequence system;
  auto owned = std::make_unique<IterativeEngine>();
  IterativeEngine& engine = *owned;
  SaddlePointSolver solver = eager(std::move(owned));
  SolutionReport report;
  for (int row = 0; row < 3; ++row) {
    system.on[row] = true;
    system.fill();
    EXPECT_LE(system.error(solver, report), 1e-11);
    EXPECT_TRUE(report.factorised);
    EXPECT_EQ(report.factorisation.negative_pivots, std::nullopt);
  }
  EXPECT_GE(solver.affordable_columns(system.matrix), 10U);
  SparseSides side;
  side.add_entry(system.first_multiplier(), 1);
  side.end_side();
  std::vector<float> column;
  columns(solver, system.matrix, side, column);
  const Eigen::VectorXd expected = dense(system.matrix).inverse().col(system.first_multiplier());
  ASSERT_EQ(column.size(), static_cast<std::size_t>(expected.size()));
  EXPECT_LE((Eigen::Map<const Eigen::VectorXf>(column.data(), expected.size()).cast<double>() - expected).norm(),
            1e-5 * expected.norm());
  engine.stagnates = true;
  try {
    system.error(solver, report);
    FAIL() << "an engine that fails was taken to succeed";
  } catch (const Error& error) {
    EXPECT_EQ(error.message().text, "no progress in 30 iterations");
  }
  engine.stagnates = false;
  EXPECT_LE(system.error(solver, report), 1e-11);
}

// Where every displacement is imposed there is nothing to solve, whatever the engine.
TEST(SaddlePointSolver, SolvesNoEquations) {
  const Chain chain(3, 0, std::vector<std::uint8_t>(6, 0));
  const SparseMatrix matrix(chain.numbering, chain.cliques, {});
  SaddlePointSolver solver = eager();
  for (int round = 0; round < 2; ++round) {
    const SolutionReport report = solver.solve(matrix, 0, {});
    EXPECT_FALSE(report.factorised);
    EXPECT_TRUE(report.factorisation.null_pivots.empty());
  }
}

// The cost model factorises small matrices: that is cheaper than any iteration.
TEST(SaddlePointSolver, FactorisesSmallMatrices) {
  Sequence system;
  SaddlePointSolver solver(std::make_unique<MumpsEngine>());
  SolutionReport report;
  system.error(solver, report);
  system.on[0] = true;
  system.fill();
  system.error(solver, report);
  EXPECT_TRUE(report.factorised);
}

}  // namespace
}  // namespace lacon
