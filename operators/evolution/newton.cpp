#include "lacon/operators/evolution/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/program/program.hpp"

namespace lacon {
namespace {

/// Nodes of every element that has a matrix.
Ragged<std::int32_t> nodes_of_elements(const StaticProblem& problem) {
  Ragged<std::int32_t> nodes;
  const auto add = [&](const ElementSet& set) {
    for (const std::int32_t cell : set.cells) nodes.push_back(problem.mesh.cells[cell]);
  };
  for (const ElementSet& set : problem.solids) add(set);
  for (const TimedLoad& load : problem.loads)
    for (const LoadedCells& loaded : load.following) add(loaded.set);
  return nodes;
}

constexpr double vanishing_force = 1e-6;         // of the largest force so far
constexpr double gap_share = 1e-2;               // of RESI_GEOM: largest |g_T| / h, 1e-8 by default
constexpr double vanishing_displacement = 1e-8;  // of the smallest patch
constexpr double other_stress = 1e-8;            // of the largest stress: that of another law
constexpr double round_off = 1e-15;              // a few units in the last place

/// The largest length of a node's vector.
double largest_vector(std::span<const double> values, int dimension) {
  double largest = 0;
  for (std::size_t i = 0; i + dimension <= values.size(); i += dimension) {
    double square = 0;
    for (int d = 0; d < dimension; ++d) square += values[i + d] * values[i + d];
    largest = std::max(largest, square);
  }
  return std::sqrt(largest);
}

}  // namespace

Newton::Newton(const StaticProblem& problem, const NewtonCriteria& criteria, std::unique_ptr<Engine> engine)
    : problem_(problem),
      criteria_(criteria),
      relations_(problem),
      elements_(nodes_of_elements(problem)),
      system_(problem.numbering, elements_),
      solver_(std::move(engine)) {
  if (problem.contact) {
    contact_.emplace(problem);
    criteria_.resi_geom = problem.contact->resi_geom;
    criteria_.constraint = gap_share * criteria_.resi_geom;
  }
  linear_ = !problem.has_following_loads();
  for (const ElementSet& set : problem.solids) {
    linear_ = linear_ && set.linear;
    has_memory_ = has_memory_ || set.kernel->has_memory;
    points_.push_back(
        {std::vector<double>(set.cells.size() * set.n_stress()), std::vector<double>(set.cells.size() * set.n_variables())});
  }
}

StaticState Newton::initial_state() {
  StaticState state{std::vector<double>(problem_.n_dofs(), 0.0), {}, std::vector<double>(relations_.size(), 0.0), points_};
  if (contact_) {
    const Phase phase("pairing");
    contact_->update_geometry(state.displacement);
    state.patches = contact_->initial();
  }
  assemble(state, state, suited(criteria_.matrix, state));
  return state;
}

SolidMatrix Newton::suited(SolidMatrix asked, const StaticState& state) const {
  if (elastic_ > 0) return SolidMatrix::elastic;
  const bool touches = has_memory_ && contact_ && contact_->n_constraints(state.patches) > 0;
  return asked == SolidMatrix::tangent && !linear_ && (touches || unstable_) ? SolidMatrix::stressless : asked;
}

void Newton::assemble(const StaticState& state, const StaticState& previous, SolidMatrix wanted) {
  present_ = wanted;
  const bool keep_stiffness = linear_ && has_stiffness_;
  std::vector<Coupling> couplings = relations_.couplings();
  if (contact_) {
    const std::vector<Coupling> own = contact_->couplings();
    couplings.insert(couplings.end(), own.begin(), own.end());
  }
  system_.start(couplings, keep_stiffness);
  const int dimension = problem_.dimension;
  {
    const Phase phase("elements");
    std::vector<std::int64_t> unknowns;
    std::vector<double> sums(problem_.n_dofs(), 0.0);
    inside_out_.reset();
    for (std::size_t s = 0; s < problem_.solids.size(); ++s) {
      const ElementSet& set = problem_.solids[s];
      SolidInput input{.displacement = state.displacement};
      if (set.kernel->has_memory) {
        input.previous_displacement = previous.displacement;
        input.previous_stress = previous.points[s].stress;
        input.previous_variable = previous.points[s].variable;
      }
      const SolidOutput output{points_[s].stress, points_[s].variable};
      const auto add = [&](const ElementValues& element) {
        unknowns.clear();
        for (const std::int32_t node : problem_.mesh.cells[element.cell])
          for (int d = 0; d < dimension; ++d) unknowns.push_back(std::int64_t{node} * dimension + d);
        system_.add(unknowns, element.matrix, element.force);
        for (std::size_t i = 0; i < unknowns.size(); ++i) sums[unknowns[i]] += std::abs(element.force[i]);
      };
      const auto inverted =
          evaluate_solids(set, problem_.mesh, dimension, input, keep_stiffness ? SolidMatrix::none : wanted, output, add);
      if (!inside_out_) inside_out_ = inverted;
    }
    force_scale_ = sums.empty() ? 0 : *std::max_element(sums.begin(), sums.end());
  }
  if (instant_ && problem_.has_following_loads()) {
    external_ = given_;
    std::vector<double> matrix, nothing;
    problem_.following_forces(
        *instant_, state.displacement, true,
        [&](std::span<const std::int64_t> dofs, std::span<const double> force, std::span<const double> by) {
          for (std::size_t i = 0; i < dofs.size(); ++i) external_[dofs[i]] += force[i];
          matrix.assign(by.begin(), by.end());
          for (double& entry : matrix) entry = -entry;
          nothing.assign(dofs.size(), 0.0);
          system_.add(dofs, matrix, nothing);
        });
  }
  if (linear_ && !keep_stiffness) system_.stiffness_is_complete();
  has_stiffness_ = true;
  relations_.assemble(state.relations, state.displacement, system_);
  if (contact_) {
    const Phase phase("contact");
    contact_->assemble(state.patches, system_);
  }
}

SolutionReport Newton::solve_system(std::vector<double>& right_side, bool rough) {
  SolutionReport report = solver_.solve(system_.matrix(), system_.first_multiplier(), right_side, rough);
  add_to_phase("analysis", report.analysis_seconds);
  add_to_phase("factorisation", report.factorisation_seconds);
  add_to_phase("solution", report.solution_seconds);
  add_to_count("solutions", 1);
  add_to_count("factorisations", report.factorised ? 1 : 0);
  add_to_count("Gflop of factorisations", 1e-9 * report.factorisation.flops);
  add_to_count("columns of the inverse", report.columns);
  add_to_count("iterations of GMRES", report.iterations);
  const std::vector<std::int64_t>& null = report.factorisation.null_pivots;
  if (null.empty()) return report;
  std::string names;
  constexpr std::size_t most = 5;
  std::size_t shown = 0;
  for (std::size_t dof = 0; dof < problem_.n_dofs() && shown < most; ++dof) {
    const std::int64_t equation = problem_.numbering.equation[dof];
    if (equation < 0 || std::find(null.begin(), null.end(), equation) == null.end()) continue;
    names += (shown++ ? ", " : "") + problem_.dof_name(static_cast<std::int64_t>(dof));
  }
  for (std::size_t r = 0; r < relations_.size() && shown < most; ++r)
    if (std::find(null.begin(), null.end(), system_.equation(relations_.unknown(r, system_))) != null.end())
      names += (shown++ ? ", " : "") + relations_.name(r);
  fail("SOLVER_3", {{"count", std::to_string(null.size())}, {"names", names.empty() ? "multipliers of contact" : names}});
}

void Newton::judge(const StaticState& state, IterationReport& report) {
  const std::vector<double>& residual = system_.residual();
  double reference = 0;  // external forces, reactions and forces of relations
  for (const double force : relations_.forces(state.relations)) reference = std::max(reference, std::abs(force));
  report.maxi = 0;
  for (std::size_t dof = 0; dof < problem_.n_dofs(); ++dof) {
    const double unbalanced = std::abs(residual[dof] - external_[dof]);
    if (problem_.imposed[dof]) {
      reference = std::max(reference, unbalanced);
    } else if (problem_.exists[dof]) {
      reference = std::max(reference, std::abs(external_[dof]));
      if (unbalanced > report.maxi || report.worst_dof < 0) {
        report.maxi = unbalanced;
        report.worst_dof = static_cast<std::int64_t>(dof);
      }
    }
  }
  // where all forces vanish (unloaded, opened) they are no measure: what is left is compared with the largest forces before
  largest_force_ = std::max({largest_force_, reference, force_scale_});
  report.rela = report.maxi == 0 ? 0 : report.maxi / std::max(reference, vanishing_force * largest_force_);
  if (!std::isfinite(report.maxi)) report.rela = report.maxi;
  // a body that moves without strain has no forces at all: nothing falls below the round-off of stiffness times displacement
  double stiffness = 0;
  for (const std::int64_t equation : problem_.numbering.equation)
    if (equation >= 0) stiffness = std::max(stiffness, system_.matrix().diagonal(equation));
  const double noise = round_off * stiffness * largest_vector(state.displacement, problem_.dimension);
  report.rela_met = !criteria_.resi_glob_rela || report.rela <= *criteria_.resi_glob_rela || report.maxi <= noise;
  report.maxi_met = !criteria_.resi_glob_maxi || report.maxi <= *criteria_.resi_glob_maxi;
  if (contact_) {
    report.constraint = contact_->constraint_residual(state.patches);
    report.geometry_met = report.geometry <= criteria_.resi_geom;
    report.constraint_met = report.constraint <= criteria_.constraint;
  }
}

std::string Newton::unmet_criteria(const IterationReport& line, std::int64_t first_changed) const {
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
                           cell_name(problem_.mesh.patches->cells[static_cast<std::size_t>(first_changed)].front())));
  return text;
}

int Newton::solve(double instant, StaticState& state, const std::function<void(const IterationReport&)>& report) {
  const int dimension = problem_.dimension;
  const std::vector<double> values = problem_.imposed_values(instant), relations = relations_.values(instant, values);
  instant_ = instant;
  given_ = problem_.dead_force(instant);
  given_.resize(problem_.n_dofs() + problem_.n_patches(), 0.0);
  given_.insert(given_.end(), relations.begin(), relations.end());
  external_ = given_;
  problem_.following_forces(instant, state.displacement, false,
                            [&](std::span<const std::int64_t> dofs, std::span<const double> force, std::span<const double>) {
                              for (std::size_t i = 0; i < dofs.size(); ++i) external_[dofs[i]] += force[i];
                            });
  std::vector<double> step(problem_.n_dofs(), 0.0);
  for (std::size_t dof = 0; dof < step.size(); ++dof)
    if (problem_.imposed[dof]) step[dof] = values[dof] - state.displacement[dof];

  const StaticState previous = state;
  // plasticity answers to a step of no length elastically: a body that is unloaded now does not overshoot on the tangent of the
  // flow that the last instant ended with, which makes Newton's method go to and fro between two states
  unstable_ = false;
  elastic_ = 0;
  if (const SolidMatrix wanted = suited(criteria_.prediction, state); has_memory_ || wanted != present_)
    assemble(state, previous, wanted);
  bool settling = false;  // statuses change from iteration to iteration: a rough solution finds them as well
  std::string unmet;
  double residual = std::numeric_limits<double>::infinity();
  int elastic_span = 1;  // twice as long each time that it was not enough
  for (int iteration = 0; iteration <= criteria_.iterations; ++iteration) {
    std::int64_t changed = 0;  // the first patch whose status has changed
    const auto start = std::chrono::steady_clock::now();
    IterationReport line{.iteration = iteration};
    line.constraints = relations_.n_constraints() + (contact_ ? contact_->n_constraints(state.patches) : 0);
    std::vector<double> solution = system_.right_side(external_, step);
    const bool rough = settling && iteration < criteria_.iterations;
    line.solution = solve_system(solution, rough);
    // more negative pivots than constraints: beyond a limit point or a bifurcation, from where Newton's step leads anywhere
    if (present_ == SolidMatrix::tangent && !linear_ && line.solution.factorised &&
        line.solution.factorisation.negative_pivots > line.constraints) {
      unstable_ = true;
      assemble(state, previous, suited(SolidMatrix::tangent, state));
      solution = system_.right_side(external_, step);
      line.solution = solve_system(solution, rough);
    }
    // the increment of all displacements: imposed ones move in the first iteration alone
    std::vector<double> increment = step;
    std::fill(step.begin(), step.end(), 0.0);
    for (std::size_t dof = 0; dof < increment.size(); ++dof)
      if (const std::int64_t e = problem_.numbering.equation[dof]; e >= 0) increment[dof] = solution[e];
    for (std::size_t dof = 0; dof < increment.size(); ++dof) state.displacement[dof] += increment[dof];
    for (std::size_t r = 0; r < relations_.size(); ++r)
      state.relations[r] += solution[system_.equation(relations_.unknown(r, system_))];
    if (contact_) {
      for (std::size_t p = 0; p < contact_->n_patches(); ++p)
        state.patches.lambda[p] += solution[problem_.numbering.of_patch(static_cast<std::int64_t>(p))];
      const Phase phase("pairing");
      contact_->update_geometry(state.displacement);
      const std::vector<Status> before = state.patches.status;
      line.status_changes = contact_->update_statuses(state.patches);
      changed = std::mismatch(before.begin(), before.end(), state.patches.status.begin()).first - before.begin();
    }
    assemble(state, previous, suited(criteria_.matrix, state));
    const double moved = largest_vector(increment, dimension), whole = largest_vector(state.displacement, dimension);
    // likewise displacements that vanish against the patches
    line.geometry =
        moved == 0 ? 0 : moved / std::max(whole, contact_ ? vanishing_displacement * contact_->smallest_patch() : 0.0);
    judge(state, line);
    line.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report(line);
    if (line.converged()) {
      if (contact_) contact_->check_radii();
      if (inside_out_) fail("EVOLUTION_9", {{"instant", fmt::format("{:.9g}", instant)}, {"cell", cell_name(*inside_out_)}});
      state.points = points_;
      return iteration;
    }
    if (elastic_ > 0) {
      --elastic_;
    } else if (has_memory_ && line.maxi > residual) {
      elastic_ = elastic_span;
      elastic_span *= 2;
      assemble(state, previous, suited(criteria_.matrix, state));
    }
    residual = line.maxi;
    unmet = unmet_criteria(line, changed);
    settling = line.status_changes > 0;
    if (!std::isfinite(line.maxi)) break;
  }
  fail("EVOLUTION_4",
       {{"instant", fmt::format("{:.9g}", instant)}, {"iterations", std::to_string(criteria_.iterations)}, {"unmet", unmet}});
}

void Newton::begin(StaticState& state, const std::string& label) {
  state.relations.assign(relations_.size(), 0.0);
  if (contact_ && state.patches.status.empty()) {
    contact_->update_geometry(state.displacement);
    state.patches = contact_->initial();
  }
  restart(state);
  for (std::size_t s = 0; s < problem_.solids.size(); ++s) {
    const std::vector<double>&given = state.points[s].stress, &found = points_[s].stress;
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
  if (contact_) {
    const Phase phase("pairing");
    contact_->update_geometry(state.displacement);
  }
  assemble(state, state, suited(criteria_.matrix, state));
}

}  // namespace lacon
