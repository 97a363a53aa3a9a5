#include "lacon/assembly/petsc/near_null_space.hpp"

#include <utility>

namespace lacon {

std::vector<OwnedVec> rigid_motions(Mat k, int dimension, const OwnNodes& nodes) {
  const int n_turns = dimension == 3 ? 3 : 1;
  std::vector<OwnedVec> motions;
  for (int motion = 0; motion < dimension + n_turns; ++motion) {
    OwnedVec v;
    double* values = nullptr;
    checked(MatCreateVecs(k, v.out(), nullptr));
    checked(VecGetArray(v, &values));
    for (std::size_t at = 0; at < nodes.is_free.size(); at += dimension)
      for (int i = 0; i < dimension; ++i)
        values[at + i] = nodes.is_free[at + i] ? moved_by(motion, dimension, i, &nodes.coordinates[at], nodes.middle) : 0;
    checked(VecRestoreArray(v, &values));
    double before = 0, after = 0;
    checked(VecNorm(v, NORM_2, &before));
    for (const OwnedVec& other : motions) {
      double product = 0;
      checked(VecDot(v, other, &product));
      checked(VecAXPY(v, -product, other));
    }
    checked(VecNormalize(v, &after));
    if (after > 1e-8 * before) motions.push_back(std::move(v));
  }
  return motions;
}

void set_near_null_space(Mat matrix, std::span<const OwnedVec> motions) {
  MatNullSpace space = nullptr;
  const std::vector<Vec> vectors(motions.begin(), motions.end());
  checked(MatNullSpaceCreate(PetscObjectComm(reinterpret_cast<PetscObject>(matrix)), PETSC_FALSE,
                             static_cast<PetscInt>(vectors.size()), vectors.data(), &space));
  checked(MatSetNearNullSpace(matrix, space));
  checked(MatNullSpaceDestroy(&space));
}

}  // namespace lacon
