#include "lacon/operators/evolution/newton/linear_solver.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "lacon/assembly/petsc_engine.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/problem/free_bodies.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

constexpr int most_iterations = 500;      // where NMAX_ITER does not say
constexpr double round_off = 1e-16;       // of a solution, of its right side
constexpr double direct_residual = 1e-6;  // of a factor that stands in for iterations: RESI_RELA is theirs

int number_in(const char* variable, int otherwise) {
  const char* const wanted = std::getenv(variable);
  return wanted ? std::max(1, std::atoi(wanted)) : otherwise;
}
/// Processes that the user wants (--mpi), where he says.
constexpr const char* wanted_ranks = "LACON_MPI";
/// Machines where they run (--hosts), likewise.
constexpr const char* wanted_hosts = "LACON_HOSTS";
/// Those that share a factor where he does not, but has threads; iterations are shared by as many as there are threads, for
/// each of them is busy all the time. More than cores, for subtrees are of uneven sizes; the same on every machine, for their
/// number decides the last bits.
constexpr int own_ranks = 4;
/// Equations from which on they share it: tests have them share small ones.
constexpr int least_shared = 20'000;

MumpsOptions direct_options(const Keywords& solver, const Base& base) {
  using Use = MumpsOptions::Use;
  using Memory = MumpsOptions::Memory;
  const auto use = [](bool always) { return always ? Use::always : Use::never; };
  const std::string acceleration = solver.text("ACCELERATION"), memory = solver.text("GESTION_MEMOIRE");
  return {.memory_margin = static_cast<int>(solver.integer("PCENT_PIVOT")),
          .residual_tolerance = solver.real("RESI_RELA"),
          .single_precision = solver.has("MIXER_PRECISION") ? use(solver.yes("MIXER_PRECISION")) : Use::where_it_pays,
          .low_rank = acceleration == "AUTO" ? Use::where_it_pays : use(acceleration.starts_with("LR")),
          .low_rank_threshold = solver.real("LOW_RANK_SEUIL"),
          .memory = memory == "OUT_OF_CORE" ? Memory::out_of_core
                    : memory == "IN_CORE"   ? Memory::in_core
                                            : Memory::where_needed,
          .folder = base.folder() / "factor.partial",
          .processes = number_in(wanted_ranks, n_threads() > 1 ? own_ranks : 1),
          .processes_required = std::getenv(wanted_ranks) != nullptr,
          .least_shared = number_in("LACON_MPI_FROM", least_shared)};
}

PetscOptions iterative_options(const Keywords& solver, const Base& base, const StaticProblem& problem,
                               const std::string& preconditioner) {
  const double tolerance = solver.real("RESI_RELA");
  if (!(tolerance > 0 && tolerance < 1)) fail("SOLVER_15", {{"value", fmt::format("{:g}", tolerance)}});
  PetscOptions options{.preconditioner = preconditioner,
                       .tolerance = tolerance,
                       .geometry = geometry_of(problem, Bodies(problem.mesh)),
                       .direct = direct_options(solver, base)};
  if (solver.has("ALGORITHME")) options.algorithm = solver.text("ALGORITHME");
  options.direct.residual_tolerance = direct_residual;
  options.iterations = solver.integer("NMAX_ITER") > 0 ? static_cast<int>(solver.integer("NMAX_ITER")) : most_iterations;
  const bool is_shared = problem.numbering.n_equations() >= number_in("LACON_MPI_FROM", least_shared);
  options.n_ranks = number_in(wanted_ranks, is_shared && PetscEngine::has_mpirun() ? n_threads() : 1);
  if (const char* const hosts = std::getenv(wanted_hosts)) options.hosts = hosts;
  return options;
}

void tell_that_hosts_do_nothing() {
  if (std::getenv(wanted_hosts)) inform("SOLVER_12");
}

/// PRE_COND of PETSC that are factors, with which a solution is a direct one.
std::unique_ptr<Engine> factor_of(const std::string& preconditioner, const Keywords& solver, const Base& base) {
  inform("EVOLUTION_38", {{"preconditioner", preconditioner}});
  tell_that_hosts_do_nothing();
  MumpsOptions options = direct_options(solver, base);
  options.residual_tolerance = direct_residual;
  if (preconditioner == "LDLT_SP") options.single_precision = MumpsOptions::Use::always;
  if (preconditioner == "LDLT_DP") options.single_precision = MumpsOptions::Use::never;
  return std::make_unique<MumpsEngine>(options);
}

/// What AUTO is, said so.
std::string suited_method(const Keywords& solver, const StaticProblem& problem) {
  const std::int64_t n = problem.numbering.n_equations();
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double factor = memory_of_factor(n, problem.dimension, solver.has("MIXER_PRECISION") && !solver.yes("MIXER_PRECISION"));
  const char* const reason = reason_of_iterations(n, problem.dimension, factor, memory);
  const bool iterates = reason && PetscEngine::is_there();
  const std::string method = iterates ? "PETSC" : "MUMPS";
  inform("EVOLUTION_39", {{"method", method},
                          {"equations", std::to_string(n)},
                          {"factor", fmt::format("{:.2g}", 1e-9 * factor)},
                          {"memory", fmt::format("{:.2g}", 1e-9 * memory)},
                          {"reason", part(iterates ? reason
                                          : reason ? "petsc_not_there"
                                                   : "factor_has_room")}});
  return method;
}

}  // namespace

double memory_of_factor(std::int64_t n_equations, int dimension, bool in_double_precision) {
  const auto n = static_cast<double>(n_equations);
  if (dimension == 2) return 100 * n * std::log2(std::max(n, 2.0));
  // low-rank blocks in single precision: 0.9, 2.05 and 6.9 GB for 154 963, 310 965 and 964 603 equations
  return in_double_precision ? 4.2e9 * std::pow(n / 311'469, 1.3) : 7e9 * std::pow(n / 964'603, 1.2);
}

const char* reason_of_iterations(std::int64_t n_equations, int dimension, double factor, double memory) {
  // of two blocks with 310 965 equations they take three quarters of a factor's time, of 964 603 a quarter (two processes)
  constexpr std::int64_t many_in_space = 300'000;
  if (factor > memory / 2) return "factor_too_large";
  return dimension == 3 && n_equations >= many_in_space ? "iterations_are_faster" : nullptr;
}

std::unique_ptr<Engine> engine_of(const Keywords& solver, const Base& base, const StaticProblem& problem) {
  const std::string asked = solver.text("METHODE"), method = asked == "AUTO" ? suited_method(solver, problem) : asked;
  if (method == "PETSC") {
    const std::string preconditioner = solver.has("PRE_COND") ? solver.text("PRE_COND") : "GAMG";
    if (preconditioner == "LDLT_SP" || preconditioner == "LDLT_DP") return factor_of(preconditioner, solver, base);
    return std::make_unique<PetscEngine>(iterative_options(solver, base, problem, preconditioner));
  }
  tell_that_hosts_do_nothing();
  if (method != "MUMPS") inform("EVOLUTION_24", {{"method", method}});
  MumpsOptions options = direct_options(solver, base);
  if (asked == "AUTO") options.residual_tolerance = direct_residual;
  if (const double asked_for = options.residual_tolerance; asked_for >= 0 && asked_for < round_off)
    fail("SOLVER_19", {{"value", fmt::format("{:g}", asked_for)}});
  return std::make_unique<MumpsEngine>(options);
}

}  // namespace lacon
