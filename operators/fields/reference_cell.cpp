#include "lacon/operators/fields/reference_cell.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace lacon {
namespace {

ReferenceCell made(const catalog::CellRow& row) {
  const auto vertex = [&](int i) -> ReferenceVector {
    return Eigen::Map<const Eigen::VectorXd>(row.nodes.data() + static_cast<std::ptrdiff_t>(i) * row.dimension, row.dimension);
  };
  ReferenceCell cell{ReferenceVector::Zero(row.dimension), {}};
  for (int i = 0; i < row.n_vertices; ++i) cell.middle += vertex(i) / row.n_vertices;
  for (const catalog::FacetRow& facet : row.facets) {
    const ReferenceVector a = vertex(facet.nodes[0]);
    ReferenceVector normal = a - cell.middle;  // on a line the facet is a point
    if (row.dimension == 2) {
      const ReferenceVector along = vertex(facet.nodes[1]) - a;
      normal << along[1], -along[0];
    } else if (row.dimension == 3) {
      const Eigen::Vector3d u = vertex(facet.nodes[1]) - a, v = vertex(facet.nodes[2]) - a;
      normal = u.cross(v);
    }
    normal.normalize();
    if (normal.dot(cell.middle - a) > 0) normal = -normal;
    cell.sides.push_back({normal, normal.dot(a)});
  }
  return cell;
}

}  // namespace

bool ReferenceCell::holds(const ReferenceVector& xi, double margin) const {
  return std::all_of(sides.begin(), sides.end(),
                     [&](const HalfSpace& side) { return side.normal.dot(xi) - side.offset <= margin; });
}

const ReferenceCell& reference_cell(CellType type) {
  static std::map<CellType, ReferenceCell> cells;
  const auto known = cells.find(type);
  return known != cells.end() ? known->second : cells.emplace(type, made(catalog::cell(type))).first->second;
}

}  // namespace lacon
