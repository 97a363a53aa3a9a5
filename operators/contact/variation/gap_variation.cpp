#include "lacon/operators/contact/variation/gap_variation.hpp"

#include <cblas.h>

#include "lacon/operators/contact/variation/cell_variation.hpp"

namespace lacon {

void variations::QuadraticForm::sum_up() {
  const auto n = static_cast<int>(size());
  // not dsyr2k, which takes longer for matrices so small
  if (count_ > 0)
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, n, n, static_cast<int>(count_), 1.0, left_.data(), n, right_.data(), n,
                1.0, sum_.data(), n);
  count_ = 0;
}

Eigen::MatrixXd variations::QuadraticForm::matrix() {
  sum_up();
  return 0.5 * (sum_ + sum_.transpose());
}

int ContactCellGeometry::n_nodes() const {
  return catalog::cell(slave).n_nodes + catalog::cell(master).n_nodes + static_cast<int>(other_nodes.size()) / dimension;
}

int ContactCellGeometry::n_unknowns() const {
  return n_nodes() * dimension + (slave_normals.empty() ? 0 : catalog::cell(slave).n_nodes * dimension);
}

variations::Matrix variations::by_corners(const Eigen::MatrixXd& by_points, const Columns& columns) {
  const auto& [skins, others, normals, n_corners] = columns;
  Matrix mixed = Matrix::Zero(n_corners, columns.unknowns());
  mixed.leftCols(skins) = by_points.block(columns.first_corner(), 0, n_corners, skins);
  mixed.rightCols(normals) = by_points.block(columns.first_corner(), skins, n_corners, normals);
  return mixed;
}

void variations::chain_corners(const Eigen::MatrixXd& by_points, const Columns& columns, const Matrix& corners,
                               const std::vector<OwnUnknown>& own, QuadraticForm& form, GapVariation& variation) {
  const auto& [skins, others, normals, n_corners] = columns;
  const Eigen::Index n = columns.unknowns(), behind = skins + others;
  Matrix right = by_points.bottomRightCorner(n_corners, n_corners) * corners;
  right.leftCols(n) += 2 * by_corners(by_points, columns);
  for (Eigen::Index k = 0; k < n_corners; ++k) form.add(1, corners.row(k), right.row(k));
  Eigen::MatrixXd hessian = form.matrix();
  hessian.topLeftCorner(skins, skins) += by_points.topLeftCorner(skins, skins);
  hessian.block(behind, 0, normals, skins) += by_points.block(skins, 0, normals, skins);
  hessian.block(0, behind, skins, normals) += by_points.block(0, skins, skins, normals);
  hessian.block(behind, behind, normals, normals) += by_points.block(skins, skins, normals, normals);
  variation.hessian.resize(static_cast<std::size_t>(n * n));
  Eigen::Map<Eigen::MatrixXd>(variation.hessian.data(), n, n) = hessian.topLeftCorner(n, n);
  for (Eigen::Index k = 0; k < std::ssize(own); ++k) {
    const auto& [gap, place] = own[static_cast<std::size_t>(k)];
    const Row gradient = hessian.row(n + k).head(n);
    variation.ends.push_back({gap, {gradient.begin(), gradient.end()}, {place.begin(), place.end()}});
  }
}

void vary_gap(const ContactCellGeometry& cell, bool second, GapVariation& variation) {
  if (cell.dimension == 2)
    variations::vary_in_plane(cell, second, variation);
  else
    variations::vary_in_space(cell, second, variation);
  variations::vary_share(cell, variation);
}

}  // namespace lacon
