#include "lacon/operators/evolution/problem/heat.hpp"

#include <algorithm>
#include <cmath>

#include "lacon/assembly/solid_step.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/problem/behaviours.hpp"
#include "lacon/operators/program/program.hpp"

namespace lacon {

namespace {

/// Whether a law takes the whole thermal strain, from VALE_REF on, and not its changes.
bool is_total(const ElementSet& set) {
  return set.option == "ELAS/GREEN_LAGRANGE" || set.option == "ELAS/GROT_GDEP" || set.option.ends_with("/SIMO_MIEHE");
}

/// BEHAVIOUR_2 where the hardening of a set does not go with the E of a cell. The limits are bounds: two cells tell of all.
void check_moduli(const StaticProblem& problem, const ElementSet& set, std::span<const double> parameters, double instant) {
  const auto place = set.kernel->takes_curve ? elastic_parameters(set) : std::nullopt;
  if (!place) return;
  const auto young = [&](std::size_t c) { return parameters[c * static_cast<std::size_t>(set.n_parameters) + place->young]; };
  std::size_t least = 0, most = 0;
  for (std::size_t c = 1; c < set.cells.size(); ++c) {
    if (young(c) < young(least)) least = c;
    if (young(c) > young(most)) most = c;
  }
  for (const std::size_t c : {least, most})
    check_modulus(*problem.materials, set.cells[c], behaviour_rows(*problem.registry, set.option).relation.hardening,
                  set.row->name, young(c), instant);
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
    check_moduli(problem_, set, points[s].parameter, instant);
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
