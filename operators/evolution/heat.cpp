#include "lacon/operators/evolution/heat.hpp"

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
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

void Heat::warn_of_start(const StaticState& state) const {
  std::int64_t count = 0;
  std::int32_t first = -1;
  std::vector<double> room;
  for (std::size_t s = 0; s < state.n_sets(); ++s) {
    if (is_total(problem_.solids[s])) continue;
    const std::span<const double> strain = values_of(state, s, PointQuantity::thermal, room);
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
