#include "lacon/assembly/petsc_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "lacon/assembly/block_numbering.hpp"
#include "lacon/assembly/loose_motions.hpp"
#include "lacon/assembly/parts/solid_parts.hpp"
#include "lacon/assembly/petsc/exchange.hpp"
#include "lacon/assembly/petsc_processes.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/executable.hpp"

namespace lacon {
namespace {

/// What resists a motion less, of what resists most, iterations cannot tell from nothing.
constexpr double hardly_resisted = 1e-6;
/// Of the matrices that are spared a try behind each that was in vain: 1, 2, 4 and so on, for what makes iterations slow (a
/// material, thin bodies) mostly stays.
constexpr int most_doublings = 3;

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
                                                        {"STALLED", "residual_does_not_fall"},
                                                        {"SLOW", "iterations_would_be_spent"}};
  const auto name = names.find(reason);
  return part("after_iterations", {{"reason", name == names.end() ? reason : part(name->second)},
                                   {"iterations", std::to_string(iterations)},
                                   {"share", left}});
}

}  // namespace

struct PetscEngine::State {
  PetscOptions options;
  std::shared_ptr<PetscProcesses> processes;
  BlockSystem::Sizes sizes;
  std::optional<BlockNumbering> blocks;
  std::optional<LooseMotions> loose;
  std::vector<double> place;  ///< of the nodes now, (n_nodes, 3); empty: where they were at first
  const SparseMatrix* matrix = nullptr;
  std::unique_ptr<MumpsEngine> direct;  ///< where this matrix has a factor
  std::optional<SparseMatrix> whole;    ///< the same, where other processes have most of it
  bool lacked_memory = false;           ///< the processes, so that iterations have ended
  int in_vain = 0;                      ///< matrices in a row that were iterated on in vain
  int spared = 0;                       ///< matrices to come that are factorised without a try

  explicit State(const PetscOptions& given) : options(given) {
    std::string& program = options.program;
    if (program.empty()) program = program_beside_this();
    if (!std::filesystem::exists(program)) fail("SOLVER_6", {{"reason", part("built_without_petsc")}});
    processes = std::make_shared<PetscProcesses>(
        PetscProgram{program, options.algorithm, options.preconditioner, options.iterations, options.n_ranks, options.hosts});
  }

  void number(const SparseMatrix& given) {
    const auto* const parts = dynamic_cast<const SolidParts*>(given.elsewhere());
    if (parts)
      blocks = parts->blocks();
    else
      blocks.emplace(given.numbering(), options.geometry.dimension, options.n_ranks);
    sizes = {.n = given.numbering().n_equations(),
             .n_blocks = std::ssize(blocks->node),
             .n_multipliers = blocks->n_multipliers,
             .dimension = blocks->dimension,
             .n_parts = options.n_ranks};
    loose.emplace(RigidMotions(options.geometry), given.numbering());
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
    std::ranges::copy(blocks->place, made.place.begin());
    std::ranges::copy(blocks->first_block, made.first_block.begin());
    const std::span<const double> coordinates = place.empty() ? options.geometry.coordinates : std::span<const double>(place);
    for (std::size_t b = 0; b < blocks->node.size(); ++b)
      for (int i = 0; i < sizes.dimension; ++i)
        made.coordinates[b * static_cast<std::size_t>(sizes.dimension) + static_cast<std::size_t>(i)] =
            coordinates[3 * static_cast<std::size_t>(blocks->node[b]) + static_cast<std::size_t>(i)];
    return memory;
  }

  /// Unknowns that their row alone decides, those of open patches among them, and their values: iterations come near them only.
  std::vector<std::pair<std::int64_t, double>> decided(std::span<const double> right_side) const {
    std::vector<std::pair<std::int64_t, double>> found;
    for (const std::int64_t i : matrix->rows_alone()) found.emplace_back(i, right_side[i] / matrix->diagonal(i));
    return found;
  }

  /// What an answer says that is none, in words.
  std::string failure(const std::string& answer) {
    lacked_memory = answer == no_memory;
    return lacked_memory ? part("processes_without_memory") : reason_of(answer);
  }
  /// In place. @return why there is no solution, in words
  std::string iterate(double share, std::span<double> right_side, Solution& solution) {
    const SharedMemory memory(right_side.size_bytes());
    const std::span<double> shared = memory.numbers();
    std::ranges::copy(right_side, shared.begin());
    const std::string answer = processes->ask(fmt::format("solve {:.3e} {}", share, memory.path()));
    std::istringstream said(answer);
    std::string word, left, why;
    said >> word;
    if (word != "converged" && word != "diverged") return failure(answer);
    said >> solution.iterations >> left;
    std::getline(said >> std::ws, why);
    if (word == "diverged") return words_of(why, solution.iterations, left);
    const auto exact = decided(right_side);
    std::ranges::copy(shared, right_side.begin());
    for (const auto& [row, value] : exact) right_side[row] = value;
    solution.residual = std::stod(left);
    return {};
  }

  void forget_factor() {
    direct.reset();
    whole.reset();
  }

  /// A factor, where there is memory for it.
  std::optional<Factorisation> factor() {
    direct = std::make_unique<MumpsEngine>(options.direct);
    try {
      if (matrix->elsewhere()) whole.emplace(matrix->elsewhere()->whole(*matrix));
      const SparseMatrix& own = whole ? *whole : *matrix;
      direct->analyse(own);
      return direct->factorise(own);
    } catch (const Error& error) {
      if (error.message().id != "SOLVER_2") throw;
    }
    forget_factor();
    return std::nullopt;
  }

  /// A factor instead. @param why
  Factorisation factorise_directly(const std::string& why) {
    if (std::optional<Factorisation> found = factor()) {
      found->stalled = why;
      return *found;
    }
    if (lacked_memory) fail("SOLVER_2", {{"phase", "factorisation"}, {"equations", std::to_string(sizes.n)}});
    fail("SOLVER_9", {{"reason", why}, {"equations", std::to_string(sizes.n)}});
  }
};

bool PetscEngine::is_there() { return std::filesystem::exists(program_beside_this()); }

bool PetscEngine::has_mpirun() { return PetscProcesses::have_mpirun(); }

PetscEngine::PetscEngine(const PetscOptions& options) : state_(std::make_unique<State>(options)) {}
PetscEngine::~PetscEngine() = default;
std::shared_ptr<PartProcesses> PetscEngine::processes(std::int64_t /*n_equations*/) const { return state_->processes; }

void PetscEngine::place_nodes(std::span<const double> coordinates) {
  state_->place.assign(coordinates.begin(), coordinates.end());
}

void PetscEngine::analyse(const SparseMatrix& matrix) {
  State& s = *state_;
  s.matrix = nullptr;
  s.forget_factor();
  s.processes->start();
  s.number(matrix);
}

Factorisation PetscEngine::factorise(const SparseMatrix& matrix) {
  State& s = *state_;
  s.matrix = &matrix;
  s.forget_factor();
  if (!s.loose->of(matrix, hardly_resisted).empty()) return s.factorise_directly(part("free_rigid_motion"));
  s.lacked_memory = false;
  s.processes->start();  // anew, where they have failed
  s.processes->ask("forget");
  if (std::exchange(s.spared, std::max(0, s.spared - 1)) > 0)
    if (const std::optional<Factorisation> found = s.factor()) return *found;
  std::optional<SharedMemory> memory(s.system());
  std::string said = s.processes->ask("set up " + memory->path());
  memory.reset();  // before the multigrid takes most
  if (said == "taken") said = s.processes->answer();
  if (said != "ready") return s.factorise_directly(s.failure(said));
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
  if (why.empty()) {
    s.in_vain = 0;
    return solution;
  }
  const Factorisation again = s.factorise_directly(why);
  if (solution.iterations > 0) s.spared = 1 << std::min(s.in_vain++, most_doublings);
  Solution second;
  if (again.null_pivots.empty()) second = s.direct->solve(right_side);
  second.iterations += solution.iterations;
  if (!second.again) second.again = again;
  second.again->stalled =
      s.spared == 0 ? why : part("and_next_matrices", {{"reason", why}, {"count", std::to_string(s.spared)}});
  return second;
}

}  // namespace lacon
