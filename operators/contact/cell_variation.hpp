#pragma once
// What the integration points of a contact cell add to the derivatives of its integrated gap, in the plane and in space.
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "lacon/operators/contact/gap_variation.hpp"
#include "lacon/operators/contact/variations.hpp"

// The variables of points: slave, master, nodal normals, and behind them the corners of the polygon in the slave's chart, which
// in the end are themselves functions of all unknowns. At a point the integrand is
//     h = k c,   k = J r / (A . m),   c = g - o(xi),   y(eta) = x(xi) + g n(xi),
// J the measure, r the radius (1 but in axisymmetry), A the area normal, m the mean normal of a plane chart (A . m is 1
// elsewhere), o the offset of the skins, n the direction of N, which is A or interpolates nodal normals. With the multiplier k
// a of the last equation, a . y_i = 0 and a . n = 1,
//     dh  = c dk + k a . (dy - dx - g dn) - k do                                       at fixed eta,
//     d2h = c d2k + 2 dk (dg - do) + k a . (d2y - d2x - 2 dg dn - g d2n) - k d2o       where eta moves, but for d2eta,
// so that first derivatives are sums over nodes, and only second ones need rows, of the few quantities that move at a point:
//     dg = a . R,   d eta^i = -b^i . R,   R = dy - dx - g dn,   b^i . y_j = 1 if i = j, b^i . n = 0.
// Of a direction, d2n = (d2N - n (n . d2N)) / L - n |dn|^2 - 2 dn dL / L, and |N| has d2L = n . d2N + L |dn|^2.

namespace lacon::variations {

/// How many columns of each kind there are: the unknowns of points leave others out, and have corners.
struct Columns {
  Eigen::Index skins, others, normals, corners;
  Eigen::Index of_points() const { return skins + normals + corners; }
  Eigen::Index unknowns() const { return skins + others + normals; }
  Eigen::Index first_corner() const { return skins + normals; }
};

/// What adds up over the integration points of a cell: G = scale * sum over simplices of part * sum over points of rule * h.
template <int D>
class CellVariation {
  static constexpr int R = D - 1;

 public:
  /// @param n_corners coordinates of corners
  CellVariation(const ContactCellGeometry& cell, int n_corners, bool second)
      : cell_(cell),
        first_master_(D * catalog::cell(cell.slave).n_nodes),
        columns_{first_master_ + D * catalog::cell(cell.master).n_nodes, static_cast<Eigen::Index>(cell.other_nodes.size()),
                 static_cast<Eigen::Index>(cell.slave_normals.size()), n_corners},
        gradient_(PointRow::Zero(columns_.of_points())),
        of_simplex_(gradient_),
        slave_shapes_(cell.slave, cell.slave_point),
        master_shapes_(cell.master, cell.master_point),
        form_(second ? columns_.of_points() : 0) {
    for (Vector<3>& v : cross_) v.setZero();
  }

  const Columns& columns() const { return columns_; }
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

  /// An integration point on the slave.
  struct OnSlave {
    std::size_t number;
    Shapes<D> phi;
    Interpolated<D> at;
    AreaNormal<D> area;

    OnSlave(std::size_t p, const ShapeTable<D>& table, int order, const double* nodes)
        : number(p), phi(table, p, order), at(phi, nodes), area(at) {}
  };
  OnSlave on_slave(std::size_t p) const { return {p, slave_shapes_, is_second() ? 3 : 2, cell_.slave_nodes.data()}; }

  /// h at a point, and its derivative by what it is made of.
  struct Integrand {
    Shapes<D> psi;
    Interpolated<D> master;
    Interpolated<D> nodal;  ///< normals
    double value = 0;
    Vector<D> of_place, of_area, of_normal, of_image, of_mean;  ///< x, A, nodal N, y, m
    Vector<R> slope;                                            ///< where the reference coordinates alone change
    // of what second derivatives are made
    Vector<D> n{}, a{};
    std::array<Vector<D>, R> b{};
    double g = 0, c = 0, k = 0, length = 1, jacobian = 0, radius = 1, lift = 1;
    Vector<R> offset_slope = Vector<R>::Zero();
    Vector<D> mean = Vector<D>::Zero();
    Vector<R> jacobian_slope = Vector<R>::Zero(), radius_slope = Vector<R>::Zero();  ///< of the initial geometry
    Eigen::Matrix<double, R, R> jacobian_second = Eigen::Matrix<double, R, R>::Zero(), radius_second = jacobian_second;

    Integrand(Shapes<D> shapes, const double* master_nodes) : psi(shapes), master(psi, master_nodes) {}
  };
  /// @param mean the mean normal of a plane chart @return a value of 0 beyond the axis, where an iterate may be on its way
  Integrand integrand(const OnSlave& point, const Vector<D>* mean = nullptr) const {
    const auto& [number, phi, slave, area] = point;
    Integrand f(Shapes<D>(master_shapes_, number, is_second() ? 2 : 1), cell_.master_nodes.data());
    if (is_smooth()) f.nodal = Interpolated<D>(phi, cell_.slave_normals.data());
    const Vector<D>& normal = is_smooth() ? f.nodal.x : area.n;
    f.length = normal.norm();
    f.n = normal / f.length;
    f.g = f.c = (f.master.x - slave.x).dot(f.n);
    for (std::size_t a = 0; a < cell_.slave_offset.size(); ++a) {
      f.c -= phi.value[a] * cell_.slave_offset[a];
      for (int i = 0; i < R; ++i) f.offset_slope[i] += phi.slope(static_cast<int>(a), i) * cell_.slave_offset[a];
    }
    std::tie(f.a, f.b) = dual(f.master.d, f.n);
    f.of_mean.setZero(), f.of_area.setZero(), f.of_normal.setZero(), f.of_place.setZero(), f.of_image.setZero();
    f.slope.setZero();
    measure(point, f);
    if (!(f.radius > 0)) return f;
    f.lift = mean ? area.n.dot(*mean) : 1;
    f.k = f.jacobian * f.radius / f.lift;
    f.value = f.k * f.c;

    f.of_image = f.k * f.a;
    f.of_place = -f.of_image;
    (is_smooth() ? f.of_normal : f.of_area) = -f.k * f.g / f.length * (f.a - f.n);
    if (cell_.current_jacobian) {
      f.of_area += f.c * f.radius / f.lift / f.jacobian * area.n;
      if (cell_.axis) f.of_place[0] += f.c * f.jacobian;
    }
    if (mean) {
      f.mean = *mean;
      f.of_area -= f.value / f.lift * *mean;
      f.of_mean = -f.value / f.lift * area.n;
    }
    for (int i = 0; i < R; ++i) {
      f.slope[i] = f.of_place.dot(slave.d[i]) + f.of_area.dot(area.d[i]) +
                   f.c / f.lift * (f.jacobian_slope[i] * f.radius + f.jacobian * f.radius_slope[i]) - f.k * f.offset_slope[i];
      if (is_smooth()) f.slope[i] += f.of_normal.dot(f.nodal.d[i]);
    }
    return f;
  }

  /// Points of another simplex follow. @param part its measure
  void start_simplex(double scale, double part) {
    scale_ = scale;
    part_ = part;
    value_ = 0;
    of_simplex_.setZero();
  }
  /// What the points of the simplex add to h, by the variables of points: for what else hangs on them.
  PointRow& of_simplex() { return of_simplex_; }
  /// What products of a point are multiplied with.
  double factor(double rule) const { return scale_ * part_ * rule; }

  /// Add a point, but for what its reference coordinates do. @param of_place the derivative by x
  void add_point(const OnSlave& point, const Integrand& f, double rule, const Vector<D>& of_place) {
    value_ += rule * f.value;
    const std::array<Vector<D>, R> of_tangent = of_tangents<D>(point.at.d, f.of_area);
    for (int a = 0; a < point.phi.n; ++a) {
      Vector<D> of_node = value(point.phi, a) * of_place;
      for (int i = 0; i < R; ++i) of_node += point.phi.slope(a, i) * of_tangent[i];
      of_simplex_.template segment<D>(D * a) += rule * of_node.transpose();
      if (is_smooth())
        of_simplex_.template segment<D>(columns_.skins + D * a) += rule * value(point.phi, a) * f.of_normal.transpose();
    }
    for (int a = 0; a < f.psi.n; ++a)
      of_simplex_.template segment<D>(first_master_ + D * a) += rule * value(f.psi, a) * f.of_image.transpose();
  }

  /// Add its second derivatives, but for those of its reference coordinates.
  /// @param dxi derivatives of these  @param turned_mean A . dm, with a plane chart
  void add_second_of_point(const OnSlave& point, const Integrand& f, double rule, const Vector<D>& of_place,
                           const PointRows<R>& dxi, const PointRow* turned_mean = nullptr) {
    const auto& [number, phi, slave, area] = point;
    const double w = factor(rule);
    if (w == 0) return;
    const Direction normal = direction(point, f, is_smooth(), dxi);
    // the image and the gap: R = dy - dx - g dn
    const Eigen::Index n = columns_.of_points();
    PointRow dg = PointRow::Zero(n), sideways = PointRow::Zero(n);  // a . dn
    PointRows<R> deta = PointRows<R>::Zero(R, n);
    const auto apart = [&](const Vector<D>& along, auto row) {
      for (int a = 0; a < phi.n; ++a) row.template segment<D>(D * a) -= value(phi, a) * along.transpose();
      for (int a = 0; a < f.psi.n; ++a) row.template segment<D>(first_master_ + D * a) += value(f.psi, a) * along.transpose();
      for (int i = 0; i < R; ++i)
        row -= along.dot(slave.d[i]) * dxi.row(i) + f.g * along.dot(normal.across[i]) * normal.turn.row(i);
    };
    apart(f.a, dg.row(0));
    for (int i = 0; i < R; ++i) {
      apart(-f.b[i], deta.row(i));
      sideways += f.a.dot(normal.across[i]) * normal.turn.row(i);
    }

    // the measure
    PointRow djacobian = PointRow::Zero(n), dradius = PointRow::Zero(n), dk;
    double of_turn = f.k * f.g;  // of |dn|^2
    if (cell_.current_jacobian) {
      const double of_area_turn = f.c * f.radius / f.lift * f.jacobian;
      if (is_smooth()) {
        const Direction of_area = direction(point, f, false, dxi);
        djacobian = f.jacobian * of_area.stretch;
        for (int i = 0; i < R; ++i) form_.add(w * of_area_turn, of_area.turn.row(i), of_area.turn.row(i));
      } else {
        djacobian = f.jacobian * normal.stretch;
        of_turn += of_area_turn;
      }
    } else {
      for (int i = 0; i < R; ++i) djacobian += f.jacobian_slope[i] * dxi.row(i);
    }
    dk = f.radius / f.lift * djacobian;
    if (cell_.axis) {
      if (cell_.current_jacobian)
        for (int a = 0; a < phi.n; ++a) dradius[D * a] = value(phi, a);
      for (int i = 0; i < R; ++i) dradius += (cell_.current_jacobian ? slave.d[i][0] : f.radius_slope[i]) * dxi.row(i);
      dk += f.jacobian * dradius;
      form_.add(2 * w * f.c, djacobian, dradius);
    }
    if (turned_mean) {
      PointRow dlift = *turned_mean;
      along_area(point, f.mean, dxi, dlift.row(0));
      dk -= f.k / f.lift * dlift;
      form_.add(-2 * w * f.c / f.lift, dlift, dk);
    }

    form_.add(2 * w, dg, dk - f.k * sideways);
    form_.add(2 * w * f.k * f.g, normal.stretch, sideways);
    for (int i = 0; i < R; ++i) form_.add(-2 * w * f.offset_slope[i], dxi.row(i), dk);
    for (int i = 0; i < R; ++i) form_.add(w * of_turn, normal.turn.row(i), normal.turn.row(i));
    for (int i = 0; i < R; ++i) {
      // the image slides along a master that bends and turns
      PointRow along = PointRow::Zero(n);
      for (int a = 0; a < f.psi.n; ++a)
        along.template segment<D>(first_master_ + D * a) = 2 * f.psi.slope(a, i) * f.of_image.transpose();
      for (int k = 0; k < R; ++k) along += f.of_image.dot(f.master.dd[i][k]) * deta.row(k);
      form_.add(w, deta.row(i), along);
    }
    add_second_where_it_slides(point, f, w, of_place, dxi);
  }

  /// v . dN of the area normal, to be added to a row.
  void along_area(const OnSlave& point, const Vector<D>& v, const PointRows<R>& dxi, auto row) const {
    const std::array<Vector<D>, R> of_tangent = of_tangents<D>(point.at.d, v);
    for (int a = 0; a < point.phi.n; ++a)
      for (int i = 0; i < R; ++i) row.template segment<D>(D * a) += point.phi.slope(a, i) * of_tangent[i].transpose();
    for (int i = 0; i < R; ++i) row += v.dot(point.area.d[i]) * dxi.row(i);
  }

  /// The points of the simplex are done. @param dpart by the variables of points  @return what the second derivative of its
  /// measure is multiplied with
  double end_simplex(const PointRow& dpart) {
    gap_ += scale_ * part_ * value_;
    gradient_ += scale_ * (part_ * of_simplex_ + value_ * dpart);
    if (is_second()) form_.add(2 * scale_, dpart, of_simplex_);
    return scale_ * value_;
  }

  /// In space: add v . (dp x dq), p and q sums of the slave's nodes. @param p, q factors of the nodes
  void add_cross(const Vector<3>& v, const double* p, int p_stride, const double* q, int q_stride) {
    static_assert(D == 3);
    const int n = catalog::cell(cell_.slave).n_nodes;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        cross_[static_cast<std::size_t>(a * max_skin_nodes + b)] += p[a * p_stride] * q[b * q_stride] * v;
  }

  /// The second derivatives of G by the variables of points, (points, points).
  Eigen::MatrixXd second_by_points() {
    if constexpr (D == 3) {
      const int n = catalog::cell(cell_.slave).n_nodes;
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) form_.add_cross_of_nodes(cross_[static_cast<std::size_t>(a * max_skin_nodes + b)], a, b);
    }
    return form_.matrix();
  }

 private:
  static double value(const Shapes<D>& shapes, int node) { return shapes.value[static_cast<std::size_t>(node)]; }
  bool is_smooth() const { return columns_.normals > 0; }
  bool is_second() const { return form_.size() > 0; }

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

  /// Jacobian and radius.
  void measure(const OnSlave& point, Integrand& f) const {
    if (cell_.current_jacobian) {
      f.jacobian = point.area.n.norm();
      if (cell_.axis) f.radius = point.at.x[0];
      return;
    }
    const Interpolated<D> initial(point.phi, cell_.slave_initial.data());
    const AreaNormal<D> area(initial);
    f.jacobian = area.n.norm();
    for (int i = 0; i < R; ++i) f.jacobian_slope[i] = area.n.dot(area.d[i]) / f.jacobian;
    for (int i = 0; i < R && is_second(); ++i)
      for (int k = 0; k < R; ++k)
        f.jacobian_second(i, k) = (area.n.dot(AreaNormal<D>::second(initial, i, k)) + area.d[i].dot(area.d[k]) -
                                   f.jacobian_slope[i] * f.jacobian_slope[k]) /
                                  f.jacobian;
    if (!cell_.axis) return;
    f.radius = initial.x[0];
    for (int i = 0; i < R; ++i) {
      f.radius_slope[i] = initial.d[i][0];
      for (int k = 0; k < R; ++k) f.radius_second(i, k) = initial.dd[i][k][0];
    }
  }

  /// How the direction of a normal moves: along unit vectors at a right angle to it, and its relative length.
  struct Direction {
    std::array<Vector<D>, R> across;
    PointRows<R> turn;
    PointRow stretch;
  };
  /// @param nodal of nodal normals, or of the area normal
  Direction direction(const OnSlave& point, const Integrand& f, bool nodal, const PointRows<R>& dxi) const {
    const Vector<D>& whole = nodal ? f.nodal.x : point.area.n;
    const double length = whole.norm();
    const Vector<D> n = whole / length;
    Direction direction{across(n), PointRows<R>::Zero(R, columns_.of_points()), PointRow::Zero(columns_.of_points())};
    const auto along = [&](const Vector<D>& v, auto row) {
      if (!nodal) return along_area(point, v, dxi, row);
      for (int a = 0; a < point.phi.n; ++a)
        row.template segment<D>(columns_.skins + D * a) += value(point.phi, a) * v.transpose();
      for (int i = 0; i < R; ++i) row += v.dot(f.nodal.d[i]) * dxi.row(i);
    };
    for (int i = 0; i < R; ++i) along(direction.across[i] / length, direction.turn.row(i));
    along(n / length, direction.stretch.row(0));
    return direction;
  }
  static std::array<Vector<D>, R> across(const Vector<D>& n) {
    if constexpr (D == 2) {
      return {Vector<2>(-n[1], n[0])};
    } else {
      const Vector<3> first = n.unitOrthogonal();
      return {first, n.cross(first)};
    }
  }

  /// The second derivatives of x, of both normals and of an initial measure where the reference coordinates change linearly.
  void add_second_where_it_slides(const OnSlave& point, const Integrand& f, double w, const Vector<D>& of_place,
                                  const PointRows<R>& dxi) {
    const auto& [number, phi, slave, area] = point;
    const std::array<Vector<D>, R> of_tangent = of_tangents<D>(slave.d, f.of_area);
    for (int j = 0; j < R; ++j) {
      PointRow row = PointRow::Zero(columns_.of_points());
      for (int a = 0; a < phi.n; ++a) {
        Vector<D> of_node = phi.slope(a, j) * of_place;
        for (int i = 0; i < R; ++i) of_node += phi.bend(a, i, j) * of_tangent[i];
        if constexpr (D == 3)
          of_node += phi.slope(a, 1) * f.of_area.cross(slave.dd[0][j]) + phi.slope(a, 0) * slave.dd[1][j].cross(f.of_area);
        row.template segment<D>(D * a) = 2 * of_node.transpose();
        if (is_smooth()) row.template segment<D>(columns_.skins + D * a) = 2 * phi.slope(a, j) * f.of_normal.transpose();
      }
      for (int k = 0; k < R; ++k) {
        double bent = of_place.dot(slave.dd[j][k]) + f.of_area.dot(AreaNormal<D>::second(slave, j, k));
        if (is_smooth()) bent += f.of_normal.dot(f.nodal.dd[j][k]);
        bent += f.c / f.lift * (f.radius * f.jacobian_second(j, k) + f.jacobian * f.radius_second(j, k));
        for (std::size_t a = 0; a < cell_.slave_offset.size(); ++a)
          bent -= f.k * phi.bend(static_cast<int>(a), j, k) * cell_.slave_offset[a];
        row += bent * dxi.row(k);
      }
      form_.add(w, dxi.row(j), row);
    }
    if constexpr (D == 3) add_cross(2 * w * f.of_area, phi.gradient.data(), R, phi.gradient.data() + 1, R);
  }

  const ContactCellGeometry& cell_;
  Eigen::Index first_master_;
  Columns columns_;
  double gap_ = 0, scale_ = 1, part_ = 0, value_ = 0;  ///< the latter: h summed up over the simplex
  PointRow gradient_, of_simplex_;
  ShapeTable<D> slave_shapes_, master_shapes_;
  QuadraticForm form_;
  std::array<Vector<3>, D == 3 ? max_skin_nodes * max_skin_nodes : 1> cross_;  ///< factors of dx_a x dx_b
};

/// The second derivatives by corners and unknowns, (corners, unknowns), at fixed corners.
Matrix by_corners(const Eigen::MatrixXd& by_points, const Columns& columns);
/// The second derivatives by the unknowns, from those by the variables of points, of which the last ones are corners.
/// @param corners (corners, unknowns): derivatives of the corners  @param form what their second derivatives add, by unknowns
void chain_corners(const Eigen::MatrixXd& by_points, const Columns& columns, const Matrix& corners, QuadraticForm& form,
                   GapVariation& variation);

void vary_in_plane(const ContactCellGeometry& cell, bool second, GapVariation& variation);
void vary_in_space(const ContactCellGeometry& cell, bool second, GapVariation& variation);
/// Add what the share of a couple adds that is steep (steepness.hpp), to derivatives that take it for constant.
void vary_share(const ContactCellGeometry& cell, GapVariation& variation);

}  // namespace lacon::variations
