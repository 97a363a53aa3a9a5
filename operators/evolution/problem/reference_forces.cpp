#include "lacon/operators/evolution/problem/reference_forces.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/cell_points.hpp"

namespace lacon {

namespace {

/// Forces of stresses of one size in all components, without what cancels.
/// @param stress (set, cell of the set, point, points of a cell) -> that size
template <class Stress>
std::vector<double> forces_of(const StaticProblem& problem, const Stress& stress) {
  std::vector<double> forces(problem.n_dofs(), 0.0);
  const auto width = static_cast<std::size_t>(problem.n_components()), D = static_cast<std::size_t>(problem.dimension);
  ModelPoints points(problem.mesh, problem.model, *problem.registry);
  for (std::size_t s = 0; s < problem.solids.size(); ++s)
    for (std::size_t own = 0; own < problem.solids[s].cells.size(); ++own) {
      const auto c = static_cast<std::size_t>(problem.solids[s].cells[own]);
      const CellPoints& at = points(c, problem.mesh.coordinates);
      const auto n_nodes = static_cast<std::size_t>(at.n_nodes), n_points = static_cast<std::size_t>(at.n_points);
      const bool axis = points.is_axisymmetric(c);
      for (std::size_t p = 0; p < n_points; ++p) {
        const double share = stress(s, own, p, n_points) * at.measure[p];
        for (std::size_t a = 0; a < n_nodes; ++a) {
          double gradient = 0;  // sigma_ik acts on node a in direction i by its slope along k
          for (std::size_t k = 0; k < D; ++k) gradient += std::abs(at.gradient[(p * n_nodes + a) * D + k]);
          double* const force = forces.data() + static_cast<std::size_t>(problem.mesh.cells[c][a]) * width;
          for (std::size_t i = 0; i < D; ++i) force[i] += share * gradient;
          if (axis) force[0] += share * std::abs(at.shape[p * n_nodes + a]) / at.position[3 * p];
        }
      }
    }
  return forces;
}

}  // namespace

std::vector<double> summed_forces(const StaticProblem& problem, const StaticState& state) {
  std::vector<std::vector<double>> stresses;
  bool any = false;
  for (std::size_t s = 0; s < state.n_sets(); ++s) {
    std::vector<double> room;
    const std::span<const double> values = values_of(state, s, PointQuantity::stress, room);
    stresses.emplace_back(values.begin(), values.end());
    any = any || std::ranges::any_of(values, [](double value) { return value != 0; });
  }
  if (!any) return {};
  return forces_of(problem, [&](std::size_t set, std::size_t cell, std::size_t point, std::size_t n_points) {
    const std::size_t n = problem.solids[set].n_stress() / n_points;
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, std::abs(stresses[set][(cell * n_points + point) * n + i]));
    return largest;
  });
}

std::vector<double> reference_forces(const StaticProblem& problem, double stress, std::optional<double> effort) {
  std::vector<double> forces = forces_of(problem, [&](std::size_t, std::size_t, std::size_t, std::size_t n_points) {
    return stress / static_cast<double>(n_points);
  });
  const auto width = static_cast<std::size_t>(problem.n_components()), D = static_cast<std::size_t>(problem.dimension);
  if (!problem.springs.empty() && !effort) fail("EVOLUTION_41");
  for (const Spring& spring : problem.springs)
    for (const std::int32_t node : {spring.first, spring.second})
      for (std::size_t i = 0; i < D && node >= 0; ++i) forces[static_cast<std::size_t>(node) * width + i] += *effort;
  return forces;
}

}  // namespace lacon
