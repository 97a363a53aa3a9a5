// The variation of a contact cell in space.
#include <optional>
#include <vector>

#include "lacon/operators/contact/variation/cell_variation.hpp"
#include "lacon/operators/contact/variation/polygon_variation.hpp"

namespace lacon::variations {
namespace {

/// The mean plane of a slave with straight edges (edges of a triangle, diagonals of a quadrangle are its directions), and what
/// hangs on it beside the points: their weights have the area of the triangle seen along the mean normal as a factor.
class PlaneChart {
 public:
  PlaneChart(const ContactCellGeometry& cell, const PolygonVariation& polygon) : n_(catalog::cell(cell.slave).n_nodes) {
    const auto ends = catalog::cell(cell.slave).family == Family::TRIA ? std::array{std::pair{0, 1}, std::pair{0, 2}}
                                                                       : std::array{std::pair{0, 2}, std::pair{1, 3}};
    const auto store = [](const Vector<3>& v, double* to) { Eigen::Map<Vector<3>>{to} = v; };
    const TriangleVertex& first = polygon.vertex(0);
    for (int i = 0; i < 2; ++i) {
      const auto& [from, to] = ends[static_cast<std::size_t>(i)];
      std::fill_n(plane_.of_c[i], max_slave_nodes, 0.0);
      plane_.of_c[i][from] = -1, plane_.of_c[i][to] = 1;
      c_[i] = Eigen::Map<const Vector<3>>(cell.slave_nodes.data() + 3 * to) -
              Eigen::Map<const Vector<3>>(cell.slave_nodes.data() + 3 * from);
      e_[i] = polygon.vertex(i + 1).x - first.x;
      store(c_[i], plane_.c[i]), store(e_[i], plane_.e[i]);
      for (std::size_t a = 0; a < static_cast<std::size_t>(n_); ++a)
        plane_.of_e[i][a] = polygon.vertex(i + 1).phi.value[a] - first.phi.value[a];
    }
    std::copy_n(first.phi.value.begin(), n_, plane_.of_origin);
    mean_ = c_[0].cross(c_[1]);
    facet_ = e_[0].cross(e_[1]);
    area_ = facet_.dot(mean_);
    store(first.x, plane_.origin), store(mean_, plane_.mean);
  }

  double area() const { return area_; }
  const PlaneOfSlave& plane() const { return plane_; }

  /// The points of a simplex are done: what they say of the chart goes to the nodes.
  void end_points(const CellVariation<3>& sum, const std::array<int, 3>& corners, PointRow& of_simplex) {
    const PointSums<3>::Simplex& simplex = sum.points().simplex();
    const auto vector = [](const double* v) { return Vector<3>(v[0], v[1], v[2]); };
    const Vector<3> of_mean = vector(simplex.of_mean), of_origin = vector(simplex.of_origin);
    const std::array<Vector<3>, 2> of_c = {vector(simplex.of_directions[0]) + c_[1].cross(of_mean),
                                           vector(simplex.of_directions[1]) + of_mean.cross(c_[0])},
                                   of_sides = {vector(simplex.of_sides[0]), vector(simplex.of_sides[1])};
    for (int a = 0; a < n_; ++a) {
      Vector<3> of_node = plane_.of_origin[a] * of_origin;
      for (std::size_t i = 0; i < 2; ++i) of_node += plane_.of_c[i][a] * of_c[i] + plane_.of_e[i][a] * of_sides[i];
      of_simplex.segment<3>(3 * a) += of_node.transpose();
    }
    if (sum.is_second())
      for (std::size_t k = 0; k < 3; ++k) corners_.push_back({corners[k], simplex, k});
  }

  /// All simplices are done: what the area of the triangle adds, and second derivatives of the chart.
  void end(CellVariation<3>& sum) {
    const double whole = sum.gap() / area_;
    PointRow darea = PointRow::Zero(sum.columns().of_points());
    const std::array<Vector<3>, 2> by_e = {e_[1].cross(mean_), mean_.cross(e_[0])},
                                   by_c = {c_[1].cross(facet_), facet_.cross(c_[0])};
    for (int a = 0; a < n_; ++a)
      for (std::size_t i = 0; i < 2; ++i)
        darea.segment<3>(3 * a) += (plane_.of_e[i][a] * by_e[i] + plane_.of_c[i][a] * by_c[i]).transpose();
    QuadraticForm& form = sum.form();
    const bool second = sum.is_second();
    if (second) form.add(2 / area_, darea, sum.gradient());
    sum.gradient() += whole * darea;
    if (second) add_second(sum, whole);
  }

 private:
  /// Of Q = 2 dc . by_c + 2 dm . by_mean + 2 de . (sum of of_corner dcorner) + area of second order.
  void add_second(CellVariation<3>& sum, double whole) const {
    const PointSums<3>& points = sum.points();
    QuadraticForm& form = sum.form();
    const Eigen::Index columns = points.columns(), all = sum.columns().of_points();
    std::array<PointRows<3>, 2> by_c = {PointRows<3>::Zero(3, all), PointRows<3>::Zero(3, all)};
    PointRows<3> by_mean = by_c[0];
    for (int d = 0; d < 3; ++d) {
      by_mean.row(d).head(columns) = 0.5 * Eigen::Map<const Row>(points.by_mean() + d * columns, columns);
      for (int i = 0; i < 2; ++i)
        by_c[static_cast<std::size_t>(i)].row(d).head(columns) =
            0.5 * Eigen::Map<const Row>(points.by_directions() + (2 * d + i) * columns, columns);
    }
    for (int a = 0; a < n_; ++a)
      for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        by_mean(d, 3 * a + f) += 0.5 * points.mean_by_node(a, e);
        by_mean(d, 3 * a + e) -= 0.5 * points.mean_by_node(a, f);
        for (int i = 0; i < 2; ++i) by_c[static_cast<std::size_t>(i)](d, 3 * a + d) += points.direction_by_node(i, a);
        // of the facet
        const Vector<3> first = e_[1].cross(Vector<3>::Unit(d)), behind = Vector<3>::Unit(d).cross(e_[0]);
        by_mean.row(d).segment<3>(3 * a) += whole * (plane_.of_e[0][a] * first + plane_.of_e[1][a] * behind).transpose();
      }
    for (const Corner& corner : corners_)
      for (int j = 0; j < 2; ++j) {
        const Eigen::Index column = sum.column(corner.number) + j;
        for (int i = 0; i < 2; ++i)
          by_c[static_cast<std::size_t>(i)].col(column) +=
              corner.by_c[static_cast<std::size_t>(i)] * e_[static_cast<std::size_t>(j)];
        for (int a = 0; a < n_; ++a) form.of(column).segment<3>(3 * a) += 2 * plane_.of_e[j][a] * corner.by_e.transpose();
      }
    by_c[0] += cross(c_[1], by_mean);
    by_c[1] -= cross(c_[0], by_mean);
    const Vector<3> of_area = 2 * whole * mean_,
                    of_mean = 2 * (whole * facet_ +
                                   Vector<3>(points.second_of_mean(0), points.second_of_mean(1), points.second_of_mean(2)));
    for (int a = 0; a < n_; ++a) {
      for (int i = 0; i < 2; ++i)
        for (int d = 0; d < 3 && plane_.of_c[i][a] != 0; ++d)
          form.of(3 * a + d).head(all) += 2 * plane_.of_c[i][a] * by_c[static_cast<std::size_t>(i)].row(d);
      for (int b = 0; b < n_; ++b)
        form.add_cross_of_nodes(
            plane_.of_e[0][a] * plane_.of_e[1][b] * of_area + plane_.of_c[0][a] * plane_.of_c[1][b] * of_mean, a, b);
    }
  }

  /// A corner of a simplex.
  struct Corner {
    int number;
    std::array<double, 2> by_c;
    Vector<3> by_e;

    Corner(int n, const PointSums<3>::Simplex& simplex, std::size_t k)
        : number(n),
          by_c{simplex.corner_by_c[k][0], simplex.corner_by_c[k][1]},
          by_e(simplex.corner_by_e[k][0], simplex.corner_by_e[k][1], simplex.corner_by_e[k][2]) {}
  };

  int n_;  ///< nodes of the slave
  PlaneOfSlave plane_{};
  std::array<Vector<3>, 2> c_, e_;
  Vector<3> mean_, facet_;
  double area_ = 0;
  std::vector<Corner> corners_;
};

}  // namespace

namespace {

/// Points that keep their places on the slave.
void vary_at_points(const ContactCellGeometry& cell, bool second, GapVariation& variation) {
  CellVariation<3> sum(cell, 0, second, {});
  sum.start_simplex(1, 1, {});
  for (std::size_t first = 0; first < cell.weight.size(); first += LACON_LANES) {
    PointBlock<3> block{};
    for (std::size_t l = 0; l < LACON_LANES; ++l) {
      const bool none = first + l >= cell.weight.size();
      const std::size_t own = none ? first : first + l;
      block.rule[l] = none ? 0 : cell.weight[own];
      for (std::size_t i = 0; i < 2; ++i) {
        block.slave[i * LACON_LANES + l] = cell.slave_point[2 * own + i];
        block.master[i * LACON_LANES + l] = cell.master_point[2 * own + i];
      }
    }
    sum.add(block);
  }
  sum.end_points();
  sum.end_simplex(PointRow::Zero(sum.columns().of_points()));
  sum.end();
  const Row gradient = sum.by_unknowns();
  variation.gap = sum.gap();
  variation.gradient.assign(gradient.begin(), gradient.end());
  variation.hessian.clear();
  variation.ends.clear();
  if (!second) return;
  QuadraticForm form(sum.columns().unknowns());
  chain_corners(sum.form().matrix(), sum.columns(), Matrix(0, sum.columns().unknowns()), {}, form, variation);
}

}  // namespace

void vary_in_space(const ContactCellGeometry& cell, bool second, GapVariation& variation) {
  const PolygonTrace& trace = *cell.trace;
  if (trace.vertex.empty()) {
    vary_at_points(cell, second, variation);
    return;
  }
  PolygonVariation polygon(cell, second);
  // a triangle with straight edges is affine: its reference cell does as well
  const bool in_plane = trace.plane && cell.slave != CellType::TRIA3;
  std::optional<PlaneChart> plane;
  if (in_plane) plane.emplace(cell, polygon);
  std::array<double, 4> sides{};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) sides[2 * i + j] = trace.triangle[j + 1][i] - trace.triangle[0][i];
  const double scale = plane ? plane->area() : sides[0] * sides[3] - sides[1] * sides[2];
  CellVariation<3> sum(cell, static_cast<int>(trace.vertex.size()), second, sides, plane ? &plane->plane() : nullptr);
  const Columns& columns = sum.columns();
  const Eigen::Index n = columns.unknowns();

  for (std::size_t p = 0; p < trace.point.size();) {
    const std::int32_t last = trace.point[p].last;
    const std::array<int, 3> at = {0, last - 1, last};
    std::array<Vector<2>, 3> place;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& given = trace.vertex[static_cast<std::size_t>(at[k])];
      place[k] = {given[0], given[1]};
    }
    const Vector<2> u = place[1] - place[0], v = place[2] - place[0];
    sum.start_simplex(scale, u[0] * v[1] - u[1] * v[0], at);
    while (p < trace.point.size() && trace.point[p].last == last) {
      PointBlock<3> block;
      const std::size_t first = p;
      for (std::size_t l = 0; l < LACON_LANES; ++l) {
        const bool none = p == trace.point.size() || trace.point[p].last != last;
        const std::size_t own = none ? first : p++;
        const auto& [triangle, r, s, rule] = trace.point[own];
        const std::array<double, 3> share = {1 - r - s, r, s};
        block.rule[l] = none ? 0 : rule;
        for (std::size_t k = 0; k < 3; ++k) block.share[k * LACON_LANES + l] = share[k];
        for (std::size_t i = 0; i < 2; ++i) {
          const std::size_t to = i * LACON_LANES + l;
          const auto d = static_cast<Eigen::Index>(i);
          block.slave[to] = cell.slave_point[2 * own + i], block.master[to] = cell.master_point[2 * own + i];
          block.place[to] = share[0] * place[0][d] + share[1] * place[1][d] + share[2] * place[2][d];
        }
      }
      sum.add(block);
    }
    PointRow& of_simplex = sum.end_points();
    if (plane) plane->end_points(sum, at, of_simplex);
    // twice the area of the triangle is the sum of place[k] x place[k + 1]
    PointRow dpart = PointRow::Zero(columns.of_points());
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector<2> side = place[(k + 1) % 3] - place[(k + 2) % 3];
      dpart.segment<2>(sum.column(at[k])) = Vector<2>(side[1], -side[0]).transpose();
    }
    const double of_part = sum.end_simplex(dpart);
    for (std::size_t k = 0; second && k < 3; ++k) {
      const Eigen::Index own = sum.column(at[k]), next = sum.column(at[(k + 1) % 3]);
      sum.form().of(own)[next + 1] += 2 * of_part;
      sum.form().of(own + 1)[next] -= 2 * of_part;
    }
  }
  sum.end();
  if (plane) plane->end(sum);

  Row gradient = sum.by_unknowns();
  polygon.add_gradient(sum.gradient().tail(columns.corners), gradient);
  variation.gap = sum.gap();
  variation.gradient.assign(gradient.data(), gradient.data() + n);
  variation.hessian.clear();
  variation.ends.clear();
  if (!second) return;
  QuadraticForm form(polygon.n_unknowns());
  polygon.add_second(form);
  chain_corners(sum.form().matrix(), columns, polygon.corners(), polygon.own_unknowns(), form, variation);
}

}  // namespace lacon::variations
