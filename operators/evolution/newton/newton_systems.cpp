// The linear systems of Newton's method: assembled, solved, and held where bodies are loose.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "lacon/assembly/dependent_rows.hpp"
#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/newton/instant_failure.hpp"
#include "lacon/operators/evolution/newton/linear_statuses.hpp"
#include "lacon/operators/evolution/newton/newton.hpp"
#include "lacon/operators/evolution/newton/rest_under_load.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

constexpr int most_rests = 4;        // in an instant: how often bodies are led to patches by their load
constexpr int most_flung = 6;        // in an iteration: how often bodies are held that it flings
constexpr int most_rounds = 6;       // of statuses in an iteration
constexpr int most_raised = 12;      // in an iteration: how often the resistance to creeping is
constexpr double furthest = 0.5;     // cells, by which an iteration may creep
constexpr double hardly_less = 0.8;  // of a motion: what is driven by gaps heeds no resistance
constexpr double of_a_round = 1e-6;  // of what the solution before leaves of its right side, iterations may leave
// Of what resists most: motions that are resisted by less, where bodies are flung. Rows of contact that say the same of a rigid
// body differ by its strains, and that is all that is left to resist.
constexpr double hardly = 1e-2;

}  // namespace

void Newton::place_nodes(const StaticState& state) {
  std::vector<double> place;
  displace(problem_.mesh, state.displacement, problem_.dimension, place);
  solver_.place_nodes(place);
}

void Newton::assemble(const StaticState& state, const StaticState& previous, SolidMatrix asked) {
  place_nodes(state);
  equilibrium_.assemble(state, previous, choice_.suited(asked, equilibrium_.touches(state)));
  resists_ = creep_.has_value();
  if (creep_) equilibrium_.resist(creep_->resistance());
}

std::optional<std::int64_t> Newton::consistent_pivots(const StaticState& previous, const StaticState& state) {
  constexpr std::int64_t most = 100'000;  // equations
  constexpr NewtonMatrix consistent;
  const SparseMatrix& last = equilibrium_.system().matrix();
  if (unstable_told_ || creep_ || !choice_.pivots_tell() || !choice_.has_replaced() || solved_with_ == consistent ||
      last.elsewhere() || last.size() > most)
    return std::nullopt;
  const NewtonMatrix present = equilibrium_.matrix();
  equilibrium_.assemble(state, previous, consistent);
  std::optional<std::int64_t> found;
  try {
    MumpsEngine engine({.memory = MumpsOptions::Memory::in_core});
    engine.analyse(equilibrium_.system().matrix());
    found = engine.factorise(equilibrium_.system().matrix()).negative_pivots;
  } catch (const Error&) {  // no memory for a second factor: the instant is solved all the same
  }
  equilibrium_.assemble(state, previous, present);
  return found;
}

std::vector<double> Newton::solve_system(StaticState& state, const StaticState& previous, SolidMatrix asked,
                                         std::span<const double> step, const Accuracy& accuracy, IterationReport& line) {
  const System& system = equilibrium_.system();
  hanging_.clear();
  int flung = 0;
  for (Held held = Held::no;;) {
    line.constraints = equilibrium_.n_constraints(state);
    std::vector<LooseMotion> loose;
    if (settled_ == 0) loose = loose_.of(system.matrix());
    std::vector<std::int64_t> null;
    for (const LooseMotion& motion : loose) null.push_back(problem_.numbering.equation[static_cast<std::size_t>(motion.dof)]);
    const bool moves_freely = !loose.empty();
    if (!moves_freely) {
      std::vector<double> solution = equilibrium_.right_side(step);
      const std::vector<MovingCover> covers = moving_covers(state, step);
      for (const MovingCover& cover : covers)
        for (const auto& [equation, value] : cover.column) solution[static_cast<std::size_t>(equation)] -= cover.step * value;
      double size = 0;
      for (const double value : solution) size = std::max(size, std::abs(value));
      line.solution = solve_linear(solution, accuracy);
      null = line.solution.factorisation.null_pivots;
      if (null.empty()) {
        if (flung < most_flung && flings(solution, step)) {
          ++flung;
          held = hold(hardly_resisted(), step, state, previous, asked);
          if (held != Held::no) continue;
        }
        // solutions by iterations cost more than the iterations of Newton's method that they would spare
        if (problem_.dimension == 2 || !line.solution.factorisation.is_iterative)
          line.constraints += follow_covers(
              covers, size, [&](std::vector<double>& side) { solve_linear(side, accuracy, true); }, solution);
        return solution;
      }
      for (const std::int64_t dof : equilibrium_.dofs_of(null))
        loose.push_back({dof, {bodies_.of(static_cast<std::int32_t>(dof / problem_.n_components()))}});
    }
    const bool sprung = held == Held::by_springs;
    if (!sprung && loose.size() == null.size()) {
      held = hold(loose, step, state, previous, asked);
      if (held != Held::no) continue;
    }
    const std::int64_t dependent =
        sprung || moves_freely
            ? 0
            : std::min<std::int64_t>(std::ssize(null), count_dependent_rows(system.matrix(), system.first_multiplier()));
    const std::int64_t free = std::ssize(null) - dependent;
    if (free == 0)
      throw InstantFailure(message("SOLVER_14", {{"count", std::to_string(dependent)}, {"names", equilibrium_.names(null)}}),
                           {.depends_on_step = line.iteration > 0});
    const std::string count = std::to_string(free), names = said({equilibrium_.names(null), too_little_covered(loose, state)});
    // the first matrix of an instant is that of the state before
    if (line.iteration == 0)
      throw InstantFailure(message("SOLVER_3", {{"count", count}, {"names", names}}), {.depends_on_step = false});
    throw InstantFailure(
        message("EVOLUTION_42", {{"iteration", std::to_string(line.iteration)}, {"count", count}, {"names", names}}),
        {.depends_on_step = true});
  }
}

void Newton::resist(std::vector<double>& solution, StaticState& state, const StaticState& previous, SolidMatrix asked,
                    std::span<const double> step, const Accuracy& accuracy, IterationReport& line,
                    const std::function<void()>& assemble_again) {
  const bool driven = std::ranges::any_of(step, [](double value) { return value != 0; });
  const auto unstable = [&] {
    const auto& negative = line.solution.factorisation.negative_pivots;
    return negative && *negative > line.constraints;
  };
  const auto motion = [&] { return driven ? 0 : creep_->over_cells(solution); };
  double reached = motion();
  for (int raised = 0; raised < most_raised && (unstable() || reached > furthest); ++raised) {
    const bool was_unstable = unstable();
    const double before = reached;
    creep_->raise();
    assemble_again();
    solution = solve_system(state, previous, asked, step, accuracy, line);
    reached = motion();
    if (!was_unstable && !unstable() && reached > hardly_less * before) break;
  }
  if (reached > furthest)
    for (double& value : solution) value *= furthest / reached;
}

bool Newton::flings(std::span<const double> solution, std::span<const double> step) const {
  if (unsupported_.empty() || settled_ > 0 || std::ranges::any_of(step, [](double value) { return value != 0; })) return false;
  const std::vector<std::int64_t>& equation = problem_.numbering.equation;
  const auto width = static_cast<std::size_t>(problem_.n_components()), axes = static_cast<std::size_t>(problem_.dimension);
  for (std::size_t dof = 0; dof < equation.size(); ++dof)
    if (equation[dof] >= 0 && dof % width < axes && std::abs(solution[static_cast<std::size_t>(equation[dof])]) > extent_)
      return true;
  return false;
}

std::vector<LooseMotion> Newton::hardly_resisted() {
  std::vector<LooseMotion> found = loose_.of(equilibrium_.system().matrix(), hardly);
  std::erase_if(found, [&](const LooseMotion& motion) {
    return std::ranges::any_of(motion.bodies, [&](std::int32_t body) { return !unsupported_.contains(body); });
  });
  return found;
}

std::vector<MovingCover> Newton::moving_covers(const StaticState& state, std::span<const double> step) const {
  // in space they are many: as long as statuses change these are fitted to each other without them
  if (problem_.dimension == 3 && settled_ == 0) return {};
  return equilibrium_.moving_covers(state, step);
}

void Newton::fit_statuses(std::vector<double>& solution, std::span<const double> step, StaticState& state,
                          const Accuracy& accuracy, IterationReport& line, const std::function<void()>& assemble_again) {
  if (!contact() || settled_ > 0 || statuses_.keeps() || !moving_covers(state, step).empty()) return;
  const System& system = equilibrium_.system();
  std::size_t wrong = std::numeric_limits<std::size_t>::max();
  for (int round = 0;; ++round) {
    LinearStatuses fitted(*contact(), system, state.patches, solution, step);
    const std::size_t affordable = solver_.affordable_columns(system.matrix());
    if (fitted.n_wrong() <= affordable) return fit_by_columns(fitted, affordable, step, state, accuracy, solution);
    if (round == most_rounds || fitted.n_wrong() >= wrong) return;
    wrong = fitted.n_wrong();
    const std::vector<Status> before = state.patches.status;
    fitted.change_all(state.patches);
    assemble_again();
    SolutionReport report;
    std::vector<double> other;
    const auto serves = [&] {
      if (!loose_.of(system.matrix()).empty()) return false;
      report = line.solution.factorisation.is_iterative ? solve_from(solution, step, other)
                                                        : solve_linear(other = equilibrium_.right_side(step), accuracy);
      const auto& negative = report.factorisation.negative_pivots;
      return report.factorisation.null_pivots.empty() && !flings(other, step) &&
             (!negative || *negative <= equilibrium_.n_constraints(state));
    };
    if (!serves()) {
      state.patches.status = before;
      return assemble_again();
    }
    line.constraints = equilibrium_.n_constraints(state);
    line.solution = report;
    solution = std::move(other);
  }
}

void Newton::fit_by_columns(LinearStatuses& fitted, std::size_t affordable, std::span<const double> step, StaticState& state,
                            const Accuracy& accuracy, std::vector<double>& solution) {
  const System& system = equilibrium_.system();
  const bool found = fitted.find(affordable, [&](const SparseSides& sides, const LinearStatuses::UseColumn& use) {
    begin_phase("linear system");
    note_work(solver_.columns(system.matrix(), sides, use));
  });
  if (!found) return;
  std::vector<double> side = equilibrium_.right_side(step);
  fitted.add_to(side);
  if (!solve_linear(side, accuracy, true).factorisation.null_pivots.empty()) return;
  std::vector<double> more = fitted.correction(side);
  solve_linear(more, accuracy, true);
  for (std::size_t i = 0; i < side.size(); ++i) side[i] += more[i];
  if (flings(side, step)) return;
  solution = std::move(side);
  fitted.take(state.patches, solution);
}

SolutionReport Newton::solve_from(std::span<const double> near, std::span<const double> step, std::vector<double>& solution) {
  solution.resize(near.size());
  equilibrium_.system().matrix().multiply(near, solution);
  const std::vector<double> side = equilibrium_.right_side(step);
  for (std::size_t i = 0; i < side.size(); ++i) solution[i] = side[i] - solution[i];
  const SolutionReport report = solve_linear(solution, {.rough = true, .share = of_a_round});
  for (std::size_t i = 0; i < side.size(); ++i) solution[i] += near[i];
  return report;
}

SolutionReport Newton::solve_linear(std::vector<double>& solution, const Accuracy& accuracy, bool again) {
  const System& system = equilibrium_.system();
  begin_phase("linear system");
  const SolutionReport report = again ? solver_.solve_again(system.matrix(), solution, accuracy)
                                      : solver_.solve(system.matrix(), system.first_multiplier(), solution, accuracy);
  add_to_count("solutions", 1);
  note_work(report);
  return report;
}

void Newton::note_work(const SolutionReport& report) {
  add_to_phase("analysis", report.analysis_seconds);
  add_to_phase("factorisation", report.factorisation_seconds);
  add_to_phase("solution", report.solution_seconds);
  const Factorisation& factor = report.factorisation;
  add_to_count("factorisations", report.factorised && !factor.is_iterative ? 1 : 0);
  if (report.factorised) {
    if (factor.is_iterative) add_to_count("preconditioners of PETSc", 1);
    if (!factor.stalled.empty()) inform("SOLVER_7", {{"reason", factor.stalled}});
    if (factor.single_precision) add_to_count("factors in single precision", 1);
    if (factor.low_rank) add_to_count("factors of low rank", 1);
    if (factor.processes > 1) add_to_count("factors by several processes", 1);
    if (factor.out_of_core) add_to_count("factors in files", 1);
    if (!factor.doubt.empty()) doubt_ = factor.doubt;
    if (!doubt_.empty() && factor.null_pivots.empty())  // of a singular matrix that is told, and it is why
      inform("SOLVER_4", {{"reason", std::exchange(doubt_, std::string())}});
    if (!factor.unshared.empty()) inform("SOLVER_13", {{"reason", factor.unshared}});
  }
  add_to_count("Gflop of factorisations", 1e-9 * (factor.flops + factor.wasted_flops));
  add_to_count("columns of the inverse", report.columns);
  add_to_count(factor.is_iterative ? "iterations of PETSc" : "iterations of GMRES", report.iterations);
}

Newton::Held Newton::hold(const std::vector<LooseMotion>& loose, std::span<const double> step, StaticState& state,
                          const StaticState& previous, SolidMatrix asked) {
  if (!contact() || loose.empty()) return Held::no;
  const auto take_contact_and_assemble = [&](const std::vector<NearestPatches>& holds) {
    ++times_held_;
    take_contact(holds, state);
    assemble(state, previous, asked);
    return Held::by_patches;
  };
  std::set<std::int32_t> bodies, near;
  for (const LooseMotion& motion : loose) bodies.insert(motion.bodies.begin(), motion.bodies.end());
  if (settled_ == 0 && times_rested_++ < most_rests) {  // elsewise no motions of the system are known
    const auto holds = by_zone(patches_under_load(*contact(), state.patches, equilibrium_, loose_, step), bodies);
    if (!holds.empty()) return take_contact_and_assemble(holds);
  }
  const auto holds = contact()->nearest_to_hold(state.patches, bodies, [&](std::int32_t node) { return bodies_.of(node); });
  for (const NearestPatches& hold : holds) near.insert(bodies_.of(hold.node));
  for (const LooseMotion& motion : loose)
    if (std::ranges::none_of(motion.bodies, [&](std::int32_t body) { return near.contains(body); })) return Held::no;
  // springs do not let a body tip onto what it is to stand on
  if (times_held_ == 0 || std::ranges::all_of(holds, &NearestPatches::tips)) return take_contact_and_assemble(holds);
  ++times_held_;
  std::vector<std::int64_t> dofs;
  for (const LooseMotion& motion : loose) dofs.push_back(motion.dof);
  equilibrium_.hold(dofs);
  hanging_ = bodies_.name_at(holds.front().node);
  return Held::by_springs;
}

std::vector<NearestPatches> Newton::by_zone(const std::vector<std::size_t>& patches,
                                            const std::set<std::int32_t>& loose) const {
  std::map<std::pair<std::int32_t, std::int32_t>, NearestPatches> found;  // by zone and body
  for (const std::size_t patch : patches) {
    const std::int32_t node = contact()->node_at(patch, [&](std::int32_t at) { return loose.contains(bodies_.of(at)); });
    if (node < 0) continue;
    NearestPatches& there = found[{contact()->geometry().zone_of(patch), bodies_.of(node)}];
    there.node = node;
    there.patches.push_back(patch);
  }
  std::vector<NearestPatches> all;
  for (auto& [where, there] : found) {
    std::ranges::stable_sort(there.patches, {}, [&](std::size_t patch) { return contact()->geometry().gap(patch); });
    all.push_back(std::move(there));
  }
  return all;
}

void Newton::take_contact(const std::vector<NearestPatches>& holds, StaticState& state) {
  for (const NearestPatches& hold : holds) {
    const std::size_t first = hold.patches.front();
    for (const std::size_t patch : hold.patches) state.patches.status[patch] = Status::active;
    if (!told_.insert(first).second) continue;
    const ContactZone& zone = problem_.contact->zones[contact()->geometry().zone_of(first)];
    inform("EVOLUTION_20", {{"body", bodies_.name_at(hold.node)},
                            {"count", std::to_string(hold.patches.size())},
                            {"cell", cell_name(problem_.mesh.patches->cells[first].front())},
                            {"slave", zone.slave_group},
                            {"master", zone.master_group},
                            {"gap", fmt::format("{:.3g}", contact()->geometry().gap(first))}});
  }
}

}  // namespace lacon
