#include "lacon/operators/fields/mechanics.hpp"

#include <Eigen/Dense>

#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/tensor.hpp"

namespace lacon {
namespace {

constexpr const char* displacement_names[] = {"DX", "DY", "DZ"};

/// (n_nodes of the mesh, dimension), 0 where the field has none.
std::vector<double> nodal_vectors(const Mesh& mesh, const Field& field, int dimension) {
  std::vector<double> values(mesh.n_nodes() * static_cast<std::size_t>(dimension), 0.0);
  for (int d = 0; d < dimension; ++d) {
    const int column = field.component(displacement_names[d]);
    if (column < 0) continue;
    for (std::size_t i = 0; i < field.support.size(); ++i)
      if (field.has(i, static_cast<std::size_t>(column)))
        values[static_cast<std::size_t>(field.support[i] * dimension + d)] = field.at(i, static_cast<std::size_t>(column));
  }
  return values;
}

}  // namespace

Field strains(const Mesh& mesh, ModelPoints& points, const Field& displacement, const std::vector<char>& wanted, Strain measure,
              std::string name, const std::function<double(std::int32_t)>& poisson) {
  Field field = field_like(displacement, std::move(name), Location::gauss_points);
  field.quantity = "EPSI_R";
  field.offset.assign(1, 0);
  field.components.clear();
  const int dimension = mesh.dimension;
  const std::size_t width = dimension == 3 ? 6 : 4;
  for (std::size_t k = 0; k < width; ++k) field.components.push_back("EP" + std::string(tensor_axes[k].name));
  const std::vector<double> u = nodal_vectors(mesh, displacement, dimension);
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    if (!wanted[cell] || !points.is_solid(cell)) continue;
    const CellPoints& at = points(cell, mesh.coordinates);
    const auto nodes = mesh.cells[cell];
    for (int p = 0; p < at.n_points; ++p) {
      Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
      double radial = 0;
      for (int a = 0; a < at.n_nodes; ++a) {
        const double* const node = u.data() + static_cast<std::ptrdiff_t>(nodes[static_cast<std::size_t>(a)]) * dimension;
        for (int i = 0; i < dimension; ++i)
          for (int k = 0; k < dimension; ++k)
            h(i, k) += node[i] * at.gradient[static_cast<std::size_t>((p * at.n_nodes + a) * dimension + k)];
        radial += at.shape[static_cast<std::size_t>(p * at.n_nodes + a)] * node[0];
      }
      if (points.is_axisymmetric(cell)) h(2, 2) = radial / at.position[static_cast<std::size_t>(3 * p)];
      Eigen::Matrix3d strain = 0.5 * (h + h.transpose());
      if (measure == Strain::green_lagrange) strain += 0.5 * h.transpose() * h;
      if (points.is_plane_stress(cell)) {
        const double nu = poisson(static_cast<std::int32_t>(cell));
        strain(2, 2) = -nu / (1 - nu) * (strain(0, 0) + strain(1, 1));
      }
      for (std::size_t k = 0; k < width; ++k) field.values.push_back(strain(tensor_axes[k].i, tensor_axes[k].j));
    }
    field.support.push_back(static_cast<std::int32_t>(cell));
    field.offset.push_back(field.offset.back() + at.n_points);
  }
  return field;
}

Field nodal_forces(const Mesh& mesh, ModelPoints& points, const Field& stress, const std::vector<char>& moved,
                   std::span<const double> current, std::span<const double> thickness, std::string name) {
  Field field = field_like(stress, std::move(name), Location::nodes);
  field.quantity = "DEPL_R";
  const int dimension = mesh.dimension;
  field.components.assign(displacement_names, displacement_names + dimension);
  field.support = nodes_of_cells(mesh, stress.support);
  std::vector<double> force(mesh.n_nodes() * static_cast<std::size_t>(dimension), 0.0);
  const TensorRows tensors(stress, "SI");
  for (std::size_t i = 0; i < stress.support.size(); ++i) {
    const auto cell = static_cast<std::size_t>(stress.support[i]);
    const CellPoints& at = points(cell, moved[cell] ? current : std::span<const double>(mesh.coordinates));
    const auto nodes = mesh.cells[cell];
    for (int p = 0; p < at.n_points; ++p) {
      const std::size_t row = stress.first_row(i) + static_cast<std::size_t>(p);
      const Eigen::Matrix3d sigma = tensors[row];
      const double measure = at.measure[static_cast<std::size_t>(p)] * thickness[row];
      for (int a = 0; a < at.n_nodes; ++a) {
        double* const node = force.data() + static_cast<std::ptrdiff_t>(nodes[static_cast<std::size_t>(a)]) * dimension;
        for (int d = 0; d < dimension; ++d)
          for (int k = 0; k < dimension; ++k)
            node[d] += measure * sigma(d, k) * at.gradient[static_cast<std::size_t>((p * at.n_nodes + a) * dimension + k)];
        if (points.is_axisymmetric(cell))
          node[0] += measure * sigma(2, 2) * at.shape[static_cast<std::size_t>(p * at.n_nodes + a)] /
                     at.position[static_cast<std::size_t>(3 * p)];
      }
    }
  }
  for (const std::int32_t node : field.support)
    for (int d = 0; d < dimension; ++d) field.values.push_back(force[static_cast<std::size_t>(node * dimension + d)]);
  return field;
}

}  // namespace lacon
