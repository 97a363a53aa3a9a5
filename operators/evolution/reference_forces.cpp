#include "lacon/operators/evolution/reference_forces.hpp"

#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/cell_points.hpp"

namespace lacon {

std::vector<double> reference_forces(const StaticProblem& problem, double stress, std::optional<double> effort) {
  std::vector<double> forces(problem.n_dofs(), 0.0);
  const auto width = static_cast<std::size_t>(problem.n_components()), D = static_cast<std::size_t>(problem.dimension);
  ModelPoints points(problem.mesh, problem.model, *problem.registry);
  for (const ElementSet& set : problem.solids)
    for (const std::int32_t cell : set.cells) {
      const auto c = static_cast<std::size_t>(cell);
      const CellPoints& at = points(c, problem.mesh.coordinates);
      const auto n_nodes = static_cast<std::size_t>(at.n_nodes), n_points = static_cast<std::size_t>(at.n_points);
      const bool axis = points.is_axisymmetric(c);
      for (std::size_t p = 0; p < n_points; ++p)
        for (std::size_t a = 0; a < n_nodes; ++a) {
          double gradient = 0;  // sigma_ik acts on node a in direction i by its slope along k
          for (std::size_t k = 0; k < D; ++k) gradient += std::abs(at.gradient[(p * n_nodes + a) * D + k]);
          const double share = stress * at.measure[p] / static_cast<double>(n_points);
          double* const force = forces.data() + static_cast<std::size_t>(problem.mesh.cells[c][a]) * width;
          for (std::size_t i = 0; i < D; ++i) force[i] += share * gradient;
          if (axis) force[0] += share * std::abs(at.shape[p * n_nodes + a]) / at.position[3 * p];
        }
    }
  if (!problem.springs.empty() && !effort) fail("EVOLUTION_41");
  for (const Spring& spring : problem.springs)
    for (const std::int32_t node : {spring.first, spring.second})
      for (std::size_t i = 0; i < D && node >= 0; ++i) forces[static_cast<std::size_t>(node) * width + i] += *effort;
  return forces;
}

}  // namespace lacon
