#pragma once
// What the integration points of a contact cell add to the derivatives of its integrated gap, in the plane and in space.
#include <array>
#include <cmath>
#include <utility>

#include "lacon/operators/contact/gap_variation.hpp"
#include "lacon/operators/contact/variations.hpp"

// First the variables of a contact cell: its unknowns, and behind them the corners of its polygon in the slave's reference
// cell. At an integration point everything is a function of these; derivatives by them are rows, second derivatives sums of
// products of rows. In the end the corners are themselves functions of the unknowns.
//
// At a point, with x_m(eta) = x(xi) + g n: a variation R = dx_m - dx - g dn at fixed eta gives
//     dg = a . R,   d eta^i = -b^i . R,   with a . tau_i = 0, a . n = 1 and b^i . tau_j = 1 if i = j, b^i . n = 0,
// and the next one
//     d2g = a . (tau_ij d eta^i d eta^j + 2 dtau_i d eta^i - d2x - 2 dg dn - g d2n).

namespace lacon::variations {

/// The variables of a cell, and what adds up over its integration points.
template <int D>
class CellVariation {
  static constexpr int R = D - 1;
  static constexpr int products_of_a_point = D == 2 ? 24 : 64;

 public:
  /// @param n_corners reference coordinates of corners, behind the unknowns
  CellVariation(const ContactCellGeometry& cell, int n_corners, bool second)
      : cell_(cell),
        slaves_(catalog::cell(cell.slave).n_nodes),
        masters_(catalog::cell(cell.master).n_nodes),
        first_normal_(cell.n_nodes() * D),
        n_(cell.n_unknowns() + n_corners),
        second_(second),
        gradient_(Row::Zero(n_)),
        form_(n_, second ? products_of_a_point * static_cast<Eigen::Index>(cell.weight.size()) + 64 : 0) {}

  int n_variables() const { return n_; }
  double gap() const { return gap_; }
  const Row& gradient() const { return gradient_; }
  QuadraticForm& form() { return form_; }

  /// A place on the slave, which may move in its reference cell, with derivatives.
  struct OnSlave {
    const double* xi;
    Shapes<D> phi;
    Interpolated<D> at;
    AreaNormal<D> area;
    Rows<R> dxi;
    Rows<D> dx, darea;
    std::array<Rows<D>, R> bare_dt, dt;  ///< of the tangents: at a fixed reference point, and where it moves
  };
  /// @param dxi derivatives of the reference coordinates
  OnSlave on_slave(const double* xi, const Rows<R>& dxi) const {
    const Shapes<D> phi(cell_.slave, xi);
    const Interpolated<D> at(phi, cell_.slave_nodes.data());
    OnSlave point{xi, phi, at, AreaNormal<D>(at), dxi, interpolate(phi, 0, phi.value.data(), 1), {}, {}, {}};
    for (int i = 0; i < R; ++i) {
      point.dx.noalias() += at.d[i] * dxi.row(i);
      point.bare_dt[i] = interpolate(phi, 0, phi.gradient.data() + i, R);
      point.dt[i] = point.bare_dt[i];
      for (int j = 0; j < R; ++j) point.dt[i].noalias() += at.dd[i][j] * dxi.row(j);
    }
    point.darea = area_normal_rows<D>(at.d, point.dt);
    return point;
  }

  /// The gap times the measure at an integration point, and how it changes where the reference coordinates alone do.
  struct Integrand {
    double value = 0;
    Vector<R> slope = Vector<R>::Zero();
  };

  /// Add an integration point, but for second derivatives of its reference coordinates and of its weight.
  /// @param weight in the reference cell, and its derivatives
  Integrand add_point(const OnSlave& point, const double* eta, double weight, const Row& dweight) {
    const auto& [xi, phi, slave, area, dxi, dx, darea, bare_dt, dt] = point;
    const Shapes<D> psi(cell_.master, eta);
    const Interpolated<D> master(psi, cell_.master_nodes.data());
    const bool smooth = !cell_.slave_normals.empty();
    Vector<D> normal = area.n;
    std::array<Vector<D>, R> normal_slope = area.d;
    Rows<D> dnormal = darea;
    if (smooth) {
      const Interpolated<D> nodal(phi, cell_.slave_normals.data());
      normal = nodal.x;
      normal_slope = nodal.d;
      dnormal = interpolate(phi, first_normal_, phi.value.data(), 1);
      for (int i = 0; i < R; ++i) dnormal.noalias() += nodal.d[i] * dxi.row(i);
    }
    const double length = normal.norm();
    const Vector<D> n = normal / length;
    const Row stretch = n.transpose() * dnormal / length;  // of the normal's length
    const Rows<D> dn = dnormal / length - n * stretch;

    // the master: where the image moves, and the gap
    const double g = (master.x - slave.x).dot(n);
    const auto [a, b] = dual(master.d, n);
    Rows<D> apart = interpolate(psi, slaves_ * D, psi.value.data(), 1);
    apart.noalias() -= dx + g * dn;
    const Row dg = a.transpose() * apart;
    Rows<R> deta;
    deta.resize(R, n_);
    for (int i = 0; i < R; ++i) deta.row(i).noalias() = -b[i].transpose() * apart;

    // the measure
    const Measure of_area = measure(slave, area, darea, dx, dxi, xi);
    if (!(of_area.radius > 0)) return {};  // beyond the axis, where an iterate may be on its way, nothing is measured
    const double j = of_area.jacobian * of_area.radius;

    gap_ += weight * j * g;
    gradient_ += (weight * j) * dg + (g * j) * dweight +
                 (weight * g) * (of_area.radius * of_area.djacobian + of_area.jacobian * of_area.dradius);
    if (!second_) return {};

    Integrand integrand{j * g, {}};
    for (int i = 0; i < R; ++i) {
      const Vector<D> turn = (normal_slope[i] - n * n.dot(normal_slope[i])) / length;
      integrand.slope[i] = j * a.dot(-slave.d[i] - g * turn) + g * of_area.slope[i];
    }

    // second derivatives: of the products, then of each factor
    const double r = of_area.radius, jac = of_area.jacobian;
    form_.add(2.0, dweight, Row(j * dg + g * (r * of_area.djacobian + jac * of_area.dradius)));
    form_.add(2.0 * weight, dg, Row(r * of_area.djacobian + jac * of_area.dradius));
    form_.add(2.0 * weight * g, of_area.djacobian, of_area.dradius);
    const double of_g = weight * j;
    for (int i = 0; i < R; ++i) {
      // the image slides along a master that bends and turns
      Row along = 2.0 * a.transpose() * interpolate(psi, slaves_ * D, psi.gradient.data() + i, R);
      for (int k = 0; k < R; ++k) along += a.dot(master.dd[i][k]) * deta.row(k);
      form_.add(of_g, deta.row(i), along);
    }
    add_second_of_place(-of_g * a, point);  // the point slides along the slave
    form_.add(-2.0 * of_g, dg, Row(a.transpose() * dn));
    // d2n = (d2N - n (n . d2N)) / L - n |dn|^2 - 2 dn (dL / L), and a . n = 1
    form_.add(2.0 * of_g * g, stretch, Row(a.transpose() * dn));
    for (int i = 0; i < D; ++i) form_.add(of_g * g, dn.row(i), dn.row(i));
    const Vector<D> of_normal = -of_g * g / length * (a - n);
    if (smooth)
      add_second_of_nodal_normal(of_normal, phi, dxi);
    else
      add_second_of_area_normal(of_normal, point);
    add_second_of_measure(weight * g, of_area, point);
    return integrand;
  }

 private:
  struct Measure {
    double jacobian, radius = 1;
    Row djacobian, dradius;
    Eigen::Matrix<double, R, R> second = Eigen::Matrix<double, R, R>::Zero();  ///< of an initial Jacobian by xi
    Eigen::Matrix<double, R, R> radius_second = Eigen::Matrix<double, R, R>::Zero();
    Vector<R> slope = Vector<R>::Zero();  ///< of the Jacobian with the radius, where the reference coordinates alone change
  };

  /// Rows of the sum of factors times nodal vectors. @param first variable of the first node  @param factor of node a:
  /// factor[a * stride]
  Rows<D> interpolate(const Shapes<D>& shapes, int first, const double* factor, int stride) const {
    Rows<D> rows = Rows<D>::Zero(D, n_);
    for (int a = 0; a < shapes.n; ++a)
      for (int d = 0; d < D; ++d) rows(d, first + a * D + d) = factor[a * stride];
    return rows;
  }

  /// a and b of the head of the file.
  static std::pair<Vector<D>, std::array<Vector<D>, R>> dual(const std::array<Vector<D>, R>& tau, const Vector<D>& n) {
    if constexpr (D == 2) {
      const Vector<2> a = out_of(tau[0]), b = {-n[1], n[0]};
      return {a / a.dot(n), {Vector<2>(b / b.dot(tau[0]))}};
    } else {
      const Vector<3> a = tau[0].cross(tau[1]), b0 = tau[1].cross(n), b1 = n.cross(tau[0]);
      return {a / a.dot(n), {Vector<3>(b0 / b0.dot(tau[0])), Vector<3>(b1 / b1.dot(tau[1]))}};
    }
  }

  Measure measure(const Interpolated<D>& slave, const AreaNormal<D>& area, const Rows<D>& darea, const Rows<D>& dx,
                  const Rows<R>& dxi, const double* xi) const {
    Measure m;
    m.dradius = Row::Zero(n_);
    if (cell_.current_jacobian) {
      m.jacobian = area.n.norm();
      m.djacobian = area.n.transpose() * darea / m.jacobian;
      for (int i = 0; i < R; ++i) m.slope[i] = area.n.dot(area.d[i]) / m.jacobian;
      if (cell_.axis) {
        m.radius = slave.x[0];
        m.dradius = dx.row(0);
        for (int i = 0; i < R; ++i) m.slope[i] = m.slope[i] * m.radius + m.jacobian * slave.d[i][0];
      }
      return m;
    }
    const Shapes<D> phi(cell_.slave, xi);
    const Interpolated<D> initial(phi, cell_.slave_initial.data());
    const AreaNormal<D> area0(initial);
    m.jacobian = area0.n.norm();
    m.djacobian = Row::Zero(n_);
    Vector<R> slope;
    for (int i = 0; i < R; ++i) {
      slope[i] = area0.n.dot(area0.d[i]) / m.jacobian;
      m.djacobian += slope[i] * dxi.row(i);
    }
    for (int i = 0; i < R; ++i)
      for (int k = 0; k < R; ++k)
        m.second(i, k) = (area0.n.dot(area0.dd[i][k]) + area0.d[i].dot(area0.d[k]) - slope[i] * slope[k]) / m.jacobian;
    m.slope = slope;
    if (cell_.axis) {
      m.radius = initial.x[0];
      for (int i = 0; i < R; ++i) {
        m.slope[i] = slope[i] * m.radius + m.jacobian * initial.d[i][0];
        m.dradius += initial.d[i][0] * dxi.row(i);
        for (int k = 0; k < R; ++k) m.radius_second(i, k) = initial.dd[i][k][0];
      }
    }
    return m;
  }

  /// Add factor . d2N of N = sum of shape functions times nodal normals.
  void add_second_of_nodal_normal(const Vector<D>& factor, const Shapes<D>& phi, const Rows<R>& dxi) {
    const Interpolated<D> nodal(phi, cell_.slave_normals.data());
    for (int i = 0; i < R; ++i) {
      Row row = 2.0 * factor.transpose() * interpolate(phi, first_normal_, phi.gradient.data() + i, R);
      for (int k = 0; k < R; ++k) row += factor.dot(nodal.dd[i][k]) * dxi.row(k);
      form_.add(1.0, dxi.row(i), row);
    }
  }

  /// Add factor . d2t of tangent i where the reference coordinates change linearly.
  void add_second_of_tangent(int i, const Vector<D>& factor, const OnSlave& point) {
    constexpr int stride = R == 1 ? 1 : 3;
    for (int j = 0; j < R; ++j) {
      Row row = 2.0 * factor.transpose() * interpolate(point.phi, 0, point.phi.curvature.data() + i + j, stride);
      for (int k = 0; k < R; ++k) row += factor.dot(point.at.ddd[i + j + k]) * point.dxi.row(k);
      form_.add(1.0, point.dxi.row(j), row);
    }
  }

 public:
  /// Likewise factor . d2N of the area normal.
  void add_second_of_area_normal(const Vector<D>& factor, const OnSlave& point) {
    if constexpr (D == 2) {
      add_second_of_tangent(0, Vector<2>(-factor[1], factor[0]), point);
    } else {
      add_second_of_tangent(0, point.at.d[1].cross(factor), point);
      add_second_of_tangent(1, factor.cross(point.at.d[0]), point);
      form_.add_cross(2.0 * factor, point.dt[0], point.dt[1]);
    }
  }

  /// Likewise factor . d2x.
  void add_second_of_place(const Vector<D>& factor, const OnSlave& point) {
    for (int i = 0; i < R; ++i) {
      Row slide = 2.0 * factor.transpose() * point.bare_dt[i];
      for (int k = 0; k < R; ++k) slide += factor.dot(point.at.dd[i][k]) * point.dxi.row(k);
      form_.add(1.0, point.dxi.row(i), slide);
    }
  }

 private:
  /// Add factor * (jacobian d2 radius + radius d2 jacobian).
  void add_second_of_measure(double factor, const Measure& m, const OnSlave& point) {
    if (cell_.current_jacobian) {
      const double by = factor * m.radius / m.jacobian;
      for (int i = 0; i < D; ++i) form_.add(by, point.darea.row(i), point.darea.row(i));
      form_.add(-by, m.djacobian, m.djacobian);
      add_second_of_area_normal(by * point.area.n, point);
      if (cell_.axis) add_second_of_place(factor * m.jacobian * Vector<D>::Unit(0), point);
      return;
    }
    for (int i = 0; i < R; ++i)
      for (int k = 0; k < R; ++k)
        form_.add(factor * (m.radius * m.second(i, k) + m.jacobian * m.radius_second(i, k)), point.dxi.row(i),
                  point.dxi.row(k));
  }

  const ContactCellGeometry& cell_;
  int slaves_, masters_, first_normal_, n_;
  bool second_;
  double gap_ = 0;
  Row gradient_;
  QuadraticForm form_;
};

/// Derivatives by variables of which the last ones are corners, as derivatives by the first ones.
/// @param corners (corners, variables): derivatives of the corners  @param form what second derivatives are made of
void chain_corners(const Row& gradient, const Eigen::MatrixXd& corners, int n_unknowns, const QuadraticForm* form,
                   GapVariation& variation);

void vary_in_plane(const ContactCellGeometry& cell, bool second, GapVariation& variation);
void vary_in_space(const ContactCellGeometry& cell, bool second, GapVariation& variation);

}  // namespace lacon::variations
