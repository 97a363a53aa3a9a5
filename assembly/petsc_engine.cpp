#include "lacon/assembly/petsc_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include "lacon/assembly/loose_motions.hpp"
#include "lacon/assembly/petsc/exchange.hpp"
#include "lacon/assembly/processes/companion.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/executable.hpp"

namespace lacon {
namespace {

/// What resists a motion less, of what resists most, iterations cannot tell from nothing.
constexpr double hardly_resisted = 1e-6;

std::string program_beside_this() { return executable().parent_path() / "lacon_petsc"; }

/// Why iterations have ended, in words. @param reason as PETSc names it
std::string words_of(const std::string& reason, int iterations, const std::string& left) {
  static const std::map<std::string, std::string> names{{"DIVERGED_ITS", "iterations_are_spent"},
                                                        {"DIVERGED_DTOL", "residual_grows"},
                                                        {"DIVERGED_BREAKDOWN", "iterations_break_down"},
                                                        {"DIVERGED_BREAKDOWN_BICG", "iterations_break_down"},
                                                        {"DIVERGED_INDEFINITE_PC", "preconditioner_not_positive"},
                                                        {"DIVERGED_NANORINF", "residual_no_number"},
                                                        {"DIVERGED_PC_FAILED", "preconditioner_cannot_be_made"},
                                                        {"STALLED", "residual_does_not_fall"}};
  const auto name = names.find(reason);
  return part("after_iterations", {{"reason", name == names.end() ? reason : part(name->second)},
                                   {"iterations", std::to_string(iterations)},
                                   {"share", left}});
}

}  // namespace

struct PetscEngine::State {
  PetscOptions options;
  std::unique_ptr<Companion> ranks;
  BlockSystem::Sizes sizes;
  std::vector<std::int32_t> place;  ///< of each equation
  std::vector<std::int32_t> node;   ///< of each block
  std::optional<LooseMotions> loose;
  const SparseMatrix* matrix = nullptr;
  std::unique_ptr<MumpsEngine> direct;  ///< where this matrix has a factor

  void start() {
    if (ranks) return;
    std::vector<std::string> command;
    if (options.n_ranks > 1)
      command = {"mpirun",
                 "-n",
                 std::to_string(options.n_ranks),
                 "--oversubscribe",
                 "--bind-to",
                 "none",
                 "--mca",
                 "btl_vader_single_copy_mechanism",
                 "none",
                 "--mca",
                 "mpi_yield_when_idle",  // others may need the cores
                 "1"};
    command.insert(command.end(),
                   {options.program, options.algorithm, options.preconditioner, std::to_string(options.iterations)});
    ranks = std::make_unique<Companion>(command);
    if (ranks->answer().empty()) fail("SOLVER_6", {{"reason", options.program + ": " + ranks->end()}});
  }

  std::string ask(const std::string& line) { return checked(ranks->ask(line)); }
  std::string checked(std::string answer) {
    if (answer.empty()) {
      const std::string end = ranks->end();
      ranks.reset();
      fail("SOLVER_8", {{"reason", end}});
    }
    return answer;
  }

  void number(const Numbering& numbering) {
    place.assign(static_cast<std::size_t>(numbering.n_equations()), -1);
    node.clear();
    const int dimension = options.geometry.dimension;
    for (std::int64_t n = 0; n < numbering.n_nodes; ++n) {
      bool is_free = false;
      for (int i = 0; i < dimension; ++i)
        if (const std::int64_t e = numbering.of(n, i); e >= 0) {
          is_free = true;
          place[e] = static_cast<std::int32_t>(static_cast<int>(node.size()) * dimension + i);
        }
      if (is_free) node.push_back(static_cast<std::int32_t>(n));
    }
    std::int32_t n_multipliers = 0;
    for (std::int32_t& at : place)
      if (at < 0) at = -1 - n_multipliers++;
    sizes = {.n = numbering.n_equations(),
             .n_blocks = static_cast<std::int64_t>(node.size()),
             .n_multipliers = n_multipliers,
             .dimension = dimension};
    loose.emplace(RigidMotions(options.geometry), numbering);
  }

  SharedMemory system() {
    sizes.n_entries = matrix->n_entries();
    sizes.is_symmetric = matrix->is_symmetric();
    SharedMemory memory(BlockSystem::bytes(sizes));
    std::memcpy(memory.data(), &sizes, sizeof sizes);
    const BlockSystem made = BlockSystem::in(memory);
    std::ranges::copy(matrix->rows(), made.row.begin());
    std::ranges::copy(matrix->columns(), made.column.begin());
    std::ranges::copy(matrix->values(), made.value.begin());
    std::ranges::copy(place, made.place.begin());
    for (std::size_t b = 0; b < node.size(); ++b)
      for (int i = 0; i < sizes.dimension; ++i)
        made.coordinates[b * static_cast<std::size_t>(sizes.dimension) + static_cast<std::size_t>(i)] =
            options.geometry.coordinates[3 * static_cast<std::size_t>(node[b]) + static_cast<std::size_t>(i)];
    return memory;
  }

  /// Unknowns that their row alone decides, those of open patches among them, and their values: iterations come near them only.
  std::vector<std::pair<std::int64_t, double>> decided(std::span<const double> right_side) const {
    std::vector<std::pair<std::int64_t, double>> found;
    for (const std::int64_t i : matrix->rows_alone()) found.emplace_back(i, right_side[i] / matrix->diagonal(i));
    return found;
  }

  /// In place. @return why there is no solution, in words
  std::string iterate(double share, std::span<double> right_side, Solution& solution) {
    const SharedMemory memory(right_side.size_bytes());
    const std::span<double> shared{reinterpret_cast<double*>(memory.data()), right_side.size()};
    std::ranges::copy(right_side, shared.begin());
    std::istringstream said(ask(fmt::format("solve {:.3e} {}", share, memory.path())));
    std::string word, left, why;
    said >> word;
    if (word != "failed") said >> solution.iterations >> left;
    std::getline(said >> std::ws, why);
    if (word != "converged") return word == "failed" ? why : words_of(why, solution.iterations, left);
    const auto exact = decided(right_side);
    std::ranges::copy(shared, right_side.begin());
    for (const auto& [row, value] : exact) right_side[row] = value;
    solution.residual = std::stod(left);
    return {};
  }

  /// A factor instead. @param why
  Factorisation factorise_directly(const std::string& why) {
    direct = std::make_unique<MumpsEngine>(options.direct);
    try {
      direct->analyse(*matrix);
      Factorisation found = direct->factorise(*matrix);
      found.stalled = why;
      return found;
    } catch (const Error& error) {
      if (error.message().id != "SOLVER_2") throw;
    }
    direct.reset();
    fail("SOLVER_9", {{"reason", why}, {"equations", std::to_string(sizes.n)}});
  }
};

bool PetscEngine::is_there() { return std::filesystem::exists(program_beside_this()); }

PetscEngine::PetscEngine(const PetscOptions& options) : state_(std::make_unique<State>()) {
  state_->options = options;
  std::string& program = state_->options.program;
  if (program.empty()) program = program_beside_this();
  if (!std::filesystem::exists(program)) fail("SOLVER_6", {{"reason", part("built_without_petsc")}});
}
PetscEngine::~PetscEngine() = default;

void PetscEngine::analyse(const SparseMatrix& matrix) {
  State& s = *state_;
  s.matrix = nullptr;
  s.direct.reset();
  s.start();
  s.number(matrix.numbering());
}

Factorisation PetscEngine::factorise(const SparseMatrix& matrix) {
  State& s = *state_;
  s.matrix = &matrix;
  s.direct.reset();
  if (!s.loose->of(matrix, hardly_resisted).empty()) return s.factorise_directly(part("free_rigid_motion"));
  s.ask("forget");
  std::optional<SharedMemory> memory(s.system());
  std::string said = s.ask("set up " + memory->path());
  memory.reset();  // before the multigrid takes most
  if (said == "taken") said = s.checked(s.ranks->answer());
  if (said != "ready") return s.factorise_directly(said);
  Factorisation made;
  made.is_iterative = true;
  return made;
}

Solution PetscEngine::solve(std::span<double> right_side) { return solve_to(0, right_side); }

Solution PetscEngine::solve_to(double share, std::span<double> right_side) {
  State& s = *state_;
  if (s.direct) return s.direct->solve(right_side);
  Solution solution;
  const std::string why = s.iterate(std::max(share, s.options.tolerance), right_side, solution);
  if (why.empty()) return solution;
  const Factorisation again = s.factorise_directly(why);
  Solution second;
  if (again.null_pivots.empty()) second = s.direct->solve(right_side);
  second.iterations += solution.iterations;
  if (!second.again) second.again = again;
  second.again->stalled = why;
  return second;
}

}  // namespace lacon
