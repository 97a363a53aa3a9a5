#include "lacon/operators/stat_non_line/stat_non_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <iostream>
#include <memory>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/newton/linear_solver.hpp"
#include "lacon/operators/evolution/newton/newton.hpp"
#include "lacon/operators/evolution/observers/archive.hpp"
#include "lacon/operators/evolution/observers/contact_notices.hpp"
#include "lacon/operators/evolution/observers/energy_balance.hpp"
#include "lacon/operators/evolution/observers/failed_step.hpp"
#include "lacon/operators/evolution/observers/interruption.hpp"
#include "lacon/operators/evolution/observers/journal.hpp"
#include "lacon/operators/evolution/observers/motion_notices.hpp"
#include "lacon/operators/evolution/observers/progress.hpp"
#include "lacon/operators/evolution/observers/restart.hpp"
#include "lacon/operators/evolution/observers/step_events.hpp"
#include "lacon/operators/evolution/observers/table.hpp"
#include "lacon/operators/evolution/problem/reference_forces.hpp"
#include "lacon/operators/evolution/time_stepping.hpp"
#include "lacon/operators/program/checking.hpp"
#include "lacon/operators/program/ending.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/openblas.hpp"

namespace lacon {
namespace {

SolidMatrix matrix_of(const std::string& name) { return name == "ELASTIQUE" ? SolidMatrix::elastic : SolidMatrix::tangent; }

std::optional<LineSearch> line_search_of(const Keywords& keywords) {
  if (!keywords.has("RECH_LINEAIRE")) return std::nullopt;
  const Keywords search = keywords.factor("RECH_LINEAIRE");
  if (!(search.real("RHO_MIN") <= search.real("RHO_MAX")))
    fail("EVOLUTION_57",
         {{"least", fmt::format("{:g}", search.real("RHO_MIN"))}, {"most", fmt::format("{:g}", search.real("RHO_MAX"))}});
  return LineSearch{.keeps_bracket = search.text("METHODE") == "MIXTE",
                    .accepted = search.real("RESI_LINE_RELA"),
                    .iterations = static_cast<int>(search.integer("ITER_LINE_MAXI")),
                    .least = search.real("RHO_MIN"),
                    .most = search.real("RHO_MAX"),
                    .excluded = search.real("RHO_EXCL")};
}

/// A count with so many percent more, at most what an int holds.
int with_percent(int count, std::int64_t percent) {
  return static_cast<int>(std::min(count * (1.0 + static_cast<double>(percent) / 100), static_cast<double>(INT_MAX)));
}

NewtonOptions newton_options(const Keywords& keywords, const TimeSteps& steps, const StaticProblem& problem) {
  const Keywords convergence = keywords.factor("CONVERGENCE"), newton = keywords.factor("NEWTON");
  const SolidMatrix matrix = matrix_of(newton.text("MATRICE"));
  const std::string prediction = newton.has("PREDICTION") ? newton.text("PREDICTION") : "";
  const auto iterations = static_cast<int>(convergence.integer("ITER_GLOB_MAXI"));
  return {.criteria = {.resi_glob_rela = convergence.optional_real("RESI_GLOB_RELA"),
                       .resi_glob_maxi = convergence.optional_real("RESI_GLOB_MAXI"),
                       .resi_refe_rela = convergence.optional_real("RESI_REFE_RELA")},
          .reference_forces = convergence.has("RESI_REFE_RELA") ? reference_forces(problem, convergence.real("SIGM_REFE"),
                                                                                   convergence.optional_real("EFFORT_REFE"))
                                                                : std::vector<double>(),
          .iterations = with_percent(iterations, steps.more_iterations),
          .matrix = matrix,
          .prediction = prediction == "EXTRAPOLE" ? matrix : matrix_of(prediction),
          .extrapolates = prediction.empty() ? std::nullopt : std::optional(prediction == "EXTRAPOLE"),
          .start = steps.values.front(),
          .line_search = line_search_of(keywords),
          .cuts = steps.action.cut};
}

TimeSteps steps_of(const Keywords& increment, const Base& base, std::optional<double> origin) {
  return restrict(base.time_steps(increment.concept_id("LIST_INST")),
                  {.initial_state = origin,
                   .first_instant = increment.optional_real("INST_INIT"),
                   .last_instant = increment.optional_real("INST_FIN"),
                   .first_number = increment.optional_integer("NUME_INST_INIT"),
                   .last_number = increment.optional_integer("NUME_INST_FIN"),
                   .precision = increment.real("PRECISION")});
}

/// Equilibrium at each instant by Newton's method.
class QuasiStatic : public InstantSolver {
 public:
  QuasiStatic(const StaticProblem& problem, const NewtonOptions& options, std::unique_ptr<Engine> engine)
      : newton_(problem, options, std::move(engine)), state_(newton_.initial_state()), last_(state_) {}

  /// Start from a state of another computation. @param label of its result
  void begin(StaticState state, const std::string& label, bool as_given = false) {
    state_ = std::move(state);
    newton_.begin(state_, label, as_given);
    last_ = state_;
  }
  int solve(double instant, const std::function<void(const IterationReport&)>& report) override {
    return newton_.solve(instant, state_, report);
  }
  void accept() override {
    newton_.accept(state_);
    rest_ = std::move(last_.displacement);
    last_ = state_;
  }
  void go_back() override {
    state_ = last_;
    newton_.restart(state_);
  }
  bool take(Effort effort) override { return newton_.take(effort); }
  void save(const hdf5::Group& group) const override {
    write(group.create("state"), state_);
    group.write("rest", rest_);
    if (newton_.origin()) write(group.create("origin"), *newton_.origin());
    newton_.save(group);
  }
  std::int64_t number_of_base() const override { return newton_.solver().base_number(); }
  void save_base(const hdf5::Group& group) const override { newton_.solver().save_base(group); }
  void resume(const hdf5::Group& group, const hdf5::Group* base) override {
    const auto read = [&](const char* name) {
      StaticState state = read_state(group.open(name));
      newton_.hand_out(state);
      return state;
    };
    state_ = last_ = read("state");
    rest_ = group.read<double>("rest");
    if (group.has("origin")) newton_.start_from(read("origin"));
    newton_.resume(group, base, state_, rest_);
  }
  const ConvergenceCriteria& criteria() const { return newton_.criteria(); }
  Present present(const StaticProblem& problem) const {
    return {problem, state_, newton_.contact(), [this] { return newton_.internal_forces(state_); },
            [this] { return newton_.unbalanced(); }};
  }

 private:
  Newton newton_;
  StaticState state_, last_;
  std::vector<double> rest_;  ///< displacements at the instant before the last
};

/// STEP_7: instants behind the last one that ARCHIVAGE or OBSERVATION asks for. Those before the first one a computation that
/// this one goes on with may have had.
void tell_instants_behind(const Keywords& keywords, const Base& base, double last) {
  for (const char* name : {"ARCHIVAGE", "OBSERVATION"})
    for (const Keywords& occurrence : keywords.factors(name)) {
      const char* keyword = occurrence.has("INST") ? "INST" : "LIST_INST";
      if (!occurrence.has(keyword)) continue;
      std::vector<double> instants =
          occurrence.has("INST") ? occurrence.reals(keyword) : base.list_of_reals(occurrence.concept_id(keyword));
      const double near = occurrence.real("PRECISION") * (occurrence.text("CRITERE") == "RELATIF" ? std::abs(last) : 1.0);
      std::erase_if(instants, [&](double instant) { return instant <= last + near; });
      if (!instants.empty())
        inform("STEP_7", {{"keyword", occurrence.path(keyword)},
                          {"count", std::to_string(instants.size())},
                          {"instant", fmt::format("{:.9g}", std::ranges::min(instants))},
                          {"last", fmt::format("{:.9g}", last)}});
    }
}

/// Throws what loads without a value at the first instant or the last one are refused for.
void check_loads(const StaticProblem& problem, const StaticState& state, const TimeSteps& steps) {
  for (const double instant : {steps.values[std::min<std::size_t>(1, steps.values.size() - 1)], steps.values.back()}) {
    problem.external_force(instant, state.displacement);
    problem.imposed_values(instant);
    for (const TimedLoad& load : problem.loads) load.relation_values.at(instant);
  }
}

}  // namespace

void stat_non_line(const Order& order, const Base& base) {
  reserve_blas_memory();
  const Keywords& keywords = order.keywords;
  const StaticProblem problem = [&] {
    const Phase phase("read");
    return read_problem(order, base);
  }();
  const std::optional<hdf5::Reader> record = restart_record(order, base);
  const std::optional<Origin> origin = record ? std::nullopt : origin_of(keywords, base);
  const std::optional<double> begins = record ? origin_in(*record) : origin ? std::optional(origin->instant) : std::nullopt;
  const TimeSteps steps = steps_of(keywords.factor("INCREMENT"), base, begins);
  tell_missing_instants(keywords, base, steps.values);
  tell_instants_behind(keywords, base, steps.values.back());
  QuasiStatic solver(problem, newton_options(keywords, steps, problem), engine_of(keywords.factor("SOLVEUR"), base, problem));
  const Present present = solver.present(problem);
  Observations observations(keywords, base, problem.mesh, observed_fields_of(present));
  EnergyBalance energies(keywords.has("ENERGIE"), present);
  const auto tables = [&] {
    std::map<std::string, Table> kept;
    if (const auto& observed = observations.table()) kept["OBSERVATION"] = *observed;
    if (const auto& works = energies.table()) kept["PARA_CALC"] = *works;
    return kept;
  };
  Archive archive(order, base, present, origin, tables, record.has_value());
  if (origin)
    solver.begin(archived_state(problem, base, origin->result, origin->order), origin->result.label);
  else if (!record && keywords.has("ETAT_INIT"))
    solver.begin(given_state(problem, base, keywords.factor("ETAT_INIT")), "ETAT_INIT", true);
  else if (!record)
    Heat(problem).warn_of_start(present.state);

  NewtonTable table(std::cout, present, keywords.factor("AFFICHAGE").yes("INFO_RESIDU"),
                    solver.criteria().resi_refe_rela.has_value(), keywords.integer("INFO") == 2);
  StepEvents events(steps.events, base, problem.mesh, fields_of(present));
  ContactNotices notices(present);
  MotionNotices motions(present);
  RestartRecord restart(base, begins, solver, archive,
                        {{"archive", &archive},
                         {"energies", &energies},
                         {"events", &events},
                         {"motions", &motions},
                         {"notices", &notices},
                         {"observations", &observations}});
  if (only_checks()) {
    check_loads(problem, present.state, steps);
    if (record) return;  // whose state is read where the run goes on
    observations.start(steps.values.front());
    events.start(steps.values.front());
    return;
  }
  Interruption interruption;
  wait_with_ending();
  const Course past = record ? restart.go_on(*record) : Course();
  const double start = reached(past, steps.values.front());
  FailedStep failed_step(order, base, present, start, steps.values.back());
  Journal journal(base.result_folder(), steps, start, solver.criteria(), present);
  Progress progress(steps.values);
  // what is told as converged is in the base
  const std::array<EvolutionObserver*, 12> observers{&observations, &energies,    &notices, &motions, &archive,  &restart,
                                                     &table,        &failed_step, &journal, &events,  &progress, &interruption};
  try {
    evolve(steps, solver, observers, past);
  } catch (const Error& error) {
    failed_step.tell(error);
  }
  notices.fail_if_all_missed();
}

}  // namespace lacon
