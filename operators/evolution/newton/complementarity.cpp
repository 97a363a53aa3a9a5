#include "lacon/operators/evolution/newton/complementarity.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lacon {
namespace {

constexpr int patience = 3;         // changes of all wrong pairs that make them no fewer
constexpr Eigen::Index most = 100;  // changes, and two of each pair: a P-matrix that asks for more is a curiosity,
constexpr double work = 1e11;       // operations of these: where there are many pairs, statuses are found by iterations as well
constexpr double least = 1e-10;     // of a diagonal, where 1 is usual: what resists less is loose
constexpr double singular = 1e-9;   // reciprocal condition, behind scaling by the diagonal

/// z of the pairs in which it is not zero, (pairs), or nothing where the matrix lets them go.
std::optional<Eigen::VectorXd> solution_of(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& q,
                                           const std::vector<Eigen::Index>& pairs) {
  const Eigen::VectorXd diagonal = matrix.diagonal()(pairs);
  if (!(diagonal.minCoeff() > least)) return std::nullopt;
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(scale.asDiagonal() * matrix(pairs, pairs) * scale.asDiagonal());
  if (!(factor.rcond() > singular)) return std::nullopt;
  return scale.cwiseProduct(factor.solve(-scale.cwiseProduct(q(pairs))));
}

}  // namespace

std::optional<Eigen::VectorXd> solve_complementarity(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& q, double digits) {
  const Eigen::Index n = q.size();
  const auto last = most + static_cast<Eigen::Index>(std::min(2.0 * static_cast<double>(n), work / std::pow(n, 3)));
  std::vector<bool> has_z(static_cast<std::size_t>(n), false);
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int in_vain = 0;
  for (Eigen::Index changes = 0; changes < last; ++changes) {
    std::vector<Eigen::Index> pairs, wrong;
    for (Eigen::Index i = 0; i < n; ++i)
      if (has_z[static_cast<std::size_t>(i)]) pairs.push_back(i);
    Eigen::VectorXd z = Eigen::VectorXd::Zero(n);
    if (!pairs.empty()) {
      const std::optional<Eigen::VectorXd> found = solution_of(matrix, q, pairs);
      if (!found) return std::nullopt;
      z(pairs) = *found;
    }
    const Eigen::VectorXd w = q + matrix * z, error = digits * (q.cwiseAbs() + matrix.cwiseAbs() * z.cwiseAbs());
    for (Eigen::Index i = 0; i < n; ++i)
      if (has_z[static_cast<std::size_t>(i)] ? z[i] * matrix(i, i) < -error[i] : w[i] < -error[i]) wrong.push_back(i);
    if (wrong.empty()) return z;
    in_vain = wrong.size() < fewest ? 0 : in_vain + 1;
    fewest = std::min(fewest, wrong.size());
    if (in_vain > patience) wrong = {wrong.back()};
    for (const Eigen::Index i : wrong) has_z[static_cast<std::size_t>(i)] = !has_z[static_cast<std::size_t>(i)];
  }
  return std::nullopt;
}

}  // namespace lacon
