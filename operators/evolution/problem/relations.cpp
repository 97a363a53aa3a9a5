#include "lacon/operators/evolution/problem/relations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/problem/dependent_relations.hpp"

namespace lacon {
namespace {

constexpr double contradiction = 1e-9;  // of the largest term: coordinates that coefficients come from may have ten digits

}  // namespace

Relations::Relations(const StaticProblem& problem) : problem_(problem) {
  std::vector<FreeRow> rows;
  for (const TimedLoad& load : problem.loads)
    for (const DofRelation& row : load.relations) {
      relations_.push_back({&load, &row, {}});
      FreeRow& free = rows.emplace_back();
      for (std::size_t i = 0; i < row.dofs.size(); ++i)
        if (problem.numbering.equation[row.dofs[i]] >= 0) {
          free.unknowns.push_back(row.dofs[i]);
          free.coefficients.push_back(row.coefficients[i]);
        }
    }
  for (DependentRelation& follows : dependent_relations(rows)) relations_[follows.relation].sum_of = std::move(follows.sum_of);
}

std::int64_t Relations::n_constraints() const {
  return std::count_if(relations_.begin(), relations_.end(), [](const Held& held) { return !held.sum_of; });
}

std::int64_t Relations::unknown(std::size_t relation, const System& system) const {
  return system.multiplier(problem_.n_patches() + static_cast<std::int64_t>(relation));
}

std::string Relations::name(std::size_t relation) const {
  return part("relation_of", {{"load", relations_[relation].load->label}, {"source", relations_[relation].row->source}});
}

void Relations::tell_dependent() const {
  const auto is_dependent = [](const Held& held) { return held.sum_of.has_value(); };
  const auto first = std::ranges::find_if(relations_, is_dependent);
  if (first == relations_.end()) return;
  inform("EVOLUTION_77", {{"count", std::to_string(std::ranges::count_if(relations_, is_dependent))},
                          {"relation", name(static_cast<std::size_t>(first - relations_.begin()))},
                          {"dof", problem_.dof_name(first->row->dofs.front())}});
}

std::vector<Coupling> Relations::couplings() const {
  std::vector<Coupling> couplings;
  const std::int64_t first = problem_.numbering.n_nodes + problem_.n_patches();
  for (std::size_t r = 0; r < relations_.size(); ++r)
    for (const std::int64_t dof : relations_[r].row->dofs)
      couplings.push_back({static_cast<std::int32_t>(first + static_cast<std::int64_t>(r)),
                           static_cast<std::int32_t>(dof / problem_.n_components())});
  return couplings;
}

void Relations::assemble(std::span<const double> multipliers, std::span<const double> displacement, System& system) const {
  std::vector<std::int64_t> unknowns;
  std::vector<double> matrix, residual;
  for (std::size_t r = 0; r < relations_.size(); ++r) {
    const std::vector<std::int64_t>& dofs = relations_[r].row->dofs;
    const std::vector<double>& coefficients = relations_[r].row->coefficients;
    if (relations_[r].sum_of) {
      system.add_diagonal(unknown(r, system), 1.0);
      system.residual()[unknown(r, system)] = multipliers[r];
      continue;
    }
    unknowns = dofs;
    unknowns.push_back(unknown(r, system));
    const std::size_t n = dofs.size();
    matrix.assign((n + 1) * (n + 2) / 2, 0.0);
    residual.assign(n + 1, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      matrix[n * (n + 1) / 2 + i] = coefficients[i];
      residual[i] = multipliers[r] * coefficients[i];
      residual[n] += coefficients[i] * displacement[dofs[i]];
    }
    system.add(unknowns, matrix, residual);
  }
}

std::vector<double> Relations::forces(std::span<const double> multipliers) const {
  std::vector<double> sum(problem_.n_dofs(), 0.0);
  for (std::size_t r = 0; r < relations_.size(); ++r)
    for (std::size_t i = 0; i < relations_[r].row->dofs.size(); ++i)
      sum[relations_[r].row->dofs[i]] += multipliers[r] * relations_[r].row->coefficients[i];
  return sum;
}

std::vector<double> Relations::values(double instant, std::span<const double> imposed) const {
  std::vector<double> values;
  for (const TimedLoad& load : problem_.loads) {
    if (load.relations.empty()) continue;
    const double factor = load.multiplier(instant);
    for (const double value : load.relation_values.at(instant)) values.push_back(factor * value);
  }
  const std::vector<double> wanted = values;
  for (std::size_t r = 0; r < relations_.size(); ++r) {
    if (!relations_[r].sum_of) continue;
    double sum = 0, scale = std::abs(wanted[r]);
    const auto add = [&](double term) {
      sum += term;
      scale = std::max(scale, std::abs(term));
    };
    const auto add_imposed = [&](const DofRelation& row, double factor) {
      for (std::size_t i = 0; i < row.dofs.size(); ++i)
        if (problem_.numbering.equation[row.dofs[i]] < 0) add(factor * row.coefficients[i] * imposed[row.dofs[i]]);
    };
    add_imposed(*relations_[r].row, 1);
    for (const auto& [other, factor] : *relations_[r].sum_of) {
      add(factor * wanted[other]);
      add_imposed(*relations_[other].row, -factor);
    }
    if (std::abs(sum - wanted[r]) > contradiction * scale)
      fail("LOAD_6", {{"relation", name(r)},
                      {"dof", problem_.dof_name(relations_[r].row->dofs.front())},
                      {"instant", fmt::format("{:.15g}", instant)},
                      {"found", fmt::format("{:.15g}", sum)},
                      {"expected", fmt::format("{:.15g}", wanted[r])}});
    values[r] = 0;  // its row is that of a multiplier that vanishes
  }
  return values;
}

}  // namespace lacon
