#include "lacon/assembly/tree/tree_mumps.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <new>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>

#include "dense.hpp"
#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/assembly/ordering.hpp"
#include "lacon/assembly/parts/part_processes.hpp"
#include "lacon/assembly/tree/ordering_ahead.hpp"
#include "lacon/catalog/messages.hpp"
#include "lattice.hpp"

namespace lacon {
namespace {

using test::Lattice;
using Use = MumpsOptions::Use;

MumpsOptions shared_by(int processes) {
  return {.processes = processes, .least_shared = 1, .program = LACON_BINARY_DIR "/bin/lacon_mumps"};
}

std::vector<double> any_force(std::int64_t n) {
  std::mt19937 random(5);
  return test::random_values(static_cast<std::size_t>(n), random);
}

/// Lattices one on the other, the upper one held by multipliers alone: pairs of points that move as one.
struct Stacked {
  static constexpr int n = 9, points = n * n * n, rows = n * n;
  explicit Stacked(bool is_symmetric = true)
      : numbering(number_equations(2 * points, 1, free(), rows)),
        matrix(numbering, springs(), couplings(), is_symmetric ? Symmetry::symmetric : Symmetry::general) {
    const Ragged<std::int32_t> all = springs();
    const auto add = [&](std::vector<std::int64_t> equations, double a, double b, double c) {
      if (is_symmetric)
        matrix.add(equations, std::vector{a, b, c});
      else
        matrix.add_unsymmetric(equations, std::vector{a, 0.9 * b, b, c});
    };
    for (std::size_t s = 0; s < all.size(); ++s) add({numbering.of(all[s][0], 0), numbering.of(all[s][1], 0)}, 1, -1, 1.1);
    for (const Coupling& c : couplings())
      add({numbering.of_patch(c.a - 2 * points), numbering.of(c.b, 0)}, 0, c.b < points ? 1 : -1, 0);
  }
  static std::vector<std::uint8_t> free() {
    std::vector<std::uint8_t> all(2 * points, 1);
    std::fill(all.begin(), all.begin() + n * n, 0);
    return all;
  }
  static Ragged<std::int32_t> springs() {
    const Ragged<std::int32_t> one = Lattice::springs(n);
    Ragged<std::int32_t> all;
    for (const std::int32_t from : {0, points})
      for (std::size_t s = 0; s < one.size(); ++s) all.push_back(std::vector<std::int32_t>{one[s][0] + from, one[s][1] + from});
    return all;
  }
  static std::vector<Coupling> couplings() {
    std::vector<Coupling> all;
    for (int r = 0; r < rows; ++r) {
      all.push_back({2 * points + r, points - rows + r});
      all.push_back({2 * points + r, points + r});
    }
    return all;
  }
  Numbering numbering;
  SparseMatrix matrix;
};

// Equations of two subtrees never meet, and sharing shortens the work.
TEST(Subtrees, DoNotMeet) {
  const Stacked system;
  const std::vector<std::int32_t> order = elimination_order(system.matrix);
  for (const int processes : {2, 3, 5}) {
    const Subtrees found = independent_subtrees(system.matrix, order, processes);
    for (std::int64_t row = 0; row < system.matrix.size(); ++row)
      for (std::int64_t k = system.matrix.rows()[row]; k < system.matrix.rows()[row + 1]; ++k) {
        const int one = found.of[row], other = found.of[system.matrix.columns()[k]];
        ASSERT_TRUE(one == other || one < 0 || other < 0);
      }
    EXPECT_LT(found.longest, 0.85 * found.whole.flops);
    EXPECT_GE(found.longest, found.whole.flops / processes);
  }
}

// Flops and entries are those of an elimination of the graph, unknown by unknown.
TEST(Subtrees, CountWhatAnEliminationTakes) {
  const Stacked system;
  const std::vector<std::int32_t> order = elimination_order(system.matrix);
  std::vector<std::set<std::int32_t>> later(order.size());  // neighbours that are eliminated behind each, by place
  for (std::int64_t row = 0; row < system.matrix.size(); ++row)
    for (std::int64_t k = system.matrix.rows()[row]; k < system.matrix.rows()[row + 1]; ++k) {
      const std::int32_t a = order[row], b = order[system.matrix.columns()[k]];
      if (a != b) later[std::min(a, b)].insert(std::max(a, b));
    }
  double flops = 0, entries = 0;
  for (std::set<std::int32_t>& column : later) {
    const double height = static_cast<double>(column.size() + 1);
    flops += height * height;
    entries += height;
    if (column.empty()) continue;
    const std::int32_t next = *column.begin();
    later[next].insert(std::next(column.begin()), column.end());
  }
  const EliminationCounts counts = elimination_counts(system.matrix, order);
  EXPECT_EQ(counts.flops, flops);
  EXPECT_EQ(counts.entries, entries);
  EXPECT_EQ(independent_subtrees(system.matrix, order, 2).whole.flops, flops);
}

/// Of lattices one on the other: pairs of points hang on multipliers.
void expect_order(const Stacked& system, const std::vector<std::int32_t>& order) {
  EXPECT_EQ(std::set(order.begin(), order.end()).size(), order.size());
  for (int r = 0; r < Stacked::rows; ++r) {
    const std::int64_t own = system.numbering.of_patch(r), above = system.numbering.of(Stacked::points + r, 0);
    EXPECT_GT(order[own], order[above]);
  }
}

// Two processes have halves of one size: of a cube with a waist off its middle the waist is the smallest separator, but then
// the larger side would be ready when the other one has long been waiting.
TEST(OrderingAhead, CutsInHalvesForTwoProcesses) {
  constexpr int n = 33, waist = 13, opening = 6;
  std::vector<std::uint8_t> free(n * n * n, 1);
  for (int i = waist * n * n; i < (waist + 1) * n * n; ++i) free[i] = i % n < opening && i / n % n < opening;
  const Numbering numbering = number_equations(n * n * n, 1, free, 0);
  const SparseMatrix matrix(numbering, Lattice::springs(n), {});
  const auto taken = [&](int n_processes) {
    MumpsProcesses processes(n_processes, shared_by(n_processes).program);
    OrderingAhead ahead;
    return ahead.take(matrix, processes).order;
  };
  const Subtrees even = independent_subtrees(matrix, taken(2), 2), any = independent_subtrees(matrix, taken(3), 2);
  EXPECT_LT(even.longest, 0.9 * any.longest);
  EXPECT_LT(even.longest, 0.6 * even.whole.flops);
}

// Processes order a graph while it is evaluated yet: in the same way in every run, not much worse than METIS does alone, and
// where one is killed or another graph was expected, all the same.
TEST(OrderingAhead, IsThatOfTheGraph) {
  const Stacked system;
  expect_order(system, elimination_order(system.matrix));
  const Lattice large(33), other(10);  // a graph of 30 000 vertices is ordered in halves
  MumpsProcesses processes(3, shared_by(3).program);
  const auto ordered = [&](const VertexGraph& expected, const VertexGraph& graph) {
    OrderingAhead ahead;
    ahead.begin(expected, processes);
    return ahead.take(graph, processes);
  };
  expect_order(system, ordered(system.matrix, system.matrix).order);
  const SharedOrder found = ordered(large.matrix, large.matrix);
  EXPECT_EQ(std::set(found.order.begin(), found.order.end()).size(), found.order.size());
  const EliminationCounts alone = elimination_counts(large.matrix, elimination_order(large.matrix));
  EXPECT_LT(found.subtrees.whole.flops, 1.3 * alone.flops);
  EXPECT_EQ(found.subtrees.whole.flops, elimination_counts(large.matrix, found.order).flops);
  EXPECT_EQ(found.subtrees.of, independent_subtrees(large.matrix, found.order, 3).of);
  EXPECT_EQ(found.subtrees.process, independent_subtrees(large.matrix, found.order, 3).process);
  EXPECT_EQ(ordered(other.matrix, large.matrix).order, found.order);
  MumpsProcesses none(3, "/nowhere/lacon_mumps");
  OrderingAhead without;
  without.begin(large.matrix, none);
  EXPECT_EQ(without.take(large.matrix, none).order, elimination_order(large.matrix));
}

/// Processes of lacon_mumps that this one has started, and that have not ended. In the order in which they were started.
std::vector<pid_t> own_processes() {
  std::vector<pid_t> found;
  for (const auto& folder : std::filesystem::directory_iterator("/proc")) {
    std::ostringstream status;
    status << std::ifstream(folder.path() / "status").rdbuf();  // nothing more, where the process ends meanwhile
    const std::string text = status.str();
    if (text.starts_with("Name:\tlacon_mumps\n") && text.find("\nState:\tZ") == std::string::npos &&
        text.find("\nPPid:\t" + std::to_string(getpid()) + '\n') != std::string::npos)
      found.push_back(std::stoi(folder.path().filename()));
  }
  std::ranges::sort(found);
  return found;
}

// Whichever process ends before there is work for it, others take their places.
TEST(OrderingAhead, OutlivesProcesses) {
  const Stacked system;
  const std::vector<std::int32_t> expected = elimination_order(system.matrix);
  for (const std::size_t which : {0U, 1U}) {
    MumpsProcesses processes(2, shared_by(2).program);
    processes.start();
    const std::vector<pid_t> own = own_processes();
    ASSERT_EQ(own.size(), 2U);
    OrderingAhead ahead;
    ahead.begin(system.matrix, processes);
    kill(own[which], SIGKILL);
    while (std::ranges::count(own_processes(), own[which]) > 0) usleep(1000);
    EXPECT_EQ(ahead.take(system.matrix, processes).order, expected);
    processes.start();
    EXPECT_EQ(own_processes().size(), 2U);
    EXPECT_EQ(processes.ask("forget"), "done");
  }
}

// A pattern that is expected while processes still have a factor, and one that never comes, leave them able to hear.
TEST(OrderingAhead, KeepsProcessesInStep) {
  const Stacked system;
  const Lattice other(10);
  MumpsEngine engine(shared_by(2));
  const auto solves = [&](const SparseMatrix& matrix) {
    engine.expect(matrix);
    engine.analyse(matrix);
    EXPECT_EQ(engine.factorise(matrix).processes, 2);
    std::vector<double> x = any_force(matrix.size());
    EXPECT_LE(engine.solve(x).residual, 1e-15);
  };
  solves(system.matrix);
  solves(system.matrix);
  engine.expect(other.matrix);
  solves(system.matrix);
  solves(other.matrix);
}

// A factor that processes share gives solutions, inertia and columns of the inverse as that of one process does, in the same
// bits in every run.
TEST(TreeMumps, SolvesAsOneProcessDoes) {
  const std::vector<std::int64_t> offset{0, 2, 3};
  const std::vector<std::int32_t> index{100, 700, 1000};
  const std::vector<double> value{1.0, 3.0, -2.0};
  for (const bool is_symmetric : {true, false}) {
    const Stacked system(is_symmetric);
    const std::vector<double> force = any_force(system.matrix.size());
    MumpsEngine one;
    one.analyse(system.matrix);
    const Factorisation wanted = one.factorise(system.matrix);
    std::vector<double> expected = force;
    one.solve(expected);
    const std::vector<float> columns = one.substitute(offset, index, value);
    const double size = *std::max_element(expected.begin(), expected.end());
    for (const int processes : {2, 3})
      for (const auto& [single, low_rank] :
           {std::pair(Use::never, Use::never), {Use::always, Use::never}, {Use::always, Use::always}}) {
        MumpsOptions options = shared_by(processes);
        options.single_precision = single;
        options.low_rank = low_rank;
        std::vector<std::vector<double>> runs;
        for (int run = 0; run < 2; ++run) {
          MumpsEngine engine(options);
          engine.analyse(system.matrix);
          const Factorisation found = engine.factorise(system.matrix);
          EXPECT_EQ(found.doubt, "");
          EXPECT_EQ(found.processes, processes);
          EXPECT_EQ(found.single_precision, single == Use::always);
          EXPECT_EQ(found.negative_pivots, wanted.negative_pivots);
          runs.push_back(force);
          engine.solve(runs.back());
          const std::vector<float> now = engine.substitute(offset, index, value);
          for (std::size_t i = 0; i < now.size(); ++i) ASSERT_NEAR(now[i], columns[i], 1e-3);
        }
        EXPECT_EQ(runs[0], runs[1]);
        for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(runs[0][i], expected[i], 1e-11 * size);
      }
  }
}

// Other values on the same pattern, and matrices that are not large enough.
TEST(TreeMumps, IsMadeForLargeMatricesAgainAndAgain) {
  Lattice lattice(10);
  MumpsOptions options = shared_by(2);
  MumpsEngine engine(options);
  engine.analyse(lattice.matrix);
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(engine.factorise(lattice.matrix).processes, 2);
    std::vector<double> force = any_force(lattice.matrix.size());
    EXPECT_LE(engine.solve(force).residual, 1e-14);
    lattice.matrix.add_diagonal(500, 3.0);
  }
  options.least_shared = 1'000;
  MumpsEngine of_large_ones(options);
  of_large_ones.analyse(lattice.matrix);
  EXPECT_EQ(of_large_ones.factorise(lattice.matrix).processes, 1);
}

// Where something moves freely one process makes an exact factor, which says what.
TEST(TreeMumps, LeavesFreeMotionsToOneProcess) {
  const Lattice lattice(8, 1, false);
  MumpsEngine one, engine(shared_by(2));
  one.analyse(lattice.matrix);
  engine.analyse(lattice.matrix);
  const Factorisation found = engine.factorise(lattice.matrix);
  EXPECT_EQ(found.null_pivots, one.factorise(lattice.matrix).null_pivots);
  EXPECT_EQ(found.null_pivots.size(), 1);
  EXPECT_NE(found.doubt, "");
  EXPECT_EQ(found.processes, 1);
}

// A body that multipliers alone hold is loose where these are all of its border: its last pivots are left to the top.
TEST(TreeMumps, HoldsBodiesByTheTop) {
  const Stacked system;
  const Numbering& numbering = system.numbering;
  Subtrees bodies{.of = std::vector<std::int32_t>(static_cast<std::size_t>(system.matrix.size()), -1), .process = {0, 1}};
  for (int point = 0; point < 2 * Stacked::points; ++point)
    if (const std::int64_t e = numbering.of(point, 0); e >= 0) bodies.of[e] = point < Stacked::points ? 0 : 1;
  std::vector<int> row, column, place;
  for (std::int64_t i = 0; i < system.matrix.size(); ++i)
    for (std::int64_t k = system.matrix.rows()[i]; k < system.matrix.rows()[i + 1]; ++k) {
      row.push_back(static_cast<int>(i) + 1);
      column.push_back(system.matrix.columns()[k] + 1);
    }
  for (const std::int32_t p : elimination_order(system.matrix)) place.push_back(p + 1);
  MumpsProcesses processes(2, shared_by(2).program);
  const auto solved = [&]<class Real>(double singular_pivot) {
    TreeMumps<Real> factor({.singular_pivot = singular_pivot}, bodies, processes);
    factor.analyse({.row = row, .column = column, .place = place, .border = {}});
    const std::vector<Real> values(system.matrix.values().begin(), system.matrix.values().end());
    const Factorisation found = factor.factorise(values);
    EXPECT_TRUE(found.null_pivots.empty());
    EXPECT_EQ(found.negative_pivots, Stacked::rows);
    const std::vector<double> force = any_force(system.matrix.size());
    std::vector<Real> x(force.begin(), force.end());
    factor.substitute(x);
    const std::vector<double> found_x(x.begin(), x.end());
    std::vector<double> image(force.size());
    system.matrix.multiply(found_x, image);
    double left = 0;
    for (std::size_t i = 0; i < force.size(); ++i) left = std::max(left, std::abs(force[i] - image[i]));
    return left;
  };
  EXPECT_LE(solved.operator()<double>(1e-10), 1e-10);
  EXPECT_LE(solved.operator()<float>(1e-6), 1e-2);
}

// Pressures of open patches are zero to the last bit, not to that of a refinement.
TEST(TreeMumps, LeavesUnknownsAsTheirRowAloneDecides) {
  constexpr int open = 20;
  std::vector<std::uint8_t> free(Stacked::points, 1);
  std::fill(free.begin(), free.begin() + Stacked::rows, 0);
  const Numbering numbering = number_equations(Stacked::points, 1, free, open);
  const Ragged<std::int32_t> springs = Lattice::springs(Stacked::n);
  SparseMatrix matrix(numbering, springs, {});
  for (std::size_t s = 0; s < springs.size(); ++s)
    matrix.add(std::vector{numbering.of(springs[s][0], 0), numbering.of(springs[s][1], 0)}, std::vector{1.0, -1.0, 1.1});
  for (int r = 0; r < open; ++r) matrix.add_diagonal(numbering.of_patch(r), 3.0 + r);
  MumpsEngine engine(shared_by(2));
  engine.analyse(matrix);
  ASSERT_EQ(engine.factorise(matrix).processes, 2);
  const std::vector<double> force = any_force(matrix.size());
  std::vector<double> x = force;
  engine.solve(x);
  for (int r = 0; r < open; ++r) EXPECT_EQ(x[numbering.of_patch(r)], force[numbering.of_patch(r)] / (3.0 + r)) << r;
}

/// The message that a factorisation ends with.
std::string end_of(const std::string& program, const Lattice& lattice = Lattice(10)) {
  MumpsOptions options = shared_by(2);
  options.program = program;
  options.memory = MumpsOptions::Memory::in_core;
  MumpsEngine engine(options);
  try {
    engine.analyse(lattice.matrix);
    engine.factorise(lattice.matrix);
  } catch (const Error& error) {
    return error.message().id + " " + error.message().text;
  }
  return {};
}

// A process that cannot be started, or ends, is told.
TEST(TreeMumps, SaysThatProcessesHaveEnded) {
  const std::string none = end_of("/nowhere/lacon_mumps");
  EXPECT_TRUE(none.starts_with("SOLVER_8")) << none;
  const std::filesystem::path script = std::filesystem::temp_directory_path() / "lacon_mumps_that_is_killed";
  std::ofstream(script) << "#!/bin/sh\necho ready\nread line\nkill -9 $$\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const std::string killed = end_of(script);
  EXPECT_TRUE(killed.starts_with("SOLVER_8")) << killed;
  EXPECT_NE(killed.find("Killed"), std::string::npos) << killed;
  std::filesystem::remove(script);
}

// Answers about cells: memory that ends is not a process that has ended, and why it has failed is said without that word.
TEST(PartProcesses, HaveReasons) {
  EXPECT_NO_THROW(require_done("done"));
  EXPECT_THROW(require_done("no memory"), std::bad_alloc);
  try {
    require_done("failed to map segment");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "SOLVER_8");
    EXPECT_TRUE(error.message().text.ends_with(": to map segment")) << error.message().text;
  }
}

// Where a process has no room for what OpenBLAS works in (128 MB), this would look for it for ever.
TEST(TreeMumps, SaysThatProcessesHaveNoMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer has tables of its own";
#endif
  const std::filesystem::path script = std::filesystem::temp_directory_path() / "lacon_mumps_with_a_limit";
  std::ofstream(script) << "#!/bin/sh\nulimit -v 200000\nexec " << shared_by(2).program << " \"$@\"\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const std::string end = end_of(script, Lattice(24));
  EXPECT_TRUE(end.starts_with("SOLVER_2")) << end;
  std::filesystem::remove(script);
}

// Where nobody has asked for processes one does without them, if they cannot be started or see no memory of the operator's;
// that is told once.
TEST(TreeMumps, IsNotMadeWhereProcessesAreOfNoUse) {
  const Lattice lattice(10);
  const std::filesystem::path blind = std::filesystem::temp_directory_path() / "lacon_mumps_that_is_blind";
  std::ofstream(blind) << "#!/bin/sh\necho ready\nwhile read line; do echo failed; done\n";
  std::filesystem::permissions(blind, std::filesystem::perms::owner_all);
  EXPECT_NE(end_of(blind).find("/proc"), std::string::npos);
  for (const std::string program : {"/nowhere/lacon_mumps", blind.c_str()}) {
    MumpsOptions options = shared_by(2);
    options.processes_required = false;
    options.program = program;
    MumpsEngine engine(options);
    engine.analyse(lattice.matrix);
    const Factorisation made = engine.factorise(lattice.matrix);
    EXPECT_EQ(made.processes, 1) << program;
    EXPECT_NE(made.unshared.find(program), std::string::npos) << made.unshared;
    engine.analyse(lattice.matrix);
    EXPECT_EQ(engine.factorise(lattice.matrix).unshared, "") << program;
  }
  std::filesystem::remove(blind);
}

}  // namespace
// What is done meanwhile may fail: answers are heard all the same, and the next ones are those of the next question.
TEST(MumpsProcesses, AreHeardWhereWhatIsDoneMeanwhileFails) {
  MumpsProcesses processes(2, shared_by(2).program);
  processes.start();
  const std::vector<int> both = {0, 1};
  const auto ask = [&](const char* verb, const std::string& rest, const std::function<void()>& meanwhile) {
    return processes.ask(
        {verb, "analysis", 1}, both, [&](std::size_t) { return rest; }, meanwhile);
  };
  EXPECT_THROW(ask("forget", "", [] { throw std::length_error("meanwhile"); }), std::length_error);
  EXPECT_THROW(ask("open", " /nowhere", {}), std::runtime_error);  // not the answers to "forget"
  EXPECT_EQ(ask("forget", "", {}).size(), 2U);
}

}  // namespace lacon
