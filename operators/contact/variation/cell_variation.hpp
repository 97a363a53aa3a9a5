#pragma once
// The derivatives of the integrated gap of a contact cell by the variables of its points, in the plane and in space.
#include "lacon/operators/contact/variation/gap_variation.hpp"
#include "lacon/operators/contact/variation/point_sums.hpp"
#include "lacon/operators/contact/variation/variations.hpp"

namespace lacon::variations {

/// How many columns of each kind there are: the variables of points (point_sums.hpp) leave others out, and have corners.
struct Columns {
  Eigen::Index skins, others, normals, corners;
  Eigen::Index of_points() const { return skins + normals + corners; }
  Eigen::Index unknowns() const { return skins + others + normals; }
  Eigen::Index first_corner() const { return skins + normals; }
};

/// What adds up over the simplices of a cell: G = scale * sum over simplices of part * sum over points of rule * h.
template <int D>
class CellVariation {
  static constexpr int R = D - 1;

 public:
  /// @param n_corners of the polygon; 0: points keep their places on the slave  @param sides, plane as PointSums has them
  CellVariation(const ContactCellGeometry& cell, int n_corners, bool second, const std::array<double, R * R>& sides,
                const PlaneOfSlave* plane = nullptr)
      : columns_{D * (catalog::cell(cell.slave).n_nodes + catalog::cell(cell.master).n_nodes),
                 static_cast<Eigen::Index>(cell.other_nodes.size()), static_cast<Eigen::Index>(cell.slave_normals.size()),
                 R * n_corners},
        gradient_(PointRow::Zero(columns_.of_points())),
        of_simplex_(gradient_),
        form_(second ? columns_.of_points() : 0),
        points_(workspace()) {
    points_.start(cell, n_corners, second, sides, plane);
  }

  bool is_second() const { return form_.size() > 0; }
  const Columns& columns() const { return columns_; }
  const PointSums<D>& points() const { return points_; }
  double gap() const { return gap_; }
  PointRow& gradient() { return gradient_; }  ///< of G by the variables of points
  /// Likewise by all unknowns, at fixed corners.
  Row by_unknowns() const {
    Row row = Row::Zero(columns_.unknowns());
    row.head(columns_.skins) = gradient_.head(columns_.skins);
    row.tail(columns_.normals) = gradient_.segment(columns_.skins, columns_.normals);
    return row;
  }
  QuadraticForm& form() { return form_; }
  Eigen::Index column(int corner) const { return columns_.first_corner() + R * corner; }

  /// Points of another simplex follow. @param corners by number @param part its measure
  void start_simplex(double scale, double part, const std::array<int, D>& corners) {
    scale_ = scale, part_ = part, corners_ = corners;
    points_.start_simplex(corners, scale * part);
  }
  void add(const PointBlock<D>& block) { points_.add(block); }
  /// The points of the simplex are there. @return what they add to h, by the variables of points: for what else hangs on them
  PointRow& end_points() {
    points_.end_simplex();
    const auto& simplex = points_.simplex();
    of_simplex_.setZero();
    std::copy_n(simplex.gradient, points_.columns(), of_simplex_.data());
    for (std::size_t k = 0; k < D && columns_.corners > 0; ++k)
      for (int i = 0; i < R; ++i) {
        of_simplex_[column(corners_[k]) + i] += simplex.of_corner[k][i];
        for (std::size_t l = 0; l < D && is_second(); ++l)
          for (int j = 0; j < R; ++j)
            form_.of(column(corners_[k]) + i)[column(corners_[l]) + j] += simplex.corner_pairs[k][l][i][j];
      }
    return of_simplex_;
  }
  /// And all that hangs on them. @param dpart by the variables of points  @return what the second derivative of the simplex's
  /// measure is multiplied with
  double end_simplex(const PointRow& dpart) {
    const double value = points_.simplex().value;
    gap_ += scale_ * part_ * value;
    gradient_ += scale_ * (part_ * of_simplex_ + value * dpart);
    if (is_second()) form_.add(2 * scale_, dpart, of_simplex_);
    return scale_ * value;
  }
  /// All simplices are there.
  void end() {
    points_.end();
    const Eigen::Index n = points_.columns();
    for (Eigen::Index i = 0; i < form_.size(); ++i)
      form_.of(i).head(n) +=
          Eigen::Map<const Row>((i < n ? points_.by_nodes() + i * n : points_.by_corners() + (i - n) * n), n);
  }

 private:
  static PointSums<D>& workspace() {
    thread_local PointSums<D> points;
    return points;
  }

  Columns columns_;
  double gap_ = 0, scale_ = 1, part_ = 0;
  std::array<int, D> corners_{};
  PointRow gradient_, of_simplex_;
  QuadraticForm form_;
  PointSums<D>& points_;
};

/// The second derivatives by corners and unknowns, (corners, unknowns), at fixed corners.
Matrix by_corners(const Eigen::MatrixXd& by_points, const Columns& columns);

/// The second derivatives by the unknowns, from those by the variables of points, of which the last ones are corners.
/// @param corners (corners, unknowns and own): derivatives of the corners  @param own unknowns behind the others
/// @param form what the corners' second derivatives add, by all of these
void chain_corners(const Eigen::MatrixXd& by_points, const Columns& columns, const Matrix& corners,
                   const std::vector<OwnUnknown>& own, QuadraticForm& form, GapVariation& variation);

void vary_in_plane(const ContactCellGeometry& cell, bool second, GapVariation& variation);
void vary_in_space(const ContactCellGeometry& cell, bool second, GapVariation& variation);
/// Add what the share of a couple adds that is steep (steepness.hpp), to derivatives that take it for constant.
void vary_share(const ContactCellGeometry& cell, GapVariation& variation);

}  // namespace lacon::variations
