#include "lacon/operators/fields/extrapolation.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <map>
#include <utility>

#include "lacon/elements/reference.hpp"

namespace lacon {
namespace {

/// The shape functions of a cell at points, (n_points, n_nodes).
Eigen::MatrixXd shapes_at(CellType type, std::span<const double> points, int n_points) {
  const catalog::CellRow& cell = catalog::cell(type);
  Eigen::MatrixXd values(n_points, cell.n_nodes);
  std::vector<double> row(static_cast<std::size_t>(cell.n_nodes));
  const auto dimension = static_cast<std::size_t>(cell.dimension);
  for (int p = 0; p < n_points; ++p) {
    shape_functions(type, points.subspan(static_cast<std::size_t>(p) * dimension, dimension), row);
    for (int a = 0; a < cell.n_nodes; ++a) values(p, a) = row[static_cast<std::size_t>(a)];
  }
  return values;
}

}  // namespace

Field field_like(const Field& from, std::string name, Location location) {
  Field to;
  to.name = std::move(name);
  to.quantity = from.quantity;
  to.location = location;
  to.components = from.components;
  to.mesh = from.mesh;
  to.order = from.order;
  to.instant = from.instant;
  return to;
}

std::vector<double> extrapolation_matrix(CellType type, int n_points) {
  const catalog::CellRow& cell = catalog::cell(type);
  const Rule& rule = integration_rule(cell.family, n_points);
  const CellType linear = cell.linear;
  std::vector<double> matrix(static_cast<std::size_t>(cell.n_nodes * n_points), 1.0 / n_points);
  if (n_points < cell.n_vertices) return matrix;
  const Eigen::MatrixXd at_points = shapes_at(linear, rule.points, n_points);
  const Eigen::MatrixXd fit = at_points.householderQr().solve(Eigen::MatrixXd::Identity(n_points, n_points));
  const Eigen::MatrixXd at_nodes = shapes_at(linear, cell.nodes, cell.n_nodes) * fit;
  for (int a = 0; a < cell.n_nodes; ++a)
    for (int p = 0; p < n_points; ++p) matrix[static_cast<std::size_t>(a * n_points + p)] = at_nodes(a, p);
  return matrix;
}

Field gauss_points_to_cell_nodes(const Mesh& mesh, const Field& points, std::string name) {
  Field nodes = field_like(points, std::move(name), Location::cell_nodes);
  nodes.support = points.support;
  nodes.offset.assign(1, 0);
  const std::size_t n_components = points.n_components();
  std::map<std::pair<CellType, int>, std::vector<double>> matrices;
  for (std::size_t i = 0; i < points.support.size(); ++i) {
    const auto cell = static_cast<std::size_t>(points.support[i]);
    const auto first = static_cast<std::size_t>(points.offset[i]);
    const int n_points = static_cast<int>(points.offset[i + 1] - points.offset[i]);
    const auto n_nodes = static_cast<std::size_t>(mesh.row(cell).n_nodes);
    const auto [at, made] = matrices.try_emplace({mesh.types[cell], n_points});
    if (made) at->second = extrapolation_matrix(mesh.types[cell], n_points);
    const std::vector<double>& matrix = at->second;
    for (std::size_t a = 0; a < n_nodes; ++a)
      for (std::size_t c = 0; c < n_components; ++c) {
        double value = 0;
        for (std::size_t p = 0; p < static_cast<std::size_t>(n_points); ++p)
          value += matrix[a * static_cast<std::size_t>(n_points) + p] * points.at(first + p, c);
        nodes.values.push_back(value);
        if (!points.present.empty()) nodes.present.push_back(points.has(first, c));
      }
    nodes.offset.push_back(nodes.offset.back() + static_cast<std::int64_t>(n_nodes));
  }
  return nodes;
}

Field cell_nodes_to_nodes(const Mesh& mesh, const Field& cells, std::string name) {
  Field nodes = field_like(cells, std::move(name), Location::nodes);
  const std::size_t n_components = cells.n_components();
  std::vector<std::int32_t> row_of(mesh.n_nodes(), -1);
  for (const std::int32_t cell : cells.support)
    for (const std::int32_t node : mesh.cells[static_cast<std::size_t>(cell)]) row_of[static_cast<std::size_t>(node)] = 0;
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n)
    if (row_of[n] == 0) {
      row_of[n] = static_cast<std::int32_t>(nodes.support.size());
      nodes.support.push_back(static_cast<std::int32_t>(n));
    }
  nodes.values.assign(nodes.support.size() * n_components, 0.0);
  std::vector<int> count(nodes.values.size(), 0);
  for (std::size_t i = 0; i < cells.support.size(); ++i) {
    const auto members = mesh.cells[static_cast<std::size_t>(cells.support[i])];
    for (std::size_t a = 0; a < members.size(); ++a) {
      const std::size_t from = cells.offset.empty() ? i : static_cast<std::size_t>(cells.offset[i]) + a;
      const auto to = static_cast<std::size_t>(row_of[static_cast<std::size_t>(members[a])]);
      for (std::size_t c = 0; c < n_components; ++c)
        if (cells.counts(from, c)) {
          nodes.at(to, c) += cells.at(from, c);
          ++count[to * n_components + c];
        }
    }
  }
  for (std::size_t k = 0; k < count.size(); ++k)
    if (count[k] > 0) nodes.values[k] /= count[k];
  if (std::find(count.begin(), count.end(), 0) != count.end())
    for (const int n : count) nodes.present.push_back(n > 0);
  return nodes;
}

Field restrict_to_cells(const Field& field, const std::vector<char>& wanted) {
  Field part = field_like(field, field.name, field.location);
  if (!field.offset.empty()) part.offset.assign(1, 0);
  const std::size_t n_components = field.n_components();
  for (std::size_t i = 0; i < field.support.size(); ++i) {
    if (!wanted[static_cast<std::size_t>(field.support[i])]) continue;
    const std::size_t first = field.offset.empty() ? i : static_cast<std::size_t>(field.offset[i]);
    const std::size_t last = field.offset.empty() ? i + 1 : static_cast<std::size_t>(field.offset[i + 1]);
    part.support.push_back(field.support[i]);
    for (std::size_t k = first * n_components; k < last * n_components; ++k) {
      part.values.push_back(field.values[k]);
      if (!field.present.empty()) part.present.push_back(field.present[k]);
    }
    if (!field.offset.empty()) part.offset.push_back(part.offset.back() + static_cast<std::int64_t>(last - first));
  }
  return part;
}

Field restrict_to_nodes(const Field& field, const std::vector<char>& wanted) {
  Field part = field;
  part.support.clear();
  part.values.clear();
  part.present.clear();
  const std::size_t width = field.n_components();
  for (std::size_t i = 0; i < field.support.size(); ++i) {
    if (!wanted[static_cast<std::size_t>(field.support[i])]) continue;
    part.support.push_back(field.support[i]);
    for (std::size_t k = 0; k < width; ++k) {
      part.values.push_back(field.at(i, k));
      if (!field.present.empty()) part.present.push_back(field.present[i * width + k]);
    }
  }
  return part;
}

Field restrict_to_components(const Field& field, const std::vector<std::string>& wanted) {
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < field.n_components(); ++k)
    if (std::find(wanted.begin(), wanted.end(), field.components[k]) != wanted.end()) kept.push_back(k);
  Field part = field;
  part.components.clear();
  part.values.clear();
  part.present.clear();
  for (const std::size_t k : kept) part.components.push_back(field.components[k]);
  for (std::size_t row = 0; row < field.n_rows(); ++row)
    for (const std::size_t k : kept) {
      part.values.push_back(field.at(row, k));
      if (!field.present.empty()) part.present.push_back(field.presence(row, k));
    }
  return part;
}

}  // namespace lacon
