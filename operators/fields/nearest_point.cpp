#include "lacon/operators/fields/nearest_point.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numeric>
#include <span>

#include "lacon/elements/reference.hpp"
#include "lacon/operators/fields/reference_cell.hpp"

namespace lacon {
namespace {

using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using Shape = Eigen::VectorXd;

/// A facet, an edge or a vertex of a cell, relative to the point.
struct Part {
  CellType type;
  std::vector<int> nodes;  ///< of the cell
  Positions positions;     ///< (n_nodes, 3)

  Part(CellType kind, std::vector<int> numbers, const Positions& cell)
      : type(kind), nodes(std::move(numbers)), positions(static_cast<Eigen::Index>(nodes.size()), 3) {
    for (std::size_t a = 0; a < nodes.size(); ++a) positions.row(static_cast<Eigen::Index>(a)) = cell.row(nodes[a]);
  }
  Shape shape(const ReferenceVector& xi) const {
    Shape values(positions.rows());
    shape_functions(type, {xi.data(), static_cast<std::size_t>(xi.size())}, {values.data(), nodes.size()});
    return values;
  }
  Eigen::Vector3d at(const ReferenceVector& xi) const { return positions.transpose() * shape(xi); }
  /// All partial derivatives of an order, one a column: by xi alone first, by eta alone last.
  Eigen::Matrix<double, 3, Eigen::Dynamic> derivatives(const ReferenceVector& xi, int order) const {
    const Eigen::Index columns = xi.size() == 2 ? order + 1 : 1;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(positions.rows(), columns);
    shape_derivatives(type, {xi.data(), static_cast<std::size_t>(xi.size())}, order,
                      {values.data(), static_cast<std::size_t>(values.size())});
    return positions.transpose() * values;
  }
};

/// Where Newton's method on half the squared distance comes to from xi. The matrix is that of Gauss and Newton where the whole
/// one has another sign, and steps are halved where the distance would grow.
ReferenceVector descended(const Part& part, ReferenceVector xi) {
  constexpr double round_off = 1e-15;
  Eigen::Vector3d x = part.at(xi);
  for (int iteration = 0; iteration < 40; ++iteration) {
    const auto tangents = part.derivatives(xi, 1);
    const auto curvatures = part.derivatives(xi, 2);
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2>;
    const Matrix metric = tangents.transpose() * tangents;
    Matrix whole = metric;
    for (Eigen::Index i = 0; i < xi.size(); ++i)
      for (Eigen::Index j = 0; j < xi.size(); ++j) whole(i, j) += x.dot(curvatures.col(i + j));
    const bool convex = whole(0, 0) > 0 && whole.determinant() > 1e-6 * metric.determinant();
    if (!(metric.determinant() > 0)) return xi;  // the part has no extent
    const ReferenceVector step = -(convex ? whole : metric).inverse() * (tangents.transpose() * x);
    double share = 1;
    ReferenceVector next = xi + step;
    while (share > 1e-4 && part.at(next).squaredNorm() > x.squaredNorm() * (1 + round_off)) next = xi + (share /= 2) * step;
    if (share <= 1e-4) return xi;
    xi = next;
    x = part.at(xi);
    if (share * step.norm() < round_off) return xi;
  }
  return xi;
}

/// From where stationary points are sought: one of an affine part is found from anywhere.
std::vector<ReferenceVector> starts(CellType type) {
  const catalog::CellRow& row = catalog::cell(type);
  std::vector<ReferenceVector> points{reference_cell(type).middle};
  if (row.n_nodes == row.dimension + 1) return points;
  const catalog::CellRow& quadratic = catalog::cell(row.quadratic);
  for (int a = 0; a < quadratic.n_nodes; ++a)
    points.emplace_back(Eigen::Map<const Eigen::VectorXd>(
        quadratic.nodes.data() + static_cast<std::ptrdiff_t>(a) * quadratic.dimension, quadratic.dimension));
  return points;
}

class BorderSearch {
 public:
  BorderSearch(const Positions& cell, double size) : cell_(cell), size_(size) {}

  /// Take what is nearest on a part and on what bounds it.
  void add(const Part& part) {
    const catalog::CellRow& row = catalog::cell(part.type);
    if (row.dimension == 0) {
      offer(part, Shape::Ones(1));
      return;
    }
    for (const ReferenceVector& start : starts(part.type)) {
      const ReferenceVector xi = descended(part, start);
      if (reference_cell(part.type).holds(xi, 0)) offer(part, part.shape(xi));
    }
    add_facets(row, part.nodes);
  }
  void add_facets(const catalog::CellRow& row, std::span<const int> nodes) {
    for (const catalog::FacetRow& facet : row.facets) {
      std::vector<int> of_cell;
      for (const std::int8_t a : facet.nodes) of_cell.push_back(nodes[static_cast<std::size_t>(a)]);
      add({facet.type, std::move(of_cell), cell_});
    }
  }
  const NearestPoint& found() const { return found_; }

 private:
  void offer(const Part& part, const Shape& shape) {
    const Eigen::Vector3d x = part.positions.transpose() * shape;
    const double distance = x.norm();
    if (!preferred(distance, x, found_, size_)) return;
    found_ = {distance, x, std::vector<double>(static_cast<std::size_t>(cell_.rows()), 0.0)};
    for (std::size_t a = 0; a < part.nodes.size(); ++a)
      found_.weights[static_cast<std::size_t>(part.nodes[a])] = shape[static_cast<Eigen::Index>(a)];
  }

  const Positions& cell_;
  double size_;
  NearestPoint found_{HUGE_VAL, Eigen::Vector3d::Zero(), {}};
};

}  // namespace

bool preferred(double distance, const Eigen::Vector3d& from_point, const NearestPoint& other, double size) {
  const double round_off = 1e-14 * (size + distance);
  const Eigen::Vector3d apart = from_point - other.from_point;
  // a border is nearer than this to round-off around its nearest point itself: there the nearer one counts
  const double around = 1e3 * distance * round_off;
  if (std::abs(distance - other.distance) > round_off || apart.squaredNorm() <= around) return distance < other.distance;
  for (Eigen::Index d = 0; d < 3; ++d)
    if (std::abs(apart[d]) > round_off) return apart[d] < 0;
  return false;
}

NearestPoint nearest_on_border(CellType type, const Positions& nodes, double size) {
  std::vector<int> all(static_cast<std::size_t>(nodes.rows()));
  std::iota(all.begin(), all.end(), 0);
  BorderSearch search(nodes, size);
  search.add_facets(catalog::cell(type), all);
  return search.found();
}

}  // namespace lacon
