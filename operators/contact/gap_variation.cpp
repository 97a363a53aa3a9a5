#include "lacon/operators/contact/gap_variation.hpp"

#include <cblas.h>

#include "lacon/operators/contact/cell_variation.hpp"

namespace lacon {

Eigen::MatrixXd variations::QuadraticForm::matrix() const {
  const auto n = static_cast<int>(n_);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n_, n_);
  if (count_ > 0)  // the rows of both are columns to a library that goes column by column
    cblas_dsyr2k(CblasColMajor, CblasLower, CblasNoTrans, n, static_cast<int>(count_), 0.5, left_.data(), n, right_.data(), n,
                 0.0, sum.data(), n);
  sum.triangularView<Eigen::StrictlyUpper>() = sum.transpose();
  return sum;
}

int ContactCellGeometry::n_nodes() const {
  return catalog::cell(slave).n_nodes + catalog::cell(master).n_nodes + static_cast<int>(other_nodes.size()) / dimension;
}

int ContactCellGeometry::n_unknowns() const {
  return n_nodes() * dimension + (slave_normals.empty() ? 0 : catalog::cell(slave).n_nodes * dimension);
}

void variations::chain_corners(const Row& gradient, const Eigen::MatrixXd& corners, int n_unknowns, const QuadraticForm* form,
                               GapVariation& variation) {
  const int n = n_unknowns;
  const Eigen::Index n_corners = corners.rows();
  const Row by_nodes = gradient.head(n) + gradient.segment(n, n_corners) * corners;
  variation.gradient.assign(by_nodes.data(), by_nodes.data() + n);
  variation.hessian.clear();
  if (!form) return;
  const Eigen::MatrixXd all = form->matrix();
  const Eigen::MatrixXd mixed = all.block(0, n, n, n_corners) * corners;
  const Eigen::MatrixXd hessian = all.topLeftCorner(n, n) + mixed + mixed.transpose() +
                                  corners.transpose() * all.block(n, n, n_corners, n_corners) * corners;
  variation.hessian.assign(hessian.data(), hessian.data() + n * n);
}

void vary_gap(const ContactCellGeometry& cell, bool second, GapVariation& variation) {
  if (cell.dimension == 2)
    variations::vary_in_plane(cell, second, variation);
  else
    variations::vary_in_space(cell, second, variation);
}

}  // namespace lacon
