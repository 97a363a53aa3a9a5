#include "lacon/operators/fields/cell_locator.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "lacon/elements/reference.hpp"

namespace lacon {
namespace {

using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;

/// A half-space normal . xi <= offset that holds the reference cell.
struct HalfSpace {
  Vector normal;
  double offset;
};

/// A reference cell as its middle and the half-spaces of its facets.
struct ReferenceCell {
  Vector middle;
  std::vector<HalfSpace> sides;

  explicit ReferenceCell(const catalog::CellRow& row) : middle(Vector::Zero(row.dimension)) {
    const auto vertex = [&](int i) -> Vector {
      return Eigen::Map<const Eigen::VectorXd>(row.nodes.data() + static_cast<std::ptrdiff_t>(i) * row.dimension,
                                               row.dimension);
    };
    for (int i = 0; i < row.n_vertices; ++i) middle += vertex(i) / row.n_vertices;
    for (const catalog::FacetRow& facet : row.facets) {
      const Vector a = vertex(facet.nodes[0]), along = vertex(facet.nodes[1]) - a;
      Vector normal(row.dimension);
      if (row.dimension == 2) {
        normal << along[1], -along[0];
      } else {
        const Eigen::Vector3d u = along, v = vertex(facet.nodes[2]) - a;
        normal = u.cross(v);
      }
      normal.normalize();
      if (normal.dot(middle - a) > 0) normal = -normal;
      sides.push_back({normal, normal.dot(a)});
    }
  }

  /// The side that xi is furthest beyond, and how far; negative inside.
  std::pair<const HalfSpace*, double> worst(const Vector& xi) const {
    std::pair<const HalfSpace*, double> found{nullptr, -1e300};
    for (const HalfSpace& side : sides)
      if (const double beyond = side.normal.dot(xi) - side.offset; beyond > found.second) found = {&side, beyond};
    return found;
  }
  bool holds(const Vector& xi) const { return worst(xi).second <= CellLocator::margin; }
  /// xi moved back across the sides it is beyond, one after the other.
  Vector moved_inside(Vector xi) const {
    for (int i = 0; i < 100; ++i) {
      const auto [side, beyond] = worst(xi);
      if (beyond <= CellLocator::margin) return xi;
      xi -= beyond * side->normal;
    }
    return middle;
  }
};

const ReferenceCell& reference_cell(CellType type) {
  static std::map<CellType, ReferenceCell> made;
  return made.try_emplace(type, catalog::cell(type)).first->second;
}

/// A box that holds a cell, curved or not: that of its vertices, widened by how far the other nodes are from where the linear
/// cell of these vertices has them (no shape function of such a node exceeds 1).
Box<3> box_of(const Mesh& mesh, std::size_t cell) {
  const catalog::CellRow& row = mesh.row(cell);
  const auto nodes = mesh.cells[cell];
  const auto point = [&](int a) { return mesh.point(static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])); };
  Box<3> box = Box<3>::empty();
  for (int a = 0; a < row.n_vertices; ++a) box.add(point(a).data());
  std::vector<double> shape(static_cast<std::size_t>(row.n_vertices));
  std::array<double, 3> wider{};
  for (int a = row.n_vertices; a < row.n_nodes; ++a) {
    shape_functions(row.linear,
                    row.nodes.subspan(static_cast<std::size_t>(a * row.dimension), static_cast<std::size_t>(row.dimension)),
                    shape);
    for (std::size_t d = 0; d < 3; ++d) {
      double straight = 0;
      for (int v = 0; v < row.n_vertices; ++v) straight += shape[static_cast<std::size_t>(v)] * point(v)[d];
      wider[d] += std::abs(point(a)[d] - straight);
    }
  }
  double diagonal = 0;
  for (std::size_t d = 0; d < 3; ++d) diagonal += (box.high[d] - box.low[d]) * (box.high[d] - box.low[d]);
  for (std::size_t d = 0; d < 3; ++d) {
    box.low[d] -= wider[d] + CellLocator::margin * std::sqrt(diagonal);
    box.high[d] += wider[d] + CellLocator::margin * std::sqrt(diagonal);
  }
  return box;
}

bool within(const Box<3>& box, const std::array<double, 3>& point, double distance) {
  for (std::size_t d = 0; d < 3; ++d)
    if (point[d] < box.low[d] - distance || point[d] > box.high[d] + distance) return false;
  return true;
}

}  // namespace

CellLocator::CellLocator(const Mesh& mesh, std::span<const std::int32_t> cells) : mesh_(mesh) {
  std::vector<Box<3>> boxes;
  for (const std::int32_t cell : cells) {
    if (mesh.row(static_cast<std::size_t>(cell)).dimension != mesh.dimension) continue;
    cells_.push_back(cell);
    boxes.push_back(box_of(mesh, static_cast<std::size_t>(cell)));
    const Eigen::Map<const Eigen::Vector3d> low(boxes.back().low.data()), high(boxes.back().high.data());
    size_.push_back((high - low).norm());
    largest_ = std::max(largest_, size_.back());
  }
  tree_.emplace(std::move(boxes));
}

double CellLocator::residual(std::size_t cell, const std::array<double, 3>& point, std::span<const double> xi,
                             std::vector<double>& weights) const {
  const auto nodes = mesh_.cells[cell];
  weights.resize(nodes.size());
  shape_functions(mesh_.types[cell], xi, weights);
  Eigen::Vector3d r = -Eigen::Map<const Eigen::Vector3d>(point.data());
  for (std::size_t a = 0; a < nodes.size(); ++a)
    r += weights[a] * Eigen::Map<const Eigen::Vector3d>(mesh_.point(static_cast<std::size_t>(nodes[a])).data());
  return r.norm();
}

bool CellLocator::inverse(std::size_t cell, const std::array<double, 3>& point, std::span<double> xi) const {
  const auto nodes = mesh_.cells[cell];
  const int dimension = mesh_.dimension;
  const auto n = static_cast<Eigen::Index>(nodes.size());
  // positions relative to the point, so that round-off is that of the cell and not of the distance to the origin
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> x(n, dimension);
  for (Eigen::Index a = 0; a < n; ++a)
    for (int d = 0; d < dimension; ++d)
      x(a, d) = mesh_.point(static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)]))[static_cast<std::size_t>(d)] -
                point[static_cast<std::size_t>(d)];
  const double size = (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
  Eigen::VectorXd shape(n);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> gradient(n, dimension);
  const auto off = [&](const Vector& at) -> Vector {
    shape_functions(mesh_.types[cell], {at.data(), static_cast<std::size_t>(dimension)}, {shape.data(), nodes.size()});
    return x.transpose() * shape;
  };

  Vector at = reference_cell(mesh_.types[cell]).middle, r = off(at);
  for (int iteration = 0; iteration < 50 && r.norm() > 1e-16 * size; ++iteration) {
    shape_gradients(mesh_.types[cell], {at.data(), static_cast<std::size_t>(dimension)},
                    {gradient.data(), static_cast<std::size_t>(gradient.size())});
    const Matrix jacobian = x.transpose() * gradient;
    const Vector step = jacobian.fullPivLu().solve(r);
    // a shorter step where the residual would grow; none that helps: converged as far as round-off lets it
    bool better = false;
    for (double part = 1; part > 1e-3 && !better; part /= 2) {
      const Vector tried = at - part * step;
      const Vector there = off(tried);
      if (!(there.norm() < r.norm())) continue;
      at = tried;
      r = there;
      better = true;
    }
    if (!better) break;
  }
  std::copy_n(at.data(), dimension, xi.begin());
  return r.norm() <= 1e-11 * size;
}

std::optional<PointInCell> CellLocator::find(const std::array<double, 3>& point, std::optional<double> distance_max) const {
  const auto candidates = [&](double distance) {
    std::vector<std::int32_t> items;
    tree_->visit([&](const Box<3>& box) { return within(box, point, distance); },
                 [&](std::int32_t item) { items.push_back(item); });
    std::sort(items.begin(), items.end());
    return items;
  };
  std::array<double, 3> buffer{};
  const std::span<double> xi(buffer.data(), static_cast<std::size_t>(mesh_.dimension));
  PointInCell found;
  for (const std::int32_t item : candidates(0)) {
    found.cell = cells_[static_cast<std::size_t>(item)];
    const auto cell = static_cast<std::size_t>(found.cell);
    if (!inverse(cell, point, xi)) continue;
    if (!reference_cell(mesh_.types[cell]).holds(Eigen::Map<const Eigen::VectorXd>(xi.data(), mesh_.dimension))) continue;
    found.distance = residual(cell, point, xi, found.weights);
    return found;
  }
  found.outside = true;
  std::optional<PointInCell> nearest;
  for (const std::int32_t item : candidates(distance_max.value_or(near * largest_))) {
    found.cell = cells_[static_cast<std::size_t>(item)];
    const auto cell = static_cast<std::size_t>(found.cell);
    if (!inverse(cell, point, xi)) continue;
    const Vector inside =
        reference_cell(mesh_.types[cell]).moved_inside(Eigen::Map<const Eigen::VectorXd>(xi.data(), mesh_.dimension));
    found.distance = residual(cell, point, {inside.data(), xi.size()}, found.weights);
    if (found.distance > distance_max.value_or(near * size_[static_cast<std::size_t>(item)])) continue;
    if (!nearest || found.distance < nearest->distance) nearest = found;
  }
  return nearest;
}

}  // namespace lacon
