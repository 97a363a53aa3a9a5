// The variation of a contact cell in space.
#include <algorithm>
#include <optional>
#include <vector>

#include "lacon/operators/contact/cell_variation.hpp"

// The polygon lies in a triangle of the slave's chart, whose vertices have fixed reference coordinates; a place in it is two
// barycentric coordinates b. The variables behind the unknowns are those of the polygon's vertices. A line of a master passes
// the slave's normals on the side of s(b) = sum b_k s_k, s_k = ((q - p) x n_k) . (x_k - p) at the triangle's vertices k.

namespace lacon::variations {
namespace {

/// Two lines that meet at a smaller angle (its sine) have no corner that moves by itself: edges of slave and master that
/// coincide.
constexpr double least_angle = 1e-6;

/// The unit normal at a vertex of the triangle, its place, with derivatives.
struct TriangleVertex {
  Vector<3> x, n;
  double length = 1;  ///< of the normal that n is the direction of
  Rows<3> dx, dn;
  Row stretch;                           ///< of that length, relative
  std::array<Rows<3>, 2> dt;             ///< of the tangents; none with nodal normals
  Vector<3> weight = Vector<3>::Zero();  ///< the factor of d2n

  /// Add weight . d2n.
  void add_second(QuadraticForm& form) const {
    form.add(-2.0, stretch, Row(weight.transpose() * dn));
    const double along = weight.dot(n);
    for (int i = 0; i < 3; ++i) form.add(-along, dn.row(i), dn.row(i));
    if (dt[0].cols() > 0) form.add_cross(2.0 / length * (weight - along * n), dt[0], dt[1]);
  }
};

/// A line that cuts the triangle: coefficients l with l . b = 0 on it.
struct CuttingLine {
  Vector<3> l;
  Rows<3> dl;
  bool moves = false;
  Vector<3> from, along;  ///< p and q - p
  Rows<3> dfrom, dalong;
};

class Polygon {
 public:
  Polygon(const ContactCellGeometry& cell, int n_variables) : cell_(cell), trace_(*cell.trace), n_(n_variables) {
    for (int k = 0; k < 3; ++k) take_vertex(k);
    for (std::size_t k = 0; k < trace_.line.size(); ++k) lines_.push_back(line(k));
    first_ = n_ - 2 * static_cast<int>(trace_.vertex.size());
    for (std::size_t k = 0; k < trace_.vertex.size(); ++k) take_corner(k);
    tie_corners();
  }

  /// Derivatives of the corners by the unknowns, (2 corners, unknowns).
  Eigen::MatrixXd corners() const {
    Eigen::MatrixXd rows(2 * corners_.size(), first_);
    for (std::size_t k = 0; k < corners_.size(); ++k)
      rows.middleRows(2 * static_cast<Eigen::Index>(k), 2) = corners_[k].row.leftCols(first_);
    return rows;
  }

  /// Second derivatives of the corners. @param gradient by all variables
  void add_second(const Row& gradient, QuadraticForm& form) {
    std::vector<Vector<2>> factor;
    for (std::size_t k = 0; k < corners_.size(); ++k)
      factor.emplace_back(gradient.segment<2>(first_ + 2 * static_cast<int>(k)).transpose());
    for (std::size_t k = 0; k < corners_.size(); ++k)
      if (const Corner& tied = corners_[k]; tied.between) {
        factor[tied.between->first] += (1 - tied.share) * factor[k];
        factor[tied.between->second] += tied.share * factor[k];
      }
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      const Corner& corner = corners_[k];
      if (corner.between || !corner.moves) continue;
      // J d2b = -(2 db . dl + b . d2l)
      const Vector<2> by = -corner.inverse.transpose() * factor[k];
      for (std::size_t i = 0; i < 2; ++i) {
        CuttingLine& own = lines_[corner.lines[i]];
        if (!own.moves) continue;
        for (int j = 0; j < 2; ++j)
          form.add(2.0 * by[static_cast<int>(i)], corner.row.row(j), Row(own.dl.row(j + 1) - own.dl.row(0)));
        for (int v = 0; v < 3; ++v)
          add_second_of_side(by[static_cast<int>(i)] * corner.b[v], own, vertices_[static_cast<std::size_t>(v)], form);
      }
    }
    for (const TriangleVertex& vertex : vertices_) vertex.add_second(form);
  }

  const TriangleVertex& vertex(int k) const { return vertices_[static_cast<std::size_t>(k)]; }

 private:
  struct Corner {
    Vector<3> b;                         ///< all three barycentric coordinates
    std::array<std::size_t, 2> lines{};  ///< that meet here
    Eigen::Matrix2d inverse;             ///< of J, by which both equations depend on the last two coordinates
    Rows<2> row;
    bool moves = false, free = true;
    std::optional<std::pair<std::size_t, std::size_t>> between;  ///< corners that carry it along
    double share = 0;
  };

  Rows<3> interpolate(const double* factor, int count, int stride, const auto& node) const {
    Rows<3> rows = Rows<3>::Zero(3, n_);
    for (int a = 0; a < count; ++a)
      for (int d = 0; d < 3; ++d) rows(d, 3 * node(a) + d) += factor[a * stride];
    return rows;
  }

  void take_vertex(int k) {
    TriangleVertex& v = vertices_[static_cast<std::size_t>(k)];
    const Shapes<3> phi(cell_.slave, trace_.triangle[static_cast<std::size_t>(k)].data());
    const Interpolated<3> at(phi, cell_.slave_nodes.data());
    const auto own = [](int a) { return a; };
    v.x = at.x;
    v.dx = interpolate(phi.value.data(), phi.n, 1, own);
    Vector<3> normal;
    Rows<3> dnormal;
    if (cell_.slave_normals.empty()) {
      normal = AreaNormal<3>(at).n;
      for (int i = 0; i < 2; ++i) v.dt[static_cast<std::size_t>(i)] = interpolate(phi.gradient.data() + i, phi.n, 2, own);
      dnormal = area_normal_rows<3>(at.d, v.dt);
    } else {
      normal = Interpolated<3>(phi, cell_.slave_normals.data()).x;
      dnormal = interpolate(phi.value.data(), phi.n, 1, [&](int a) { return cell_.n_nodes() + a; });
    }
    v.length = normal.norm();
    v.n = normal / v.length;
    v.stretch = v.n.transpose() * dnormal / v.length;
    v.dn = dnormal / v.length - v.n * v.stretch;
  }

  CuttingLine line(std::size_t k) const {
    const PolygonTrace::Line& given = trace_.line[k];
    CuttingLine line;
    if (given.master < 0) {
      line.l = Vector<3>::Unit((given.edge + 2) % 3);
      return line;
    }
    const ContactCellGeometry::LineNodes& nodes = cell_.lines[k];
    const auto node = [&](int a) { return nodes.node[static_cast<std::size_t>(a)]; };
    const int n_own = 3 * (catalog::cell(cell_.slave).n_nodes + catalog::cell(cell_.master).n_nodes),
              n_slave = 3 * catalog::cell(cell_.slave).n_nodes;
    const auto end = [&](const std::array<double, 2>& eta, Vector<3>& x, Rows<3>& dx) {
      const Shapes<3> psi(nodes.type, eta.data());
      x.setZero();
      for (int a = 0; a < psi.n; ++a) {
        const int at = 3 * node(a);
        const double* const place = at < n_slave ? cell_.slave_nodes.data() + at
                                    : at < n_own ? cell_.master_nodes.data() + at - n_slave
                                                 : cell_.other_nodes.data() + at - n_own;
        x += psi.value[static_cast<std::size_t>(a)] * Eigen::Map<const Vector<3>>(place);
      }
      dx = interpolate(psi.value.data(), psi.n, 1, node);
    };
    Vector<3> to;
    end(given.from, line.from, line.dfrom);
    end(given.to, to, line.dalong);
    line.along = to - line.from;
    line.dalong -= line.dfrom;
    line.moves = true;
    line.dl.resize(3, n_);
    for (int v = 0; v < 3; ++v) {
      const TriangleVertex& at = vertices_[static_cast<std::size_t>(v)];
      const Vector<3> apart = at.x - line.from, normal_by_apart = at.n.cross(apart), apart_by_along = apart.cross(line.along),
                      along_by_normal = line.along.cross(at.n);
      line.l[v] = along_by_normal.dot(apart);
      line.dl.row(v) = normal_by_apart.transpose() * line.dalong + apart_by_along.transpose() * at.dn +
                       along_by_normal.transpose() * (at.dx - line.dfrom);
    }
    return line;
  }

  /// Add factor * d2 of ((q - p) x n) . (x - p), but for d2n, whose factor is kept.
  void add_second_of_side(double factor, const CuttingLine& line, TriangleVertex& at, QuadraticForm& form) const {
    const Vector<3> apart = at.x - line.from;
    const Rows<3> dapart = at.dx - line.dfrom;
    form.add_cross(2.0 * factor * apart, line.dalong, at.dn);
    form.add_cross(2.0 * factor * at.n, dapart, line.dalong);
    form.add_cross(2.0 * factor * line.along, at.dn, dapart);
    at.weight += factor * apart.cross(line.along);
  }

  void take_corner(std::size_t k) {
    const std::size_t n = trace_.vertex.size();
    Corner& corner = corners_.emplace_back();
    corner.lines = {(k + n - 1) % n, k};
    const auto& [b1, b2] = trace_.vertex[k];
    corner.b = {1 - b1 - b2, b1, b2};
    corner.row = Rows<2>::Zero(2, n_);
    Eigen::Matrix2d j;
    for (int i = 0; i < 2; ++i) {
      const Vector<3>& l = lines_[corner.lines[static_cast<std::size_t>(i)]].l;
      j(i, 0) = l[1] - l[0], j(i, 1) = l[2] - l[0];
    }
    const double determinant = j.determinant();
    corner.free = std::abs(determinant) > least_angle * j.row(0).norm() * j.row(1).norm();
    if (!corner.free) return;
    corner.inverse = j.inverse();
    for (int i = 0; i < 2; ++i) {
      const CuttingLine& own = lines_[corner.lines[static_cast<std::size_t>(i)]];
      if (!own.moves) continue;
      corner.moves = true;
      corner.row.noalias() -= corner.inverse.col(i) * (corner.b.transpose() * own.dl);
    }
  }

  /// A corner of two lines that coincide goes with its neighbours.
  void tie_corners() {
    const std::size_t n = corners_.size();
    for (std::size_t k = 0; k < n; ++k) {
      if (corners_[k].free) continue;
      std::size_t before = (k + n - 1) % n, behind = (k + 1) % n;
      while (before != k && !corners_[before].free) before = (before + n - 1) % n;
      while (behind != k && !corners_[behind].free) behind = (behind + 1) % n;
      if (before == k) continue;  // nothing moves
      const Vector<3> whole = corners_[behind].b - corners_[before].b;
      const double length2 = whole.squaredNorm();
      Corner& tied = corners_[k];
      tied.between = {before, behind};
      tied.share = length2 > 0 ? std::clamp(whole.dot(tied.b - corners_[before].b) / length2, 0.0, 1.0) : 0;
      tied.row = (1 - tied.share) * corners_[before].row + tied.share * corners_[behind].row;
    }
  }

  const ContactCellGeometry& cell_;
  const PolygonTrace& trace_;
  int n_, first_ = 0;
  std::array<TriangleVertex, 3> vertices_;
  std::vector<CuttingLine> lines_;
  std::vector<Corner> corners_;
};

/// Two directions in the mean plane of a slave, whose cross product is its mean normal: edges of a triangle, diagonals of a
/// quadrangle. They are linear in the nodes.
struct MeanPlane {
  std::array<std::pair<int, int>, 2> ends;
  std::array<Vector<3>, 2> c;

  explicit MeanPlane(const ContactCellGeometry& cell) {
    ends = catalog::cell(cell.slave).family == Family::TRIA ? std::array{std::pair{0, 1}, std::pair{0, 2}}
                                                            : std::array{std::pair{0, 2}, std::pair{1, 3}};
    for (std::size_t i = 0; i < 2; ++i)
      c[i] = Eigen::Map<const Vector<3>>(cell.slave_nodes.data() + 3 * ends[i].second) -
             Eigen::Map<const Vector<3>>(cell.slave_nodes.data() + 3 * ends[i].first);
  }
  std::array<Rows<3>, 2> rows(int n) const {
    std::array<Rows<3>, 2> dc = {Rows<3>::Zero(3, n), Rows<3>::Zero(3, n)};
    for (std::size_t i = 0; i < 2; ++i)
      for (int d = 0; d < 3; ++d) dc[i](d, 3 * ends[i].second + d) = 1, dc[i](d, 3 * ends[i].first + d) = -1;
    return dc;
  }
};

}  // namespace

void vary_in_space(const ContactCellGeometry& cell, bool second, GapVariation& variation) {
  const PolygonTrace& trace = *cell.trace;
  const int n = cell.n_unknowns(), n_corners = static_cast<int>(trace.vertex.size());
  CellVariation<3> sum(cell, 2 * n_corners, second);
  const int n_all = sum.n_variables();
  Polygon polygon(cell, n_all);
  QuadraticForm& form = sum.form();

  // of a slave with a plane chart: what turns areas of the triangle into those of its mean plane
  const MeanPlane mean(cell);
  const std::array<Rows<3>, 2> dc = mean.rows(n_all);
  const Vector<3> normal = mean.c[0].cross(mean.c[1]);
  const Rows<3> dnormal = area_normal_rows<3>(mean.c, dc);
  const std::array<Vector<3>, 2> e = {polygon.vertex(1).x - polygon.vertex(0).x, polygon.vertex(2).x - polygon.vertex(0).x};
  const std::array<Rows<3>, 2> de = {Rows<3>(polygon.vertex(1).dx - polygon.vertex(0).dx),
                                     Rows<3>(polygon.vertex(2).dx - polygon.vertex(0).dx)};
  const Vector<3> facet = e[0].cross(e[1]);
  const Rows<3> dfacet = area_normal_rows<3>(e, de);
  const double area = facet.dot(normal);
  const Row darea = normal.transpose() * dfacet + facet.transpose() * dnormal;
  double of_area = 0;  // the factor of d2 area, summed up
  const auto& [corner0, corner1, corner2] = trace.triangle;
  const double reference_area =
      (corner1[0] - corner0[0]) * (corner2[1] - corner0[1]) - (corner1[1] - corner0[1]) * (corner2[0] - corner0[0]);

  for (std::size_t p = 0; p < cell.weight.size(); ++p) {
    const auto& [last, r, s, of_rule] = trace.point[p];
    const std::array<int, 3> at = {0, last - 1, last};
    const std::array<double, 3> share = {1 - r - s, r, s};
    Vector<2> b = Vector<2>::Zero();
    Rows<2> db = Rows<2>::Zero(2, n_all), first = db, behind = db;  // of the sides of the polygon's triangle
    std::array<Vector<2>, 3> place;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& given = trace.vertex[static_cast<std::size_t>(at[k])];
      place[k] = {given[0], given[1]};
      b += share[k] * place[k];
      for (int j = 0; j < 2; ++j) db(j, n + 2 * at[k] + j) += share[k];
    }
    const Vector<2> u = place[1] - place[0], v = place[2] - place[0];
    for (int j = 0; j < 2; ++j) {
      first(j, n + 2 * at[1] + j) += 1, first(j, n + 2 * at[0] + j) -= 1;
      behind(j, n + 2 * at[2] + j) += 1, behind(j, n + 2 * at[0] + j) -= 1;
    }
    const double part = u[0] * v[1] - u[1] * v[0];
    const Row dpart = v[1] * first.row(0) - v[0] * first.row(1) + u[0] * behind.row(1) - u[1] * behind.row(0);
    const double* const xi = cell.slave_point.data() + 2 * p;
    const double* const eta = cell.master_point.data() + 2 * p;
    const auto add_second_of_part = [&](double factor) {
      form.add(2 * factor, first.row(0), behind.row(1));
      form.add(-2 * factor, first.row(1), behind.row(0));
    };
    if (!trace.plane) {
      Rows<2> dxi = Rows<2>::Zero(2, n_all);
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          dxi.row(i) += (trace.triangle[static_cast<std::size_t>(j) + 1][static_cast<std::size_t>(i)] -
                         trace.triangle[0][static_cast<std::size_t>(i)]) *
                        db.row(j);
      const double density = of_rule * reference_area;
      const auto integrand = sum.add_point(sum.on_slave(xi, dxi), eta, density * part, density * dpart);
      if (second) add_second_of_part(integrand.value * density);
      continue;
    }
    // c_i . (x(xi) - y) = 0, y the place in the plane of the triangle
    const CellVariation<3>::OnSlave fixed = sum.on_slave(xi, Rows<2>::Zero(2, n_all));
    const Vector<3> y = polygon.vertex(0).x + b[0] * e[0] + b[1] * e[1];
    const Rows<3> dy = polygon.vertex(0).dx + b[0] * de[0] + b[1] * de[1] + e[0] * db.row(0) + e[1] * db.row(1);
    Eigen::Matrix2d m;
    Rows<2> dxi(2, n_all);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) m(i, j) = mean.c[static_cast<std::size_t>(i)].dot(fixed.at.d[static_cast<std::size_t>(j)]);
      dxi.row(i) = -(mean.c[static_cast<std::size_t>(i)].transpose() * (fixed.dx - dy) +
                     (fixed.at.x - y).transpose() * dc[static_cast<std::size_t>(i)]);
    }
    const Eigen::Matrix2d inverse = m.inverse();
    dxi = (inverse * dxi).eval();
    const CellVariation<3>::OnSlave point = sum.on_slave(xi, dxi);
    // the weight is part * density, and the density that of the rule * area / lift
    const double lift = point.area.n.dot(normal);
    const Row dlift = normal.transpose() * point.darea + point.area.n.transpose() * dnormal;
    const double density = of_rule * area / lift, weight = part * density;
    const auto integrand = sum.add_point(point, eta, weight, density * (dpart + part * (darea / area - dlift / lift)));
    if (!second) continue;
    const double of_part = integrand.value * density, factor = of_part * part;
    add_second_of_part(of_part);
    of_area += factor / area;
    form.add(2 * of_part / area, dpart, darea);
    form.add(-2 * of_part / lift, dpart, dlift);
    form.add(-2 * factor / (area * lift), darea, dlift);
    form.add(2 * factor / (lift * lift), dlift, dlift);
    const double by = -factor / lift;  // of d2 lift
    sum.add_second_of_area_normal(by * normal, point);
    for (int i = 0; i < 3; ++i) form.add(2 * by, point.darea.row(i), dnormal.row(i));
    form.add_cross(2 * by * point.area.n, dc[0], dc[1]);
    // second derivatives of the reference coordinates
    Vector<2> slope;
    for (int i = 0; i < 2; ++i)
      slope[i] = weight * (integrand.slope[i] - integrand.value * point.area.d[static_cast<std::size_t>(i)].dot(normal) / lift);
    const Vector<2> of_equation = -inverse.transpose() * slope;
    for (int i = 0; i < 2; ++i) {
      const auto k = static_cast<std::size_t>(i);
      sum.add_second_of_place(of_equation[i] * mean.c[k], point);
      for (int j = 0; j < 2; ++j)
        form.add(-2 * of_equation[i], db.row(j), Row(mean.c[k].transpose() * de[static_cast<std::size_t>(j)]));
      for (int d = 0; d < 3; ++d) form.add(2 * of_equation[i], dc[k].row(d), Row(point.dx.row(d) - dy.row(d)));
    }
  }
  if (second && trace.plane) {
    form.add_cross(2 * of_area * normal, de[0], de[1]);
    for (int d = 0; d < 3; ++d) form.add(2 * of_area, dfacet.row(d), dnormal.row(d));
    form.add_cross(2 * of_area * facet, dc[0], dc[1]);
  }
  if (second) polygon.add_second(sum.gradient(), form);
  variation.gap = sum.gap();
  chain_corners(sum.gradient(), polygon.corners(), n, second ? &form : nullptr, variation);
}

}  // namespace lacon::variations
