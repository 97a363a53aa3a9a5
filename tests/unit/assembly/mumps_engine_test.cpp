#include <fmt/format.h>
#include <gtest/gtest.h>

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <new>
#include <random>
#include <utility>

#include "dense.hpp"
#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/structures/openblas.hpp"
#include "lattice.hpp"
#include "saddle_point.hpp"

namespace lacon {
namespace {

using test::Chain;
using test::dense;
using test::entries;
using test::Lattice;
using test::SaddlePoint;

// The solution of a saddle-point system is that of dense LU, and the inertia counts the multipliers.
TEST(MumpsEngine, SolvesSaddlePoints) {
  SaddlePoint system;
  MumpsEngine engine;
  engine.analyse(system.matrix);
  const Factorisation found = engine.factorise(system.matrix);
  EXPECT_EQ(found.negative_pivots, 2);
  EXPECT_TRUE(found.null_pivots.empty());
  Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size()), x = b;
  EXPECT_LE(engine.solve({x.data(), static_cast<std::size_t>(x.size())}).residual, 1e-15);
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
    EXPECT_LE(engine.solve({x.data(), static_cast<std::size_t>(x.size())}).residual, 1e-14);
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

// A solution that is not one is refused: the right side of a singular system outside its range. No residual is below 0 either.
TEST(MumpsEngine, RefusesABadSolution) {
  const Chain chain(25);
  SparseMatrix matrix(chain.numbering, chain.cliques, {});
  test::add_springs(matrix, chain);
  for (const double tolerance : {1e-10, 0.0}) {
    MumpsEngine engine({.residual_tolerance = tolerance});
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
}

// ------------------------------------------------------------------------------------------ factors that are not exact

using Use = MumpsOptions::Use;
constexpr MumpsOptions::Use always = Use::always, never = Use::never;

// A factor in single precision gives a solution as exact as one in double precision does, and the same inertia.
TEST(MumpsEngine, SolvesWithSinglePrecision) {
  SaddlePoint system;
  for (const Use low_rank : {never, always}) {
    MumpsEngine engine({.single_precision = always, .low_rank = low_rank});
    engine.analyse(system.matrix);
    const Factorisation found = engine.factorise(system.matrix);
    EXPECT_TRUE(found.single_precision);
    EXPECT_EQ(found.doubt, "");
    EXPECT_EQ(found.negative_pivots, 2);
    Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size()), x = b;
    EXPECT_LE(engine.solve(entries(x)).residual, 1e-15);
    const Eigen::VectorXd expected = dense(system.matrix).fullPivLu().solve(b);
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());
  }
}

// However near a matrix is to a singular one, the inertia is that of its eigenvalues: a factor that cannot tell is given up.
TEST(MumpsEngine, KnowsTheInertiaInSinglePrecision) {
  const Lattice lattice(5);
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(lattice.matrix)).eigenvalues();
  int doubts = 0, carried = 0;
  for (const int which : {0, 7, 50})
    for (const double distance : {1e-2, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, -1e-2, -1e-4, -1e-5, -1e-6, -1e-7, -1e-8}) {
      SparseMatrix shifted = lattice.matrix;
      const double shift = eigenvalues[which] + distance * eigenvalues[eigenvalues.size() - 1];
      for (std::int64_t e = 0; e < shifted.size(); ++e) shifted.add_diagonal(e, -shift);
      MumpsEngine engine({.single_precision = always, .low_rank = always, .low_rank_threshold = 1e-4});
      engine.analyse(shifted);
      const Factorisation found = engine.factorise(shifted);
      EXPECT_EQ(found.negative_pivots, (eigenvalues.array() < shift).count()) << which << " " << distance;
      ++(found.doubt.empty() ? carried : doubts);
      EXPECT_EQ(found.single_precision, found.doubt.empty());
    }
  EXPECT_GE(doubts, 6) << "nearer than single precision tells";
  EXPECT_GE(carried, 6);
}

// Free motions are found as by a factor in double precision, and the engine remembers.
TEST(MumpsEngine, FindsFreeMotionsInSinglePrecision) {
  const Chain chain(25);
  SparseMatrix matrix(chain.numbering, chain.cliques, {});
  test::add_springs(matrix, chain);
  MumpsEngine engine({.single_precision = always});
  for (const bool remembers : {false, true}) {
    EXPECT_EQ(engine.care(), remembers ? Engine::Care::exact : Engine::Care::none);
    engine.analyse(matrix);
    const Factorisation found = engine.factorise(matrix);
    EXPECT_EQ(found.null_pivots.size(), 2u);
    EXPECT_FALSE(found.single_precision);
    EXPECT_EQ(found.doubt.empty(), remembers);
  }
}

/// A beam of points: what bends it is the second difference. Held at its first two points; the condition is its length to the
/// power of four.
struct Beam {
  explicit Beam(int n) : numbering(number_equations(n, 1, held(n), 0)), matrix(numbering, triples(n), {}) {
    for (int i = 0; i + 2 < n; ++i) {
      const double k = 1 + 0.3 * std::sin(i);
      matrix.add(std::vector<std::int64_t>{numbering.of(i, 0), numbering.of(i + 1, 0), numbering.of(i + 2, 0)},
                 std::vector<double>{k, -2 * k, 4 * k, k, -2 * k, k});
    }
  }
  static std::vector<std::uint8_t> held(int n) {
    std::vector<std::uint8_t> free(n, 1);
    free[0] = free[1] = 0;
    return free;
  }
  static Ragged<std::int32_t> triples(int n) {
    Ragged<std::int32_t> all;
    for (int i = 0; i + 2 < n; ++i) all.push_back(std::vector<std::int32_t>{i, i + 1, i + 2});
    return all;
  }
  Numbering numbering;
  SparseMatrix matrix;
};

// A solution that comes next proves the factor on its way, also where its right side meets none of the slow motions that the
// factor has wrong, or is zero, which takes no iteration: what factorise() gives up is given up.
TEST(MumpsEngine, ProvesAFactorWithTheSolution) {
  int again = 0, proved = 0;
  for (const int n : {20, 30, 40, 60, 80, 100, 120, 150, 200})
    for (const double size : {1.0, 0.0}) {
      const Beam beam(n);
      MumpsEngine safe({.single_precision = always}), fast({.single_precision = always});
      safe.analyse(beam.matrix);
      const Factorisation wanted = safe.factorise(beam.matrix);
      fast.analyse(beam.matrix);
      Factorisation found = fast.factorise_to_solve(beam.matrix);
      std::vector<double> zigzag(static_cast<std::size_t>(beam.matrix.size())), x(zigzag.size());
      for (std::size_t i = 0; i < zigzag.size(); ++i) zigzag[i] = i % 2 ? size : -size;
      beam.matrix.multiply(zigzag, x);
      const Solution solution = fast.solve(x);
      EXPECT_EQ(solution.error.has_value(), !solution.again && found.single_precision) << n;
      if (solution.error) {
        EXPECT_NEAR(*solution.error, wanted.error, 0.1 * wanted.error) << n;
        ++proved;
      }
      if (solution.again) {
        ++again;
        found = *solution.again;
      }
      EXPECT_EQ(found.negative_pivots, wanted.negative_pivots) << n;
      EXPECT_EQ(found.single_precision, wanted.single_precision) << n;
      EXPECT_EQ(found.doubt.empty(), wanted.doubt.empty()) << n;
      EXPECT_EQ(fast.care(), safe.care()) << n;
      EXPECT_LE(solution.residual, 1e-14) << n;
    }
  EXPECT_GE(again, 2);
  EXPECT_GE(proved, 2);
}

// What single precision cannot carry, a slender beam and a stiff body on a soft one, is factorised in double precision; what it
// can has the same digits.
TEST(MumpsEngine, GivesSinglePrecisionUpWhereItDoesNotCarry) {
  const Beam slender(300), stout(20);
  const Lattice stiff(8, 1e6), uniform(8);
  const struct {
    const SparseMatrix& matrix;
    bool carries;
    double condition;
  } cases[] = {
      {slender.matrix, false, 8.1e9}, {stout.matrix, true, 1.6e5}, {stiff.matrix, false, 1e7}, {uniform.matrix, true, 1e2}};
  for (const auto& [matrix, carries, condition] : cases) {
    SCOPED_TRACE(condition);
    std::vector<double> solutions[2];
    for (const bool single : {false, true}) {
      MumpsEngine engine({.single_precision = single ? always : never});
      engine.analyse(matrix);
      const Factorisation found = engine.factorise(matrix);
      EXPECT_EQ(found.negative_pivots, 0);
      EXPECT_EQ(found.single_precision, single && carries) << found.doubt;
      solutions[single].assign(static_cast<std::size_t>(matrix.size()), 1.0);
      EXPECT_LE(engine.solve(solutions[single]).residual, 1e-14);
    }
    const double largest = *std::max_element(solutions[0].begin(), solutions[0].end());
    for (std::size_t i = 0; i < solutions[0].size(); ++i)
      ASSERT_NEAR(solutions[1][i], solutions[0][i], 1e-15 * condition * largest);
  }
}

// Low-rank blocks are cheaper, and the same bits in every run; columns of the inverse come from them as from any factor.
TEST(MumpsEngine, CompressesBlocks) {
  const Lattice lattice(30);
  const std::vector<std::int64_t> offset{0, 1, 2};
  const std::vector<std::int32_t> index{100, 7000};
  const std::vector<double> value{1.0, 3.0};
  std::vector<double> solutions[2];
  double flops[2];
  for (const bool low_rank : {false, true})
    for (int run = 0; run < 2; ++run) {
      MumpsEngine engine({.single_precision = always, .low_rank = low_rank ? always : never, .low_rank_threshold = 1e-3});
      engine.analyse(lattice.matrix);
      const Factorisation found = engine.factorise(lattice.matrix);
      EXPECT_EQ(found.low_rank, low_rank);
      EXPECT_EQ(found.doubt, "");
      flops[low_rank] = found.flops;
      std::vector<double> x(static_cast<std::size_t>(lattice.matrix.size()), 0.0);
      x[7000] = 3;
      engine.solve(x);
      const std::vector<float> columns = engine.substitute(offset, index, value);
      for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(columns[x.size() + i], x[i], 0.05 * x[7000]);
      if (run == 0)
        solutions[low_rank] = x;
      else
        EXPECT_EQ(solutions[low_rank], x);
    }
  EXPECT_LT(flops[true], 0.9 * flops[false]);
  for (std::size_t i = 0; i < solutions[0].size(); ++i)
    ASSERT_NEAR(solutions[1][i], solutions[0][i], 1e-12 * solutions[0][7000]);
}

// Blocks of low rank are eliminated as ordered; where that gives no pivot they are looked for, from then on, which takes no
// other precision. Of what no factor can take, a free body, nothing but an exact one is left.
TEST(MumpsEngine, LooksForPivotsWhereTheOrderGivesNone) {
  constexpr int n = 6;
  Lattice lattice(n, 1, false);
  const SparseMatrix free = lattice.matrix;
  test::make_pairs(lattice, n);
  MumpsEngine engine({.single_precision = always, .low_rank = always});
  engine.analyse(lattice.matrix);
  for (const bool remembers : {false, true}) {
    const Factorisation found = engine.factorise(lattice.matrix);
    EXPECT_TRUE(found.low_rank && found.single_precision);
    EXPECT_EQ(found.doubt, "");
    EXPECT_TRUE(found.null_pivots.empty());
    EXPECT_EQ(found.negative_pivots, lattice.matrix.size() / 2);
    EXPECT_EQ(found.wasted_flops == 0, remembers);
    EXPECT_EQ(engine.care(), Engine::Care::pivots);
    std::vector<double> x(static_cast<std::size_t>(lattice.matrix.size()), 1.0);
    EXPECT_LE(engine.solve(x).residual, 1e-14);
  }
  engine.analyse(free);
  const Factorisation found = engine.factorise(free);
  EXPECT_EQ(found.null_pivots.size(), 1u);
  EXPECT_NE(found.doubt, "");
  EXPECT_EQ(engine.care(), Engine::Care::exact);
}

// ------------------------------------------------------------------------------------------------------ factors in files

// A factor that is kept in files gives the solution that one in memory gives, and leaves no files behind.
TEST(MumpsEngine, KeepsFactorsInFiles) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("mumps_engine_test.{}", getpid());
  const SaddlePoint system;
  Eigen::VectorXd x = Eigen::VectorXd::Random(system.matrix.size()), y = x;
  {
    MumpsEngine in_memory, in_files({.memory = MumpsOptions::Memory::out_of_core, .folder = folder});
    for (const auto& [engine, side] : {std::pair(&in_memory, &x), std::pair(&in_files, &y)}) {
      engine->analyse(system.matrix);
      EXPECT_EQ(engine->factorise(system.matrix).out_of_core, engine == &in_files);
      engine->solve(entries(*side));
    }
    EXPECT_FALSE(std::filesystem::is_empty(folder));
  }
  EXPECT_EQ(x, y);
  EXPECT_FALSE(std::filesystem::exists(folder));
}

/// Bytes of addresses that this process has.
std::size_t addresses() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(getpagesize());
}

// Where memory ends the factor goes into files by itself; where it may not, that is told.
TEST(MumpsEngine, GoesOnInFilesWhereMemoryEnds) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer has tables of its own, and ends where memory does";
#endif
  const Lattice lattice(30);
  const auto solve = [&](MumpsOptions::Memory memory) {
    const std::string folder = std::filesystem::temp_directory_path() / fmt::format("mumps_engine_memory.{}", getpid());
    MumpsEngine engine({.single_precision = never, .memory = memory, .folder = folder});
    const Lattice small(16);  // OpenBLAS takes its own memory at its first product
    engine.analyse(small.matrix);
    engine.factorise(small.matrix);
    engine.analyse(lattice.matrix);
    const rlimit limit{addresses() + (std::size_t{45} << 20), RLIM_INFINITY};  // files need 30
    setrlimit(RLIMIT_AS, &limit);
    try {
      if (!engine.factorise(lattice.matrix).out_of_core) return 1;
      std::vector<double> x(static_cast<std::size_t>(lattice.matrix.size()), 1.0);
      return engine.solve(x).residual < 1e-14 ? 0 : 2;
    } catch (const Error& error) {
      return error.message().id == "SOLVER_2" ? 3 : 4;
    }
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a process that has nothing to give back
  EXPECT_EXIT(_exit(solve(MumpsOptions::Memory::where_needed)), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(_exit(solve(MumpsOptions::Memory::in_core)), testing::ExitedWithCode(3), "");
}

// The analysis as well, whatever it is that it can have no more of: each array of it is the first one for which there is no
// room.
TEST(MumpsEngine, SaysThatItsAnalysisHasNoMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer has tables of its own, and ends where memory does";
#endif
  const auto ends = [] {
    constexpr std::size_t page = 4096, most = 64 << 20;
    reserve_blas_memory();
    const Lattice lattice(20);
    mallopt(M_MMAP_THRESHOLD, page);  // what is given back counts no more
    MumpsEngine({.single_precision = never}).analyse(lattice.matrix);
    int n = 0;
    for (std::size_t more = 0; more < most; more += 8 * page, ++n) {
      const rlimit none{RLIM_INFINITY, RLIM_INFINITY}, limit{addresses() + more, RLIM_INFINITY};
      setrlimit(RLIMIT_AS, &limit);
      try {
        MumpsEngine engine({.single_precision = never});
        engine.analyse(lattice.matrix);
        return n > 20 ? 0 : 1;
      } catch (const Error& error) {
        if (error.message().id != "SOLVER_2") return 2;
      } catch (const std::bad_alloc&) {  // of our own
      } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 3;
      }
      setrlimit(RLIMIT_AS, &none);
    }
    return 4;
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(_exit(ends()), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace lacon
