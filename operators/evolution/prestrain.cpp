#include "lacon/operators/evolution/prestrain.hpp"

#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/behaviours.hpp"
#include "lacon/operators/fields/tensor.hpp"

namespace lacon {

void check_laws(const Registry& registry, const InitialStrains& strains, const std::vector<ElementSet>& solids) {
  const auto concerned = [&](std::int32_t cell) { return strains.concerns(cell); };
  for (const ElementSet& set : solids)
    if (const auto cell = std::ranges::find_if(set.cells, concerned); cell != set.cells.end())
      if (!starts_elastically(registry, set)) fail("BEHAVIOUR_6", {{"behaviour", set.option}, {"cell", cell_name(*cell)}});
}

void Prestrain::move_to(double instant, std::vector<PointValues>& points) const {
  for (std::size_t s = 0; s < points.size(); ++s) {
    const ElementSet& set = problem_.solids[s];
    const InitialStrains& strains = problem_.initial_strains;
    points[s].initial = strains.empty() ? std::vector<double>() : strains.at(instant, set.cells, set.tabulation.n_points);
  }
}

void Prestrain::copy(const std::vector<PointValues>& from, std::vector<PointValues>& to) const {
  for (std::size_t s = 0; s < to.size(); ++s) to[s].initial = from[s].initial;
}

bool Prestrain::acts(const StaticState& state) const {
  return !problem_.initial_strains.empty() ||
         std::any_of(state.points.begin(), state.points.end(), [](const PointValues& p) { return !p.initial.empty(); });
}

void Prestrain::take_off(std::size_t s, const PointValues& at, const PointValues* before, std::vector<double>& stress) const {
  const ElementSet& set = problem_.solids[s];
  const auto n_points = static_cast<std::size_t>(set.tabulation.n_points), n_stress = set.row->stress.size(),
             n_parameters = static_cast<std::size_t>(set.n_parameters);
  const auto place = elastic_parameters(set);
  if (!place) return;  // of another set of cells, which have no initial strains
  const bool plane_stress = set.row->stress_state == catalog::StressState::plane_stress;
  const std::size_t normal = plane_stress ? 2 : 3;
  const std::vector<double>& parameters = at.parameter.empty() ? set.parameters : at.parameter;
  const auto of = [](const PointValues* points, std::size_t entry) {
    return points && !points->initial.empty() ? points->initial[entry] : 0.0;
  };
  const auto change = [&](std::size_t entry) { return of(&at, entry) - of(before, entry); };
  for (std::size_t point = 0; point < set.cells.size() * n_points; ++point) {
    const double* const own = parameters.data() + point / n_points * n_parameters;
    const double young = own[place->young], nu = own[place->poisson];
    const double lame = plane_stress ? young * nu / (1 - nu * nu) : young * nu / ((1 + nu) * (1 - 2 * nu)),
                 twice_shear = young / (1 + nu);
    double trace = 0;
    for (std::size_t i = 0; i < normal; ++i) trace += change(point * tensor_axes.size() + i);
    for (std::size_t i = 0; i < n_stress; ++i) {
      if (i < 3 && i >= normal) continue;  // no stress across a plate
      stress[point * n_stress + i] -= twice_shear * change(point * tensor_axes.size() + i) + (i < normal ? lame * trace : 0.0);
    }
  }
}

}  // namespace lacon
