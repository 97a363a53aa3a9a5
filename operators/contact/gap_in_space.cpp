// The variation of a contact cell in space.
#include <optional>
#include <vector>

#include "lacon/operators/contact/cell_variation.hpp"
#include "lacon/operators/contact/polygon_variation.hpp"

namespace lacon::variations {
namespace {

/// The chart of a slave with straight edges: its mean plane, along two directions c whose cross product is its mean normal
/// (edges of a triangle, diagonals of a quadrangle). A point of the slave is where c . (x(xi) - y) = 0, y the place in the
/// plane of the triangle, and its weight is the area of the triangle seen along the mean normal over the lift of the slave.
/// With factors nu of these equations, by which a point's reference coordinates stand still, derivatives need none of its own.
class PlaneChart {
 public:
  using Cell = CellVariation<3>;

  PlaneChart(const ContactCellGeometry& cell, const PolygonVariation& polygon, Cell& sum, bool second)
      : polygon_(polygon), sum_(sum), n_(catalog::cell(cell.slave).n_nodes) {
    const auto ends = catalog::cell(cell.slave).family == Family::TRIA ? std::array{std::pair{0, 1}, std::pair{0, 2}}
                                                                       : std::array{std::pair{0, 2}, std::pair{1, 3}};
    for (std::size_t i = 0; i < 2; ++i) {
      of_c_[i].fill(0), of_c_[i][static_cast<std::size_t>(ends[i].first)] = -1,
                        of_c_[i][static_cast<std::size_t>(ends[i].second)] = 1;
      c_[i] = Eigen::Map<const Vector<3>>(cell.slave_nodes.data() + 3 * ends[i].second) -
              Eigen::Map<const Vector<3>>(cell.slave_nodes.data() + 3 * ends[i].first);
      e_[i] = polygon.vertex(static_cast<int>(i) + 1).x - polygon.vertex(0).x;
      for (std::size_t a = 0; a < static_cast<std::size_t>(n_); ++a)
        of_e_[i][a] = polygon.vertex(static_cast<int>(i) + 1).phi.value[a] - polygon.vertex(0).phi.value[a];
    }
    mean_ = c_[0].cross(c_[1]);
    facet_ = e_[0].cross(e_[1]);
    area_ = facet_.dot(mean_);
    if (!second) return;
    of_corner_.resize(cell.trace->vertex.size());
    for (auto& of : of_corner_) of[0].setZero(), of[1].setZero();
    by_c_[0] = by_c_[1] = by_mean_ = PointRows<3>::Zero(3, sum.columns().of_points());
  }

  double area() const { return area_; }
  const Vector<3>& mean() const { return mean_; }

  /// Add a point. @param b its place  @param at corners of its triangle, by number  @param share of them
  void add_point(const Cell::OnSlave& point, double rule, const Vector<2>& b, const std::array<int, 3>& at,
                 const std::array<double, 3>& share, bool second) {
    const Cell::Integrand h = sum_.integrand(point, &mean_);
    Eigen::Matrix2d m;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) m(i, j) = c_[static_cast<std::size_t>(i)].dot(point.at.d[static_cast<std::size_t>(j)]);
    const Eigen::Matrix2d inverse = m.inverse();
    const Vector<2> nu = -inverse.transpose() * h.slope;
    const Vector<3> held = nu[0] * c_[0] + nu[1] * c_[1], of_place = h.of_place + held;
    const Vector<3> off = point.at.x - (polygon_.vertex(0).x + b[0] * e_[0] + b[1] * e_[1]);
    sum_.add_point(point, h, rule, of_place);
    of_mean_ += rule * h.of_mean;
    for (std::size_t i = 0; i < 2; ++i) {
      of_directions_[i] += rule * nu[static_cast<int>(i)] * off;
      of_sides_[i] -= rule * b[static_cast<int>(i)] * held;
    }
    of_origin_ -= rule * held;
    const Eigen::Index corner = sum_.columns().first_corner();
    for (std::size_t k = 0; k < 3; ++k)
      for (int j = 0; j < 2; ++j)
        sum_.of_simplex()[corner + 2 * at[k] + j] -= rule * share[k] * held.dot(e_[static_cast<std::size_t>(j)]);
    if (!second) return;

    // c . (dx - dy) + (x - y) . dc = 0
    PointRows<2> dxi = PointRows<2>::Zero(2, sum_.columns().of_points());
    PointRows<3> moved = PointRows<3>::Zero(3, dxi.cols());  // dx - dy
    for (int a = 0; a < n_; ++a) {
      const auto node = static_cast<std::size_t>(a);
      const double left =
          point.phi.value[node] - polygon_.vertex(0).phi.value[node] - b[0] * of_e_[0][node] - b[1] * of_e_[1][node];
      moved.block<3, 3>(0, 3 * a).diagonal().setConstant(left);
      for (std::size_t i = 0; i < 2; ++i)
        dxi.row(static_cast<int>(i)).segment<3>(3 * a) = (left * c_[i] + of_c_[i][node] * off).transpose();
    }
    for (std::size_t k = 0; k < 3; ++k)
      for (int j = 0; j < 2; ++j) {
        const Eigen::Index column = corner + 2 * at[k] + j;
        moved.col(column) -= share[k] * e_[static_cast<std::size_t>(j)];
        for (int i = 0; i < 2; ++i)
          dxi(i, column) -= share[k] * c_[static_cast<std::size_t>(i)].dot(e_[static_cast<std::size_t>(j)]);
      }
    dxi = (-inverse * dxi).eval();
    for (int i = 0; i < 2; ++i) moved += point.at.d[static_cast<std::size_t>(i)] * dxi.row(i);
    PointRow turned_mean = PointRow::Zero(dxi.cols());  // A . dm
    const Vector<3> by_first = c_[1].cross(point.area.n), by_second = point.area.n.cross(c_[0]);
    for (int a = 0; a < n_; ++a)
      turned_mean.segment<3>(3 * a) =
          (of_c_[0][static_cast<std::size_t>(a)] * by_first + of_c_[1][static_cast<std::size_t>(a)] * by_second).transpose();
    sum_.add_second_of_point(point, h, rule, of_place, dxi, &turned_mean);

    const double w = sum_.factor(rule);
    for (int i = 0; i < 2; ++i) by_c_[static_cast<std::size_t>(i)] += w * nu[i] * moved;
    for (int d = 0; d < 3; ++d) sum_.along_area(point, -w * h.value / h.lift * Vector<3>::Unit(d), dxi, by_mean_.row(d));
    second_of_mean_ += w * h.of_mean;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 2; ++j) of_corner_[static_cast<std::size_t>(at[k])][j] -= w * share[k] * held;
  }

  /// The points of a simplex are done: what they say of the chart goes to the nodes.
  void end_simplex() {
    const std::array<Vector<3>, 2> of_c = {of_directions_[0] + c_[1].cross(of_mean_),
                                           of_directions_[1] + of_mean_.cross(c_[0])};
    for (std::size_t a = 0; a < static_cast<std::size_t>(n_); ++a) {
      Vector<3> of_node = polygon_.vertex(0).phi.value[a] * of_origin_;
      for (std::size_t i = 0; i < 2; ++i) of_node += of_c_[i][a] * of_c[i] + of_e_[i][a] * of_sides_[i];
      sum_.of_simplex().segment<3>(3 * static_cast<Eigen::Index>(a)) += of_node.transpose();
    }
    for (Vector<3>* const done : {&of_directions_[0], &of_directions_[1], &of_sides_[0], &of_sides_[1], &of_origin_, &of_mean_})
      done->setZero();
  }

  /// All simplices are done: what the area of the triangle adds, and second derivatives of the chart.
  void end(bool second) {
    const double whole = sum_.gap() / area_;
    PointRow darea = PointRow::Zero(sum_.columns().of_points());
    const std::array<Vector<3>, 2> by_e = {e_[1].cross(mean_), mean_.cross(e_[0])},
                                   by_c = {c_[1].cross(facet_), facet_.cross(c_[0])};
    for (std::size_t a = 0; a < static_cast<std::size_t>(n_); ++a)
      for (std::size_t i = 0; i < 2; ++i)
        darea.segment<3>(3 * static_cast<Eigen::Index>(a)) += (of_e_[i][a] * by_e[i] + of_c_[i][a] * by_c[i]).transpose();
    QuadraticForm& form = sum_.form();
    if (second) form.add(2 / area_, darea, sum_.gradient());
    sum_.gradient() += whole * darea;
    if (!second) return;

    sum_.add_cross(2 * whole * mean_, of_e_[0].data(), 1, of_e_[1].data(), 1);
    sum_.add_cross(2 * (whole * facet_ + second_of_mean_), of_c_[0].data(), 1, of_c_[1].data(), 1);
    for (int d = 0; d < 3; ++d) {  // of the facet
      const Vector<3> first = e_[1].cross(Vector<3>::Unit(d)), behind = Vector<3>::Unit(d).cross(e_[0]);
      for (std::size_t a = 0; a < static_cast<std::size_t>(n_); ++a)
        by_mean_.row(d).segment<3>(3 * static_cast<Eigen::Index>(a)) +=
            whole * (of_e_[0][a] * first + of_e_[1][a] * behind).transpose();
    }
    by_c_[0] += cross(c_[1], by_mean_);
    by_c_[1] -= cross(c_[0], by_mean_);
    for (std::size_t a = 0; a < static_cast<std::size_t>(n_); ++a)
      for (std::size_t i = 0; i < 2; ++i)
        for (int d = 0; d < 3 && of_c_[i][a] != 0; ++d)
          form.of(3 * static_cast<Eigen::Index>(a) + d) += 2 * of_c_[i][a] * by_c_[i].row(d);
    const Eigen::Index corner = sum_.columns().first_corner();
    for (std::size_t k = 0; k < of_corner_.size(); ++k)
      for (std::size_t j = 0; j < 2; ++j) {
        auto row = form.of(corner + 2 * static_cast<Eigen::Index>(k) + static_cast<Eigen::Index>(j));
        for (std::size_t a = 0; a < static_cast<std::size_t>(n_); ++a)
          row.segment<3>(3 * static_cast<Eigen::Index>(a)) += 2 * of_e_[j][a] * of_corner_[k][j].transpose();
      }
  }

 private:
  const PolygonVariation& polygon_;
  Cell& sum_;
  int n_;                                                          ///< nodes of the slave
  std::array<Vector<3>, 2> c_, e_;                                 ///< directions of the plane, sides of the triangle
  std::array<std::array<double, max_skin_nodes>, 2> of_c_, of_e_;  ///< as sums over the nodes
  Vector<3> mean_, facet_;
  double area_ = 0;
  // derivatives of what the points of a simplex add by c, e, the triangle's origin and the mean normal
  std::array<Vector<3>, 2> of_directions_ = {Vector<3>::Zero(), Vector<3>::Zero()}, of_sides_ = of_directions_;
  Vector<3> of_origin_ = Vector<3>::Zero(), of_mean_ = Vector<3>::Zero();
  // factors in second derivatives, of all points: of dc, dm, dc x dc, and of each corner times de
  std::array<PointRows<3>, 2> by_c_;
  PointRows<3> by_mean_;
  Vector<3> second_of_mean_ = Vector<3>::Zero();
  std::vector<std::array<Vector<3>, 2>> of_corner_;
};

}  // namespace

void vary_in_space(const ContactCellGeometry& cell, bool second, GapVariation& variation) {
  const PolygonTrace& trace = *cell.trace;
  CellVariation<3> sum(cell, 2 * static_cast<int>(trace.vertex.size()), second);
  const Columns& columns = sum.columns();
  const Eigen::Index n = columns.unknowns(), corner = columns.first_corner();
  PolygonVariation polygon(cell, second);
  // a triangle with straight edges is affine: its reference cell does as well
  const bool in_plane = trace.plane && cell.slave != CellType::TRIA3;
  std::optional<PlaneChart> plane;
  if (in_plane) plane.emplace(cell, polygon, sum, second);
  Eigen::Matrix2d sides;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      sides(i, j) = trace.triangle[static_cast<std::size_t>(j) + 1][static_cast<std::size_t>(i)] -
                    trace.triangle[0][static_cast<std::size_t>(i)];
  const double scale = plane ? plane->area() : sides.determinant();

  for (std::size_t p = 0; p < trace.point.size();) {
    const std::int32_t last = trace.point[p].last;
    const std::array<int, 3> at = {0, last - 1, last};
    std::array<Vector<2>, 3> place;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& given = trace.vertex[static_cast<std::size_t>(at[k])];
      place[k] = {given[0], given[1]};
    }
    const Vector<2> u = place[1] - place[0], v = place[2] - place[0];
    sum.start_simplex(scale, u[0] * v[1] - u[1] * v[0]);
    for (; p < trace.point.size() && trace.point[p].last == last; ++p) {
      const auto& [triangle, r, s, rule] = trace.point[p];
      const std::array<double, 3> share = {1 - r - s, r, s};
      const Vector<2> b = share[0] * place[0] + share[1] * place[1] + share[2] * place[2];
      const CellVariation<3>::OnSlave point = sum.on_slave(p);
      if (plane) {
        plane->add_point(point, rule, b, at, share, second);
        continue;
      }
      const CellVariation<3>::Integrand h = sum.integrand(point);
      sum.add_point(point, h, rule, h.of_place);
      const Vector<2> of_b = rule * sides.transpose() * h.slope;
      for (std::size_t k = 0; k < 3; ++k) sum.of_simplex().segment<2>(corner + 2 * at[k]) += share[k] * of_b.transpose();
      if (!second) continue;
      PointRows<2> dxi = PointRows<2>::Zero(2, columns.of_points());
      for (std::size_t k = 0; k < 3; ++k) dxi.middleCols<2>(corner + 2 * at[k]) += share[k] * sides;
      sum.add_second_of_point(point, h, rule, h.of_place, dxi);
    }
    if (plane) plane->end_simplex();
    // twice the area of the triangle is the sum of place[k] x place[k + 1]
    PointRow dpart = PointRow::Zero(columns.of_points());
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector<2> side = place[(k + 1) % 3] - place[(k + 2) % 3];
      dpart.segment<2>(corner + 2 * at[k]) = Vector<2>(side[1], -side[0]).transpose();
    }
    const double of_part = sum.end_simplex(dpart);
    for (std::size_t k = 0; second && k < 3; ++k) {
      const Eigen::Index own = corner + 2 * at[k], next = corner + 2 * at[(k + 1) % 3];
      sum.form().of(own)[next + 1] += 2 * of_part;
      sum.form().of(own + 1)[next] -= 2 * of_part;
    }
  }
  if (plane) plane->end(second);

  Row gradient = sum.by_unknowns();
  polygon.add_gradient(sum.gradient().tail(columns.corners), gradient);
  variation.gap = sum.gap();
  variation.gradient.assign(gradient.data(), gradient.data() + n);
  variation.hessian.clear();
  if (!second) return;
  QuadraticForm form(n);
  polygon.add_second(form);
  chain_corners(sum.second_by_points(), columns, polygon.corners(), form, variation);
}

}  // namespace lacon::variations
