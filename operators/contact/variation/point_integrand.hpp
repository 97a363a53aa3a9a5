#pragma once
// What is known at a point by itself, before it goes to the nodes: the integrand, the chart, the form of second derivatives.
#include "lacon/operators/contact/variation/point_kernel.hpp"

namespace lacon::variations {

LACON_INLINE Lanes masked(const LaneMask& mask, const Lanes& yes, const Lanes& no) { return mask ? yes : no; }

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::find_integrand() {
  const Vector& normal = smooth ? nodal.x() : area.n;
  size = length(normal);
  n = 1 / size * normal;
  g = dot(master.x() - slave.x(), n);
  c = g;
  for (int a = 0; a < static_cast<int>(cell.slave_offset.size()); ++a) {
    const double offset = cell.slave_offset[static_cast<std::size_t>(a)];
    c -= phi.value(a) * offset;
    for (int i = 0; i < R; ++i) offset_slope[i] += phi.slope(a, i) * offset;
  }
  if constexpr (D == 2) {
    a_ = out_of(master.d(0)), b[0] = {{-n[1], n[0]}};
  } else {
    a_ = cross(master.d(0), master.d(1)), b[0] = cross(master.d(1), n), b[1] = cross(n, master.d(0));
  }
  a_ = 1 / dot(a_, n) * a_;
  for (int i = 0; i < R; ++i) b[i] = 1 / dot(b[i], master.d(i)) * b[i];

  radius = lift = Lanes{} + 1.0;
  if (current) {
    jacobian = length(area.n);
    if (axis) radius = slave.x()[0];
  } else {
    const LaneInterpolated<D> initial(phi, second ? 3 : 2, cell.slave_initial.data());
    const LaneNormal<D> at_first(initial);
    jacobian = length(at_first.n);
    for (int i = 0; i < R; ++i) jacobian_slope[i] = dot(at_first.n, at_first.d[i]) / jacobian;
    for (int i = 0; i < R && second; ++i)
      for (int j = 0; j < R; ++j)
        jacobian_second[i][j] = (dot(at_first.n, LaneNormal<D>::second(initial, i, j)) + dot(at_first.d[i], at_first.d[j]) -
                                 jacobian_slope[i] * jacobian_slope[j]) /
                                jacobian;
    if (axis) {
      radius = initial.x()[0];
      for (int i = 0; i < R; ++i) {
        radius_slope[i] = initial.d(i)[0];
        for (int j = 0; j < R && second; ++j) radius_second[i][j] = initial.dd(i, j)[0];
      }
    }
  }
  if (axis) {  // beyond the axis, where an iterate may be on its way, nothing counts
    rule = masked(radius > 0, rule, Lanes{});
    radius = masked(radius > 0, radius, Lanes{} + 1.0);
  }
  if constexpr (plane) mean = everywhere<D>(sums.plane_->mean), lift = dot(area.n, mean);
  k = jacobian * radius / lift;
  h = k * c;
  of_image = k * a_;
  of_place = Lanes(-k) * a_;
  (smooth ? of_normal : of_area) = Lanes(-k * g / size) * (a_ - n);
  if (current) {
    of_area += Lanes(c * radius / lift / jacobian) * area.n;
    if (axis) of_place[0] += c * jacobian;
  }
  if constexpr (plane) {
    of_area += Lanes(-h / lift) * mean;
    of_mean = Lanes(-h / lift) * area.n;
  }
  for (int i = 0; i < R; ++i) {
    slope[i] = dot(of_place, slave.d(i)) + dot(of_area, area.d[i]) +
               c / lift * (jacobian_slope[i] * radius + jacobian * radius_slope[i]) - k * offset_slope[i];
    if (smooth) slope[i] += dot(of_normal, nodal.d(i));
  }
}

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::find_chart() {
  for (int corner = 0; corner < D; ++corner) share[corner] = lanes(block.share, corner);
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < R; ++j) sides[i][j] = Lanes{} + sums.sides_[static_cast<std::size_t>(i * R + j)];
  if constexpr (plane) {
    LaneVector<3> edge[2];
    for (int i = 0; i < 2; ++i)
      chart[i] = everywhere<3>(sums.plane_->c[i]), edge[i] = everywhere<3>(sums.plane_->e[i]), place[i] = lanes(block.place, i);
    Lanes m[2][2];
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) m[i][j] = dot(chart[i], slave.d(j));
    const Lanes scale = 1 / (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
    inverse[0][0] = scale * m[1][1], inverse[0][1] = -scale * m[0][1];
    inverse[1][0] = -scale * m[1][0], inverse[1][1] = scale * m[0][0];
    for (int i = 0; i < 2; ++i) {
      nu[i] = -(inverse[0][i] * slope[0] + inverse[1][i] * slope[1]);
      for (int j = 0; j < 2; ++j) sides[i][j] = inverse[i][0] * dot(chart[0], edge[j]) + inverse[i][1] * dot(chart[1], edge[j]);
    }
    held = nu[0] * chart[0] + nu[1] * chart[1];
    of_place += held;
    off = slave.x() - (everywhere<3>(sums.plane_->origin) + place[0] * edge[0] + place[1] * edge[1]);
    for (int a = 0; a < slaves; ++a)
      left[a] =
          phi.value(a) - sums.plane_->of_origin[a] - place[0] * sums.plane_->of_e[0][a] - place[1] * sums.plane_->of_e[1][a];
    for (int d = 0; d < 3; ++d) {
      add_up.of_mean[d] += rule * of_mean[d];
      for (int i = 0; i < 2; ++i) {
        add_up.of_directions[i][d] += rule * nu[i] * off[d];
        add_up.of_sides[i][d] -= rule * place[i] * held[d];
      }
      add_up.of_origin[d] -= rule * held[d];
    }
  }
}

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::add_first() {
  add_up.value += rule * h;
  of_tangents<D>(slave.slopes(), of_area, of_tangent);
  for (int a = 0; a < slaves; ++a) {
    Vector of_node = phi.value(a) * of_place;
    for (int i = 0; i < R; ++i) of_node += phi.slope(a, i) * of_tangent[i];
    for (int d = 0; d < D; ++d) {
      add_up.gradient[a * D + d] += rule * of_node[d];
      if (smooth) add_up.gradient[first_normal + a * D + d] += rule * phi.value(a) * of_normal[d];
    }
  }
  for (int a = 0; a < masters; ++a)
    for (int d = 0; d < D; ++d) add_up.gradient[first_master + a * D + d] += rule * psi.value(a) * of_image[d];
  for (int j = 0; j < R; ++j) {
    Lanes of_side{};
    for (int i = 0; i < R; ++i) of_side += sides[i][j] * slope[i];
    for (int corner = 0; corner < D; ++corner) add_up.of_corner[corner][j] += rule * share[corner] * of_side;
  }
}

template <int D, bool smooth, bool plane>
LACON_INLINE void PointKernel<D, smooth, plane>::find_form() {
  w = rule * sums.factor_;
  constexpr int turning = smooth ? L::normal : L::area;
  const Vector* const turns = smooth ? nodal.slopes() : area.d;
  typename L::Row sideways, stretch, dg, dk, djacobian, dlift;  // a . dn, relative length of N, ...
  sideways.add(turning, 1 / size * (a_ - n), turns);
  stretch.add(turning, 1 / size * n, turns);
  dg = Lanes(-g) * sideways;
  for (int d = 0; d < D; ++d) dg.of[L::apart + d] += a_[d];
  for (int j = 0; j < R; ++j) dg.of[L::xi + j] -= dot(a_, slave.d(j));
  if (current)
    djacobian.add(L::area, 1 / jacobian * area.n, area.d);
  else
    for (int j = 0; j < R; ++j) djacobian.of[L::xi + j] = jacobian_slope[j];
  dk = Lanes(radius / lift) * djacobian;
  Lanes of_turn = w * k * g;  // of |dn|^2
  if (current) {
    const Lanes of_area_turn = w * c * radius / lift * jacobian;
    if (smooth) {
      form.add_square(L::area, of_area_turn / (jacobian * jacobian), area.d);
      form.add(Lanes(-of_area_turn / (jacobian * jacobian)) * djacobian, djacobian);
    } else {
      of_turn += of_area_turn;
    }
  }
  if constexpr (D == 2)
    if (axis) {
      typename L::Row dradius;
      if (current) dradius.of[L::last] = Lanes{} + 1.0;
      for (int j = 0; j < R; ++j) dradius.of[L::xi + j] = current ? slave.d(j)[0] : radius_slope[j];
      dk += jacobian * dradius;
      form.add(Lanes(2 * w * c) * djacobian, dradius);
    }
  if constexpr (plane) {
    dlift.of[L::last] = Lanes{} + 1.0;
    dlift.add(L::area, mean, area.d);
    dk += Lanes(-k / lift) * dlift;
    form.add(Lanes(-2 * w * c / lift) * dlift, dk);
  }
  {
    typename L::Row with_gap = dk, with_stretch = Lanes(2 * w * k * g) * sideways;
    with_gap += Lanes(-k) * sideways;
    form.add(Lanes(2 * w) * dg, with_gap);
    form.add_square(turning, of_turn / (size * size), turns);  // |dn|^2 = |dN / L|^2 - stretch^2
    with_stretch += Lanes(-of_turn) * stretch;
    form.add(stretch, with_stretch);
  }
  for (int i = 0; i < R && !cell.slave_offset.empty(); ++i)
    for (int j = 0; j < L::size; ++j) form.of[L::xi + i][j] -= 2 * w * offset_slope[i] * dk.of[j];
  typename L::Row deta[R];  // the image slides along a master that bends and turns
  for (int i = 0; i < R; ++i) {
    deta[i].add(turning, Lanes(g / size) * b[i], turns);
    for (int d = 0; d < D; ++d) deta[i].of[L::apart + d] -= b[i][d];
    for (int j = 0; j < R; ++j) deta[i].of[L::xi + j] += dot(b[i], slave.d(j));
  }
  for (int i = 0; i < R; ++i) {
    typename L::Row along;
    for (int j = 0; j < R; ++j) along += dot(of_image, master.dd(i, j)) * deta[j];
    along.of[L::slide + i] += 2 * k;
    form.add(w * deta[i], along);
  }
  // where reference coordinates change linearly
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < R; ++j) {
      Lanes bent = dot(of_place, slave.dd(i, j)) + dot(of_area, LaneNormal<D>::second(slave, i, j));
      if (smooth) bent += dot(of_normal, nodal.dd(i, j));
      bent += c / lift * (radius * jacobian_second[i][j] + jacobian * radius_second[i][j]);
      for (int a = 0; a < static_cast<int>(cell.slave_offset.size()); ++a)
        bent -= k * phi.bend(a, i, j) * cell.slave_offset[static_cast<std::size_t>(a)];
      form.of[L::xi + i][L::xi + j] += w * bent;
    }
}

}  // namespace lacon::variations
