#include "lacon/operators/stat_non_line/stat_non_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <limits>
#include <set>

#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/archive.hpp"
#include "lacon/operators/evolution/newton.hpp"
#include "lacon/operators/evolution/observation.hpp"
#include "lacon/operators/evolution/table.hpp"
#include "lacon/operators/evolution/time_stepping.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/program/program.hpp"

namespace lacon {
namespace {

template <class Get>
auto optional(const Keywords& keywords, std::string_view name, Get get) -> std::optional<decltype((keywords.*get)(name))> {
  if (!keywords.has(name)) return std::nullopt;
  return (keywords.*get)(name);
}

/// The one occurrence of a factor keyword whose defaults the launcher fills in.
Keywords single(const Keywords& keywords, std::string_view name) {
  const std::vector<Keywords> occurrences = keywords.factors(name);
  if (occurrences.size() != 1) fail("ORDER_4", {{"keyword", keywords.path(name)}, {"expected", "given once"}});
  return occurrences.front();
}

SolidMatrix matrix_of(const std::string& name) { return name == "ELASTIQUE" ? SolidMatrix::elastic : SolidMatrix::tangent; }

NewtonCriteria criteria_of(const Keywords& convergence, const Keywords& newton) {
  return {.resi_glob_rela = optional(convergence, "RESI_GLOB_RELA", &Keywords::real),
          .resi_glob_maxi = optional(convergence, "RESI_GLOB_MAXI", &Keywords::real),
          .iterations = static_cast<int>(convergence.integer("ITER_GLOB_MAXI")),
          .matrix = matrix_of(newton.text("MATRICE")),
          .prediction = matrix_of(newton.text("PREDICTION"))};
}

TimeSteps steps_of(const Keywords& increment, const Base& base, std::optional<double> initial_state) {
  return restrict(base.time_steps(increment.concept_id("LIST_INST")),
                  {.initial_state = initial_state,
                   .first_instant = optional(increment, "INST_INIT", &Keywords::real),
                   .last_instant = optional(increment, "INST_FIN", &Keywords::real),
                   .first_number = optional(increment, "NUME_INST_INIT", &Keywords::integer),
                   .last_number = optional(increment, "NUME_INST_FIN", &Keywords::integer),
                   .precision = increment.real("PRECISION")});
}

/// ETAT_INIT: where a computation starts from another one.
struct Origin {
  Result result;
  std::int64_t order;
  double instant;
};

std::optional<Origin> origin_of(const Keywords& keywords, const Base& base) {
  if (!keywords.has("ETAT_INIT")) return std::nullopt;
  const Keywords from = single(keywords, "ETAT_INIT");
  Origin origin{base.result(from.concept_id("EVOL_NOLI")), 0, 0};
  const std::vector<std::int64_t> orders = selected_orders(base, origin.result, from);
  origin.order = orders.back();
  const std::vector<std::int64_t>& all = origin.result.orders;
  origin.instant = origin.result.instants[std::find(all.begin(), all.end(), origin.order) - all.begin()];
  if (from.has("INST_ETAT_INIT")) origin.instant = from.real("INST_ETAT_INIT");
  return origin;
}

/// Which instants and fields are kept. The first and the last instant always are.
class Archiving {
 public:
  Archiving(const Keywords& keywords, const Base& base) : instants_(keywords, base, "PAS_ARCH") {
    for (const std::string& name : keywords.texts("CHAM_EXCLU")) excluded_.insert(name);
  }
  bool keeps(double instant, std::int64_t step) const { return instants_.has(instant, step); }
  bool keeps(const std::string& field) const { return !excluded_.contains(field); }

 private:
  ChosenInstants instants_;
  std::set<std::string> excluded_;
};

/// The fields of the instant that was solved last.
FieldMakers fields_at(const StaticProblem& problem, const StaticState& state, const Newton& newton) {
  FieldMakers fields;
  fields["DEPL"] = [&] { return displacement_field(problem, state); };
  fields["SIEF_ELGA"] = [&] { return stress_field(problem, state); };
  if (Field variables = variable_field(problem, state); !variables.components.empty())
    fields["VARI_ELGA"] = [&] { return variable_field(problem, state); };
  if (const ContactState* contact = newton.contact())
    fields["CONT_ELEM"] = [&, contact] { return contact_field(problem, state, *contact); };
  return fields;
}

/// Negative pivots of the last factorisation of an instant, and how many were to be expected; -1 where nothing was factorised.
struct Pivots {
  std::int64_t found = -1, expected = -1;
};

/// The result as it grows.
class Archive {
 public:
  Archive(const Order& order, const Base& base, const StaticProblem& problem, const std::optional<Origin>& origin)
      : base_(base) {
    const Keywords& keywords = order.keywords;
    result_.label = order.result_label;
    result_.model = keywords.concept_id("MODELE");
    result_.mesh = problem.model.mesh;
    result_.material_field = keywords.concept_id("CHAM_MATER");
    result_.contact = keywords.optional_concept("CONTACT").value_or("");
    for (const Keywords& excit : keywords.factors("EXCIT"))
      result_.loads.push_back(
          {excit.concept_id("CHARGE"), excit.optional_concept("FONC_MULT").value_or(""), excit.text("TYPE_CHARGE")});
    result_.behaviour = keywords.values().value("COMPORTEMENT", nlohmann::json::array()).dump();
    if (order.reuse || keywords.has("RESULTAT")) go_on(order, origin);
  }

  /// reuse: take over the instants up to the initial state. Throws EVOLUTION_12.
  void go_on(const Order& order, const std::optional<Origin>& origin) {
    const auto refuse = [&](const std::string& reason, const std::string& remedy) {
      fail("EVOLUTION_12", {{"label", result_.label}, {"reason", reason}, {"remedy", remedy}});
    };
    const std::string another = "give the computation a result of its own, without reuse";
    if (!order.reuse) refuse("RESULTAT without reuse", "give reuse as well, or leave RESULTAT out");
    if (!origin || single(order.keywords, "ETAT_INIT").concept_id("EVOL_NOLI") != order.result_id)
      refuse("ETAT_INIT does not start from this result", "give ETAT_INIT=_F(EVOL_NOLI=" + result_.label + ")");
    const Result& old = origin->result;
    const auto differs = [&](const std::string& what) {
      refuse("it was computed with another " + what + ", and has one alone", another);
    };
    if (old.model != result_.model) differs("MODELE");
    if (old.material_field != result_.material_field) differs("CHAM_MATER");
    if (old.contact != result_.contact) differs("CONTACT");
    if (old.behaviour != result_.behaviour) differs("COMPORTEMENT");
    if (!std::equal(
            old.loads.begin(), old.loads.end(), result_.loads.begin(), result_.loads.end(),
            [](const auto& a, const auto& b) { return a.load == b.load && a.function == b.function && a.type == b.type; }))
      differs("EXCIT");
    std::vector<std::int64_t> orders = old.orders;
    orders.erase(std::upper_bound(orders.begin(), orders.end(), origin->order), orders.end());
    if (orders.size() < old.orders.size() && !single(order.keywords, "ARCHIVAGE").has("DETR_NUME_SUIV"))
      refuse(fmt::format("it has {} instant(s) behind order {}", old.orders.size() - orders.size(), origin->order),
             "give ARCHIVAGE=_F(DETR_NUME_SUIV='OUI') to remove them, or " + another);
    const auto fields = old.fields;
    result_ = part_of(old, orders);
    for (const auto& [name, files] : fields)
      for (const auto& [number, file] : files)
        if (number <= origin->order) result_.fields[name][number] = file;
    taken_over_ = result_.orders.size();
    if (const auto observed = result_.tables.find("OBSERVATION"); observed != result_.tables.end())
      drop_behind(observed->second, result_.instants.back());
  }

  void add(double instant, int iterations, const Pivots& pivots, const StaticState& state, const FieldMakers& fields,
           const ContactState* contact, const Archiving& archiving) {
    const Phase phase("archive");
    const std::int64_t number = result_.orders.empty() ? 0 : result_.orders.back() + 1;
    for (const auto& [name, make] : fields) {
      if (!archiving.keeps(name)) continue;
      Field field = make();
      field.order = number;
      field.instant = instant;
      base_.add_field(result_, std::move(field));
    }
    if (contact) add_balance(contact->balance(state.patches));
    put("newton_iterations", iterations);
    put("negative_pivots", static_cast<double>(pivots.found));
    put("expected_negative_pivots", static_cast<double>(pivots.expected));
    result_.orders.push_back(number);
    result_.instants.push_back(instant);
  }
  /// The proof lines as parameters of the instant: zone_1_slave_force_x, ...
  void add_balance(const std::vector<ZoneBalance>& zones) {
    for (std::size_t z = 0; z < zones.size(); ++z) {
      const std::string name = "zone_" + std::to_string(z + 1) + "_";
      const auto put = [&](const std::string& what, double value) { this->put(name + what, value); };
      for (int d = 0; d < 3; ++d) {
        const std::string axis(1, "xyz"[d]);
        put("slave_force_" + axis, zones[z].on_slave[d]);
        put("master_force_" + axis, zones[z].on_master[d]);
        put("moment_" + axis, zones[z].moment[d]);
      }
      put("active", static_cast<double>(zones[z].active));
      put("open", static_cast<double>(zones[z].open));
      put("unpaired", static_cast<double>(zones[z].unpaired));
      put("covered", zones[z].covered);
      put("whole", zones[z].whole);
      put("largest_lambda_gap", zones[z].work);
    }
  }
  void store(const std::optional<Table>& observed) {
    if (observed) add_observed(*observed);
    base_.store(result_);
  }
  void discard() const {
    if (taken_over_ == 0) base_.discard(result_);
  }
  /// Instants of this computation, without its initial state.
  std::size_t n_solved() const { return result_.orders.size() - std::max<std::size_t>(taken_over_, 1); }
  /// The initial state is an instant of the result that goes on.
  bool has_initial_state() const { return taken_over_ > 0; }

 private:
  /// Remove the rows of a table whose INST is behind an instant.
  static void drop_behind(Table& table, double instant) {
    const auto named = [](const Table::Column& column) { return column.name == "INST"; };
    const std::vector<Table::Cell> instants = std::find_if(table.columns.begin(), table.columns.end(), named)->cells;
    for (Table::Column& column : table.columns) {
      std::vector<Table::Cell> kept;
      for (std::size_t row = 0; row < instants.size(); ++row)
        if (std::get<double>(instants[row]) <= instant) kept.push_back(column.cells[row]);
      column.cells = std::move(kept);
    }
  }
  /// Behind what the result that goes on has observed; NUME_REUSE counts its computations.
  void add_observed(const Table& observed) {
    const auto [at, first] = result_.tables.try_emplace("OBSERVATION", observed);
    if (first) return;
    for (std::size_t c = 0; c < observed.columns.size(); ++c) {
      Table::Column& column = at->second.columns[c];
      std::vector<Table::Cell> cells = observed.columns[c].cells;
      if (column.name == "NUME_REUSE" && !column.cells.empty())
        cells.assign(cells.size(), std::get<std::int64_t>(column.cells.back()) + 1);
      column.cells.insert(column.cells.end(), cells.begin(), cells.end());
    }
  }
  void put(const std::string& parameter, double value) { result_.parameters[parameter].push_back(value); }

  const Base& base_;
  Result result_;
  std::size_t taken_over_ = 0;  ///< instants of a result that goes on
};

}  // namespace

void stat_non_line(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const Keywords solver = single(keywords, "SOLVEUR");
  StaticProblem problem = [&] {
    const Phase phase("read");
    return read_problem(order, base);
  }();
  const std::optional<Origin> origin = origin_of(keywords, base);
  const TimeSteps steps = steps_of(single(keywords, "INCREMENT"), base, origin ? std::optional(origin->instant) : std::nullopt);
  const Archiving archiving(single(keywords, "ARCHIVAGE"), base);
  NewtonCriteria criteria = criteria_of(single(keywords, "CONVERGENCE"), single(keywords, "NEWTON"));
  criteria.iterations += static_cast<int>(criteria.iterations * steps.more_iterations / 100);
  Newton newton(problem, criteria,
                std::make_unique<MumpsEngine>(MumpsOptions{.memory_margin = static_cast<int>(solver.integer("PCENT_PIVOT")),
                                                           .residual_tolerance = solver.real("RESI_RELA")}));
  NewtonTable table(std::cout, problem, single(keywords, "AFFICHAGE").yes("INFO_RESIDU"), keywords.integer("INFO") == 2);

  Archive archive(order, base, problem, origin);
  StaticState state = newton.initial_state();
  if (origin) {
    state = archived_state(problem, base, origin->result, origin->order);
    newton.begin(state, origin->result.label);
  }
  StaticState last = state;
  if (const ContactState* contact = newton.contact()) {
    std::int64_t locked = 0, first = -1;
    for (std::size_t p = 0; p < contact->n_patches(); ++p)
      if (contact->coverage(p) > 0 && contact->is_locked(p)) {
        if (locked++ == 0) first = problem.mesh.patches->cells[p].front();
      }
    if (locked) inform("EVOLUTION_6", {{"count", std::to_string(locked)}, {"cell", cell_name(first)}});
  }
  Observations observations(keywords, base, problem.mesh);
  const FieldMakers fields = fields_at(problem, state, newton);
  observations.start(steps.values.front(), fields);
  if (!archive.has_initial_state()) archive.add(steps.values.front(), 0, {}, state, fields, newton.contact(), archiving);

  std::vector<IncrementLimit> increments;
  double largest_residual = std::numeric_limits<double>::infinity();
  bool may_diverge = true;
  for (const StepEvent& event : steps.events) {
    if (event.event == "RESI_MAXI")
      largest_residual = event.limit;
    else if (event.event == "DIVE_RESI")
      may_diverge = false;
    else
      increments.emplace_back(event, base, problem.mesh).accept(fields);
  }

  int iterations = 0;
  Pivots pivots;
  std::int64_t step = 0;
  const auto solve = [&](double instant) {
    table.start(instant);
    pivots = {};
    std::array<double, 2> before{};  // residuals of the last iterations, the latest first
    iterations = newton.solve(instant, state, [&](const IterationReport& report) {
      table.line(report);
      if (report.maxi > largest_residual)
        fail("STEP_1", {{"residual", fmt::format("{:.6g}", report.maxi)},
                        {"limit", fmt::format("{:.6g}", largest_residual)},
                        {"instant", fmt::format("{:.9g}", instant)}});
      if (!may_diverge && report.iteration >= 2 && std::min(report.maxi, before[0]) > before[1])
        fail("STEP_4", {{"residual", fmt::format("{:.6g}", report.maxi)},
                        {"before", fmt::format("{:.6g}, {:.6g}", before[1], before[0])},
                        {"instant", fmt::format("{:.9g}", instant)}});
      before = {report.maxi, before[0]};
      if (const auto& found = report.solution.factorisation.negative_pivots) pivots = {*found, report.constraints};
    });
    for (const IncrementLimit& increment : increments) increment.check(fields, instant);
  };
  const auto go_back = [&] {
    state = last;
    newton.restart(state);
  };
  const auto solved = [&](double instant, bool asked) {
    table.finish(instant, iterations, state, newton.contact());
    if (const ContactState* contact = newton.contact())
      if (const HeldOverlap overlap = contact->held_overlap(); overlap.count > 0)
        inform("EVOLUTION_14", {{"count", std::to_string(overlap.count)},
                                {"instant", fmt::format("{:.9g}", instant)},
                                {"cell", cell_name(problem.mesh.patches->cells[overlap.deepest].front())},
                                {"gap", fmt::format("{:.6g}", overlap.gap)}});
    last = state;
    for (IncrementLimit& increment : increments) increment.accept(fields);
    step += asked;
    if (archiving.keeps(instant, step) || instant == steps.values.back())
      archive.add(instant, iterations, pivots, state, fields, newton.contact(), archiving);
    observations.observe(instant, step, fields);
  };
  try {
    step_through(steps, solve, go_back, solved, [&] { return iterations; });
  } catch (...) {
    // what was computed before the failure is not lost; without it the base stays as it was
    if (archive.n_solved() > 0)
      archive.store(observations.table());
    else
      archive.discard();
    throw;
  }
  archive.store(observations.table());
}

}  // namespace lacon
