#include "lacon/operators/fields/mechanics.hpp"

#include <Eigen/Dense>
#include <memory>

#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/tensor.hpp"
#include "lacon/structures/displacement.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

constexpr std::size_t cells_at_once = 256;  // in one block of a loop

constexpr const char* displacement_names[] = {"DX", "DY", "DZ"};

/// Of Green and Lagrange's strain.
Eigen::Matrix3d logarithmic(const Eigen::Matrix3d& green) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> stretches(Eigen::Matrix3d::Identity() + 2 * green);
  const Eigen::Vector3d logarithms = 0.5 * stretches.eigenvalues().array().log();
  return stretches.eigenvectors() * logarithms.asDiagonal() * stretches.eigenvectors().transpose();
}

}  // namespace

Eigen::Matrix3d displacement_gradient(const CellPoints& at, int point, std::span<const std::int32_t> nodes,
                                      std::span<const double> u, int dimension, bool axisymmetric) {
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  double radial = 0;
  for (int a = 0; a < at.n_nodes; ++a) {
    const double* const node = u.data() + static_cast<std::ptrdiff_t>(nodes[static_cast<std::size_t>(a)]) * dimension;
    for (int i = 0; i < dimension; ++i)
      for (int k = 0; k < dimension; ++k)
        h(i, k) += node[i] * at.gradient[static_cast<std::size_t>((point * at.n_nodes + a) * dimension + k)];
    radial += at.shape[static_cast<std::size_t>(point * at.n_nodes + a)] * node[0];
  }
  if (axisymmetric) h(2, 2) = radial / at.position[static_cast<std::size_t>(3 * point)];
  return h;
}

Field strains(const Mesh& mesh, ModelPoints& points, const Field& displacement, const std::vector<char>& wanted, Strain measure,
              std::string name) {
  Field field = field_like(displacement, std::move(name), Location::gauss_points);
  field.quantity = "EPSI_R";
  field.offset.assign(1, 0);
  field.components.clear();
  const int dimension = mesh.dimension;
  const std::size_t width = dimension == 3 ? 6 : 4;
  for (std::size_t k = 0; k < width; ++k) field.components.push_back("EP" + std::string(tensor_axes[k].name));
  const std::vector<double> u = nodal_displacements(mesh, displacement, dimension);
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    if (!wanted[cell] || !points.is_solid(cell)) continue;
    field.support.push_back(static_cast<std::int32_t>(cell));
    field.offset.push_back(field.offset.back() + points.n_points(cell));
  }
  field.values.resize(static_cast<std::size_t>(field.offset.back()) * width);
  parallel_for(field.support.size(), cells_at_once, [&](const LoopBlock& block) {
    ModelPoints own = points;
    for (std::size_t c = block.first; c < block.last; ++c) {
      const auto cell = static_cast<std::size_t>(field.support[c]);
      const CellPoints& at = own(cell, mesh.coordinates);
      const bool axis = own.is_axisymmetric(cell);
      const auto nodes = mesh.cells[cell];
      for (int p = 0; p < at.n_points; ++p) {
        const Eigen::Matrix3d h = displacement_gradient(at, p, nodes, u, dimension, axis);
        Eigen::Matrix3d strain = 0.5 * (h + h.transpose());
        if (measure != Strain::small) strain += 0.5 * h.transpose() * h;
        if (measure == Strain::logarithmic) strain = logarithmic(strain);
        double* const row =
            field.values.data() + (static_cast<std::size_t>(field.offset[c]) + static_cast<std::size_t>(p)) * width;
        for (std::size_t k = 0; k < width; ++k) row[k] = strain(tensor_axes[k].i, tensor_axes[k].j);
      }
    }
  });
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
  struct Worker {
    ModelPoints points;
    std::vector<double> forces;  // of the nodes of each cell of the block
  };
  parallel_in_turn(stress.support.size(), cells_at_once, [&] {
    const auto own = std::make_shared<Worker>(Worker{points, {}});
    const auto evaluate = [&, own](const LoopBlock& block) {
      own->forces.clear();
      for (std::size_t i = block.first; i < block.last; ++i) {
        const auto cell = static_cast<std::size_t>(stress.support[i]);
        const CellPoints& at = own->points(cell, moved[cell] ? current : std::span<const double>(mesh.coordinates));
        const bool axis = own->points.is_axisymmetric(cell);
        const std::size_t first = own->forces.size();
        own->forces.resize(first + static_cast<std::size_t>(at.n_nodes * dimension));
        for (int p = 0; p < at.n_points; ++p) {
          const std::size_t row = stress.first_row(i) + static_cast<std::size_t>(p);
          const Eigen::Matrix3d sigma = tensors[row];
          const double measure = at.measure[static_cast<std::size_t>(p)] * thickness[row];
          double* node = own->forces.data() + first;
          for (int a = 0; a < at.n_nodes; ++a, node += dimension) {
            for (int d = 0; d < dimension; ++d)
              for (int k = 0; k < dimension; ++k)
                node[d] += measure * sigma(d, k) * at.gradient[static_cast<std::size_t>((p * at.n_nodes + a) * dimension + k)];
            if (axis)
              node[0] += measure * sigma(2, 2) * at.shape[static_cast<std::size_t>(p * at.n_nodes + a)] /
                         at.position[static_cast<std::size_t>(3 * p)];
          }
        }
      }
    };
    const auto add = [&, own](const LoopBlock& block) {
      const double* value = own->forces.data();
      for (std::size_t i = block.first; i < block.last; ++i)
        for (const std::int32_t node : mesh.cells[static_cast<std::size_t>(stress.support[i])])
          for (int d = 0; d < dimension; ++d) force[static_cast<std::size_t>(node * dimension + d)] += *value++;
    };
    return LoopWorker{evaluate, add};
  });
  for (const std::int32_t node : field.support)
    for (int d = 0; d < dimension; ++d) field.values.push_back(force[static_cast<std::size_t>(node * dimension + d)]);
  return field;
}

}  // namespace lacon
