#include "lacon/operators/fields/cell_locator.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "lacon/elements/reference.hpp"
#include "lacon/operators/fields/nearest_point.hpp"
#include "lacon/operators/fields/reference_cell.hpp"

namespace lacon {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;

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

double distance(const Box<3>& box, const std::array<double, 3>& point) {
  std::array<double, 3> off;
  for (std::size_t d = 0; d < 3; ++d) off[d] = std::max({box.low[d] - point[d], point[d] - box.high[d], 0.0});
  return std::hypot(off[0], off[1], off[2]);
}

/// The nodes of a cell relative to a point, so that round-off is that of the cell and not of the distance to the origin.
Eigen::Matrix<double, Eigen::Dynamic, 3> relative_nodes(const Mesh& mesh, std::int32_t cell,
                                                        const std::array<double, 3>& point) {
  const auto nodes = mesh.cells[static_cast<std::size_t>(cell)];
  Eigen::Matrix<double, Eigen::Dynamic, 3> x(static_cast<Eigen::Index>(nodes.size()), 3);
  for (Eigen::Index a = 0; a < x.rows(); ++a) {
    const auto at = mesh.point(static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)]));
    for (std::size_t d = 0; d < 3; ++d) x(a, static_cast<Eigen::Index>(d)) = at[d] - point[d];
  }
  return x;
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

std::optional<PointInCell> CellLocator::within(std::int32_t cell, const std::array<double, 3>& point) const {
  const CellType type = mesh_.types[static_cast<std::size_t>(cell)];
  const auto x = relative_nodes(mesh_, cell, point).leftCols(mesh_.dimension).eval();
  const double size = (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
  PointInCell found{cell, std::vector<double>(static_cast<std::size_t>(x.rows())), 0, false};
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> gradient(x.rows(), mesh_.dimension);
  const auto off = [&](const ReferenceVector& at) -> ReferenceVector {
    shape_functions(type, {at.data(), static_cast<std::size_t>(at.size())}, found.weights);
    return x.transpose() * Eigen::Map<const Eigen::VectorXd>(found.weights.data(), x.rows());
  };

  ReferenceVector at = reference_cell(type).middle, r = off(at);
  for (int iteration = 0; iteration < 50 && r.norm() > 1e-16 * size; ++iteration) {
    shape_gradients(type, {at.data(), static_cast<std::size_t>(at.size())},
                    {gradient.data(), static_cast<std::size_t>(gradient.size())});
    const Matrix jacobian = x.transpose() * gradient;
    const ReferenceVector step = jacobian.fullPivLu().solve(r);
    // a shorter step where the residual would grow; none that helps: converged as far as round-off lets it
    bool better = false;
    for (double part = 1; part > 1e-3 && !better; part /= 2) {
      const ReferenceVector tried = at - part * step;
      const ReferenceVector there = off(tried);
      if (!(there.norm() < r.norm())) continue;
      at = tried;
      r = there;
      better = true;
    }
    if (!better) break;
  }
  found.distance = off(at).norm();
  if (found.distance > 1e-11 * size || !reference_cell(type).holds(at, margin)) return std::nullopt;
  return found;
}

std::optional<PointInCell> CellLocator::nearest(const std::array<double, 3>& point, std::optional<double> distance_max) const {
  const auto limit = [&](std::int32_t item) { return distance_max.value_or(near * size_[static_cast<std::size_t>(item)]); };
  // cells farther than some cell's nearest vertex need not be looked at
  double bound = distance_max.value_or(near * largest_);
  const auto touches = [&](const Box<3>& box) { return distance(box, point) <= bound; };
  tree_->visit(touches, [&](std::int32_t item) {
    const std::int32_t cell = cells_[static_cast<std::size_t>(item)];
    const double vertex = relative_nodes(mesh_, cell, point)
                              .topRows(mesh_.row(static_cast<std::size_t>(cell)).n_vertices)
                              .rowwise()
                              .norm()
                              .minCoeff();
    if (vertex <= limit(item)) bound = std::min(bound, vertex * (1 + 1e-12));
  });
  std::vector<std::int32_t> items;
  tree_->visit(touches, [&](std::int32_t item) { items.push_back(item); });
  std::sort(items.begin(), items.end());

  std::optional<NearestPoint> best;
  PointInCell found;
  for (const std::int32_t item : items) {
    const std::int32_t cell = cells_[static_cast<std::size_t>(item)];
    NearestPoint there =
        nearest_on_border(mesh_.types[static_cast<std::size_t>(cell)], relative_nodes(mesh_, cell, point), largest_);
    if (there.distance > limit(item)) continue;
    if (best && !preferred(there.distance, there.from_point, *best, largest_)) continue;
    best = std::move(there);
    found.cell = cell;
  }
  if (!best) return std::nullopt;
  found.weights = std::move(best->weights);
  found.distance = best->distance;
  found.outside = true;
  return found;
}

std::optional<PointInCell> CellLocator::find(const std::array<double, 3>& point, std::optional<double> distance_max) const {
  std::vector<std::int32_t> items;
  tree_->visit([&](const Box<3>& box) { return distance(box, point) <= 0; }, [&](std::int32_t item) { items.push_back(item); });
  std::sort(items.begin(), items.end());
  for (const std::int32_t item : items)
    if (auto found = within(cells_[static_cast<std::size_t>(item)], point)) return found;
  return nearest(point, distance_max);
}

}  // namespace lacon
