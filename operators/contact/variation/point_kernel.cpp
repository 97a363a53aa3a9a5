// Products of what moves at the points, by the nodes.
#include "lacon/operators/contact/variation/point_kernel.hpp"

#include "lacon/operators/contact/variation/point_integrand.hpp"

namespace lacon::variations {

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::add_apart() {
  for (int a = 0; a < slaves; ++a) sums.of_skins_.left(a) = -phi.value(a);
  for (int a = 0; a < masters; ++a) sums.of_skins_.left(slaves + a) = psi.value(a);
  for (int d = 0; d < D; ++d) {
    NodeRow<D> row = row_of(L::apart + d, true);
    for (int e = 0; e < D; ++e) row.apart[e] = form.of[L::apart + d][L::apart + e];
    expand(row, sums.of_skins_.right() + static_cast<std::size_t>(d) * next_row);
  }
  sums.of_skins_.next();
}

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::add_area() {
  NodeRow<D> of_area_rows[D];
  for (int d = 0; d < D; ++d) {
    of_area_rows[d] = row_of(L::area + d, false);
    Vector own;
    for (int e = 0; e < D; ++e) own[e] = form.of[L::area + d][L::area + e];
    of_tangents<D>(slave.slopes(), own, of_area_rows[d].tangent);
  }
  const Vector crossing = Lanes(2 * w) * of_area;  // of dt x ds
  for (int i = 0; i < R; ++i) {
    for (int a = 0; a < slaves; ++a) sums.of_slaves_.left(a) = phi.slope(a, i);
    for (int d = 0; d < D; ++d) {
      NodeRow<D> row;
      const auto add = [&](const NodeRow<D>& other, const Lanes& times) LACON_INLINE_LAMBDA {
        for (int j = 0; j < R; ++j) row.tangent[j] += times * other.tangent[j], row.slide[j] += times * other.slide[j];
        row.normal += times * other.normal;
      };
      if constexpr (D == 2) {
        add(of_area_rows[1 - d], Lanes{} + (d == 0 ? -1.0 : 1.0));
      } else {
        const Vector& t = slave.d(1 - i);  // t[1] x rows, rows x t[0]
        const double sign = i == 0 ? 1 : -1;
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        add(of_area_rows[f], Lanes(sign * t[e]));
        add(of_area_rows[e], Lanes(-sign * t[f]));
        if (i == 0) row.tangent[1][e] += crossing[f], row.tangent[1][f] -= crossing[e];
      }
      expand(row, sums.of_slaves_.right() + static_cast<std::size_t>(d) * next_row);
    }
    sums.of_slaves_.next();
  }
}

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::add_normal() {
  for (int a = 0; a < slaves; ++a) sums.of_normals_.left(a) = phi.value(a);
  for (int d = 0; d < D; ++d) {
    NodeRow<D> row;
    for (int i = 0; i < R; ++i) row.slide[i] = form.both(L::normal + d, L::slide + i) * a_;
    for (int e = 0; e < D; ++e) row.normal[e] = form.of[L::normal + d][L::normal + e];
    expand(row, sums.of_normals_.right() + static_cast<std::size_t>(d) * next_row);
  }
  sums.of_normals_.next();
}

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::add_radius() {
  for (int a = 0; a < slaves; ++a) sums.of_slaves_.left(a) = phi.value(a);
  NodeRow<D> row = row_of(L::last, true);
  expand(row, sums.of_slaves_.right());
  for (int a = 0; a < slaves; ++a)  // by the radius itself
    lanes(sums.of_slaves_.right() + static_cast<std::size_t>(a * D) * next, 0) += phi.value(a) * form.of[L::last][L::last];
  for (int column = 0; column < columns; ++column)
    lanes(sums.of_slaves_.right() + next_row + static_cast<std::size_t>(column) * next, 0) = Lanes{};
  sums.of_slaves_.next();
}

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::find_rows_of_xi() {
  for (int j = 0; j < R; ++j) {
    NodeRow<D> row = row_of(L::xi + j, true);
    row.tangent[j] += Lanes(2 * w) * of_place;
    if constexpr (D == 3) {
      row.tangent[1] += cross(Lanes(2 * w) * of_area, slave.dd(0, j));
      row.tangent[0] += cross(slave.dd(1, j), Lanes(2 * w) * of_area);
    }
    expand(row, sums.of_corners_.right() + static_cast<std::size_t>(j) * next_row);
    for (int a = 0; a < slaves; ++a) {
      for (int d = 0; d < D; ++d) {
        Lanes more{};
        for (int i = 0; i < R; ++i) more += phi.bend(a, i, j) * of_tangent[i][d];
        of_xi(j, a * D + d) += 2 * w * more;
        if (smooth) of_xi(j, first_normal + a * D + d) += 2 * w * phi.slope(a, j) * of_normal[d];
        if constexpr (D == 2)
          if (axis && d == 0) of_xi(j, a * D) += phi.value(a) * form.both(L::xi + j, L::last);
      }
    }
  }
}

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::add_plane() {
  // A . dm
  for (int d = 0; d < 3; ++d) sums.of_means_.left(d) = area.n[d];
  LaneVector<3> of_node[max_slave_nodes], turned[R][max_slave_nodes];
  for (int a = 0; a < slaves; ++a) {
    const LaneVector<3> u =
        Lanes(Lanes{} + sums.plane_->of_c[1][a]) * chart[0] - Lanes(Lanes{} + sums.plane_->of_c[0][a]) * chart[1];
    of_node[a] = cross(area.n, u);
    for (int j = 0; j < R; ++j) turned[j][a] = cross(area.d[j], u);
  }
  expand(row_of(L::last, true), sums.of_means_.right());
  const Lanes of_turned = -2 * w * h / lift;
  for (int a = 0; a < slaves; ++a) {
    const LaneVector<3> by_mean = phi.slope(a, 1) * slave.d(0) - phi.slope(a, 0) * slave.d(1);
    for (int d = 0; d < 3; ++d) {
      lanes(sums.of_means_.right() + static_cast<std::size_t>(3 * a + d) * next, 0) +=
          form.of[L::last][L::last] * of_node[a][d];
      add_up.turned[a][d] += of_turned * by_mean[d];
    }
    for (int i = 0; i < 2; ++i) add_up.held[i][a] += w * nu[i] * left[a];
    // with dxi: A . dm, A_j . dm, x_j . dc
    const Lanes of_c = 2 * w * (nu[0] * sums.plane_->of_c[0][a] + nu[1] * sums.plane_->of_c[1][a]);
    for (int j = 0; j < R; ++j)
      for (int d = 0; d < 3; ++d)
        of_xi(j, 3 * a + d) +=
            form.both(L::xi + j, L::last) * of_node[a][d] + of_turned * turned[j][a][d] + of_c * slave.d(j)[d];
  }
  sums.of_means_.next();
  for (int d = 0; d < 3; ++d) {
    add_up.second_of_mean[d] += w * of_mean[d];
    for (int corner = 0; corner < D; ++corner) add_up.corner_by_e[corner][d] -= w * share[corner] * held[d];
  }
  for (int corner = 0; corner < D; ++corner)
    for (int i = 0; i < 2; ++i) add_up.corner_by_c[corner][i] -= w * nu[i] * share[corner];
  // dxi itself hangs on the slave's nodes: as a row there, and in products with all of these
  LaneVector<3> dxi[R][max_slave_nodes];
  for (int a = 0; a < slaves; ++a) {
    LaneVector<3> equation[2];
    for (int i = 0; i < 2; ++i) equation[i] = left[a] * chart[i] + Lanes(Lanes{} + sums.plane_->of_c[i][a]) * off;
    for (int i = 0; i < 2; ++i) dxi[i][a] = Lanes(-inverse[i][0]) * equation[0] - inverse[i][1] * equation[1];
  }
  const auto add_dxi = [&](bool transposed) LACON_INLINE_LAMBDA {
    for (int j = 0; j < R; ++j)
      for (int i = 0; i < R; ++i) {
        const Lanes factor = transposed ? form.of[L::xi + i][L::xi + j] : form.of[L::xi + j][L::xi + i];
        for (int a = 0; a < slaves; ++a)
          for (int d = 0; d < 3; ++d) of_xi(j, 3 * a + d) += factor * dxi[i][a][d];
      }
  };
  add_dxi(false);
  for (int a = 0; a < slaves; ++a) sums.of_slaves_.left(a) = left[a];
  for (int d = 0; d < 3; ++d) sums.of_offs_.left(d) = off[d];
  for (int column = 0; column < columns; ++column) {
    const std::size_t at = static_cast<std::size_t>(column) * next;
    const Lanes m[2] = {of_xi(0, column), of_xi(1, column)};
    Lanes mu[2];
    for (int i = 0; i < 2; ++i) {
      mu[i] = -(inverse[0][i] * m[0] + inverse[1][i] * m[1]);
      lanes(sums.of_offs_.right() + static_cast<std::size_t>(i) * next_row + at, 0) = mu[i];
    }
    for (int d = 0; d < 3; ++d)
      lanes(sums.of_slaves_.right() + static_cast<std::size_t>(d) * next_row + at, 0) =
          mu[0] * chart[0][d] + mu[1] * chart[1][d];
  }
  sums.of_slaves_.next(), sums.of_offs_.next();
  add_dxi(true);
}

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::add_corners() {
  for (int column = 0; column < columns; ++column) {
    Lanes by_side[R] = {};
    for (int i = 0; i < R; ++i)
      for (int j = 0; j < R; ++j) by_side[j] += sides[i][j] * of_xi(i, column);
    for (int j = 0; j < R; ++j) of_xi(j, column) = by_side[j];
  }
  for (int corner = 0; corner < sums.n_corners_; ++corner) sums.of_corners_.left(corner) = Lanes{};
  for (int corner = 0; corner < D; ++corner)
    sums.of_corners_.left(sums.corners_[static_cast<std::size_t>(corner)]) = share[corner];
  sums.of_corners_.next();
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < R; ++j) {
      Lanes pair{};
      for (int s = 0; s < R; ++s)
        for (int t = 0; t < R; ++t) pair += sides[s][i] * form.of[L::xi + s][L::xi + t] * sides[t][j];
      for (int corner = 0; corner < D; ++corner)
        for (int other = 0; other < D; ++other) add_up.corner_pairs[corner][other][i][j] += share[corner] * share[other] * pair;
    }
}

namespace {

template <bool smooth, bool plane, int D>
LACON_INLINE void add_to(PointSums<D>& sums, const PointBlock<D>& block) {
  PointKernel<D, smooth, plane>(sums, block).add();
}

// each for several instruction sets
LACON_KERNEL void add_2d(PointSums<2>& sums, const PointBlock<2>& block) { add_to<false, false>(sums, block); }
LACON_KERNEL void add_2d_smooth(PointSums<2>& sums, const PointBlock<2>& block) { add_to<true, false>(sums, block); }
LACON_KERNEL void add_3d(PointSums<3>& sums, const PointBlock<3>& block) { add_to<false, false>(sums, block); }
LACON_KERNEL void add_3d_plane(PointSums<3>& sums, const PointBlock<3>& block) { add_to<false, true>(sums, block); }
LACON_KERNEL void add_3d_smooth(PointSums<3>& sums, const PointBlock<3>& block) { add_to<true, false>(sums, block); }
LACON_KERNEL void add_3d_smooth_plane(PointSums<3>& sums, const PointBlock<3>& block) { add_to<true, true>(sums, block); }

}  // namespace

template <int D>
void PointSums<D>::add(const PointBlock<D>& block) {
  const bool smooth = !cell_->slave_normals.empty();
  if constexpr (D == 2)
    (smooth ? add_2d_smooth : add_2d)(*this, block);
  else if (plane_)
    (smooth ? add_3d_smooth_plane : add_3d_plane)(*this, block);
  else
    (smooth ? add_3d_smooth : add_3d)(*this, block);
}

template void PointSums<2>::add(const PointBlock<2>&);
template void PointSums<3>::add(const PointBlock<3>&);

}  // namespace lacon::variations
