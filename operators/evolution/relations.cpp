#include "lacon/operators/evolution/relations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {

Relations::Relations(const StaticProblem& problem) : problem_(problem) {
  for (const TimedLoad& load : problem.loads)
    for (const DofRelation& row : load.relations)
      relations_.push_back({&load, &row, std::all_of(row.dofs.begin(), row.dofs.end(), [&](std::int64_t dof) {
                              return problem.numbering.equation[dof] < 0;
                            })});
}

std::int64_t Relations::n_constraints() const {
  return std::count_if(relations_.begin(), relations_.end(), [](const Held& held) { return !held.locked; });
}

std::int64_t Relations::unknown(std::size_t relation, const System& system) const {
  return system.multiplier(problem_.n_patches() + static_cast<std::int64_t>(relation));
}

std::string Relations::name(std::size_t relation) const {
  return part("relation_of", {{"load", relations_[relation].load->label}, {"source", relations_[relation].row->source}});
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
    if (relations_[r].locked) {
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
  for (std::size_t r = 0; r < relations_.size(); ++r) {
    if (!relations_[r].locked) continue;
    const DofRelation& row = *relations_[r].row;
    double sum = 0, scale = std::abs(values[r]);
    for (std::size_t i = 0; i < row.dofs.size(); ++i) {
      const double term = row.coefficients[i] * imposed[row.dofs[i]];
      sum += term;
      scale = std::max(scale, std::abs(term));
    }
    if (std::abs(sum - values[r]) > 1e-12 * scale)
      fail("LOAD_6", {{"relation", name(r)},
                      {"dof", problem_.dof_name(row.dofs.front())},
                      {"instant", fmt::format("{:.15g}", instant)},
                      {"found", fmt::format("{:.15g}", sum)},
                      {"expected", fmt::format("{:.15g}", values[r])}});
    values[r] = 0;  // its row is that of a multiplier that vanishes
  }
  return values;
}

}  // namespace lacon
