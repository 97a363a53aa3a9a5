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

// modelisations are told apart by code_aster's names for them, which plug-ins keep
bool ModelPoints::is_axisymmetric(std::size_t cell) const { return element(cell)->modelisation.starts_with("AXIS"); }
bool ModelPoints::is_plane_stress(std::size_t cell) const { return element(cell)->modelisation.starts_with("C_PLAN"); }

const CellPoints& ModelPoints::operator()(std::size_t cell, std::span<const double> coordinates) {
  const catalog::ElementRow& row = *element(cell);
  const auto [at, made] = tabulations_.try_emplace(&row);
  if (made) at->second = tabulate(row.cell, integration_rule(catalog::cell(row.cell).family, row.points));
  const Tabulation& table = at->second;
  const auto nodes = mesh_.cells[cell];
  const int n = table.n_nodes, space = static_cast<int>(row.dofs.size());
  const bool solid = row.role == catalog::Role::solid;

  CellPoints& points = points_;
  points.n_points = table.n_points;
  points.n_nodes = n;
  points.dimension = space;
  points.shape = table.shape;
  points.position.assign(static_cast<std::size_t>(table.n_points) * 3, 0.0);
  points.measure.resize(static_cast<std::size_t>(table.n_points));
  points.gradient.assign(solid ? static_cast<std::size_t>(table.n_points * n * space) : 0, 0.0);

  using Gradients = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  Eigen::MatrixXd x(space, n);
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < space; ++i) x(i, a) = coordinates[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)] * 3 + i)];
  for (int p = 0; p < table.n_points; ++p) {
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < 3; ++i)
        points.position[static_cast<std::size_t>(3 * p + i)] +=
            table.shape[static_cast<std::size_t>(p * n + a)] *
            coordinates[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)] * 3 + i)];
    const Gradients reference(table.gradient.data() + static_cast<std::ptrdiff_t>(p) * n * table.dimension, n, table.dimension);
    const Eigen::MatrixXd jacobian = x * reference;
    double size = 0;
    if (solid) {
      size = jacobian.determinant();
      if (!(size > 0))
        fail("FIELDS_4", {{"cell", cell_name(static_cast<std::int64_t>(cell))}, {"element", std::string(row.name)}});
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          points.gradient.data() + static_cast<std::ptrdiff_t>(p) * n * space, n, space) = reference * jacobian.inverse();
    } else {
      size = std::sqrt((jacobian.transpose() * jacobian).determinant());
    }
    const double radius = is_axisymmetric(cell) ? points.position[static_cast<std::size_t>(3 * p)] : 1.0;
    points.measure[static_cast<std::size_t>(p)] = table.weight[static_cast<std::size_t>(p)] * size * radius;
  }
  return points;
}

std::vector<double> displaced(const Mesh& mesh, const Field& displacement) {
  std::vector<double> coordinates = mesh.coordinates;
  constexpr const char* names[] = {"DX", "DY", "DZ"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int column = displacement.component(names[axis]);
    if (column < 0) continue;
    for (std::size_t i = 0; i < displacement.support.size(); ++i)
      if (displacement.has(i, static_cast<std::size_t>(column)))
        coordinates[static_cast<std::size_t>(displacement.support[i]) * 3 + axis] +=
            displacement.at(i, static_cast<std::size_t>(column));
  }
  return coordinates;
}

}  // namespace lacon
