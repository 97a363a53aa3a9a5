#include "lacon/operators/contact/variation/polygon_variation.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace lacon::variations {
namespace {

/// Two lines that meet at a smaller angle (its sine) coincide: their corner goes with one of them.
constexpr double least_angle = 1e-6;
/// A line that coincides with an edge of the triangle, and meets another line this near to it (in barycentric coordinates), is
/// that edge there: what meets moves in one way in all polygons around, whichever of the two bounds them. In symmetric meshes
/// edges of slaves do lie on lines of masters, as near as iterates are symmetric.
constexpr double on_edge = 1e-9;
/// A line between parts of one master that passes an edge of the triangle this near to both of its ends stays where it is:
/// gaps are the same on both sides of it, so that it may as well, and what it meets goes the same way in all polygons around.
constexpr double along_edge = 1e-3;

/// Whether a line of a curved master leads to its middle, between parts of it.
bool is_within(const PolygonTrace::Line& line, CellType master) {
  const double middle = catalog::cell(master).family == Family::QUAD ? 0.0 : 1.0 / 3;
  const std::array<double, 2> centre{middle, middle};
  return line.from == centre || line.to == centre;
}

bool passes_along_an_edge(const Vector<3>& l) {
  for (int corner = 0; corner < 3; ++corner)
    if (std::max(std::abs(l[(corner + 1) % 3]), std::abs(l[(corner + 2) % 3])) <= along_edge * std::abs(l[corner])) return true;
  return false;
}

}  // namespace

PolygonVariation::PolygonVariation(const ContactCellGeometry& cell, bool second)
    : cell_(cell),
      trace_(*cell.trace),
      n_(cell.n_unknowns() +
         (second ? 3 * static_cast<int>(std::ranges::count_if(cell.lines, [](const auto& line) { return line.still; })) : 0)),
      first_normal_(3 * cell.n_nodes()),
      second_(second),
      vertices_{vertex_at(0), vertex_at(1), vertex_at(2)} {
  for (std::size_t k = 0; k < trace_.line.size(); ++k) lines_.push_back(line(k));
  for (int k = 0; k < 3; ++k) lines_.push_back({.l = Vector<3>::Unit(k)});  // the triangle's edges
  for (std::size_t k = 0; k < trace_.vertex.size(); ++k) take_corner(k);
}

void PolygonVariation::add_gradient(const Row& of_corners, Row& gradient) {
  std::vector<Vector<2>> of_corner;
  for (std::size_t k = 0; k < corners_.size(); ++k)
    of_corner.emplace_back(of_corners.segment<2>(2 * static_cast<int>(k)).transpose());
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    Corner& corner = corners_[k];
    corner.of_equations = -corner.inverse.transpose() * of_corner[k];
    for (int i = 0; i < 2; ++i) lines_[corner.lines[static_cast<std::size_t>(i)]].of_l += corner.of_equations[i] * corner.b;
  }
  for (const CuttingLine& line : lines_) {
    if (!line.moves) continue;
    Vector<3> of_from = Vector<3>::Zero(), of_along = of_from;
    for (int v = 0; v < 3; ++v) {
      TriangleVertex& at = vertices_[static_cast<std::size_t>(v)];
      const Vector<3> apart = at.x - line.from, side = line.of_l[v] * line.along.cross(at.n);
      of_along += line.of_l[v] * at.n.cross(apart);
      at.of_normal += line.of_l[v] * apart.cross(line.along);
      at.of_place += side;
      of_from -= side;
    }
    for (std::size_t a = 0; a < static_cast<std::size_t>(line.n_nodes); ++a)
      gradient.segment<3>(line.column[a]) += (line.p[a] * of_from + (line.q[a] - line.p[a]) * of_along).transpose();
  }
  for (const TriangleVertex& at : vertices_) {
    const Vector<3> factor = of_unscaled(at);
    const std::array<Vector<3>, 2> of_tangent = of_tangents<3>(at.at.d, factor);
    for (int a = 0; a < at.phi.n; ++a) {
      const double value = at.phi.value[static_cast<std::size_t>(a)];
      gradient.segment<3>(3 * a) += value * at.of_place.transpose();
      if (is_smooth())
        gradient.segment<3>(first_normal_ + 3 * a) += value * factor.transpose();
      else
        gradient.segment<3>(3 * a) += (at.phi.slope(a, 0) * of_tangent[0] + at.phi.slope(a, 1) * of_tangent[1]).transpose();
    }
  }
}

std::vector<OwnUnknown> PolygonVariation::own_unknowns() const {
  std::vector<OwnUnknown> own;
  for (const CuttingLine& line : lines_)
    for (int k = 0; k < 3 && line.own_column >= 0; ++k)
      own.push_back({line.of_l[k], still_[own.size() / 3].row(k).head(cell_.n_unknowns())});
  return own;
}

Matrix PolygonVariation::corners() const {
  Matrix rows(2 * corners_.size(), n_);
  for (std::size_t k = 0; k < corners_.size(); ++k) rows.middleRows(2 * static_cast<Eigen::Index>(k), 2) = corners_[k].row;
  return rows;
}

void PolygonVariation::add_second(QuadraticForm& form) {
  for (const Corner& corner : corners_) {
    if (!corner.moves) continue;
    // J d2b = -(2 db . dl + b . d2l)
    for (int j = 0; j < 2; ++j) {
      Row turn = Row::Zero(n_);
      for (int i = 0; i < 2; ++i)
        if (const CuttingLine& own = lines_[corner.lines[static_cast<std::size_t>(i)]]; own.varies())
          turn += corner.of_equations[i] * (own.dl.row(j + 1) - own.dl.row(0));
      form.add(2, corner.row.row(j), turn);
    }
  }
  for (const CuttingLine& line : lines_)
    if (line.moves) add_second_of_line(line, form);
  for (const TriangleVertex& at : vertices_) add_second_of_vertex(at, form);
}

TriangleVertex PolygonVariation::vertex_at(int k) const {
  const Shapes<3> phi(cell_.slave, trace_.triangle[static_cast<std::size_t>(k)].data());
  const Interpolated<3> at(phi, cell_.slave_nodes.data());
  const Vector<3> normal = is_smooth() ? Interpolated<3>(phi, cell_.slave_normals.data()).x : Vector<3>(at.d[0].cross(at.d[1]));
  const double length = normal.norm();
  TriangleVertex v{.phi = phi, .at = at, .x = at.x, .n = normal / length, .length = length};
  if (!second_) return v;
  v.dn = Rows<3>::Zero(3, n_);
  for (int a = 0; a < phi.n; ++a)
    if (is_smooth())
      v.dn.block<3, 3>(0, first_normal_ + 3 * a).diagonal().setConstant(phi.value[static_cast<std::size_t>(a)]);
    else
      for (int d = 0; d < 3; ++d) {
        const std::array<Vector<3>, 2> of_tangent = of_tangents<3>(at.d, Vector<3>::Unit(d));
        v.dn.row(d).segment<3>(3 * a) = (phi.slope(a, 0) * of_tangent[0] + phi.slope(a, 1) * of_tangent[1]).transpose();
      }
  v.dn /= length;
  v.stretch = v.n.transpose() * v.dn;
  v.dn -= v.n * v.stretch;
  return v;
}

CuttingLine PolygonVariation::line(std::size_t k) {
  const PolygonTrace::Line& given = trace_.line[k];
  CuttingLine line;
  if (given.master < 0) {
    line.l = Vector<3>::Unit((given.edge + 2) % 3);
    return line;
  }
  const ContactCellGeometry::LineNodes& nodes = cell_.lines[k];
  shape_functions(nodes.type, given.from, line.p);
  shape_functions(nodes.type, given.to, line.q);
  line.moves = true;
  line.n_nodes = catalog::cell(nodes.type).n_nodes;
  line.from.setZero(), line.along.setZero();
  const int n_slave = static_cast<int>(cell_.slave_nodes.size()), n_own = n_slave + static_cast<int>(cell_.master_nodes.size());
  for (std::size_t a = 0; a < static_cast<std::size_t>(line.n_nodes); ++a) {
    const int at = line.column[a] = 3 * nodes.node[a];
    const double* const place = at < n_slave ? cell_.slave_nodes.data() + at
                                : at < n_own ? cell_.master_nodes.data() + at - n_slave
                                             : cell_.other_nodes.data() + at - n_own;
    line.foreign = line.foreign || at >= n_own;
    line.from += line.p[a] * Eigen::Map<const Vector<3>>(place);
    line.along += (line.q[a] - line.p[a]) * Eigen::Map<const Vector<3>>(place);
  }
  if (second_) line.dl = Rows<3>::Zero(3, n_);
  for (int v = 0; v < 3; ++v) {
    const TriangleVertex& at = vertices_[static_cast<std::size_t>(v)];
    const Vector<3> apart = at.x - line.from, normal_by_apart = at.n.cross(apart), apart_by_along = apart.cross(line.along),
                    along_by_normal = line.along.cross(at.n);
    line.l[v] = along_by_normal.dot(apart);
    if (!second_) continue;
    line.dl.row(v) = apart_by_along.transpose() * at.dn;
    for (int a = 0; a < at.phi.n; ++a)
      line.dl.row(v).segment<3>(3 * a) += at.phi.value[static_cast<std::size_t>(a)] * along_by_normal.transpose();
    for (std::size_t a = 0; a < static_cast<std::size_t>(line.n_nodes); ++a)
      line.dl.row(v).segment<3>(line.column[a]) +=
          ((line.q[a] - line.p[a]) * normal_by_apart - line.p[a] * along_by_normal).transpose();
  }
  if (nodes.still || (is_within(given, nodes.type) && passes_along_an_edge(line.l))) line.moves = false;
  if (nodes.still && second_) {
    line.own_column = cell_.n_unknowns() + 3 * static_cast<int>(still_.size());
    still_.push_back(std::exchange(line.dl, Rows<3>::Zero(3, n_)));
    line.dl.middleCols<3>(line.own_column).setIdentity();
  }
  return line;
}

void PolygonVariation::take_corner(std::size_t k) {
  const std::size_t n = trace_.vertex.size();
  Corner& corner = corners_.emplace_back();
  corner.lines = {(k + n - 1) % n, k};
  const auto& [b1, b2] = trace_.vertex[k];
  corner.b = {1 - b1 - b2, b1, b2};
  if (second_) corner.row = Rows<2>::Zero(2, n_);
  const auto slope = [&](std::size_t line) {  // by the last two coordinates
    const Vector<3>& l = lines_[line].l;
    return Vector<2>(l[1] - l[0], l[2] - l[0]);
  };
  const auto sine = [&](std::size_t first, std::size_t behind) {
    const Vector<2> u = slope(first), v = slope(behind);
    return std::abs(u[0] * v[1] - u[1] * v[0]) / (u.norm() * v.norm());
  };
  for (std::size_t edge = 0; edge < 3; ++edge) {
    if (std::abs(corner.b[static_cast<int>(edge)]) > on_edge) continue;
    for (std::size_t& line : corner.lines)
      if (lines_[line].moves && sine(line, n + edge) <= least_angle) line = n + edge;
  }
  Eigen::Matrix2d j;
  for (int i = 0; i < 2; ++i) j.row(i) = slope(corner.lines[static_cast<std::size_t>(i)]).transpose();
  if (sine(corner.lines[0], corner.lines[1]) > least_angle) {
    corner.inverse = j.inverse();
  } else {
    // at a right angle to one of them, the same in all polygons that meet here: the triangle's own edge, which stays, or the
    // edge of the master that is seen here, on whose other side its neighbour has no corner; a line of another master, which
    // hides a part of this one, only divides what is left
    const auto rank = [&](int i) {
      const std::size_t line = corner.lines[static_cast<std::size_t>(i)];
      const PolygonTrace::Line given = lines_[line].moves ? trace_.line[line] : PolygonTrace::Line{};
      return std::tuple(lines_[line].foreign, given.master, given.from, given.to);
    };
    const int i = rank(0) <= rank(1) ? 0 : 1;
    corner.inverse.setZero();
    if (const double length = j.row(i).norm(); length > 0) corner.inverse.col(i) = j.row(i).transpose() / (length * length);
  }
  for (int i = 0; i < 2; ++i) {
    const CuttingLine& own = lines_[corner.lines[static_cast<std::size_t>(i)]];
    if (!own.varies()) continue;
    corner.moves = true;
    if (second_) corner.row.noalias() -= corner.inverse.col(i) * (corner.b.transpose() * own.dl);
  }
}

void PolygonVariation::add_second_of_line(const CuttingLine& line, QuadraticForm& form) {
  Rows<3> turn = Rows<3>::Zero(3, n_), of_along = turn;
  Vector<3> normal = Vector<3>::Zero();
  const auto add_moved = [&](const Vector<3>& v, double factor, Eigen::Index column) {  // v x dx of a node
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      of_along(i, column + k) += factor * v[j];
      of_along(i, column + j) -= factor * v[k];
    }
  };
  for (int v = 0; v < 3; ++v) {
    TriangleVertex& at = vertices_[static_cast<std::size_t>(v)];
    turn += line.of_l[v] * at.dn;
    of_along -= cross(line.of_l[v] * (at.x - line.from), at.dn);
    for (int a = 0; a < at.phi.n; ++a) add_moved(line.of_l[v] * at.n, at.phi.value[static_cast<std::size_t>(a)], 3 * a);
    normal += line.of_l[v] * at.n;
    at.turned += line.of_l[v] * line.along;
  }
  const auto n_nodes = static_cast<std::size_t>(line.n_nodes);
  for (std::size_t a = 0; a < n_nodes; ++a) add_moved(normal, -line.p[a], line.column[a]);
  const Rows<3> of_from = cross(line.along, turn);
  for (std::size_t a = 0; a < n_nodes; ++a)
    for (int d = 0; d < 3; ++d)
      form.of(line.column[a] + d) += 2 * (line.q[a] - line.p[a]) * of_along.row(d) - 2 * line.p[a] * of_from.row(d);
}

void PolygonVariation::add_second_of_vertex(const TriangleVertex& at, QuadraticForm& form) const {
  form.add(-2, at.stretch, Row(at.of_normal.transpose() * at.dn));
  for (int i = 0; i < 3; ++i) form.add(-at.of_normal.dot(at.n), at.dn.row(i), at.dn.row(i));
  const Rows<3> of_place = cross(2 * at.turned, at.dn);
  const Vector<3> factor = 2 * of_unscaled(at);
  for (int a = 0; a < at.phi.n; ++a) {
    for (int d = 0; d < 3; ++d) form.of(3 * a + d) += at.phi.value[static_cast<std::size_t>(a)] * of_place.row(d);
    for (int b = 0; b < at.phi.n && !is_smooth(); ++b)
      form.add_cross_of_nodes(at.phi.slope(a, 0) * at.phi.slope(b, 1) * factor, a, b);
  }
}

}  // namespace lacon::variations
