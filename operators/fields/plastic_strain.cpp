#include "lacon/operators/fields/plastic_strain.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/mechanics.hpp"
#include "lacon/operators/fields/tensor.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

using Matrix3 = Eigen::Matrix3d;
using catalog::PlasticStrain;

/// C^-1 : stress.
Matrix3 elastic_strain(const Matrix3& stress, double young, double nu) {
  return ((1 + nu) * stress - nu * stress.trace() * Matrix3::Identity()) / young;
}

/// (ln(1 + a) - ln(1 + b)) / (2 (a - b)).
double logarithmic_slope(double a, double b) {
  const double r = (a - b) / (1 + b);
  return (r == 0 ? 1 : std::log1p(r) / r) / (2 * (1 + b));
}

/// E - C^-1 : T of a strain E of F^T F and the stress T that works on it. @param slope F - I @param free strain without stress
Matrix3 of_measure(bool logarithmic, const Matrix3& slope, const Matrix3& cauchy, double young, double nu,
                   const Matrix3& free) {
  const Matrix3 f = Matrix3::Identity() + slope, back = f.inverse();
  const Eigen::SelfAdjointEigenSolver<Matrix3> stretch(slope + slope.transpose() + slope.transpose() * slope);
  const Eigen::Vector3d c = stretch.eigenvalues();
  const Matrix3& axes = stretch.eigenvectors();
  const Matrix3 piola = axes.transpose() * (f.determinant() * back * cauchy * back.transpose()) * axes;
  Matrix3 strain = Matrix3::Zero(), stress;
  for (int i = 0; i < 3; ++i) {
    strain(i, i) = logarithmic ? std::log1p(c[i]) / 2 : c[i] / 2;
    for (int k = 0; k < 3; ++k) stress(i, k) = piola(i, k) / (2 * (logarithmic ? logarithmic_slope(c[i], c[k]) : 0.5));
  }
  return axes * (strain - elastic_strain(stress, young, nu)) * axes.transpose() - free;
}

/// ln(F^T b^-1 F) / 2 without its trace. @param elastic (I - b) / 2
Matrix3 of_stretches(const Matrix3& slope, const Matrix3& elastic) {
  const Matrix3 f = Matrix3::Identity() + slope, b = Matrix3::Identity() - 2 * elastic;
  const Eigen::SelfAdjointEigenSolver<Matrix3> flown(f.transpose() * b.inverse() * f);
  const Eigen::Vector3d logarithms = flown.eigenvalues().array().log() / 2;
  return flown.eigenvectors() * (logarithms.array() - logarithms.mean()).matrix().asDiagonal() *
         flown.eigenvectors().transpose();
}

/// The internal variables V3 to V8 of a row as a tensor.
Matrix3 elastic_variables(const Field& variables, std::size_t row) {
  Matrix3 tensor;
  for (std::size_t k = 0; k < tensor_axes.size(); ++k) {
    const auto [name, i, j] = tensor_axes[k];
    tensor(i, j) = tensor(j, i) = variables.at(row, k + 2);
  }
  return tensor;
}

}  // namespace

PlasticStrain plastic_measure(const catalog::RelationRow& relation, const catalog::DeformationRow& deformation) {
  // of elastic bodies under small strains the difference itself, which shows stresses that were given (ETAT_INIT)
  const bool is_said = relation.name != "ELAS" || deformation.plastic_strain == PlasticStrain::small;
  return is_said ? deformation.plastic_strain : PlasticStrain::none;
}

Field plastic_strain(const Mesh& mesh, ModelPoints& points, const FlownState& state, const std::vector<PlasticStrain>& measure,
                     std::string name, ResultMaterials& materials) {
  Field field = state.strain;
  field.name = std::move(name);
  const std::vector<double> moduli = materials.moduli(state.stress);
  const std::vector<Matrix3> free = materials.free_strains(state.strain);
  const TensorRows sigma(state.stress, "SI"), whole(state.strain, "EP");
  const std::vector<double> u = nodal_displacements(mesh, state.displacement, mesh.dimension);
  const std::vector<std::int64_t> variable_place =
      state.variables ? places(*state.variables, mesh.n_cells()) : std::vector<std::int64_t>();
  for (std::size_t i = 0; i < field.support.size(); ++i) {
    const auto cell = static_cast<std::size_t>(field.support[i]);
    const double young = moduli[2 * i], nu = moduli[2 * i + 1];
    const std::size_t first = field.first_row(i);
    const CellPoints& at = points(cell, mesh.coordinates);
    for (std::size_t row = first; row < field.first_row(i + 1); ++row) {
      const Matrix3 slope = displacement_gradient(at, static_cast<int>(row - first), mesh.cells[cell], u, mesh.dimension,
                                                  points.is_axisymmetric(cell));
      Matrix3 plastic = Matrix3::Zero();
      switch (measure[cell]) {
        case PlasticStrain::small:
          plastic = whole[row] - free[row] - elastic_strain(sigma[row], young, nu);
          break;
        case PlasticStrain::unknown:
        case PlasticStrain::none:
          break;
        case PlasticStrain::green_lagrange:
        case PlasticStrain::logarithmic:
          plastic = of_measure(measure[cell] == PlasticStrain::logarithmic, slope, sigma[row], young, nu, free[row]);
          break;
        case PlasticStrain::stretches: {
          const std::size_t own = state.variables->first_row(static_cast<std::size_t>(variable_place[cell])) + row - first;
          plastic = of_stretches(slope, elastic_variables(*state.variables, own));
          break;
        }
      }
      for (const TensorAxes& axes : tensor_axes)
        if (const int column = field.component("EP" + std::string(axes.name)); column >= 0)
          field.at(row, static_cast<std::size_t>(column)) = plastic(axes.i, axes.j);
    }
  }
  return field;
}

}  // namespace lacon
