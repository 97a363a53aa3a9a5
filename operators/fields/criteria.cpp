#include "lacon/operators/fields/criteria.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/tensor.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

/// Principal values, ascending, and their unit vectors, the component of largest magnitude positive.
struct Principal {
  Eigen::Vector3d values;
  Eigen::Matrix3d vectors;  ///< one a column

  explicit Principal(const Eigen::Matrix3d& tensor) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
    values = solver.eigenvalues();
    vectors = solver.eigenvectors();
    for (int k = 0; k < 3; ++k) {
      Eigen::Index largest = 0;
      vectors.col(k).cwiseAbs().maxCoeff(&largest);
      if (vectors(largest, k) < 0) vectors.col(k) *= -1;
    }
  }
};

double signed_by(double value, double trace) { return trace < 0 ? -value : value; }

Eigen::Matrix3d deviator(const Eigen::Matrix3d& tensor) { return tensor - tensor.trace() / 3 * Eigen::Matrix3d::Identity(); }

void add(std::vector<double>& row, const Eigen::Matrix3d& vectors) {
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) row.push_back(vectors(axis, k));
}

std::vector<double> stress_row(const Eigen::Matrix3d& stress) {
  const Principal principal(stress);
  const double trace = stress.trace(), mises = std::sqrt(1.5) * deviator(stress).norm();
  std::vector<double> row{mises, principal.values(2) - principal.values(0)};
  for (int k = 0; k < 3; ++k) row.push_back(principal.values(k));
  row.push_back(signed_by(mises, trace));
  add(row, principal.vectors);
  row.push_back(trace);
  row.push_back(mises > 0 ? trace / 3 / mises : 0.0);
  return row;
}

std::vector<double> strain_row(const Eigen::Matrix3d& strain) {
  const Principal principal(strain);
  const double invariant = std::sqrt(2.0 / 3) * deviator(strain).norm();
  std::vector<double> row{invariant};
  for (int k = 0; k < 3; ++k) row.push_back(principal.values(k));
  row.push_back(signed_by(invariant, strain.trace()));
  add(row, principal.vectors);
  return row;
}

Field invariants(const Field& tensors, std::string name, std::string_view prefix, std::vector<std::string> components,
                 std::vector<double> (*row_of)(const Eigen::Matrix3d&)) {
  Field field = field_like(tensors, std::move(name), tensors.location);
  field.components = std::move(components);
  field.support = tensors.support;
  field.offset = tensors.offset;
  const TensorRows rows(tensors, prefix);
  constexpr std::size_t rows_at_once = 4096;
  const std::size_t width = field.n_components();
  field.values.assign(tensors.n_rows() * width, 0.0);
  field.present.assign(tensors.n_rows() * width, 1);
  parallel_for(tensors.n_rows(), rows_at_once, [&](const LoopBlock& block) {
    for (std::size_t row = block.first; row < block.last; ++row)
      if (rows.has(row))
        std::ranges::copy(row_of(rows[row]), field.values.begin() + static_cast<std::ptrdiff_t>(row * width));
      else
        std::fill_n(field.present.begin() + static_cast<std::ptrdiff_t>(row * width), width, 0);
  });
  if (std::find(field.present.begin(), field.present.end(), 0) == field.present.end()) field.present.clear();
  return field;
}

const std::vector<std::string> principal_names{"PRIN_1", "PRIN_2", "PRIN_3"};
const std::vector<std::string> vector_names{"VECT_1_X", "VECT_1_Y", "VECT_1_Z", "VECT_2_X", "VECT_2_Y",
                                            "VECT_2_Z", "VECT_3_X", "VECT_3_Y", "VECT_3_Z"};

std::vector<std::string> joined(std::initializer_list<std::vector<std::string>> parts) {
  std::vector<std::string> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

Field equivalent_stress(const Field& stress, std::string name) {
  return invariants(stress, std::move(name), "SI",
                    joined({{"VMIS", "TRESCA"}, principal_names, {"VMIS_SG"}, vector_names, {"TRSIG", "TRIAX"}}), stress_row);
}

Field equivalent_strain(const Field& strain, std::string name) {
  return invariants(strain, std::move(name), "EP", joined({{"INVA_2"}, principal_names, {"INVA_2SG"}, vector_names}),
                    strain_row);
}

}  // namespace lacon
