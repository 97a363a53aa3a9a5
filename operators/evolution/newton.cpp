#include "lacon/operators/evolution/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/line_search.hpp"
#include "lacon/operators/program/program.hpp"

namespace lacon {
namespace {

constexpr double gap_share = 1e-2;     // of RESI_GEOM: largest |g_T| / h, 1e-8 by default
constexpr double other_stress = 1e-8;  // of the largest stress: that of another law

}  // namespace

Newton::Newton(const StaticProblem& problem, const NewtonOptions& options, std::unique_ptr<Engine> engine)
    : problem_(problem),
      options_(options),
      equilibrium_(problem),
      choice_(equilibrium_.is_linear(), equilibrium_.has_memory(), problem.dimension == 3),
      solver_(std::move(engine)) {
  if (!problem.contact) return;
  options_.criteria.resi_geom = problem.contact->resi_geom;
  options_.criteria.constraint = gap_share * problem.contact->resi_geom;
}

StaticState Newton::initial_state() {
  StaticState state = equilibrium_.natural_state();
  equilibrium_.pair(state.displacement);
  if (contact()) state.patches = contact()->initial();
  assemble(state, state, options_.matrix);
  return state;
}

void Newton::begin(StaticState& state, const std::string& label) {
  state.relations = equilibrium_.natural_state().relations;
  if (contact() && state.patches.status.empty()) {
    equilibrium_.rest_at(state.displacement);
    equilibrium_.pair(state.displacement);
    state.patches = contact()->initial();
  }
  restart(state);
  for (std::size_t s = 0; s < problem_.solids.size(); ++s) {
    const std::vector<double>&given = state.points[s].stress, &found = equilibrium_.points()[s].stress;
    double largest = 0;
    for (const double stress : found) largest = std::max(largest, std::abs(stress));
    for (std::size_t i = 0; i < given.size(); ++i)
      if (!(std::abs(given[i] - found[i]) <= other_stress * largest))
        fail("EVOLUTION_10", {{"label", label},
                              {"cell", cell_name(problem_.solids[s].cells[i / problem_.solids[s].n_stress()])},
                              {"given", fmt::format("{:.6g}", given[i])},
                              {"found", fmt::format("{:.6g}", found[i])}});
  }
}

void Newton::restart(const StaticState& state) {
  choice_.start_instant();
  solver_.forget_right_sides();
  equilibrium_.rest_at(state.displacement);
  equilibrium_.pair(state.displacement);
  assemble(state, state, options_.matrix);
}

int Newton::solve(double instant, StaticState& state, const std::function<void(const IterationReport&)>& report) {
  const StaticState previous = state;
  equilibrium_.rest_at(previous.displacement);
  std::vector<double> step = equilibrium_.load(instant, state);
  choice_.start_instant();
  statuses_.start_instant();
  // plasticity answers to a step of no length elastically: a body that is unloaded now does not overshoot on the tangent of the
  // flow that the last instant ended with, which makes Newton's method go to and fro between two states
  if (equilibrium_.has_memory() || choice_.suited(options_.prediction, equilibrium_.touches(state)) != equilibrium_.matrix())
    assemble(state, previous, options_.prediction);
  bool settling = false;  // statuses change from iteration to iteration: a rough solution finds them as well
  std::string unmet;
  for (int iteration = 0; iteration <= options_.iterations; ++iteration) {
    const auto start = std::chrono::steady_clock::now();
    IterationReport line{.iteration = iteration};
    line.constraints = equilibrium_.n_constraints(state);
    const bool rough = settling && iteration < options_.iterations;
    std::vector<double> solution = solve_system(step, rough, line);
    const auto& negative = line.solution.factorisation.negative_pivots;
    if (negative && choice_.note_pivots(equilibrium_.matrix(), equilibrium_.curves(state), *negative, line.constraints)) {
      assemble(state, previous, SolidMatrix::tangent);
      solution = solve_system(step, rough, line);
    }
    std::vector<double> increment = equilibrium_.add(solution, step, state);
    std::fill(step.begin(), step.end(), 0.0);  // imposed displacements move in the first iteration alone
    if (iteration > 0 && equilibrium_.flows())
      shorten(solution, previous, state, increment);
    else
      equilibrium_.pair(state.displacement);
    const std::vector<Status> before = state.patches.status, wanted = wanted_statuses(state, line);
    state.patches.status = statuses_.next(before, wanted);
    assemble(state, previous, options_.matrix);
    judge_forces(options_.criteria, equilibrium_.forces(state, previous), line);
    if (contact())
      judge_contact(options_.criteria, equilibrium_.motion(increment, state), contact()->constraint_residual(state.patches),
                    line);
    line.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report(line);
    if (line.converged()) {
      if (contact()) contact()->geometry().check_radii();
      if (const auto cell = equilibrium_.cell_inside_out())
        fail("EVOLUTION_9", {{"instant", fmt::format("{:.9g}", instant)}, {"cell", cell_name(*cell)}});
      state.points = equilibrium_.points();
      return iteration;
    }
    const auto first_changed = std::mismatch(before.begin(), before.end(), wanted.begin()).first - before.begin();
    unmet = unmet_criteria(line, static_cast<std::size_t>(first_changed));
    settling = line.status_changes > 0 && !statuses_.keeps();
    bool other_matrix = choice_.note_residual(line.maxi, line.status_changes == 0 && equilibrium_.curves(state));
    if (statuses_.keeps() && line.status_changes > 0 && line.in_equilibrium()) {
      state.patches.status = statuses_.change(state.patches.status, wanted);
      other_matrix = true;
      fail_if_endless(instant);
    }
    if (other_matrix) assemble(state, previous, options_.matrix);
    if (!std::isfinite(line.maxi)) break;
  }
  fail("EVOLUTION_4",
       {{"instant", fmt::format("{:.9g}", instant)}, {"iterations", std::to_string(options_.iterations)}, {"unmet", unmet}});
}

void Newton::assemble(const StaticState& state, const StaticState& previous, SolidMatrix asked) {
  equilibrium_.assemble(state, previous, choice_.suited(asked, equilibrium_.touches(state)));
}

std::vector<double> Newton::solve_system(std::span<const double> step, bool rough, IterationReport& line) {
  const System& system = equilibrium_.system();
  std::vector<double> solution = equilibrium_.right_side(step);
  line.solution = solver_.solve(system.matrix(), system.first_multiplier(), solution, rough);
  const SolutionReport& report = line.solution;
  add_to_phase("analysis", report.analysis_seconds);
  add_to_phase("factorisation", report.factorisation_seconds);
  add_to_phase("solution", report.solution_seconds);
  add_to_count("solutions", 1);
  add_to_count("factorisations", report.factorised ? 1 : 0);
  add_to_count("Gflop of factorisations", 1e-9 * report.factorisation.flops);
  add_to_count("columns of the inverse", report.columns);
  add_to_count("iterations of GMRES", report.iterations);
  const std::vector<std::int64_t>& null = report.factorisation.null_pivots;
  if (!null.empty()) fail("SOLVER_3", {{"count", std::to_string(null.size())}, {"names", equilibrium_.names(null)}});
  return solution;
}

void Newton::shorten(std::span<const double> solution, const StaticState& previous, StaticState& state,
                     std::vector<double>& increment) {
  const std::vector<double> at_rest(increment.size(), 0.0);
  double reached = 1;
  part_of_increment(equilibrium_.power(solution), [&](double part) {
    if (part != reached) {
      std::vector<double> back(solution.begin(), solution.end());
      for (double& value : back) value *= part - reached;
      const std::vector<double> moved = equilibrium_.add(back, at_rest, state);
      for (std::size_t i = 0; i < moved.size(); ++i) increment[i] += moved[i];
      reached = part;
    }
    equilibrium_.pair(state.displacement);
    equilibrium_.assemble(state, previous, {SolidMatrix::none, false});
    return equilibrium_.power(solution);
  });
}

std::vector<Status> Newton::wanted_statuses(const StaticState& state, IterationReport& line) const {
  if (!contact()) return {};
  const Phase phase("pairing");
  Patchwise patches = state.patches;
  line.status_changes = contact()->update_statuses(patches);
  return patches.status;
}

void Newton::fail_if_endless(double instant) const {
  if (statuses_.endless().empty()) return;
  constexpr std::size_t most = 4;
  std::string cells;
  for (std::size_t i = 0; i < std::min(most, statuses_.endless().size()); ++i)
    cells += (i ? ", " : "") + cell_name(problem_.mesh.patches->cells[statuses_.endless()[i]].front());
  fail("EVOLUTION_15", {{"instant", fmt::format("{:.9g}", instant)},
                        {"count", std::to_string(statuses_.endless().size())},
                        {"cells", cells + (statuses_.endless().size() > most ? ", ..." : "")},
                        {"period", std::to_string(statuses_.period())}});
}

std::string Newton::unmet_criteria(const IterationReport& line, std::size_t first_changed) const {
  std::string text;
  const auto add = [&](bool met, const std::string& what) {
    if (!met) text += (text.empty() ? "" : ", ") + what;
  };
  const std::string where = line.worst_dof < 0 ? "" : " at " + problem_.dof_name(line.worst_dof);
  add(line.rela_met, fmt::format("RESI_GLOB_RELA {:.1e}{}", line.rela, where));
  add(line.maxi_met, fmt::format("RESI_GLOB_MAXI {:.1e}{}", line.maxi, where));
  add(line.geometry_met, fmt::format("RESI_GEOM {:.1e}", line.geometry));
  add(line.constraint_met, fmt::format("max. gap / size {:.1e}", line.constraint));
  if (line.status_changes)
    add(false, fmt::format("{} patch(es) changing status, the first at slave cell {}", line.status_changes,
                           cell_name(problem_.mesh.patches->cells[first_changed].front())));
  return text;
}

}  // namespace lacon
