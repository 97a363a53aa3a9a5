#include "lacon/operators/evolution/problem/cell_motion.hpp"

#include <Eigen/Dense>

namespace lacon {

CellMotion motion_of(const ElementSet& set, std::size_t i, const Mesh& mesh, std::span<const double> displacement, int point) {
  const int d = set.dimension(), n = set.n_nodes();
  const auto nodes = mesh.cells[set.cells[i]];
  const double* const slope = set.tabulation.gradient.data() + static_cast<std::ptrdiff_t>(point) * n * d;
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity(), moved = Eigen::Matrix3d::Zero();
  map.topLeftCorner(d, d).setZero();
  for (int a = 0; a < n; ++a) {
    const auto node = static_cast<std::size_t>(nodes[a]);
    for (int r = 0; r < d; ++r)
      for (int k = 0; k < d; ++k) {
        map(k, r) += mesh.point(node)[static_cast<std::size_t>(k)] * slope[a * d + r];
        moved(k, r) += displacement[node * static_cast<std::size_t>(set.n_components) +
                                    static_cast<std::size_t>(set.columns[static_cast<std::size_t>(k)])] *
                       slope[a * d + r];
      }
  }
  const Eigen::Matrix3d gradient = moved * map.inverse(), strain = 0.5 * (gradient + gradient.transpose()),
                        turn = 0.5 * (gradient - gradient.transpose());
  return {set.cells[i], turn.norm() / std::numbers::sqrt2,
          strain.selfadjointView<Eigen::Lower>().eigenvalues().cwiseAbs().maxCoeff(),
          1 - (Eigen::Matrix3d::Identity() + gradient).jacobiSvd().singularValues().minCoeff()};
}

bool softens_in_compression(const ElementSet& set) {
  return set.option.ends_with("ELAS/GREEN_LAGRANGE") || set.option.ends_with("ELAS/GROT_GDEP");
}

std::optional<CellMotion> most_softened(const StaticProblem& problem, std::span<const double> displacement) {
  std::optional<CellMotion> found;
  for (const ElementSet& set : problem.solids)
    for (std::size_t i = 0; softens_in_compression(set) && i < set.cells.size(); ++i)
      for (int point = 0; point < set.tabulation.n_points; ++point)
        if (const CellMotion motion = motion_of(set, i, problem.mesh, displacement, point);
            motion.shortening > (found ? found->shortening : most_shortened))
          found = motion;
  return found;
}

}  // namespace lacon
