#include "lacon/assembly/least_distance.hpp"

#include <algorithm>
#include <vector>

namespace lacon {
namespace {

constexpr double round_off = 1e-12;

/// x >= 0 that brings `matrix` x nearest to `side`.
class NonNegative {
 public:
  NonNegative(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& side)
      : matrix_(matrix), side_(side), x_(Eigen::VectorXd::Zero(matrix.cols())), free_(matrix.cols(), false) {}

  Eigen::VectorXd solve() {
    std::vector<bool> refused(free_.size(), false);  // columns that would become negative at once: round-off
    for (Eigen::Index pass = 0; pass < 3 * matrix_.cols() + 30; ++pass) {
      const Eigen::VectorXd slope = matrix_.transpose() * (side_ - matrix_ * x_);
      Eigen::Index next = -1;
      for (Eigen::Index i = 0; i < slope.size(); ++i)
        if (!free_[i] && !refused[i] && slope[i] > round_off * matrix_.col(i).norm() && (next < 0 || slope[i] > slope[next]))
          next = i;
      if (next < 0) break;
      free_[next] = true;
      if (descend(next))
        std::fill(refused.begin(), refused.end(), false);
      else
        refused[next] = true;
    }
    return x_;
  }

 private:
  /// To the least squares of the free columns, as far as all stay positive. @return false where the new one does not
  bool descend(Eigen::Index newest) {
    for (bool is_first = true;; is_first = false) {
      std::vector<Eigen::Index> columns;
      for (Eigen::Index i = 0; i < matrix_.cols(); ++i)
        if (free_[i]) columns.push_back(i);
      const Eigen::VectorXd best = matrix_(Eigen::all, columns).colPivHouseholderQr().solve(side_);
      if (is_first && best[std::ranges::find(columns, newest) - columns.begin()] <= 0) return free_[newest] = false;
      double part = 1;
      for (Eigen::Index k = 0; k < best.size(); ++k)
        if (best[k] <= 0) part = std::min(part, x_[columns[k]] / (x_[columns[k]] - best[k]));
      for (Eigen::Index k = 0; k < best.size(); ++k) {
        double& value = x_[columns[k]];
        value += part * (best[k] - value);
        if (part < 1 && best[k] <= 0 && value <= round_off * x_.maxCoeff()) value = 0, free_[columns[k]] = false;
      }
      if (part == 1) return true;
    }
  }

  const Eigen::MatrixXd& matrix_;
  const Eigen::VectorXd& side_;
  Eigen::VectorXd x_;
  std::vector<bool> free_;
};

}  // namespace

std::optional<LeastDistance> least_distance(const Eigen::MatrixXd& rows, const Eigen::VectorXd& bounds,
                                            const Eigen::VectorXd& aim) {
  const Eigen::Index n = rows.cols();
  Eigen::VectorXd missing = bounds - rows * aim;  // by what the aim lies outside
  if (missing.size() == 0 || missing.maxCoeff() <= 0) return LeastDistance{aim, Eigen::VectorXd::Zero(rows.rows())};
  const double unit = missing.cwiseAbs().maxCoeff();
  missing /= unit;
  Eigen::MatrixXd matrix(n + 1, rows.rows());
  matrix.topRows(n) = rows.transpose();
  matrix.row(n) = missing.transpose();
  const Eigen::VectorXd side = Eigen::VectorXd::Unit(n + 1, n);
  const Eigen::VectorXd found = NonNegative(matrix, side).solve();
  const double left = 1 - missing.dot(found);  // 0 where the sides have no point in common
  if (left <= round_off * (1 + found.sum())) return std::nullopt;
  const Eigen::VectorXd forces = unit / left * found;
  return LeastDistance{aim + rows.transpose() * forces, forces};
}

}  // namespace lacon
