#include "lacon/operators/meca_statique/meca_statique.hpp"

#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/newton/linear_solver.hpp"
#include "lacon/operators/evolution/newton/newton.hpp"
#include "lacon/operators/evolution/state_fields.hpp"
#include "lacon/operators/program/checking.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/openblas.hpp"

namespace lacon {
namespace {

// A linear problem is solved by its first iteration; the second one improves what a badly conditioned matrix leaves.
constexpr int iterations = 3;
constexpr double residual = 1e-6;      // of the largest force
constexpr double same_instant = 1e-6;  // of INST_FIN

std::vector<double> instants_of(const Keywords& keywords, const Base& base) {
  if (!keywords.has("LIST_INST")) return {keywords.real("INST")};
  std::vector<double> instants = base.time_steps(keywords.concept_id("LIST_INST")).values;
  if (const auto last = keywords.optional_real("INST_FIN"))
    std::erase_if(instants, [&](double instant) { return instant > *last + same_instant * std::abs(*last); });
  if (instants.empty()) fail("EVOLUTION_34", {{"keyword", keywords.path("INST_FIN")}});
  return instants;
}

Result empty_result(const Order& order, const StaticProblem& problem) {
  const Keywords& keywords = order.keywords;
  Result result;
  result.label = order.result_label;
  result.model = keywords.concept_id("MODELE");
  result.mesh = problem.model.mesh;
  result.material_field = keywords.concept_id("CHAM_MATER");
  for (const Keywords& excit : keywords.factors("EXCIT"))
    result.stages.front().loads.push_back(
        {excit.concept_id("CHARGE"), excit.optional_concept("FONC_MULT").value_or(""), excit.text("TYPE_CHARGE")});
  return result;
}

}  // namespace

void meca_statique(const Order& order, const Base& base) {
  reserve_blas_memory();
  const Keywords& keywords = order.keywords;
  const StaticProblem problem = [&] {
    const Phase phase("read");
    return read_problem(order, base);
  }();
  const std::vector<double> instants = instants_of(keywords, base);
  Newton newton(
      problem,
      {.criteria = {.resi_glob_rela = residual}, .iterations = iterations, .start = instants.front(), .from_reference = true},
      engine_of(keywords.factor("SOLVEUR"), base, problem));
  StaticState state = newton.initial_state();
  if (only_checks()) return;
  Result result = empty_result(order, problem);
  for (const double instant : instants) {
    newton.solve(instant, state, [](const IterationReport&) {});
    const std::int64_t number = static_cast<std::int64_t>(result.orders.size()) + 1;
    const auto add = [&](FieldRows rows) {
      rows.field.order = number;
      rows.field.instant = instant;
      base.add_field(result, std::move(rows));
    };
    add(displacement_field(problem, state));
    if (keywords.text("OPTION") == "SIEF_ELGA") add(stress_field(problem, state));
    result.orders.push_back(number);
    result.instants.push_back(instant);
    fmt::print("  {:>4}  instant {:.9g}\n", number, instant);
  }
  base.store(result);
}

}  // namespace lacon
