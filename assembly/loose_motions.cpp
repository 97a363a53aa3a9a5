#include "lacon/assembly/loose_motions.hpp"

#include <algorithm>
#include <cmath>

namespace lacon {
namespace {

constexpr double takes_part = 1e-6;  // of a motion: a body that it moves

/// Rows of a matrix of few columns as its triangle, which has the same null space.
class Triangle {
 public:
  explicit Triangle(Eigen::Index columns) : rows_(0, columns), pending_(4 * columns + 64, columns) {}
  void add(const Eigen::VectorXd& row) {
    pending_.row(count_++) = row.transpose();
    if (count_ == pending_.rows()) reduce();
  }
  /// (n_columns, n): combinations of columns that vanish.
  Eigen::MatrixXd null_space(double negligible) {
    reduce();
    if (rows_.rows() == 0) return Eigen::MatrixXd::Identity(rows_.cols(), rows_.cols());
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows_, Eigen::ComputeFullV);
    Eigen::Index rank = 0;
    while (rank < svd.singularValues().size() &&
           svd.singularValues()[rank] > negligible * std::max(1.0, svd.singularValues()[0]))
      ++rank;
    return svd.matrixV().rightCols(rows_.cols() - rank);
  }

 private:
  void reduce() {
    Eigen::MatrixXd all(rows_.rows() + count_, rows_.cols());
    all.topRows(rows_.rows()) = rows_;
    all.bottomRows(count_) = pending_.topRows(count_);
    count_ = 0;
    const Eigen::Index rank = std::min(all.rows(), all.cols());
    if (rank == 0) return;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(all);
    rows_ = qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>();
  }
  Eigen::MatrixXd rows_, pending_;
  Eigen::Index count_ = 0;
};

}  // namespace

LooseMotions::LooseMotions(const RigidMotions& motions, const Numbering& numbering) {
  const auto for_each_row = [&](const auto& use) {
    for (std::int64_t dof = 0; dof < std::ssize(numbering.equation); ++dof)
      if (const auto row = motions.row(dof / numbering.n_components, static_cast<int>(dof % numbering.n_components)))
        use(dof, *row);
  };
  std::map<std::int32_t, Eigen::Matrix<double, 6, 6>> held;
  for (const std::int32_t body : motions.bodies()) held[body].setZero();
  for_each_row([&](std::int64_t dof, const RigidMotions::Row& row) {
    if (numbering.equation[dof] < 0) held[row.body] += row.by * row.by.transpose();
  });
  struct Left {
    std::int32_t first;
    Eigen::Matrix<double, 6, Eigen::Dynamic> motions;
  };
  std::map<std::int32_t, Left> left;
  for (const auto& [body, gram] : held) {
    const Eigen::Matrix<double, 6, Eigen::Dynamic> free = motions.free_of(gram);
    if (free.cols() == 0) continue;
    left[body] = {static_cast<std::int32_t>(bodies_.size()), free};
    bodies_.insert(bodies_.end(), static_cast<std::size_t>(free.cols()), body);
  }
  if (left.empty()) return;
  for_each_row([&](std::int64_t dof, const RigidMotions::Row& row) {
    const auto own = left.find(row.body);
    if (numbering.equation[dof] < 0 || own == left.end()) return;
    moved_.push_back({dof, numbering.equation[dof], own->second.first, own->second.motions.transpose() * row.by});
  });
}

std::vector<LooseMotion> LooseMotions::of(const SparseMatrix& matrix, double negligible) const {
  if (moved_.empty()) return {};
  const auto columns = static_cast<Eigen::Index>(bodies_.size());
  std::vector<const Moved*> at(static_cast<std::size_t>(matrix.size()), nullptr);
  for (const Moved& moved : moved_) at[moved.equation] = &moved;
  // what a row makes of the motions: of those of one body for nearly all, which meet no other one
  struct Image {
    double most = 0;  ///< what its entries sum up to
    std::int32_t first = -1;
    MotionVector own = MotionVector::Zero();
    std::map<std::int32_t, MotionVector> others;
  };
  std::vector<Image> images(at.size());
  const auto of_body = [](Image& image, std::int32_t first) -> MotionVector& {
    if (image.first < 0) image.first = first;
    return image.first == first ? image.own : image.others.try_emplace(first, MotionVector::Zero()).first->second;
  };
  const auto add = [&](std::int64_t row, std::int64_t column, double value) {
    const Moved* const moved = at[column];
    if (!moved || value == 0) return;
    Image& image = images[row];
    of_body(image, moved->first).head(moved->by.size()) += value * moved->by;
    image.most += std::abs(value) * moved->by.cwiseAbs().sum();
  };
  for (std::int64_t row = 0; row < matrix.size(); ++row)
    for (std::int64_t k = matrix.rows()[row]; k < matrix.rows()[row + 1]; ++k) {
      const std::int64_t column = matrix.columns()[k];
      add(row, column, matrix.values()[k]);
      if (matrix.is_symmetric() && column != row) add(column, row, matrix.values()[k]);
    }
  if (matrix.elsewhere()) {
    std::vector<double> x(at.size()), y(at.size());
    const auto multiply = [&](const auto& moves, bool magnitudes, const auto& use) {
      std::ranges::fill(x, 0.0);
      std::ranges::fill(y, 0.0);
      for (const Moved& moved : moved_) x[moved.equation] = moves(moved);
      matrix.multiply_elsewhere(x, y, magnitudes);
      for (const Moved& moved : moved_)
        if (y[moved.equation] != 0) use(images[moved.equation], moved, y[moved.equation]);
    };
    for (Eigen::Index motion = 0; motion < 6; ++motion)  // one of each body at once: no cell meets two of them
      multiply([&](const Moved& moved) { return motion < moved.by.size() ? moved.by[motion] : 0.0; }, false,
               [&](Image& image, const Moved& moved, double value) { of_body(image, moved.first)[motion] += value; });
    multiply([](const Moved& moved) { return moved.by.cwiseAbs().sum(); }, true,
             [&](Image& image, const Moved& moved, double value) {
               of_body(image, moved.first);  // of a row that nothing moves, too: on even meshes its entries cancel exactly
               image.most += value;
             });
  }
  Triangle resistance(columns);
  for (const Image& image : images) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(columns);
    const auto put = [&](std::int32_t first, const MotionVector& values) {
      for (Eigen::Index i = 0; i < 6 && first + i < columns && bodies_[first + i] == bodies_[first]; ++i)
        row[first + i] = values[i] / image.most;
    };
    if (image.most == 0) continue;
    put(image.first, image.own);
    for (const auto& [first, values] : image.others) put(first, values);
    if (row.cwiseAbs().maxCoeff() > negligible) resistance.add(row);
  }
  Eigen::MatrixXd free = resistance.null_space(negligible);

  std::vector<LooseMotion> loose;
  for (Eigen::Index motion = 0; motion < free.cols(); ++motion) {
    LooseMotion found{-1, {}};
    for (Eigen::Index i = 0; i < columns; ++i)
      if (std::abs(free(i, motion)) > takes_part) found.bodies.insert(bodies_[static_cast<std::size_t>(i)]);
    const auto moves = [&](const Moved& moved, Eigen::Index which) {
      return moved.by.dot(free.col(which).segment(moved.first, moved.by.size()));
    };
    const Moved* largest = &moved_.front();
    double size = 0;
    for (const Moved& moved : moved_)
      if (const double now = std::abs(moves(moved, motion)); now > (1 + takes_part) * size) largest = &moved, size = now;
    found.dof = largest->dof;
    // the others do not move it
    for (Eigen::Index other = motion + 1; other < free.cols(); ++other)
      free.col(other) -= moves(*largest, other) / moves(*largest, motion) * free.col(motion);
    loose.push_back(found);
  }
  return loose;
}

}  // namespace lacon
