#pragma once
// The integrand at LACON_LANES points, with its derivatives: formulas and names at the head of point_sums.hpp.
#include "lacon/operators/contact/variation/point_form.hpp"
#include "lacon/operators/contact/variation/point_sums.hpp"

namespace lacon::variations {

/// @tparam smooth nodal normals are interpolated  @tparam plane the chart is the slave's mean plane
template <int D, bool smooth, bool plane>
class PointKernel {
  static constexpr int R = D - 1;
  using L = Local<D, smooth, plane>;
  using Vector = LaneVector<D>;

 public:
  LACON_INLINE PointKernel(PointSums<D>& of, const PointBlock<D>& points)
      : sums(of),
        add_up(of.sums_),
        cell(*of.cell_),
        block(points),
        second(of.second_),
        current(cell.current_jacobian),
        axis(D == 2 && cell.axis),
        slaves(of.slaves_),
        masters(of.masters_),
        columns(of.columns_),
        phi(cell.slave, block.slave, second ? 3 : 2),
        psi(cell.master, block.master, second ? 2 : 1),
        slave(phi, second ? 3 : 2, cell.slave_nodes.data()),
        master(psi, second ? 2 : 1, cell.master_nodes.data()),
        nodal(phi, smooth ? 2 : 0, cell.slave_normals.data()),
        area(slave),
        rule(lanes(block.rule, 0)) {}
  LACON_INLINE void add() {
    find_integrand();
    find_chart();
    add_first();
    if (!second) return;
    find_form();
    for (PointProducts* products :
         {&sums.of_skins_, &sums.of_slaves_, &sums.of_normals_, &sums.of_corners_, &sums.of_means_, &sums.of_offs_})
      products->make_room();
    add_apart();
    add_area();
    if constexpr (smooth) add_normal();
    if constexpr (D == 2)
      if (axis) add_radius();
    if (sums.n_corners_ == 0) return;
    find_rows_of_xi();
    if constexpr (plane) add_plane();
    add_corners();
  }

 private:
  /// h, and its derivatives by what it is made of.
  LACON_INLINE void find_integrand();
  /// How reference coordinates hang on corners and, in a plane chart, on the slave's nodes: by the factor nu of its equations
  /// they stand still.
  LACON_INLINE void find_chart();
  LACON_INLINE void add_first();
  /// The second derivatives by what moves at the points.
  LACON_INLINE void find_form();
  /// A row by the nodes, of what is multiplied with one of these quantities.
  LACON_INLINE NodeRow<D> row_of(int of, bool with_apart) const {
    NodeRow<D> row;
    if (with_apart) row.apart = form.template block<D>(of, L::apart);
    of_tangents<D>(slave.slopes(), form.template block<D>(of, L::area), row.tangent);
    for (int i = 0; i < R; ++i) row.slide[i] = form.both(of, L::slide + i) * a_;
    if constexpr (smooth) row.normal = form.template block<D>(of, L::normal);
    return row;
  }
  LACON_INLINE void expand(const NodeRow<D>& row, double* to) const {
    for (int a = 0; a < slaves; ++a)
      for (int d = 0; d < D; ++d, to += next) {
        Lanes sum = -phi.value(a) * row.apart[d];
        for (int i = 0; i < R; ++i) sum += phi.slope(a, i) * row.tangent[i][d];
        lanes(to, 0) = sum;
      }
    for (int a = 0; a < masters; ++a)
      for (int d = 0; d < D; ++d, to += next) {
        Lanes sum = psi.value(a) * row.apart[d];
        for (int i = 0; i < R; ++i) sum += psi.slope(a, i) * row.slide[i][d];
        lanes(to, 0) = sum;
      }
    if constexpr (smooth)
      for (int a = 0; a < slaves; ++a)
        for (int d = 0; d < D; ++d, to += next) lanes(to, 0) = phi.value(a) * row.normal[d];
  }
  LACON_INLINE Lanes& of_xi(int j, int column) {
    return lanes(sums.of_corners_.right() + static_cast<std::size_t>(j) * next_row + static_cast<std::size_t>(column) * next,
                 0);
  }
  /// Products with dy - dx.
  LACON_INLINE void add_apart();
  /// With dA, by tangents: the rest of them but dy - dx.
  LACON_INLINE void add_area();
  LACON_INLINE void add_normal();
  LACON_INLINE void add_radius();
  /// What dxi is multiplied with, by the nodes.
  LACON_INLINE void find_rows_of_xi();
  /// With what a plane chart hangs on: A . dm, dc, and dxi as far as the slave's nodes move it.
  LACON_INLINE void add_plane();
  /// With dxi, as far as corners move it.
  LACON_INLINE void add_corners();

  PointSums<D>& sums;
  typename PointSums<D>::Sums& add_up;
  const ContactCellGeometry& cell;
  const PointBlock<D>& block;
  const bool second, current, axis;
  const int slaves, masters, columns;
  const int first_master = slaves * D, first_normal = first_master + masters * D;
  static constexpr std::size_t next = PointProducts::room;
  const std::size_t next_row = static_cast<std::size_t>(columns) * next;
  const LaneShapes<D> phi, psi;
  const LaneInterpolated<D> slave, master, nodal;
  const LaneNormal<D> area;
  Lanes rule;
  // names as at the head of point_sums.hpp; n unit, `size` the length of N, `lift` A . m
  Vector n, a_, b[R], mean;
  Lanes size, g, c, k, h, jacobian, radius, lift, offset_slope[R] = {};
  Lanes jacobian_slope[R] = {}, radius_slope[R] = {}, jacobian_second[R][R] = {}, radius_second[R][R] = {};  ///< initial ones
  Vector of_place, of_area, of_normal, of_image, of_mean, of_tangent[R];  ///< derivatives of h
  Lanes slope[R];                                                         ///< where the reference coordinates alone change
  Lanes share[D], sides[R][R];
  Lanes nu[2] = {}, inverse[2][2], left[max_slave_nodes], place[2];
  LaneVector<3> chart[2], held, off;  ///< c, nu . c, x - y
  Lanes w;                            ///< of second derivatives
  typename L::Form form;
};

}  // namespace lacon::variations
