#include "lacon/operators/evolution/newton/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/newton/instant_failure.hpp"
#include "lacon/operators/evolution/problem/free_bodies.hpp"
#include "lacon/operators/evolution/problem/parts.hpp"
#include "lacon/operators/program/checking.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/displacement.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {
namespace {

constexpr double few_digits = 1e-4;    // of the largest force: round-off that is told
constexpr int most_times = 3;          // ITER_GLOB_MAXI, where each set of statuses has that many iterations to its equilibrium
constexpr int drifting = 4;            // iterations without change of status, each of which leaves more than the one before
constexpr int in_vain = 18;            // iterations whose residuals get nowhere: what flows or is soft may settle sooner
constexpr int in_vain_to_the_end = 9;  // likewise, where the instant would fail
constexpr double gap_share = 1e-2;     // of RESI_GEOM: largest |g_T| / h, 1e-8 by default
constexpr double deepest = 1;          // sizes of a patch, by which bodies that began in a few patches may go into each other
constexpr double through = 10;         // likewise, other bodies that only springs hold before they touch
constexpr int most_times_anew = 2;     // that cells are cut, or masters left out, in an instant
constexpr double other_stress = 1e-8;  // of the largest stress: that of another law

/// Iterations of Effort::lasts: O-rings that leave an equilibrium for another one take 15 to 25.
int lasting(int iterations) { return std::min(4 * iterations, 60); }

}  // namespace

Newton::Newton(const StaticProblem& problem, const NewtonOptions& options, std::unique_ptr<Engine> engine)
    : problem_(problem),
      options_(options),
      bodies_(problem.mesh),
      extent_(extent(problem.mesh)),
      unsupported_(problem.contact ? free_bodies(problem, bodies_) : std::set<std::int32_t>()),
      loose_(RigidMotions(geometry_of(problem, bodies_)), problem.numbering),
      equilibrium_(problem, parts_of(problem, *engine)),
      choice_({.linear = equilibrium_.is_linear(),
               .made_symmetric = equilibrium_.makes_symmetric(),
               .symmetric = equilibrium_.is_symmetric(),
               .in_space = problem.dimension == 3,
               .settling = problem.contact ? problem.contact->elastic_iterations : 0}),
      prediction_(problem.imposed),
      solver_(std::move(engine)) {
  equilibrium_.measure_by(options.reference_forces);
  if (!only_checks()) equilibrium_.on_new_graph([this](const VertexGraph& graph) { solver_.expect(graph); });
  if (!problem.contact) return;
  options_.criteria.resi_geom = problem.contact->resi_geom;
  options_.criteria.constraint = gap_share * problem.contact->resi_geom;
}

StaticState Newton::initial_state() {
  StaticState state = equilibrium_.natural_state();
  equilibrium_.offset_skins(options_.start);
  if (!options_.from_reference) start_heated(state);
  equilibrium_.pair(state.displacement);
  equilibrium_.choose_masters();
  if (contact()) state.patches = contact()->initial();
  assemble(state, state, options_.matrix);
  return state;
}

void Newton::start_heated(StaticState& state) {
  if (!equilibrium_.heat(options_.start, state)) return;
  equilibrium_.strain_as(state);
  equilibrium_.start_from(state);
}

void Newton::begin(StaticState& state, const std::string& label, bool as_given) {
  state.relations = equilibrium_.natural_state().relations;
  equilibrium_.hand_out(state);
  if (contact() && state.patches.status.empty()) {
    equilibrium_.rest_at(state.displacement);
    equilibrium_.pair(state.displacement);
    equilibrium_.choose_masters();
    state.patches = contact()->initial();
  }
  equilibrium_.keep(std::exchange(state.kept_pairing, {}));
  for (const std::size_t patch : std::exchange(state.kept_covers, {}))
    if (contact()->geometry().zone_of(patch) >= 0) keep_cover(options_.start, patch);
  start_heated(state);
  if (as_given) equilibrium_.start_from(state);
  equilibrium_.begin_stressed(state);
  restart(state);
  StaticState now;
  equilibrium_.hold_points(now);
  std::vector<double> room, other_room;
  for (std::size_t s = 0; s < problem_.solids.size(); ++s) {
    const std::span<const double> given = values_of(state, s, PointQuantity::stress, room),
                                  found = values_of(now, s, PointQuantity::stress, other_room);
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
  equilibrium_.strain_as(state);
  creep_.reset();
  choice_.start_instant();
  solver_.forget_right_sides();
  prediction_.distrust();
  equilibrium_.rest_at(state.displacement);
  equilibrium_.pair(state.displacement);
  equilibrium_.choose_masters();
  assemble(state, state, options_.matrix);
}

bool Newton::take(Effort effort) {
  if (effort == Effort::searches && options_.line_search) return false;
  if (effort == Effort::lasts && lasting(options_.iterations) <= options_.iterations) return false;
  return std::exchange(effort_, effort) != effort;
}

void Newton::save(const hdf5::Group& group) const {
  group.set("waits", std::int64_t{choice_.waits()});
  group.write("told", std::vector<std::int64_t>(told_.begin(), told_.end()));
  group.set("unstable_told", std::int64_t{unstable_told_});
  if (round_off_told_) group.create("round_off_told");
  group.write("covers_told", std::vector<std::int32_t>(covers_told_.begin(), covers_told_.end()));
  std::vector<std::int64_t> covers;
  for (std::size_t p = 0; contact() && p < contact()->n_patches(); ++p)
    if (contact()->keeps_cover(p)) covers.push_back(static_cast<std::int64_t>(p));
  group.write("covers", covers);
  unstable_path_.save(group.create("unstable_path"));
  prediction_.save(group.create("prediction"));
  equilibrium_.save(group.create("equilibrium"));
  solver_.save(group.create("solver"));
}

void Newton::resume(const hdf5::Group& group, const hdf5::Group* base, const StaticState& state, std::span<const double> rest) {
  choice_.set_waits(group.integer("waits") != 0);
  for (const std::int64_t patch : group.read<std::int64_t>("told")) told_.insert(static_cast<std::size_t>(patch));
  unstable_told_ = group.integer("unstable_told") != 0;
  round_off_told_ = group.has("round_off_told");
  for (const std::int32_t zone : group.read<std::int32_t>("covers_told")) covers_told_.insert(zone);
  for (const std::int64_t patch : group.read<std::int64_t>("covers")) equilibrium_.keep_cover(static_cast<std::size_t>(patch));
  unstable_path_.resume(group.open("unstable_path"));
  prediction_.resume(group.open("prediction"));
  equilibrium_.resume(group.open("equilibrium"), state, rest);
  place_nodes(state);
  solver_.resume(group.open("solver"), base, problem_.numbering);
}

int Newton::solve(double instant, StaticState& state, const std::function<void(const IterationReport&)>& report) {
  course_.start();
  elsewhere_ = false;
  creep_.reset();
  if (effort_ == Effort::creeps) creep_.emplace(problem_, equilibrium_.system());
  try {
    return iterate(instant, state, report);
  } catch (const Error& error) {
    Message told = error.message();
    if (is_of_the_machine(told)) throw;
    FailureNature nature = nature_of(error);
    nature.led_astray = elsewhere_ && told.severity == 'S';
    if (!nature.led_astray && told.severity == 'S' && unstable_path_.fail(choice_.leaves_unstable()))
      (choice_.follows_unstable() ? nature.stayed_unstable : nature.left_unstable) = true;
    // the state before was computed: what is wrong with a cell now, the iterations have done
    if (told.id == "ELEMENT_1" || told.id == "EVOLUTION_3")
      told = message("EVOLUTION_18", {{"instant", fmt::format("{:.9g}", instant)},
                                      {"reason", said({told.text, course_.words()})},
                                      {"remedy", part(options_.cuts ? "remedy_coarser_load" : "remedy_cut_step")}});
    else if (!nature.begins_again())
      throw;
    if (nature.led_astray) prediction_.mislead();
    throw InstantFailure(told, nature);
  }
}

std::vector<double> Newton::begin_instant(double instant, const StaticState& state) {
  equilibrium_.rest_at(state.displacement);
  equilibrium_.keep_gliding(state.patches);
  depths_before_ = depths(state);
  const bool follows = unstable_path_.begin();
  choice_.start_instant(follows || creep_);
  if (creep_) choice_.set_waits(false);  // it is far from balance, or was: second derivatives are worth their cost
  statuses_.start_instant();
  edges_ = {};
  lost_masters_.start_instant();
  settled_ = times_held_ = times_rested_ = times_round_ = times_cut_ = times_left_out_ = 0;
  looked_far_ = goes_round_ = other_covers_ = false;
  forcing_.start_instant();
  return equilibrium_.load(instant, state);
}

void Newton::judge(const StaticState& state, const StaticState& previous, std::span<const double> increment,
                   IterationReport& line) const {
  judge_forces(options_.criteria, equilibrium_.forces(state, previous), line);
  if (contact())
    judge_contact(options_.criteria, equilibrium_.motion(increment, state), contact()->constraint_residual(state.patches),
                  line);
}

void Newton::finish_instant(double instant, const StaticState& previous, StaticState& state,
                            const std::vector<double>& external, const IterationReport& line) {
  if (contact()) contact()->geometry().check_radii();
  if (const auto cell = equilibrium_.cell_inside_out())
    fail("EVOLUTION_9", {{"instant", fmt::format("{:.9g}", instant)}, {"cell", cell_name(*cell)}});
  fail_if_passed_through(instant, state);
  equilibrium_.hold_points(state);
  found_ = {.instant = instant,
            .before = {.displacement = previous.displacement, .pressure = previous.patches.lambda},
            .external = external,
            .negative = line.solution.factorisation.negative_pivots,
            .of_consistent = consistent_pivots(previous, state),
            .constraints = line.constraints,
            .unbalanced = line.round_off && line.rela > few_digits ? line.rela : 0,
            .worst_dof = line.worst_dof};
}

void Newton::accept(const StaticState& state) {
  note_stability();
  note_round_off();
  equilibrium_.let_covers_go();
  tell_of_covers();
  prediction_.note(options_.start, found_.before,
                   {found_.instant, state.displacement, state.patches.lambda, std::move(found_.external)}, elsewhere_);
}

int Newton::iterate(double instant, StaticState& state, const std::function<void(const IterationReport&)>& report) {
  const StaticState previous = state;
  std::vector<double> step = begin_instant(instant, state);
  const std::vector<double> external = equilibrium_.external();
  extrapolate(instant, state, step);
  // plasticity answers to a step of no length by the flow that the last instant ended with where the load goes on: a neck that
  // softens goes on alone. A body that is unloaded now would overshoot on it, to and fro between two states
  const auto motion = prediction_.last_motion();
  const bool goes_on =
      motion && equilibrium_.has_memory() && equilibrium_.load_goes_on(motion->first, motion->second, instant, state);
  const auto assemble_first = [&] {
    assemble(state, goes_on ? previous : equilibrium_.at_rest(previous), options_.prediction);
  };
  if (creep_.has_value() != resists_ || equilibrium_.has_memory() || equilibrium_.strains_freely(previous) ||
      equilibrium_.has_new_gaps() || state.displacement != previous.displacement ||
      choice_.suited(options_.prediction, equilibrium_.touches(state)) != equilibrium_.matrix())
    assemble_first();
  IterationReport there;
  double forces_before = 0;
  if (elsewhere_) judge_forces(options_.criteria, equilibrium_.forces(state, previous), there);
  bool settling = false;  // statuses change from iteration to iteration: a rough solution finds them as well
  IterationReport line;
  std::size_t changing = 0;
  const bool lasts = effort_ == Effort::lasts || effort_ == Effort::creeps;
  int last = lasts ? std::max(options_.iterations, lasting(options_.iterations)) : options_.iterations,
      beyond = last / 2;  // more iterations, which are made where they lead to the end
  const auto with_own_iterations = [&](int first) {
    return std::max(last, std::min(first + options_.iterations, most_times * options_.iterations));
  };
  for (int iteration = 0; iteration <= last; ++iteration) {
    const auto start = std::chrono::steady_clock::now();
    const bool rough = settling && iteration < last;
    const Accuracy accuracy{.rough = rough, .share = iteration > 0 ? forcing_.next(line, rough) : 0};
    line = {.iteration = iteration};
    const auto assemble_again = [&] { iteration == 0 ? assemble_first() : assemble(state, previous, options_.matrix); };
    const SolidMatrix asked = iteration == 0 ? options_.prediction : options_.matrix;
    std::vector<double> solution = solve_system(state, previous, asked, step, accuracy, line);
    solved_with_ = equilibrium_.matrix();
    auto& negative = line.solution.factorisation.negative_pivots;
    const auto without_more = negative;  // resistance to creeping, of which next to nothing is left at the end
    if (creep_) {
      resist(solution, state, previous, asked, step, accuracy, line, assemble_again);
    } else if (negative &&
               choice_.note_pivots(equilibrium_.matrix(), equilibrium_.curves(state), *negative, line.constraints)) {
      assemble(state, previous, SolidMatrix::tangent);
      solution = solve_system(state, previous, SolidMatrix::tangent, step, accuracy, line);
      solved_with_ = equilibrium_.matrix();
    }
    // a matrix that is not that of a minimum has statuses that answer to each other in any sense
    if (!negative || *negative <= line.constraints) fit_statuses(solution, step, state, accuracy, line, assemble_again);
    if (creep_) negative = without_more;
    // what iterates that go to and fro jump over lies between them. In space forces leap where the traces of facets change, and
    // a search for balance stops at each leap: there it ends with the period
    goes_round_ = course_.period() || (goes_round_ && problem_.dimension == 2);
    const std::vector<double> gaps = contact() ? contact()->gaps_over_size() : std::vector<double>();
    std::vector<double> increment = equilibrium_.add(solution, step, state);
    const bool driven = std::ranges::any_of(step, [](double value) { return value != 0; });
    std::fill(step.begin(), step.end(), 0.0);  // imposed displacements move in the first iteration alone
    if (iteration > 0 && (options_.line_search || effort_ == Effort::searches || goes_round_ || equilibrium_.has_variables()))
      shorten(solution, previous, state, increment);
    else
      equilibrium_.pair(state.displacement);
    if (driven) equilibrium_.choose_masters();  // where what is imposed has brought bodies
    if (contact() && !driven) stay_shallow(solution, gaps, state, increment);
    comes_near_ = !hanging_.empty() && contact()->closes_within(last - iteration, gaps);
    const std::vector<Status> before = state.patches.status, wanted = wanted_statuses(state, line);
    // what imposed displacements alone have parted, the next iteration may bring together again: it starts from bodies that
    // touch
    const bool waits = iteration == 0 && parts_a_zone(before, wanted);
    if (!creep_) keep_lost_masters(instant, before, wanted, state);
    const bool kept = statuses_.keeps();
    state.patches.status = waits ? before : creep_ ? wanted : statuses_.next(before, wanted);
    if (statuses_.keeps() != kept) last = with_own_iterations(iteration);
    choice_.note_statuses(line.status_changes, equilibrium_.flows(previous));
    assemble(state, previous, options_.matrix);
    judge(state, previous, increment, line);
    line.pairs_anew = iteration < last && pairs_anew(line, state, previous);
    line.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report(line);
    course_.add(line.longest, line.worst_dof);
    if (creep_) creep_->ease(line.longest);
    settled_ = line.status_changes > 0 ? 0 : settled_ + 1;
    if (line.converged()) {
      finish_instant(instant, previous, state, external, line);
      return iteration;
    }
    if (const auto left = iteration == last ? iterations_left(line) : std::nullopt; left && *left <= beyond) {
      ++last;
      --beyond;
    }
    const bool ends = iteration == last;
    const bool goes_nowhere = course_.wanders(ends ? in_vain_to_the_end : in_vain) || (ends && course_.drags(in_vain));
    const bool other_forces = (course_.period() || goes_nowhere || (course_.stands() && settled_ > drifting) ||
                               std::min(course_.growths(), settled_) >= drifting) &&
                              keep_covers_that_sway(instant, state, ends);
    if (std::exchange(other_covers_, false) || other_forces || line.pairs_anew) last = with_own_iterations(iteration);
    if (other_forces && iteration < last && std::isfinite(line.maxi)) {  // a failure has to tell their course
      course_.start();
      statuses_.start_instant();
    }
    const int done = iteration + 1;
    if (elsewhere_ &&
        Prediction::leads_astray(done, line.longest, forces_before, there.in_equilibrium() ? HUGE_VAL : there.longest))
      fail("EVOLUTION_49", {{"count", std::to_string(done)},
                            {"residual", fmt::format("{:.3g}", line.longest)},
                            {"start", fmt::format("{:.3g}", there.longest)}});
    forces_before = line.longest;
    changing = static_cast<std::size_t>(std::mismatch(before.begin(), before.end(), wanted.begin()).first - before.begin());
    settling = line.status_changes > 0 && !statuses_.keeps();
    bool other_matrix = choice_.note_residual({.largest = line.longest,
                                               .share = line.longest_share,
                                               .in_flow = equilibrium_.flows(previous),
                                               .statuses_change = line.status_changes > 0,
                                               .curved = equilibrium_.curves(state)});
    // with other forces these statuses have another equilibrium
    if (!other_forces && statuses_.keeps() && line.status_changes > 0 && line.in_equilibrium()) {
      state.patches.status = statuses_.change(state.patches.status, wanted);
      other_matrix = true;
      fail_if_endless(instant);
      last = with_own_iterations(iteration);
    }
    if (line.pairs_anew) choice_.forget_residual();
    if (other_matrix || other_forces || line.pairs_anew || creep_) assemble(state, previous, options_.matrix);
    if (!std::isfinite(line.maxi) || (!other_forces && hangs_on_nothing())) break;
  }
  fail_to_converge(instant, line, previous, changing);
}

void Newton::note_round_off() {
  if (found_.unbalanced == 0 || std::exchange(round_off_told_, true)) return;
  inform("EVOLUTION_69", {{"instant", fmt::format("{:.9g}", found_.instant)},
                          {"residual", fmt::format("{:.2g}", found_.unbalanced)},
                          {"asked", fmt::format("{:g}", *options_.criteria.resi_glob_rela)},
                          {"place", equilibrium_.place(found_.worst_dof)}});
}

void Newton::note_stability() {
  const Stability stability = stability_of(choice_.follows_unstable(), found_.negative, found_.constraints);
  unstable_path_.solve(stability != Stability::stable);
  // iterations without what makes a matrix unstable leave such an equilibrium, but not where symmetry keeps them on it
  const bool kept = found_.of_consistent && *found_.of_consistent > found_.constraints;
  if ((stability == Stability::stable && !kept) || std::exchange(unstable_told_, true)) return;
  const std::string instant = fmt::format("{:.9g}", found_.instant);
  if (stability == Stability::unknown) return inform("EVOLUTION_75", {{"instant", instant}});
  inform("EVOLUTION_54", {{"instant", instant},
                          {"negative", std::to_string(kept ? *found_.of_consistent : *found_.negative)},
                          {"constraints", std::to_string(found_.constraints)}});
}

void Newton::shorten(std::span<const double> solution, const StaticState& previous, StaticState& state,
                     std::vector<double>& increment) {
  const std::vector<double> at_rest(increment.size(), 0.0);
  const std::int64_t multipliers = equilibrium_.first_multiplier();
  std::optional<LineSearch> search = options_.line_search;
  if (!search && effort_ == Effort::searches) search = {.keeps_bracket = true};
  if (!search && goes_round_) search = {.keeps_bracket = true, .most = 1};
  bool flows = equilibrium_.flows(previous);
  double reached = 1;
  const auto power = [&](double part) {
    if (part != reached) {
      std::vector<double> back(solution.begin(), solution.end());
      if (search) std::fill(back.begin() + multipliers, back.end(), 0.0);
      for (double& value : back) value *= part - reached;
      const std::vector<double> moved = equilibrium_.add(back, at_rest, state);
      for (std::size_t i = 0; i < moved.size(); ++i) increment[i] += moved[i];
      reached = part;
    }
    equilibrium_.pair(state.displacement);
    equilibrium_.assemble(state, previous, {SolidMatrix::none, false});
    flows = flows || equilibrium_.flows(previous);
    return search || flows ? equilibrium_.power(solution) : 0;
  };
  // a search keeps the new multipliers: with the old ones forces of contact, which do work where gaps close, hide those that
  // count
  if (search) {
    const double start = power(0);
    part_without_power(*search, start, power);
  } else {
    // a patch that has just taken contact moves bodies whose forces are balanced
    part_of_increment(std::max(equilibrium_.power(solution), equilibrium_.resistance(solution)), power);
  }
}

void Newton::stay_shallow(std::span<const double> solution, std::span<const double> gaps, StaticState& state,
                          std::vector<double>& increment) {
  const double part = contact()->part_to_depth(state.patches, gaps, times_held_ > 0 ? deepest : through, deepest);
  if (!(part < 1)) return;
  std::vector<double> back(solution.begin(), solution.end());
  for (double& value : back) value *= part - 1;
  equilibrium_.add(back, std::vector<double>(increment.size(), 0.0), state);
  for (double& value : increment) value *= part;
  equilibrium_.pair(state.displacement);
}

void Newton::extrapolate(double instant, StaticState& state, std::vector<double>& step) {
  const bool asked = options_.extrapolates.value_or(false) && prediction_.reaches(state.displacement);
  elsewhere_ = !options_.extrapolates && (contact() || !equilibrium_.is_linear()) && !equilibrium_.strains_freely(state) &&
               !equilibrium_.has_new_gaps() && prediction_.serves(instant, state.displacement, step, equilibrium_.external());
  if (!asked && !elsewhere_) return;
  const KnownState there = prediction_.at(instant);
  for (std::size_t dof = 0; dof < step.size(); ++dof)
    state.displacement[dof] = problem_.imposed[dof] ? state.displacement[dof] + step[dof] : there.displacement[dof];
  for (std::size_t p = 0; elsewhere_ && p < state.patches.status.size(); ++p)
    if (state.patches.status[p] == Status::active && !contact()->is_locked(p))
      state.patches.lambda[p] = std::min(there.pressure[p], 0.0);
  std::fill(step.begin(), step.end(), 0.0);
  equilibrium_.pair(state.displacement);
}

std::vector<Status> Newton::wanted_statuses(const StaticState& state, IterationReport& line) {
  if (!contact()) return {};
  const Phase phase("pairing");
  Patchwise patches = state.patches;
  line.status_changes = contact()->update_statuses(patches);
  // in space an edge has other patches from iteration to iteration, whose pulls do not compare
  EdgeCourse* const course = problem_.dimension == 2 ? &edges_ : nullptr;
  if (!statuses_.keeps()) line.status_changes += contact()->open_behind_edges(state.patches.status, patches, course);
  return patches.status;
}

bool Newton::pairs_anew(const IterationReport& line, const StaticState& state, const StaticState& previous) {
  if (!contact() || line.status_changes > 0 || line.longest_share >= near_balance) return false;
  bool anew = false;
  // once as soon as it is near, and where it would be accepted
  if (times_left_out_ < most_times_anew && (!std::exchange(looked_far_, true) || line.in_equilibrium())) {
    const auto copy = [](std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); };
    const std::vector<double> gaps = copy(contact()->geometry().gaps()), covered = copy(contact()->geometry().measures());
    if (equilibrium_.choose_masters()) {
      anew = contact()->presses_otherwise(gaps, covered, state.patches);
      if (!anew) assemble(state, previous, options_.matrix);
    }
    times_left_out_ += anew ? 1 : 0;
  }
  if (times_cut_ < most_times_anew && contact()->geometry().keeps_cuts()) {
    ++times_cut_;
    equilibrium_.renew_cuts();
    equilibrium_.pair(state.displacement);
    anew = true;
  }
  return anew;
}

bool Newton::parts_a_zone(const std::vector<Status>& before, const std::vector<Status>& wanted) const {
  std::map<std::int32_t, bool> stays;  // of the zones that touched
  for (std::size_t p = 0; p < before.size(); ++p)
    if (before[p] == Status::active) stays.try_emplace(contact()->geometry().zone_of(p), false);
  for (std::size_t p = 0; p < wanted.size(); ++p)
    if (const auto zone = stays.find(contact()->geometry().zone_of(p)); zone != stays.end() && wanted[p] == Status::active)
      zone->second = true;
  return std::ranges::any_of(stays, [](const auto& zone) { return !zone.second; });
}

}  // namespace lacon
