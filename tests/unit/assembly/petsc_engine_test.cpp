#include "lacon/assembly/petsc_engine.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "dense.hpp"
#include "lacon/assembly/parts/part_processes.hpp"
#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

using test::Chain;
using test::dense;

constexpr int n_nodes = 40, n_rows = 3;
const std::string program = LACON_BINARY_DIR "/bin/lacon_petsc";

/// Two chains of springs in the plane, the second one held by the rows of multipliers alone, where they are on.
struct TwoBodies {
  explicit TwoBodies(bool is_tied = true)
      : chain(n_nodes, n_rows, free()), matrix(chain.numbering, chain.cliques, couplings()) {
    matrix.set_zero();
    for (int i = 0; i + 1 < n_nodes; ++i)
      if (i + 1 != n_nodes / 2)
        for (int axis = 0; axis < 2; ++axis)
          matrix.add(std::vector<std::int64_t>{chain.numbering.of(i, axis), chain.numbering.of(i + 1, axis)},
                     std::vector<double>{50, -50, 50});
    for (int r = 0; r < n_rows; ++r) {
      const std::int64_t row = chain.numbering.of_patch(r);
      if (!is_tied || r == n_rows - 1) {
        matrix.add_diagonal(row, 1e-4);  // off
        continue;
      }
      matrix.add(std::vector<std::int64_t>{row, chain.numbering.of(5 + r, r), chain.numbering.of(25 + r, r)},
                 std::vector<double>{0, 1e-3, 0, -1e-3, 0, 0});
    }
  }
  static std::vector<std::uint8_t> free() {
    std::vector<std::uint8_t> flags(2 * n_nodes, 1);
    flags[0] = flags[1] = 0;
    return flags;
  }
  static std::vector<Coupling> couplings() {
    std::vector<Coupling> all;
    for (int r = 0; r < n_rows; ++r)
      for (const int node : {5 + r, 25 + r}) all.push_back({n_nodes + r, node});
    return all;
  }
  PetscOptions options() const {
    PetscOptions made{.tolerance = 1e-12, .program = program, .geometry = {.dimension = 2, .coordinates = places}};
    for (int i = 0; i < n_nodes; ++i) made.geometry.body.push_back(i < n_nodes / 2 ? 7 : 3);
    return made;
  }
  Eigen::VectorXd expected(const Eigen::VectorXd& b) const { return dense(matrix).fullPivLu().solve(b); }
  static std::vector<double> in_a_line() {
    std::vector<double> x;
    for (int i = 0; i < n_nodes; ++i) x.insert(x.end(), {static_cast<double>(i), 0.0, 0.0});
    return x;
  }
  Chain chain;
  SparseMatrix matrix;
  std::vector<double> places = in_a_line();
};

std::span<double> span_of(Eigen::VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

class PetscEngineTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(program)) GTEST_SKIP() << "built without PETSc";
  }
};

// The solution of a saddle-point system whose stiffness is singular without its constraints is that of dense LU, with each
// preconditioner and algorithm.
TEST_F(PetscEngineTest, SolvesSaddlePoints) {
  const TwoBodies system;
  for (const auto& [algorithm, preconditioner] :
       {std::pair("FGMRES", "GAMG"), std::pair("GMRES", "BOOMER"), std::pair("CR", "GAMG"), std::pair("GCR", "SOR"),
        std::pair("BCGS", "LDLT_INC")}) {
    PetscOptions options = system.options();
    options.algorithm = algorithm;
    options.preconditioner = preconditioner;
    PetscEngine engine(options);
    engine.analyse(system.matrix);
    const Factorisation made = engine.factorise(system.matrix);
    EXPECT_TRUE(made.is_iterative) << made.stalled;
    Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size()), x = b;
    const Solution solution = engine.solve(span_of(x));
    EXPECT_FALSE(solution.again) << algorithm << ", " << preconditioner << ": " << solution.again->stalled;
    EXPECT_GT(solution.iterations, 0);
    const Eigen::VectorXd expected = system.expected(b);
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-8 * expected.cwiseAbs().maxCoeff())
        << algorithm << ", " << preconditioner;
  }
}

// Where a part of the right side may be left, that much is left at most, and iterations are fewer.
TEST_F(PetscEngineTest, SolvesNoFurtherThanAsked) {
  const TwoBodies system;
  const Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size());
  PetscOptions options = system.options();
  options.preconditioner = "JACOBI";
  PetscEngine engine(options);
  engine.analyse(system.matrix);
  engine.factorise(system.matrix);
  Eigen::VectorXd rough = b, exact = b;
  const Solution some = engine.solve_to(1e-2, span_of(rough)), all = engine.solve(span_of(exact));
  EXPECT_LE(some.residual, 1e-2);
  EXPECT_LE(all.residual, 1e-12);
  EXPECT_LT(some.iterations, all.iterations);
}

// Where a row says what its unknown is, that is what it is, to the last bit: the pressure of a patch that is open is zero.
TEST_F(PetscEngineTest, PressuresOfOpenPatchesAreZero) {
  const TwoBodies system;
  const std::int64_t open = system.chain.numbering.of_patch(n_rows - 1);
  for (const double asked : {0.0, 3.0}) {
    PetscEngine engine(system.options());
    engine.analyse(system.matrix);
    engine.factorise(system.matrix);
    Eigen::VectorXd x = Eigen::VectorXd::Random(system.matrix.size());
    x[open] = asked;
    engine.solve(span_of(x));
    EXPECT_EQ(x[open], asked / 1e-4);
  }
}

// Another process with the same system gives the same bits, and so does a second solution in the same one.
TEST_F(PetscEngineTest, GivesTheSameBitsInEveryRun) {
  const TwoBodies system;
  const Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size());
  std::vector<Eigen::VectorXd> found;
  for (int run = 0; run < 2; ++run) {
    PetscEngine engine(system.options());
    engine.analyse(system.matrix);
    for (int solution = 0; solution < 2; ++solution) {
      engine.factorise(system.matrix);
      found.push_back(b);
      engine.solve(span_of(found.back()));
    }
  }
  for (const Eigen::VectorXd& x : found) EXPECT_EQ(x, found.front());
}

// A multigrid works for later matrices too, and where one is too different for that a new one is made: all are solved.
TEST_F(PetscEngineTest, SolvesMatricesThatBecomeOthers) {
  TwoBodies system;
  PetscEngine engine(system.options());
  engine.analyse(system.matrix);
  const Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size());
  for (const double stiffer : {0.0, 1e-3, 3.0, 30.0, 1e3}) {
    for (int i = 1; i + 1 < n_nodes / 2; ++i)
      system.matrix.add(std::vector<std::int64_t>{system.chain.numbering.of(i, 0), system.chain.numbering.of(i + 1, 0)},
                        std::vector<double>{50 * stiffer, -50 * stiffer, 50 * stiffer});
    engine.factorise(system.matrix);
    Eigen::VectorXd x = b;
    const Solution solution = engine.solve(span_of(x));
    EXPECT_FALSE(solution.again) << stiffer << ": " << solution.again->stalled;
    const Eigen::VectorXd expected = system.expected(b);
    // 1e-12 of the right side is left; the condition becomes some 1e6
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-6 * expected.cwiseAbs().maxCoeff()) << stiffer;
  }
}

// A matrix that is not symmetric is solved as well.
TEST_F(PetscEngineTest, SolvesUnsymmetricMatrices) {
  const TwoBodies pattern;
  SparseMatrix matrix(pattern.chain.numbering, pattern.chain.cliques, TwoBodies::couplings(), Symmetry::general);
  std::mt19937 random(3);
  test::fill_unsymmetric(matrix, pattern.chain, TwoBodies::couplings(), random);
  PetscEngine engine(pattern.options());
  engine.analyse(matrix);
  engine.factorise(matrix);
  Eigen::VectorXd b = Eigen::VectorXd::Random(matrix.size()), x = b;
  EXPECT_FALSE(engine.solve(span_of(x)).again);
  EXPECT_LE((dense(matrix) * x - b).cwiseAbs().maxCoeff(), 1e-9);
}

// A rigid motion that nothing resists is left to the factor, which names it; nothing is iterated.
TEST_F(PetscEngineTest, LeavesFreeMotionsToAFactor) {
  const TwoBodies system(false);
  PetscEngine engine(system.options());
  engine.analyse(system.matrix);
  const Factorisation found = engine.factorise(system.matrix);
  EXPECT_EQ(found.null_pivots.size(), 2);
  EXPECT_NE(found.stalled.find("rigid motion"), std::string::npos) << found.stalled;
}

// Bodies that hold each other, and that nothing else holds, move together.
TEST_F(PetscEngineTest, SeesBodiesThatMoveTogether) {
  const Chain chain(4);
  SparseMatrix matrix(chain.numbering, chain.cliques, std::vector<Coupling>{{2, 0}, {3, 1}});
  matrix.set_zero();
  const auto spring = [&](int a, int b) {
    for (int axis = 0; axis < 2; ++axis)
      matrix.add(std::vector<std::int64_t>{chain.numbering.of(a, axis), chain.numbering.of(b, axis)},
                 std::vector<double>{1, -1, 1});
  };
  for (const auto& [a, b] : {std::pair(0, 1), std::pair(2, 3), std::pair(0, 2), std::pair(1, 3)}) spring(a, b);
  const std::vector<double> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  PetscEngine engine({.program = program, .geometry = {.dimension = 2, .coordinates = corners, .body = {0, 0, 2, 2}}});
  engine.analyse(matrix);
  EXPECT_EQ(engine.factorise(matrix).null_pivots.size(), 2);
}

// Iterations that come to no end are made good by a factor. What makes them slow may stay, and a try is spared to one more
// matrix, then to two, four: others are iterated on again.
TEST_F(PetscEngineTest, FactorisesWhereIterationsStall) {
  const TwoBodies system;
  PetscOptions options = system.options();
  options.iterations = 1;
  SaddlePointSolver solver(std::make_unique<PetscEngine>(options));
  const Eigen::VectorXd b = Eigen::VectorXd::Random(system.matrix.size());
  const std::set<int> tries = {0, 2, 5, 10};
  for (int matrix = 0; matrix < 12; ++matrix) {
    Eigen::VectorXd x = b;
    const SolutionReport report = solver.solve(system.matrix, system.chain.numbering.first[n_nodes], span_of(x));
    for (const char* const words : {"NMAX_ITER", "after 1 iteration(s)"})
      EXPECT_EQ(report.factorisation.stalled.find(words) != std::string::npos, tries.contains(matrix)) << matrix;
    EXPECT_EQ(report.factorisation.negative_pivots, 2);
    EXPECT_LE((x - system.expected(b)).cwiseAbs().maxCoeff(), 1e-10 * x.cwiseAbs().maxCoeff());
  }
}

/// Resident memory, kB, of a process of PETSc that this one has started, without the pages of its programs and libraries:
/// systems differ in how many of those they bring.
struct OwnMemory {
  double now = 0, most = 0;
};
OwnMemory memory_of_petsc() {
  for (const auto& folder : std::filesystem::directory_iterator("/proc")) {
    std::ifstream status(folder.path() / "status");
    std::map<std::string, std::string> told;
    for (std::string name, value; std::getline(status, name, ':') && std::getline(status >> std::ws, value);)
      told[name] = value;
    if (told["Name"] != "lacon_petsc" || told["PPid"] != std::to_string(getpid())) continue;
    const double programs = std::stod(told["RssFile"]);
    return {std::stod(told["VmRSS"]) - programs, std::stod(told["VmHWM"]) - programs};
  }
  ADD_FAILURE() << "no lacon_petsc among the processes";
  return {};
}

// What a preconditioner takes on its way goes back to the system before iterations begin: of this grid that is a third of
// all that the process has then. Open MPI has freed memory kept, so that both figures would be the same.
TEST_F(PetscEngineTest, GivesMemoryBack) {
  constexpr int side = 260, n = side * side;  // nodes
  std::vector<std::uint8_t> free(2 * n, 1);
  std::fill_n(free.begin(), 2 * side, 0);
  const Numbering numbering = number_equations(n, 2, free, 0);
  PetscOptions options{.program = program, .geometry = {.dimension = 2, .body = std::vector<std::int32_t>(n, 0)}};
  std::vector<double> places;
  Ragged<std::int32_t> squares;
  for (std::int32_t i = 0; i < n; ++i) {
    places.insert(places.end(), {static_cast<double>(i % side), static_cast<double>(i / side), 0.0});
    if (i % side + 1 < side && i / side + 1 < side)
      squares.push_back(std::vector<std::int32_t>{i, i + 1, i + side, i + side + 1});
  }
  options.geometry.coordinates = places;
  SparseMatrix matrix(numbering, squares, {});
  matrix.set_zero();
  std::vector<std::int64_t> equations;
  for (std::size_t c = 0; c < squares.size(); ++c)
    for (int axis = 0; axis < 2; ++axis) {
      equations.clear();
      for (const std::int32_t node : squares[c]) equations.push_back(numbering.of(node, axis));
      matrix.add(equations, std::vector<double>{3, -1, 3, -1, -1, 3, -1, -1, -1, 3});
    }
  PetscEngine engine(options);
  engine.analyse(matrix);
  EXPECT_TRUE(engine.factorise(matrix).is_iterative);
  const OwnMemory memory = memory_of_petsc();
  EXPECT_LE(memory.now, 0.9 * memory.most);
}

/// The message that a call ends with; nothing where it does not.
template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.message().id + " " + error.message().text;
  }
  return {};
}

// Where PETSc is not there, or cannot be started, or ends, that is said.
TEST(PetscEngine, SaysThatPetscIsNotThere) {
  const TwoBodies system;
  PetscOptions options = system.options();
  options.program = "/nowhere/lacon_petsc";
  EXPECT_EQ(error_of([&] { PetscEngine engine(options); }).substr(0, 8), "SOLVER_6");
  options.program = "/bin/false";
  PetscEngine ends(options);
  const std::string said = error_of([&] { ends.analyse(system.matrix); });
  EXPECT_NE(said.find("SOLVER_10"), std::string::npos) << said;  // it is there
  EXPECT_NE(said.find("exit status 1"), std::string::npos) << said;
}

// mpirun would wait for ever.
TEST_F(PetscEngineTest, SaysThatSoManyProcessesNeedMoreFiles) {
  const TwoBodies system;
  PetscOptions options = system.options();
  options.program = program;
  options.n_ranks = 3;
  const auto start_with_few_files = [&] {
    const rlimit few{30, 30};
    setrlimit(RLIMIT_NOFILE, &few);
    std::cerr << error_of([&] {
      PetscEngine engine(options);
      engine.analyse(system.matrix);
    });
    _exit(0);
  };
  EXPECT_EXIT(start_with_few_files(), testing::ExitedWithCode(0), "SOLVER_10.*30 files may be open.*needs about 46");
}

/// A program in the place of lacon_petsc, beside what starts several of it.
class Script {
 public:
  explicit Script(const char* text)
      : folder_(std::filesystem::temp_directory_path() / ("lacon_petsc_" + std::to_string(getpid()))) {
    std::filesystem::create_directory(folder_);
    std::filesystem::create_symlink(std::filesystem::path(program).replace_filename("lacon_mpirun"), folder_ / "lacon_mpirun");
    std::ofstream(path()) << "#!/bin/sh\n" << text << '\n';
    std::filesystem::permissions(path(), std::filesystem::perms::owner_all);
  }
  ~Script() { std::filesystem::remove_all(folder_); }
  Script(const Script&) = delete;
  Script& operator=(const Script&) = delete;
  std::string path() const { return folder_ / "lacon_petsc"; }

 private:
  std::filesystem::path folder_;
};

TEST(PetscEngine, SaysThatItsProcessesHaveEnded) {
  const TwoBodies system;
  const Script script("echo ready 1; read line; kill -9 $$");
  PetscOptions options = system.options();
  options.program = script.path();
  PetscEngine engine(options);
  engine.analyse(system.matrix);
  const std::string said = error_of([&] { engine.factorise(system.matrix); });
  EXPECT_NE(said.find("SOLVER_8"), std::string::npos) << said;
  EXPECT_NE(said.find("Killed"), std::string::npos) << said;
}

/// What the engine says of a script in the place of its program.
std::string said_of(const char* text) {
  const TwoBodies system;
  const Script script(text);
  PetscOptions options = system.options();
  options.program = script.path();
  PetscEngine engine(options);
  return error_of([&] { engine.analyse(system.matrix); });
}

// A process that memory was missing for is no error of the user's, whenever it was killed; mpirun says so by its status.
TEST(PetscEngine, SaysThatItsProcessesWereKilledBeforeTheyWereReady) {
  for (const char* const text : {"kill -9 $$", "exit 137", "echo; echo of mpirun; exit 137"}) {
    const std::string said = said_of(text);
    EXPECT_EQ(said.substr(0, 9), "SOLVER_8 ") << said;
    EXPECT_NE(said.find("Killed"), std::string::npos) << said;
  }
}

// What MPI has to say before is no answer.
TEST(PetscEngine, IsReadyAfterWhatMpiSays) {
  EXPECT_EQ(said_of("echo; echo a warning of mpirun; echo ready 1; read line"), "");
}

// It names the machine as the process does, blanks or not.
TEST(PetscEngine, NamesTheMachineThatDoesNotSeeItsMemory) {
  const std::string said = said_of("echo elsewhere node 7");
  EXPECT_NE(said.find("SOLVER_11"), std::string::npos) << said;
  EXPECT_NE(said.find("runs on node 7,"), std::string::npos) << said;
}

// What says something else, and is no machine, is no name of one.
TEST(PetscEngine, NamesNoMachineWhereThereIsNone) {
  const std::string said = said_of("echo There are not enough slots available; exit 1");
  EXPECT_EQ(said.substr(0, 10), "SOLVER_10 ") << said;
  EXPECT_NE(said.find("exit status 1"), std::string::npos) << said;
}

// What the processes say of themselves is why there is a factor instead, without the words that they say it in.
TEST(PetscEngine, SaysWhyItsProcessesHaveFailed) {
  const TwoBodies system;
  for (const auto& [answer, why] :
       {std::pair("no memory", "its processes have no memory"), std::pair("failed to map", "to map")}) {
    const Script script(
        (std::string("echo ready 1; read line; echo forgotten; read line; echo ") + answer + "; read line").c_str());
    PetscOptions options = system.options();
    options.program = script.path();
    PetscEngine engine(options);
    engine.analyse(system.matrix);
    EXPECT_EQ(engine.factorise(system.matrix).stalled, why);
  }
}

// Of several the one that has failed says why, whatever others were saying. They are started anew, unless they had something
// that nobody else has.
TEST_F(PetscEngineTest, SaysWhyOneOfItsProcessesHasFailed) {
  if (!PetscEngine::has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const TwoBodies system;
  const Script script(R"(
    if [ "$OMPI_COMM_WORLD_RANK" = 0 ]; then
      echo ready 1; read line; echo forgotten; read line; touch "$0.go"; sleep 0.5; echo taken; sleep 30
    else
      until [ -e "$0.go" ]; do sleep 0.02; done
      rm "$0.go"; echo failed of the second; sleep 1; exit 1
    fi)");
  PetscOptions options = system.options();
  options.program = script.path();
  options.n_ranks = 2;
  PetscEngine engine(options);
  engine.analyse(system.matrix);
  for (int matrix = 0; matrix < 2; ++matrix) EXPECT_EQ(engine.factorise(system.matrix).stalled, "of the second");
  engine.processes(0)->start();
  engine.processes(0)->keep();
  const std::string said = error_of([&] { engine.factorise(system.matrix); });
  EXPECT_TRUE(said.starts_with("SOLVER_8")) << said;
  EXPECT_TRUE(said.ends_with(": of the second")) << said;
}

// Variables that mpirun reads, for it is not seen which of them keeps it from starting.
TEST(PetscEngine, NamesVariablesThatMpirunReads) {
  const TwoBodies system;
  PetscOptions options = system.options();
  options.program = "/bin/false";
  for (const bool are_there : {false, true}) {
    are_there ? setenv("OMPI_MCA_of_a_test", "1", 1) : unsetenv("OMPI_MCA_of_a_test");
    try {
      PetscEngine(options).analyse(system.matrix);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.message().advice.find("OMPI_MCA_of_a_test") != std::string::npos, are_there) << error.message().advice;
    }
  }
  unsetenv("OMPI_MCA_of_a_test");
}

// Preconditioners that PETSc does without here are the multigrid, as `lacon help` says.
TEST_F(PetscEngineTest, TakesTheMultigridForOtherNames) {
  const TwoBodies system;
  const auto iterations = [&](const char* name) {
    PetscOptions options = system.options();
    options.preconditioner = name;
    PetscEngine engine(options);
    engine.analyse(system.matrix);
    engine.factorise(system.matrix);
    Eigen::VectorXd x = Eigen::VectorXd::Ones(system.matrix.size());
    return engine.solve(span_of(x)).iterations;
  };
  const auto expected = iterations("GAMG");
  for (const char* const name : {"ML", "HPDDM", "FIELDSPLIT", "BLOC_LAGR"}) EXPECT_EQ(iterations(name), expected) << name;
  EXPECT_GT(iterations("SANS"), 2 * expected);
}

}  // namespace
}  // namespace lacon
