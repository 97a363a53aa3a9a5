#include "lacon/assembly/gmres.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <utility>

namespace lacon {

using Eigen::Map, Eigen::MatrixXd, Eigen::VectorXd;

GmresResult gmres(const std::function<void(std::span<const double> x, std::span<double> y)>& multiply,
                  const std::function<void(std::span<double> x)>& precondition, std::span<const double> scale,
                  std::span<const double> right_side, const GmresOptions& options) {
  // on D A P^-1 D^-1 (D y) = D b with the scales D, x = P^-1 y
  const auto n = static_cast<Eigen::Index>(right_side.size());
  GmresResult result{.x = std::vector<double>(right_side.size())};
  const Map<const VectorXd> weight(scale.data(), n), side(right_side.data(), n);
  Map<VectorXd> x(result.x.data(), n);
  const VectorXd unweight = weight.cwiseInverse();
  VectorXd residual = weight.cwiseProduct(side), image(n);
  std::vector<VectorXd> basis, directions;
  for (int cycle = 0; cycle < options.cycles && residual.norm() > options.goal; ++cycle) {
    basis.assign(1, residual / residual.norm());
    directions.clear();
    MatrixXd triangle = MatrixXd::Zero(options.iterations + 1, options.iterations);
    VectorXd small = VectorXd::Zero(options.iterations + 1);
    small[0] = residual.norm();
    std::vector<Eigen::JacobiRotation<double>> rotations;
    int k = 0;
    while (std::abs(small[k]) > 0.5 * options.goal && result.iterations < options.iterations) {
      VectorXd direction = unweight.cwiseProduct(basis[k]);
      precondition({direction.data(), right_side.size()});
      multiply({direction.data(), right_side.size()}, {image.data(), right_side.size()});
      image.array() *= weight.array();
      directions.push_back(std::move(direction));
      const double whole = image.norm();
      for (int pass = 0; pass < 2; ++pass)  // twice is enough to be orthogonal to round-off
        for (int i = 0; i <= k; ++i) {
          const double part = basis[i].dot(image);
          triangle(i, k) += part;
          image -= part * basis[i];
        }
      triangle(k + 1, k) = image.norm();
      for (int i = 0; i < k; ++i) triangle.col(k).applyOnTheLeft(i, i + 1, rotations[i].adjoint());
      Eigen::JacobiRotation<double> rotation;
      rotation.makeGivens(triangle(k, k), triangle(k + 1, k));
      const double rest = triangle(k + 1, k);
      triangle.col(k).applyOnTheLeft(k, k + 1, rotation.adjoint());
      small.applyOnTheLeft(k, k + 1, rotation.adjoint());
      rotations.push_back(rotation);
      ++k;
      ++result.iterations;
      if (!(rest > 1e-15 * whole)) break;  // the space holds the solution
      basis.push_back(image / image.norm());
    }
    if (k == 0) break;
    const VectorXd weights = triangle.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(small.head(k));
    if (!weights.allFinite()) {
      result.residual = INFINITY;
      return result;
    }
    for (int i = 0; i < k; ++i) x += weights[i] * directions[i];
    multiply(result.x, {image.data(), right_side.size()});
    residual = weight.cwiseProduct(side - image);
  }
  result.residual = residual.allFinite() ? residual.norm() : INFINITY;
  return result;
}

}  // namespace lacon
