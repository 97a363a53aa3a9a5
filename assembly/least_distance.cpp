#include "lacon/assembly/least_distance.hpp"

#include <algorithm>
#include <vector>

namespace lacon {
namespace {

constexpr double round_off = 1e-12;

/// Columns as orthonormal ones times a triangle; they come and go one at a time.
class Orthonormal {
 public:
  Orthonormal(Eigen::Index rows, Eigen::Index most) : q_(rows, most), r_(Eigen::MatrixXd::Zero(most, most)) {}
  /// @return false where it depends on those that are there
  bool add(const Eigen::VectorXd& column) {
    if (size_ == r_.cols()) return false;
    Eigen::VectorXd rest = column, along = Eigen::VectorXd::Zero(size_);
    for (int time = 0; time < 2; ++time) {  // the second one takes off what round-off of the first has left
      const Eigen::VectorXd part = q_.leftCols(size_).transpose() * rest;
      rest -= q_.leftCols(size_) * part;
      along += part;
    }
    const double left = rest.norm();
    if (left <= round_off * column.norm()) return false;
    r_.col(size_).head(size_) = along;
    r_(size_, size_) = left;
    q_.col(size_++) = rest / left;
    return true;
  }
  void remove(Eigen::Index place) {
    --size_;
    for (Eigen::Index i = place; i < size_; ++i) r_.col(i).head(i + 2) = r_.col(i + 1).head(i + 2);
    for (Eigen::Index i = place; i < size_; ++i) {  // below the diagonal is one entry of each
      Eigen::JacobiRotation<double> turn;
      turn.makeGivens(r_(i, i), r_(i + 1, i));
      r_.block(i, i, 2, size_ - i).applyOnTheLeft(0, 1, turn.adjoint());
      q_.applyOnTheRight(i, i + 1, turn);
    }
  }
  Eigen::VectorXd least_squares(const Eigen::VectorXd& side) const {
    return r_.topLeftCorner(size_, size_).triangularView<Eigen::Upper>().solve(q_.leftCols(size_).transpose() * side);
  }

 private:
  Eigen::MatrixXd q_, r_;
  Eigen::Index size_ = 0;
};

/// x >= 0 that brings `matrix` x nearest to `side`.
class NonNegative {
 public:
  NonNegative(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& side)
      : matrix_(matrix),
        side_(side),
        x_(Eigen::VectorXd::Zero(matrix.cols())),
        is_free_(matrix.cols(), false),
        basis_(matrix.rows(), std::min(matrix.rows(), matrix.cols())) {}

  Eigen::VectorXd solve() {
    std::vector<bool> refused(is_free_.size(), false);  // columns that would become negative at once: round-off
    for (Eigen::Index pass = 0; pass < 3 * matrix_.cols() + 30; ++pass) {
      const Eigen::VectorXd slope = matrix_.transpose() * (side_ - matrix_ * x_);
      Eigen::Index next = -1;
      for (Eigen::Index i = 0; i < slope.size(); ++i)
        if (!is_free_[i] && !refused[i] && slope[i] > round_off * matrix_.col(i).norm() && (next < 0 || slope[i] > slope[next]))
          next = i;
      if (next < 0) break;
      if (descend(next))
        std::fill(refused.begin(), refused.end(), false);
      else
        refused[next] = true;
    }
    return x_;
  }

 private:
  /// To the least squares of the free columns and a new one, as far as all stay positive. @return false where the new one does
  /// not
  bool descend(Eigen::Index newest) {
    if (!basis_.add(matrix_.col(newest))) return false;
    free_.push_back(newest);
    is_free_[newest] = true;
    for (bool is_first = true;; is_first = false) {
      const Eigen::VectorXd best = basis_.least_squares(side_);
      if (is_first && best[best.size() - 1] <= 0) {
        fix_at_zero(free_.size() - 1);
        return false;
      }
      double part = 1;
      for (Eigen::Index k = 0; k < best.size(); ++k)
        if (best[k] <= 0) part = std::min(part, x_[free_[k]] / (x_[free_[k]] - best[k]));
      for (Eigen::Index k = 0; k < best.size(); ++k) {
        double& value = x_[free_[k]];
        value += part * (best[k] - value);
        if (part < 1 && best[k] <= 0 && value <= round_off * x_.maxCoeff()) value = 0;
      }
      if (part == 1) return true;
      for (std::size_t k = free_.size(); k-- > 0;)
        if (x_[free_[k]] == 0) fix_at_zero(k);
    }
  }

  void fix_at_zero(std::size_t place) {
    x_[free_[place]] = 0;
    is_free_[free_[place]] = false;
    free_.erase(free_.begin() + static_cast<std::ptrdiff_t>(place));
    basis_.remove(static_cast<Eigen::Index>(place));
  }

  const Eigen::MatrixXd& matrix_;
  const Eigen::VectorXd& side_;
  Eigen::VectorXd x_;
  std::vector<bool> is_free_;
  std::vector<Eigen::Index> free_;  ///< those, in the order of basis_
  Orthonormal basis_;
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
