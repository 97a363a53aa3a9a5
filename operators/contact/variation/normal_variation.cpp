#include "lacon/operators/contact/variation/normal_variation.hpp"

#include <algorithm>
#include <cmath>

#include "lacon/operators/contact/variation/variations.hpp"

// A nodal normal is nu = S / |S|, S the sum of the unit normals m = N / |N| of the cells that meet at the node. Of both,
//     d(N / L) = P dN / L,   d2(N / L) = P d2N / L - m |dm|^2 - 2 dm dL / L,   P = 1 - m m^T.

namespace lacon {
namespace {

using namespace variations;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Coordinates of the nodes of a cell, (n, D).
template <int D>
std::array<double, max_skin_nodes * D> nodes_of(const Surface& skin, std::int32_t cell) {
  std::array<double, max_skin_nodes * D> x{};
  std::size_t at = 0;
  for (const std::int32_t node : skin.nodes[cell])
    for (int d = 0; d < D; ++d) x[at++] = skin.coordinates[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(d)];
  return x;
}

/// A vector as a function of all variables: its value and derivatives; second ones where `form` asks for factor . d2.
template <int D>
struct Varied {
  Vector<D> value;
  Matrix first;  ///< (D, n)
};

/// The direction of a vector. @param weight the second derivative of weight . direction goes to `form`, but for the part of
/// d2 value, whose weight is returned
template <int D>
Vector<D> normalise(Varied<D>& vector, const Vector<D>& weight, QuadraticForm* form) {
  const double length = vector.value.norm();
  const Vector<D> m = vector.value / length;
  const Matrix stretch = m.transpose() * vector.first / length;
  vector.first = (vector.first / length - m * stretch).eval();
  vector.value = m;
  if (form) {
    const double along = weight.dot(m);
    for (int d = 0; d < D; ++d) form->add(-along, vector.first.row(d), vector.first.row(d));
    form->add(-2.0, weight.transpose() * vector.first, stretch);
  }
  return (weight - weight.dot(m) * m) / length;
}

}  // namespace

NormalVariation::NormalVariation(const Surface& skin) {
  first_.assign(skin.coordinates.size() / 3 + 1, 0);
  for (const std::int32_t node : skin.nodes.values) ++first_[static_cast<std::size_t>(node) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  corners_.resize(skin.nodes.values.size());
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t cell = 0; cell < skin.size(); ++cell) {
    const auto nodes = skin.nodes[cell];
    for (std::size_t place = 0; place < nodes.size(); ++place)
      corners_[static_cast<std::size_t>(next[nodes[place]]++)] = {static_cast<std::int32_t>(cell),
                                                                  static_cast<std::int32_t>(place)};
  }
}

void NormalVariation::append_nodes_around(const Surface& skin, std::span<const std::int32_t> nodes,
                                          std::vector<std::int32_t>& all) const {
  for (const std::int32_t node : nodes)
    for (std::int32_t c = first_[node]; c < first_[node + 1]; ++c)
      for (const std::int32_t other : skin.nodes[corners_[c].cell])
        if (std::find(all.begin(), all.end(), other) == all.end()) all.push_back(other);
}

void NormalVariation::apply(const Surface& skin, std::span<const std::int32_t> nodes, int n_normals,
                            std::span<const std::int32_t> all, GapVariation& variation) const {
  if (skin.dimension == 2)
    apply_in<2>(skin, nodes, n_normals, all, variation);
  else
    apply_in<3>(skin, nodes, n_normals, all, variation);
}

template <int D>
void NormalVariation::apply_in(const Surface& skin, std::span<const std::int32_t> nodes, int n_normals,
                               std::span<const std::int32_t> all, GapVariation& variation) const {
  const auto n = static_cast<Eigen::Index>(all.size()) * D, n_before = static_cast<Eigen::Index>(variation.gradient.size());
  const auto column = [&](std::int32_t node) { return (std::find(all.begin(), all.end(), node) - all.begin()) * D; };
  const bool second = !variation.hessian.empty();
  QuadraticForm form(n);
  Matrix chain = Matrix::Zero(n_before, n);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (int d = 0; d < D; ++d) chain(static_cast<Eigen::Index>(i) * D + d, column(nodes[i]) + d) = 1;

  for (int k = 0; k < n_normals; ++k) {
    const Eigen::Index row = static_cast<Eigen::Index>(nodes.size()) * D + k * D;
    const Vector<D> weight = Eigen::Map<const Vector<D>>(variation.gradient.data() + row);
    const auto corners = std::span(corners_).subspan(first_[nodes[k]], first_[nodes[k] + 1] - first_[nodes[k]]);
    struct CellNormal {
      Varied<D> normal;
      std::array<Matrix, D - 1> dt;
    };
    std::vector<CellNormal> cells;
    Varied<D> sum{Vector<D>::Zero(), Matrix::Zero(D, n)};
    for (const Corner& corner : corners) {
      const catalog::CellRow& cell = catalog::cell(skin.types[corner.cell]);
      const Shapes<D> phi(cell.type, cell.nodes.data() + corner.place * cell.dimension);
      const auto x = nodes_of<D>(skin, corner.cell);
      const Interpolated<D> at(phi, x.data());
      CellNormal& own = cells.emplace_back();
      for (int i = 0; i < D - 1; ++i) {
        own.dt[i] = Matrix::Zero(D, n);
        for (int a = 0; a < phi.n; ++a)
          for (int d = 0; d < D; ++d) own.dt[i](d, column(skin.nodes[corner.cell][a]) + d) = phi.slope(a, i);
      }
      own.normal = {AreaNormal<D>(at).n, area_normal_rows<D>(at.d, own.dt)};
      const double length = own.normal.value.norm();
      sum.value += own.normal.value / length;
      const Vector<D> m = own.normal.value / length;
      sum.first += (own.normal.first - m * (m.transpose() * own.normal.first)) / length;
    }
    const Vector<D> of_sum = normalise<D>(sum, weight, second ? &form : nullptr);
    chain.middleRows(row, D) = sum.first;
    if (!second) continue;
    for (CellNormal& own : cells) {
      const Vector<D> of_normal = normalise<D>(own.normal, of_sum, &form);
      if constexpr (D == 3)  // d2N = 2 dt x ds
        form.add_cross(2.0 * of_normal, own.dt[0], own.dt[1]);
    }
  }

  const Eigen::Map<const Eigen::RowVectorXd> gradient(variation.gradient.data(), n_before);
  const Eigen::RowVectorXd by_nodes = gradient * chain;
  if (second) {
    const Eigen::Map<const Matrix> hessian(variation.hessian.data(), n_before, n_before);
    const Matrix sum = chain.transpose() * hessian * chain + form.matrix();
    variation.hessian.assign(sum.data(), sum.data() + n * n);
  }
  variation.gradient.assign(by_nodes.data(), by_nodes.data() + n);
  for (MovingEnd& end : variation.ends)
    for (std::vector<double>* const row : {&end.gradient, &end.place}) {
      const Eigen::RowVectorXd chained = Eigen::Map<const Eigen::RowVectorXd>(row->data(), n_before) * chain;
      row->assign(chained.data(), chained.data() + n);
    }
}

}  // namespace lacon
