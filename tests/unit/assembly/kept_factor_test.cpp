// What is made of a factor that is kept: for which work, from which columns, and in another process.
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <random>

#include "blurred_engine.hpp"
#include "columns.hpp"
#include "dense.hpp"
#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/structures/hdf5.hpp"
#include "lattice.hpp"

namespace lacon {
namespace {

using test::Chain;
using test::columns;
using test::dense;

constexpr int kept_nodes = 40, kept_rows = 6;

/// A chain held at its first node, with rows of multipliers that are on or off (diagonal alone).
struct SwitchedRows {
  SwitchedRows() : chain(kept_nodes, kept_rows, held()), matrix(chain.numbering, chain.cliques, couplings()) { fill(); }
  static std::vector<std::uint8_t> held() {
    std::vector<std::uint8_t> free(2 * kept_nodes, 1);
    free[0] = free[1] = 0;
    return free;
  }
  static std::vector<Coupling> couplings() {
    std::vector<Coupling> all;
    for (int r = 0; r < kept_rows; ++r)
      for (int k = 0; k < 2; ++k) all.push_back({kept_nodes + r, 4 + 6 * r + k});
    return all;
  }
  void fill() {
    matrix.set_zero();
    test::add_springs(matrix, chain);
    for (int r = 0; r < kept_rows; ++r) {
      if (!on[r]) matrix.add_diagonal(chain.numbering.of_patch(r), 0.5 + r);
      for (int k = 0; on[r] && k < 2; ++k)
        matrix.add(std::vector<std::int64_t>{chain.numbering.of_patch(r), chain.numbering.of(4 + 6 * r + k, (r + k) % 2)},
                   std::vector<double>{0, k ? 0.7 : -1.0, 0});
    }
  }
  SolutionReport solve(SaddlePointSolver& solver, std::vector<double>& x) const {
    return solver.solve(matrix, chain.numbering.first[kept_nodes], x);
  }
  /// What switches some rows.
  SparseSides switching(std::initializer_list<int> some) const {
    SparseSides sides;
    for (const int r : some) {
      if (on[r]) sides.add_entry(chain.numbering.of_patch(r), 1);
      for (int k = 0; !on[r] && k < 2; ++k) sides.add_entry(chain.numbering.of(4 + 6 * r + k, (r + k) % 2), k ? 0.7 : -1.0);
      sides.end_side(chain.numbering.of_patch(r), !on[r]);
    }
    return sides;
  }
  /// How far a solution is from dense LU.
  double error(const std::vector<double>& x, const std::vector<double>& b) const {
    const auto n = static_cast<Eigen::Index>(x.size());
    return (dense(matrix).fullPivLu().solve(Eigen::Map<const Eigen::VectorXd>(b.data(), n)) -
            Eigen::Map<const Eigen::VectorXd>(x.data(), n))
        .cwiseAbs()
        .maxCoeff();
  }
  std::vector<double> side(unsigned seed) const {
    std::mt19937 random(seed);
    return test::random_values(static_cast<std::size_t>(matrix.size()), random);
  }
  Chain chain;
  SparseMatrix matrix;
  std::array<bool, kept_rows> on{};
};

/// An engine that says nothing of its matrix, at the cost of so many substitutions.
std::unique_ptr<FactorEngine> poor_engine(double iterations) {
  return std::make_unique<test::BlurredEngine>(
      0.1, [=](Factorisation& found) { found.flops = iterations * 40 * static_cast<double>(found.entries); });
}

/// One that calls its exact factor one of low rank.
std::unique_ptr<FactorEngine> low_rank_engine() {
  return std::make_unique<test::BlurredEngine>(0, [](Factorisation& found) { found.low_rank = true; });
}

// GMRES may take as many substitutions as a factorisation costs, and is given up beyond: then the matrix is factorised.
TEST(KeptFactor, IsGivenUpWhereItsIterationsCostMoreThanAFactorisation) {
  for (const double worth : {10.0, 1000.0}) {
    SwitchedRows rows;
    SaddlePointSolver solver(poor_engine(worth), {.column_memory = 1e6});
    std::vector<double> x = rows.side(1);
    rows.solve(solver, x);
    x = rows.side(2);
    const SolutionReport report = rows.solve(solver, x);
    EXPECT_EQ(report.factorised, worth == 10) << report.iterations;
    if (!report.factorised) {
      EXPECT_GT(report.iterations, 10);
    }
    const Eigen::VectorXd left = dense(rows.matrix) * Eigen::Map<Eigen::VectorXd>(x.data(), rows.matrix.size()) -
                                 Eigen::Map<const Eigen::VectorXd>(rows.side(2).data(), rows.matrix.size());
    EXPECT_LE(left.cwiseAbs().maxCoeff(), 1e-10);
  }
}

// Nothing has changed: one substitution does, and nobody has to be asked whether a body came loose.
TEST(KeptFactor, SolvesTheSameMatrixAgain) {
  SwitchedRows rows;
  rows.on[1] = true;
  rows.fill();
  SaddlePointSolver solver(std::make_unique<MumpsEngine>(), {.work_limit = 1e6, .column_memory = 1e6});
  std::vector<double> x = rows.side(1);
  EXPECT_TRUE(rows.solve(solver, x).factorised);
  for (unsigned seed = 2; seed < 5; ++seed) {
    x = rows.side(seed);
    const SolutionReport report = rows.solve(solver, x);
    EXPECT_FALSE(report.factorised);
    EXPECT_LE(report.iterations, 2);
    EXPECT_EQ(report.columns, 0);
  }
}

// Digits below the tolerance of the largest right side are round-off: two of them do.
TEST(KeptFactor, SolvesRoundOffRoughly) {
  SwitchedRows rows;
  SaddlePointSolver solver(poor_engine(1e6), {.column_memory = 1e6});
  std::vector<double> x = rows.side(1);
  rows.solve(solver, x);
  std::vector<int> iterations;
  for (const double size : {1e-11, 1e-13}) {
    x = rows.side(2);
    for (double& value : x) value *= size;
    iterations.push_back(rows.solve(solver, x).iterations);
  }
  EXPECT_GT(iterations[0], iterations[1]);
  EXPECT_GT(iterations[1], 0);
}

// Columns that switch rows are there when those are switched; where memory has no room for whole ones, as bare ones.
TEST(KeptFactor, NeedsNoColumnTwice) {
  for (const bool room : {true, false}) {
    SwitchedRows rows;
    SaddlePointSolver solver(std::make_unique<MumpsEngine>(),
                             {.work_limit = 1e6, .column_memory = 0, .least_memory = room ? 1e6 : 0});
    rows.on[0] = true;
    rows.fill();
    std::vector<double> x = rows.side(1);
    rows.solve(solver, x);
    std::vector<float> first, again;
    EXPECT_EQ(columns(solver, rows.matrix, rows.switching({0, 2}), first).columns, 2);
    EXPECT_EQ(columns(solver, rows.matrix, rows.switching({0, 2}), again).columns, room ? 0 : 2);
    EXPECT_EQ(again, first);
    SparseSides mixed = rows.switching({0});  // with one of which nothing is kept in between, and one behind
    for (int side = 0; side < 3; ++side) {
      if (side == 1)
        mixed.add_side(rows.switching({2}), 0);
      else
        mixed.add_entry(7, 1 + side), mixed.end_side();
    }
    EXPECT_EQ(columns(solver, rows.matrix, mixed, again).columns, room ? 2 : 4);
    for (const auto& [at, of] : {std::pair(0, 0), std::pair(2, 1)})
      EXPECT_TRUE(std::ranges::equal(std::span(again).subspan(at * x.size(), x.size()),
                                     std::span(first).subspan(of * x.size(), x.size())));
    const Eigen::VectorXd expected = dense(rows.matrix).inverse().col(7);
    for (const int at : {1, 3})
      for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_NEAR(again[static_cast<std::size_t>(at) * x.size() + i], at * expected[static_cast<Eigen::Index>(i)], 1e-5);
    rows.on[0] = false;
    rows.on[2] = true;
    rows.fill();
    x = rows.side(2);
    const SolutionReport report = rows.solve(solver, x);
    EXPECT_FALSE(report.factorised);
    EXPECT_EQ(report.columns, 0);
    EXPECT_LE(report.iterations, 4);
    EXPECT_LE(rows.error(x, rows.side(2)), 1e-11);
    columns(solver, rows.matrix, rows.switching({0, 3}), again);  // back, and one more
    for (const auto& [at, row] : {std::pair(0, 0), std::pair(1, 3)}) {
      const SparseSides side = rows.switching({row});
      Eigen::VectorXd b = Eigen::VectorXd::Zero(rows.matrix.size());
      for (std::size_t k = 0; k < side.index.size(); ++k) b[side.index[k]] = side.value[k];
      const Eigen::VectorXd exact = dense(rows.matrix).fullPivLu().solve(b);
      for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_NEAR(again[static_cast<std::size_t>(at) * x.size() + i], exact[static_cast<Eigen::Index>(i)], 1e-5);
    }
  }
}

// Those that nothing needs give way to those that a matrix does; where these are too many, they are bare. Neither is undone in
// another process.
TEST(KeptFactor, KeepsWhatMemoryHasRoomFor) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / ("kept_columns_" + std::to_string(getpid()));
  SwitchedRows rows;
  const SaddlePointOptions three{
      .work_limit = 1e6, .column_memory = 0, .least_memory = 0.5 * 3 * static_cast<double>(rows.matrix.size())};
  SaddlePointSolver solver(std::make_unique<MumpsEngine>(), three);
  std::vector<double> x = rows.side(1);
  rows.solve(solver, x);
  std::vector<float> found;
  EXPECT_EQ(columns(solver, rows.matrix, rows.switching({0, 1, 2}), found).columns, 3);
  unsigned seed = 1;
  for (const auto& [next, more] : {std::pair(4, 2), {5, 1}, {0, 1}, {2, 1}, {3, 1}}) {
    rows.on[next] = true;
    if (next == 4) rows.on[3] = true;  // of 0, 1 and 2 nothing is needed
    if (next == 3) rows.on[5] = false;
    rows.fill();
    hdf5::write_whole(file, [&](const hdf5::Group& group) {
      solver.save(group.create("solver"));
      solver.save_base(group.create("base"));
    });
    SaddlePointSolver second(std::make_unique<MumpsEngine>(), three);
    {
      const hdf5::Reader reader(file);
      const hdf5::Group base = reader.open("base");
      second.resume(reader.open("solver"), &base, rows.chain.numbering);
    }
    std::filesystem::remove(file);
    x = rows.side(++seed);
    std::vector<double> other = x;
    const SolutionReport report = rows.solve(solver, x), again = rows.solve(second, other);
    EXPECT_FALSE(report.factorised);
    EXPECT_EQ(report.columns, next == 3 ? 0 : more) << next;
    EXPECT_LE(rows.error(x, rows.side(seed)), 1e-11);
    EXPECT_EQ(other, x) << next;
    EXPECT_EQ(again.columns, report.columns);
    EXPECT_EQ(again.iterations, report.iterations);
  }
}

// Bodies that slide take more couples in: a pattern that has more entries needs no other factor, unless they are large.
TEST(KeptFactor, ServesAPatternThatGrew) {
  for (const double entry : {0.0, 0.01, 0.5}) {
    SwitchedRows rows;
    SaddlePointSolver solver(std::make_unique<MumpsEngine>(), {.work_limit = 1e6, .column_memory = 1e6});
    std::vector<double> x = rows.side(1);
    rows.solve(solver, x);
    std::vector<Coupling> couplings = SwitchedRows::couplings();
    couplings.push_back({3, 30});
    couplings.push_back({kept_nodes + 1, 35});
    rows.matrix = SparseMatrix(rows.chain.numbering, rows.chain.cliques, couplings);
    rows.on[1] = true;
    rows.fill();
    rows.matrix.add(std::vector<std::int64_t>{rows.chain.numbering.of(3, 0), rows.chain.numbering.of(30, 1)},
                    std::vector<double>{0, entry, 0});
    rows.matrix.add(std::vector<std::int64_t>{rows.chain.numbering.of_patch(1), rows.chain.numbering.of(35, 1)},
                    std::vector<double>{0, 0.1, 0});
    x = rows.side(2);
    EXPECT_EQ(rows.solve(solver, x).factorised, entry == 0.5);
    EXPECT_LE(rows.error(x, rows.side(2)), 1e-11);
  }
}

// Whole columns of a factor of low rank take little more than half the memory, and what is seen of them loses no digit.
TEST(KeptFactor, PacksColumnsOfLowRank) {
  for (const bool packed : {false, true}) {
    SwitchedRows rows;
    const auto n = static_cast<std::size_t>(rows.matrix.size());
    const SaddlePointOptions options{.work_limit = 1e6,
                                     .column_memory = 0,
                                     .least_memory = static_cast<double>(3 * PackedVector::memory(n)) / sizeof(double)};
    std::unique_ptr<Engine> engine = std::make_unique<MumpsEngine>();
    if (packed) engine = low_rank_engine();
    SaddlePointSolver solver(std::move(engine), options);
    std::vector<double> x = rows.side(1);
    rows.solve(solver, x);
    std::vector<float> found, again;
    EXPECT_EQ(columns(solver, rows.matrix, rows.switching({0, 2, 3}), found).columns, 3);
    EXPECT_EQ(columns(solver, rows.matrix, rows.switching({0, 2, 3}), again).columns, packed ? 0 : 3);  // without room: bare
    EXPECT_EQ(again, found);
    const Eigen::MatrixXd inverse = dense(rows.matrix).inverse();
    const std::vector<int> of{0, 2, 3};
    for (std::size_t c = 0; c < of.size(); ++c) {
      const SparseSides side = rows.switching({of[c]});
      Eigen::VectorXd exact = Eigen::VectorXd::Zero(rows.matrix.size());
      for (std::size_t k = 0; k < side.index.size(); ++k) exact += side.value[k] * inverse.col(side.index[k]);
      const double size = exact.cwiseAbs().maxCoeff();
      for (std::size_t i = 0; i < n; ++i)
        EXPECT_NEAR(found[c * n + i], exact[static_cast<Eigen::Index>(i)], (packed ? 2e-5 : 1e-6) * size);
      for (const std::int32_t seen : side.index)
        EXPECT_NEAR(found[c * n + static_cast<std::size_t>(seen)], exact[seen], 1e-6 * size);
    }
    rows.on[0] = rows.on[2] = rows.on[3] = true;
    rows.fill();
    x = rows.side(2);
    const SolutionReport report = rows.solve(solver, x);
    EXPECT_FALSE(report.factorised);
    EXPECT_EQ(report.columns, 0);
    EXPECT_LE(report.iterations, 4);
    EXPECT_LE(rows.error(x, rows.side(2)), 1e-11);
  }
}

// Another process that takes over what was saved goes on with the same bits, and with all columns: they come from several
// blocks, some of whose rows have newer ones since.
TEST(KeptFactor, GoesOnInAnotherProcessWithTheSameBits) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / ("kept_factor_" + std::to_string(getpid()));
  const SaddlePointOptions eager{.work_limit = 1e6, .column_memory = 1e6};
  for (const bool packed : {false, true}) {
    const auto engine = [&]() -> std::unique_ptr<Engine> {
      if (packed) return low_rank_engine();
      return std::make_unique<MumpsEngine>();
    };
    SwitchedRows rows;
    SaddlePointSolver first(engine(), eager);
    std::vector<double> x = rows.side(1);
    rows.solve(first, x);
    unsigned seed = 1;
    for (const std::array<bool, kept_rows>& on :
         {std::array<bool, kept_rows>{true, true}, {true, true, false, true}, {false, true, false, true, true, true}}) {
      rows.on = on;
      rows.fill();
      x = rows.side(++seed);
      const SolutionReport report = rows.solve(first, x);
      EXPECT_FALSE(report.factorised);
      EXPECT_GT(report.columns, 0);
    }
    hdf5::write_whole(file, [&](const hdf5::Group& group) {
      first.save(group.create("solver"));
      first.save_base(group.create("base"));
    });
    SaddlePointSolver second(engine(), eager);
    {
      const hdf5::Reader reader(file);
      const hdf5::Group base = reader.open("base");
      second.resume(reader.open("solver"), &base, rows.chain.numbering);
    }
    std::filesystem::remove(file);
    EXPECT_EQ(second.base_number(), first.base_number());
    for (const std::array<bool, kept_rows>& on : {std::array<bool, kept_rows>{true, true, false, true, true, true},
                                                  {true, false, false, false, true},
                                                  {false, false, true, true}}) {
      rows.on = on;
      rows.fill();
      std::vector<double> one = rows.side(++seed), other = one;
      const SolutionReport expected = rows.solve(first, one), found = rows.solve(second, other);
      EXPECT_EQ(other, one);
      EXPECT_FALSE(found.factorised);
      EXPECT_EQ(found.columns, expected.columns);
      EXPECT_EQ(found.iterations, expected.iterations);
    }
  }
}

// So does one that takes over that pivots have to be looked for: it does not try without.
TEST(KeptFactor, TakesOverTheCareOfFactors) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / ("kept_care_" + std::to_string(getpid()));
  constexpr int n = 6;
  test::Lattice lattice(n, 1, false);
  test::make_pairs(lattice, n);
  const auto solver = [] {
    return SaddlePointSolver(std::make_unique<MumpsEngine>(
        MumpsOptions{.single_precision = MumpsOptions::Use::always, .low_rank = MumpsOptions::Use::always}));
  };
  SaddlePointSolver first = solver(), second = solver();
  std::vector<double> one(static_cast<std::size_t>(lattice.matrix.size()), 1.0), other = one;
  EXPECT_GT(first.solve(lattice.matrix, lattice.matrix.size(), one).factorisation.wasted_flops, 0);
  hdf5::write_whole(file, [&](const hdf5::Group& group) { first.save(group.create("solver")); });
  second.resume(hdf5::Reader(file).open("solver"), nullptr, lattice.numbering);
  std::filesystem::remove(file);
  EXPECT_EQ(second.solve(lattice.matrix, lattice.matrix.size(), other).factorisation.wasted_flops, 0);
  EXPECT_EQ(other, one);
}

// Columns of the inverse, many at once, by a factor that is exact and by one in single precision: those of the dense inverse,
// also of unknowns that their row alone decides, whatever else is in the same column.
TEST(KeptFactor, GivesTheColumnsOfTheInverse) {
  SwitchedRows rows;
  rows.on = {true, false, true, false, false, true};
  rows.fill();
  const Eigen::MatrixXd inverse = dense(rows.matrix).inverse();
  const auto patch = [&](int r) { return static_cast<std::int32_t>(rows.chain.numbering.of_patch(r)); };
  const std::vector<std::vector<std::pair<std::int32_t, double>>> columns = {{{3, 2.0}},
                                                                             {{patch(1), 1.0}},
                                                                             {{5, -1.0}, {20, 4.0}, {patch(3), 3.0}},
                                                                             {{patch(3), -2.0}, {patch(4), 0.5}},
                                                                             {{patch(0), 1e-3}},
                                                                             {{40, 1e4}, {patch(1), 1.0}}};
  std::vector<std::int64_t> offset{0};
  std::vector<std::int32_t> index;
  std::vector<double> value;
  for (const auto& column : columns) {
    for (const auto& [i, v] : column) index.push_back(i), value.push_back(v);
    offset.push_back(static_cast<std::int64_t>(index.size()));
  }
  for (const bool single : {false, true}) {
    MumpsEngine engine({.single_precision = single ? MumpsOptions::Use::always : MumpsOptions::Use::never});
    engine.analyse(rows.matrix);
    EXPECT_EQ(engine.factorise(rows.matrix).single_precision, single);
    const std::vector<float> found = engine.substitute(offset, index, value);
    const auto n = static_cast<std::size_t>(rows.matrix.size());
    ASSERT_EQ(found.size(), n * columns.size());
    for (std::size_t c = 0; c < columns.size(); ++c) {
      Eigen::VectorXd expected = Eigen::VectorXd::Zero(inverse.rows());
      for (const auto& [i, v] : columns[c]) expected += v * inverse.col(i);
      const double largest = expected.cwiseAbs().maxCoeff();
      for (std::size_t i = 0; i < n; ++i)
        EXPECT_NEAR(found[c * n + i], expected[static_cast<Eigen::Index>(i)], (single ? 1e-4 : 1e-6) * largest)
            << c << ' ' << i;
      // round-off of the column is none of theirs
      for (const int r : {1, 3, 4}) {
        const double own = expected[patch(r)];
        EXPECT_NEAR(found[c * n + static_cast<std::size_t>(patch(r))], own, 1e-6 * std::abs(own)) << c << ' ' << r;
      }
    }
  }
}

}  // namespace
}  // namespace lacon
