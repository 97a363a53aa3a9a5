#include "lacon/assembly/solid_step.hpp"

#include <algorithm>
#include <string_view>

namespace lacon {
namespace {

/// Numbers of a quantity; zeros where the points do not hold it.
class Numbers {
 public:
  Numbers(const PointValues* points, std::vector<double> PointValues::*values)
      : values_(points ? &(points->*values) : nullptr) {}
  explicit operator bool() const { return values_ && !values_->empty(); }
  double operator[](std::size_t at) const { return *this ? (*values_)[at] : 0.0; }

 private:
  const std::vector<double>* values_;
};

/// Isotropic elasticity, of plane stress or not.
struct Moduli {
  double twice_shear;
  double stretch;  ///< the normal stresses that answer to a strain of 1 in all directions, those of the plane in plane stress
  double lame;
};
Moduli moduli(std::span<const double> parameters, const ElasticParameters& place, bool plane_stress) {
  const double young = parameters[place.young], nu = parameters[place.poisson];
  return {.twice_shear = young / (1 + nu),
          .stretch = plane_stress ? young / (1 - nu) : young / (1 - 2 * nu),
          .lame = plane_stress ? young * nu / (1 - nu * nu) : young * nu / ((1 + nu) * (1 - 2 * nu))};
}

/// The stress that the laws of a set start from; empty: as the state has it, for there are no strains without stress. Under
/// other moduli a stress keeps its elastic strain. Of laws that know nothing of such strains and answer to a change of strain
/// with isotropic elasticity, what their change does is taken off.
std::vector<double> starting_stress(const ElementSet& set, const PointValues& now, const PointValues* before) {
  const Numbers thermal(&now, &PointValues::thermal), old_thermal(before, &PointValues::thermal),
      initial(&now, &PointValues::initial), old_initial(before, &PointValues::initial),
      old_parameter(before, &PointValues::parameter);
  if (!thermal && !old_thermal && !initial && !old_initial) return {};
  std::vector<double> stress = before ? before->stress : std::vector<double>(set.cells.size() * set.n_stress(), 0.0);
  const auto place = elastic_parameters(set);
  if (!place) return stress;  // a law that takes its thermal strain, and moduli of its own, by itself
  const auto n_points = static_cast<std::size_t>(set.tabulation.n_points), n_stress = set.row->stress.size(),
             n_parameters = static_cast<std::size_t>(set.n_parameters);
  const bool plane_stress = set.row->stress_state == catalog::StressState::plane_stress;
  const std::size_t normal = plane_stress ? 2 : 3;  // no stress across a plate
  const std::span<const double> parameters = now.parameter.empty() ? set.parameters : now.parameter;
  for (std::size_t c = 0; c < set.cells.size(); ++c) {
    const Moduli own = moduli(parameters.subspan(c * n_parameters, n_parameters), *place, plane_stress);
    std::optional<Moduli> old;
    if (old_parameter) old = moduli(std::span(before->parameter).subspan(c * n_parameters, n_parameters), *place, plane_stress);
    for (std::size_t point = c * n_points; point < (c + 1) * n_points; ++point) {
      double* const value = stress.data() + point * n_stress;
      if (old) {
        const double shear = own.twice_shear / old->twice_shear, stretch = own.stretch / old->stretch;
        double mean = 0;
        for (std::size_t i = 0; i < normal; ++i) mean += value[i] / static_cast<double>(normal);
        for (std::size_t i = 0; i < n_stress; ++i) value[i] = shear * value[i] + (i < normal ? (stretch - shear) * mean : 0.0);
      }
      if (!set.kernel->takes_thermal_strain) {
        const double grown = thermal[point] - old_thermal[point];
        for (std::size_t i = 0; i < normal; ++i) value[i] -= own.stretch * grown;
      }
      if (!initial && !old_initial) continue;
      const auto change = [&](std::size_t i) {
        return initial[point * n_initial_strains + i] - old_initial[point * n_initial_strains + i];
      };
      double trace = 0;
      for (std::size_t i = 0; i < normal; ++i) trace += change(i);
      for (std::size_t i = 0; i < n_stress; ++i)
        if (i < normal || i >= 3) value[i] -= own.twice_shear * change(i) + (i < normal ? own.lame * trace : 0.0);
    }
  }
  return stress;
}

/// The internal variables that a step starts from; empty: as the state has them. The middle of a criterion (XCIN...) is the
/// slope of the hardening times a plastic strain, which stays where the slope follows E.
std::vector<double> starting_variable(const ElementSet& set, const PointValues& now, const PointValues* before) {
  if (!before || before->parameter.empty() || now.parameter.empty()) return {};
  const auto place = elastic_parameters(set);
  const auto tension = parameter_place(set, "ECRO_LINE/D_SIGM_EPSI");
  const auto n_variables = static_cast<std::size_t>(set.n_point_variables);
  std::size_t n_middle = 0;
  while (n_middle < n_variables && std::string_view(set.kernel->variables[n_middle]).starts_with("XCIN")) ++n_middle;
  if (!place || !tension || n_middle == 0) return {};
  std::vector<double> variable = before->variable;
  const auto n_points = static_cast<std::size_t>(set.tabulation.n_points),
             n_parameters = static_cast<std::size_t>(set.n_parameters);
  for (std::size_t c = 0; c < set.cells.size(); ++c) {
    const double* const own = now.parameter.data() + c * n_parameters;
    const double* const old = before->parameter.data() + c * n_parameters;
    // of E ET / (E - ET), whose ET is the same
    const double share =
        own[place->young] * (old[place->young] - old[*tension]) / (old[place->young] * (own[place->young] - own[*tension]));
    for (std::size_t point = c * n_points; point < (c + 1) * n_points; ++point)
      for (std::size_t v = 0; v < n_middle; ++v) variable[point * n_variables + v] *= share;
  }
  return variable;
}

}  // namespace

std::optional<std::size_t> parameter_place(const ElementSet& set, std::string_view path) {
  const char* const* const first = set.kernel->parameters;
  const char* const* const last = first + set.n_parameters;
  const auto found = std::find(first, last, path);
  return found == last ? std::nullopt : std::optional(static_cast<std::size_t>(found - first));
}

std::optional<ElasticParameters> elastic_parameters(const ElementSet& set) {
  const auto young = parameter_place(set, "ELAS/E"), poisson = parameter_place(set, "ELAS/NU");
  if (!young || !poisson) return std::nullopt;
  return ElasticParameters{*young, *poisson};
}

std::optional<std::int32_t> evaluate_step(const ElementSet& set, const Mesh& mesh, std::span<const double> displacement,
                                          PointValues& now, const SolidStart& start, SolidMatrix wanted,
                                          const std::function<void(const ElementValues&)>& use) {
  SolidInput input{.displacement = displacement, .thermal = now.thermal, .parameters = now.parameter};
  const std::vector<double> stress = starting_stress(set, now, start.points),
                            variable = starting_variable(set, now, start.points);
  if (const PointValues* const from = start.points) {
    input.previous_displacement = start.displacement;
    input.previous_stress = from->stress;
    input.previous_variable = from->variable;
    input.previous_thermal = from->thermal;
  }
  if (!stress.empty()) input.previous_stress = stress;
  if (!variable.empty()) input.previous_variable = variable;
  return evaluate_solids(set, mesh, input, wanted, {now.stress, now.variable}, use);
}

}  // namespace lacon
