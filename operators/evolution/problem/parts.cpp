#include "lacon/operators/evolution/problem/parts.hpp"

#include <algorithm>
#include <string>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/program/checking.hpp"
#include "lacon/operators/program/program.hpp"

namespace lacon {
namespace {

/// What only one process can do; empty where there is nothing.
std::string_view needs_one_process(const StaticProblem& problem) {
  if (problem.n_components() != problem.dimension) return "parts_no_other_unknowns";
  if (symmetry_of(problem) == Symmetry::general) return "parts_no_general_matrix";
  const bool is_flat = std::ranges::any_of(
      problem.solids, [&](const ElementSet& set) { return catalog::cell(set.row->cell).dimension != problem.mesh.dimension; });
  return is_flat ? "parts_no_flat_cells" : "";
}

}  // namespace

Symmetry symmetry_of(const StaticProblem& problem) {
  const bool exact_gap = problem.dimension == 2 && problem.contact && !problem.contact->frozen_gap;
  const bool unsymmetric =
      std::any_of(problem.solids.begin(), problem.solids.end(), [](const ElementSet& set) { return set.kernel->unsymmetric; });
  return exact_gap && unsymmetric ? Symmetry::general : Symmetry::symmetric;
}

std::shared_ptr<SolidParts> parts_of(const StaticProblem& problem, const Engine& engine) {
  const std::shared_ptr<PartProcesses> processes = engine.processes(problem.numbering.n_equations());
  if (!processes || processes->size() == 1 || only_checks()) return nullptr;
  if (const std::string_view reason = needs_one_process(problem); !reason.empty()) {
    inform("EVOLUTION_46", {{"reason", part(reason)}, {"count", std::to_string(processes->size())}});
    return nullptr;
  }
  const Phase phase("cells to processes");
  auto parts = std::make_shared<SolidParts>(processes, problem.mesh, problem.solids, problem.numbering, problem.components,
                                            problem.plugins);
  add_to_count("processes with cells", processes->size());
  if (processes->machines() > 1) add_to_count("machines", processes->machines());
  add_to_count("cells of two processes or more", static_cast<double>(parts->n_shared()));
  return parts;
}

}  // namespace lacon
