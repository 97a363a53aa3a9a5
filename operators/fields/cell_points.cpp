#include "lacon/operators/fields/cell_points.hpp"

#include <Eigen/Dense>
#include <string>

#include "lacon/catalog/messages.hpp"

namespace lacon {

ModelPoints::ModelPoints(const Mesh& mesh, const Model& model, const Registry& registry) : mesh_(mesh), model_(model) {
  for (const std::string& name : model.elements) {
    rows_.push_back(registry.find_element(name));
    if (!rows_.back()) fail("PLUGIN_4", {{"element", name}});
  }
}

const catalog::ElementRow* ModelPoints::element(std::size_t cell) const {
  const std::int32_t index = model_.element[cell];
  return index < 0 ? nullptr : rows_[static_cast<std::size_t>(index)];
}

bool ModelPoints::is_solid(std::size_t cell) const {
  const catalog::ElementRow* row = element(cell);
  return row && row->role == catalog::Role::solid;
}

bool ModelPoints::is_axisymmetric(std::size_t cell) const { return element(cell)->geometry == catalog::Geometry::axis; }
bool ModelPoints::is_plane_stress(std::size_t cell) const {
  return element(cell)->stress_state == catalog::StressState::plane_stress;
}

namespace {

/// Jacobian and gradients of a body at its points, by matrices of fixed size. @param x (n_nodes, S) @return whether all
/// Jacobians are positive
template <int S>
bool body_points(const Tabulation& table, const double* x, CellPoints& points) {
  using Matrix = Eigen::Matrix<double, S, S>;
  using Row = Eigen::Map<const Eigen::Matrix<double, 1, S>>;
  points.gradient.resize(static_cast<std::size_t>(table.n_points * table.n_nodes * S));
  bool positive = true;
  for (int p = 0; p < table.n_points; ++p) {
    const double* const reference = table.gradient.data() + static_cast<std::ptrdiff_t>(p) * table.n_nodes * S;
    double* const gradient = points.gradient.data() + static_cast<std::ptrdiff_t>(p) * table.n_nodes * S;
    Matrix jacobian = Matrix::Zero();
    for (int a = 0; a < table.n_nodes; ++a) jacobian += Row(x + a * S).transpose() * Row(reference + a * S);
    const double size = jacobian.determinant();
    positive = positive && size > 0;
    const Matrix inverse = jacobian.inverse();
    for (int a = 0; a < table.n_nodes; ++a)
      Eigen::Map<Eigen::Matrix<double, 1, S>>(gradient + a * S) = Row(reference + a * S) * inverse;
    points.measure[static_cast<std::size_t>(p)] = size;
  }
  return positive;
}

/// Length or area of a skin at its points for one of the reference cell. @param x (n_nodes, space)
void skin_points(const Tabulation& table, const double* x, int space, CellPoints& points) {
  points.gradient.clear();
  for (int p = 0; p < table.n_points; ++p) {
    Eigen::Vector3d tangent[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (int a = 0; a < table.n_nodes; ++a)
      for (int k = 0; k < table.dimension; ++k)
        for (int i = 0; i < space; ++i)
          tangent[k](i) +=
              x[a * space + i] * table.gradient[static_cast<std::size_t>((p * table.n_nodes + a) * table.dimension + k)];
    points.measure[static_cast<std::size_t>(p)] =
        table.dimension == 2 ? tangent[0].cross(tangent[1]).norm() : tangent[0].norm();
  }
}

}  // namespace

const CellPoints& ModelPoints::operator()(std::size_t cell, std::span<const double> coordinates) {
  const catalog::ElementRow& row = *element(cell);
  const auto [at, made] = tabulations_.try_emplace(&row);
  if (made) at->second = tabulate(row.cell, integration_rule(catalog::cell(row.cell).family, row.points));
  const Tabulation& table = at->second;
  const auto nodes = mesh_.cells[cell];
  const int n = table.n_nodes, space = catalog::dimension_of(row.geometry);

  CellPoints& points = points_;
  points.n_points = table.n_points;
  points.n_nodes = n;
  points.dimension = space;
  points.shape = table.shape;
  points.position.assign(static_cast<std::size_t>(table.n_points) * 3, 0.0);
  points.measure.resize(static_cast<std::size_t>(table.n_points));
  x_.clear();
  for (const std::int32_t node : nodes)
    for (int i = 0; i < space; ++i) x_.push_back(coordinates[static_cast<std::size_t>(node * 3 + i)]);
  if (row.role != catalog::Role::solid)
    skin_points(table, x_.data(), space, points);
  else if (!(space == 3 ? body_points<3>(table, x_.data(), points) : body_points<2>(table, x_.data(), points)))
    fail("FIELDS_4", {{"cell", cell_name(static_cast<std::int64_t>(cell))}, {"element", std::string(row.name)}});
  const bool axis = is_axisymmetric(cell);
  for (int p = 0; p < table.n_points; ++p) {
    double* const position = points.position.data() + static_cast<std::ptrdiff_t>(3 * p);
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < 3; ++i)
        position[i] += table.shape[static_cast<std::size_t>(p * n + a)] *
                       coordinates[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)] * 3 + i)];
    points.measure[static_cast<std::size_t>(p)] *= table.weight[static_cast<std::size_t>(p)] * (axis ? position[0] : 1.0);
  }
  return points;
}

}  // namespace lacon
