// The variation of a contact cell in the plane.
#include <vector>

#include "lacon/operators/contact/variation/cell_variation.hpp"
#include "lacon/pairing/fading.hpp"

namespace lacon::variations {
namespace {

/// Where an end of an interval goes, which the normal through a node q cuts off: the zero xi of
/// f = (q - x(xi)) . T(xi), T at a right angle to the normal.
class EndVariation {
 public:
  EndVariation(const ContactCellGeometry& cell, const ContactCellGeometry::End& end, Eigen::Index n) : row_(Row::Zero(n)) {
    if (end.node < 0) return;
    const int slaves = catalog::cell(cell.slave).n_nodes, masters = catalog::cell(cell.master).n_nodes;
    const Shapes<2> phi(cell.slave, &end.crossing);
    const Interpolated<2> slave(phi, cell.slave_nodes.data());
    const bool smooth = !cell.slave_normals.empty();
    // T, its slope and its curvature
    std::array<Vector<2>, 3> t = {slave.d[0], slave.dd[0][0], Vector<2>::Zero()};
    if (smooth) {
      const Interpolated<2> normal(phi, cell.slave_normals.data());
      t = {along(normal.x), along(normal.d[0]), along(normal.dd[0][0])};
    }
    const int other = end.node - slaves - masters;
    const double* const node =
        other >= 0 ? cell.other_nodes.data() + 2 * other : cell.master_nodes.data() + 2 * (end.node - slaves);
    const Vector<2> q(node[0], node[1]), apart = q - slave.x;
    const double slope = apart.dot(t[1]) - slave.d[0].dot(t[0]);
    // where the slave's normals meet, an end has no place of its own
    if (!(std::abs(slope) > least_slope * slave.d[0].norm() * t[0].norm())) return;

    Rows<2> dq = Rows<2>::Zero(2, n), dx = dq, ddx = dq, dt = dq, ddt = dq;  // dd: of the slope
    for (int d = 0; d < 2; ++d) dq(d, 2 * end.node + d) = 1;
    for (int a = 0; a < phi.n; ++a)
      for (int d = 0; d < 2; ++d) {
        dx(d, 2 * a + d) = phi.value[static_cast<std::size_t>(a)];
        ddx(d, 2 * a + d) = phi.slope(a, 0);
        if (smooth) {  // T = (-N_y, N_x)
          const int normal = 2 * (cell.n_nodes() + a) + (1 - d);
          dt(d, normal) = (d == 0 ? -1 : 1) * phi.value[static_cast<std::size_t>(a)];
          ddt(d, normal) = (d == 0 ? -1 : 1) * phi.slope(a, 0);
        } else {
          dt(d, 2 * a + d) = phi.slope(a, 0);
          ddt(d, 2 * a + d) = phi.bend(a, 0, 0);
        }
      }
    row_ = -(t[0].transpose() * (dq - dx) + apart.transpose() * dt) / slope;
    // d2f at a given place of the end, and what the place itself adds
    const Rows<2> moved = dq - dx - slave.d[0] * row_, turned = dt + t[1] * row_;
    const auto part = [&](double factor, const Row& first, const Row& second) {
      products_.push_back({-factor / slope, first, second});
    };
    for (int d = 0; d < 2; ++d) part(2, moved.row(d), turned.row(d));
    part(1, row_, Row(2 * apart.transpose() * ddt + apart.dot(t[2]) * row_));
    part(-1, row_, Row(2 * t[0].transpose() * ddx + slave.dd[0][0].dot(t[0]) * row_));
    if (end.at != end.crossing) fade(faded_end(end.crossing, cell.fading));
  }

  const Row& row() const { return row_; }
  /// Add factor times the second derivative.
  void add_second(double factor, QuadraticForm& form) const {
    for (const Product& product : products_) form.add(factor * product.factor, product.first, product.second);
  }

 private:
  static constexpr double least_slope = 1e-9;
  struct Product {
    double factor;
    Row first, second;
  };
  static Vector<2> along(const Vector<2>& normal) { return {-normal[1], normal[0]}; }
  /// From the place where the normal crosses the slave to the end of the cover.
  void fade(const FadedEnd& end) {
    for (Product& product : products_) product.factor *= end.slope;
    products_.push_back({end.curvature, row_, row_});
    row_ *= end.slope;
  }

  Row row_;
  std::vector<Product> products_;
};

}  // namespace

void vary_in_plane(const ContactCellGeometry& cell, bool second, GapVariation& variation) {
  CellVariation<2> sum(cell, 2, second, {1});
  const Columns& columns = sum.columns();
  const Eigen::Index n = columns.unknowns(), corner = columns.first_corner();
  const auto& [from, to] = cell.ends;
  const double width = to.at - from.at;
  sum.start_simplex(1, width, {0, 1});
  for (std::size_t first = 0; first < cell.weight.size(); first += LACON_LANES) {
    PointBlock<2> block;
    for (std::size_t l = 0; l < LACON_LANES; ++l) {
      const bool none = first + l >= cell.weight.size();
      const std::size_t p = none ? first : first + l;
      block.rule[l] = none ? 0 : cell.weight[p] / width;
      block.slave[l] = cell.slave_point[p], block.master[l] = cell.master_point[p];
      const double share = (cell.slave_point[p] - from.at) / width;
      block.share[l] = 1 - share, block.share[LACON_LANES + l] = share;
    }
    sum.add(block);
  }
  sum.end_points();
  PointRow dwidth = PointRow::Zero(columns.of_points());
  dwidth[corner] = -1, dwidth[corner + 1] = 1;
  sum.end_simplex(dwidth);
  sum.end();
  // the corners as functions of the unknowns, those that keep their place of their own
  const Eigen::Index all = n + (second ? int{from.still} + int{to.still} : 0);
  const std::array ends = {EndVariation(cell, from, all), EndVariation(cell, to, all)};
  std::vector<OwnUnknown> own;
  Matrix corners = Matrix::Zero(2, all);
  for (int k = 0; k < 2; ++k) {
    const Row& end = ends[static_cast<std::size_t>(k)].row();
    if (!cell.ends[k].still) {
      corners.row(k) = end;
    } else if (second) {
      corners(k, n + std::ssize(own)) = 1;
      own.push_back({sum.gradient()[corner + k], end.head(n)});
    }
  }
  const Row gradient = sum.by_unknowns() + sum.gradient().segment<2>(corner) * corners.leftCols(n);
  variation.gap = sum.gap();
  variation.gradient.assign(gradient.data(), gradient.data() + n);
  variation.hessian.clear();
  variation.ends.clear();
  if (!second) return;
  QuadraticForm form(corners.cols());
  for (int k = 0; k < 2; ++k)
    if (!cell.ends[k].still) ends[static_cast<std::size_t>(k)].add_second(sum.gradient()[corner + k], form);
  chain_corners(sum.form().matrix(), columns, corners, own, form, variation);
}

}  // namespace lacon::variations
