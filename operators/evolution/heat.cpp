#include "lacon/operators/evolution/heat.hpp"

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/behaviours.hpp"
#include "lacon/operators/program/program.hpp"

namespace lacon {

namespace {

/// Whether a law takes the whole thermal strain, from VALE_REF on, and not its changes.
bool is_total(const ElementSet& set) {
  return set.option == "ELAS/GREEN_LAGRANGE" || set.option == "ELAS/GROT_GDEP" || set.option.ends_with("/SIMO_MIEHE");
}

}  // namespace

constexpr double no_strain = 1e-12;  // what interpolation leaves of it at VALE_REF

Heat::Heat(const StaticProblem& problem) : problem_(problem) {
  if (acts()) points_.emplace(problem.mesh, problem.model, *problem.registry);
}

bool Heat::changes_stiffness() const {
  return acts() && std::any_of(problem_.solids.begin(), problem_.solids.end(),
                               [&](const ElementSet& set) { return problem_.thermal->has_functions(set.cells); });
}

void Heat::move_to(double instant, std::vector<PointValues>& points) {
  if (!acts()) return;
  const Phase phase("temperatures");
  const Ground ground(problem_.mesh, *points_);
  for (std::size_t s = 0; s < points.size(); ++s) {
    const ElementSet& set = problem_.solids[s];
    const int n_points = set.tabulation.n_points;
    points[s].thermal = problem_.thermal->strains(ground, instant, set.cells, n_points);
    if (!problem_.thermal->has_functions(set.cells)) continue;
    const std::vector<std::string> paths(set.kernel->parameters, set.kernel->parameters + set.n_parameters);
    points[s].parameter = problem_.thermal->parameters(ground, instant, set.cells, n_points, paths, set.parameters);
  }
}

void Heat::copy(const std::vector<PointValues>& from, std::vector<PointValues>& to) const {
  for (std::size_t s = 0; acts() && s < to.size(); ++s) {
    to[s].thermal = from[s].thermal;
    to[s].parameter = from[s].parameter;
  }
}

std::vector<double> Heat::start_of_step(std::size_t s, const PointValues& at, const StaticState* from) {
  const ElementSet& set = problem_.solids[s];
  const auto n_points = static_cast<std::size_t>(set.tabulation.n_points), n_stress = set.row->stress.size(),
             n_parameters = static_cast<std::size_t>(set.n_parameters);
  const bool plane_stress = set.row->stress_state == catalog::StressState::plane_stress;
  const std::size_t normal = plane_stress ? 2 : 3;
  std::vector<double> stress = from ? from->points[s].stress : std::vector<double>(set.cells.size() * set.n_stress(), 0.0);
  const std::vector<double>& now = at.parameter.empty() ? set.parameters : at.parameter;
  const bool changed = from && !from->points[s].parameter.empty();
  const std::vector<double>& before = changed ? from->points[s].parameter : now;
  const auto place = elastic_parameters(set);
  if (!place) return stress;  // a law that takes its thermal strain, and moduli of its own, by itself
  const auto strain = [](const PointValues& values, std::size_t point) {
    return values.thermal.empty() ? 0.0 : values.thermal[point];
  };
  for (std::size_t c = 0; c < set.cells.size(); ++c) {
    const double young = now[c * n_parameters + place->young], nu = now[c * n_parameters + place->poisson],
                 old_young = before[c * n_parameters + place->young], old_nu = before[c * n_parameters + place->poisson];
    const double expansion = plane_stress ? young / (1 - nu) : young / (1 - 2 * nu);
    const double shear = young / (1 + nu) / (old_young / (1 + old_nu)),
                 bulk = plane_stress ? young / (1 - nu) / (old_young / (1 - old_nu))
                                     : young / (1 - 2 * nu) / (old_young / (1 - 2 * old_nu));
    for (std::size_t p = 0; p < n_points; ++p) {
      const std::size_t point = c * n_points + p;
      double* const value = stress.data() + point * n_stress;
      if (changed) {  // the elastic strain stays
        double mean = 0;
        for (std::size_t i = 0; i < normal; ++i) mean += value[i] / static_cast<double>(normal);
        for (std::size_t i = 0; i < n_stress; ++i) value[i] = shear * value[i] + (i < normal ? (bulk - shear) * mean : 0.0);
      }
      if (set.kernel->takes_thermal_strain) continue;
      const double grown = strain(at, point) - (from ? strain(from->points[s], point) : 0.0);
      for (std::size_t i = 0; i < normal; ++i) value[i] -= expansion * grown;
    }
  }
  return stress;
}

void Heat::warn_of_start(const StaticState& state) const {
  std::int64_t count = 0;
  std::int32_t first = -1;
  for (std::size_t s = 0; s < state.points.size(); ++s) {
    if (is_total(problem_.solids[s])) continue;
    const std::vector<double>& strain = state.points[s].thermal;
    const std::vector<std::int32_t>& cells = problem_.solids[s].cells;
    const std::size_t width = strain.size() / std::max<std::size_t>(cells.size(), 1);
    for (std::size_t c = 0; c < cells.size() && width > 0; ++c)
      if (std::any_of(strain.begin() + static_cast<std::ptrdiff_t>(c * width),
                      strain.begin() + static_cast<std::ptrdiff_t>((c + 1) * width),
                      [](double e) { return std::abs(e) > no_strain; }) &&
          count++ == 0)
        first = cells[c];
  }
  if (count > 0) inform("EVOLUTION_33", {{"count", std::to_string(count)}, {"cell", cell_name(first)}});
}

}  // namespace lacon
