#pragma once
// Matrices of PETSc by entries.
#include <petscksp.h>

#include <span>

#include "lacon/assembly/petsc/owned.hpp"

namespace lacon {

/// Own rows: where each begins and the last one ends, and their entries in columns of all processes.
struct AijRows {
  std::span<const PetscInt> offset, column;
  std::span<const double> value;
};

/// @param own_columns how many of a vector that it multiplies are the process's own  @param block_size of its square blocks
inline OwnedMat aij_matrix(MPI_Comm processes, const AijRows& rows, PetscInt own_columns, PetscInt block_size = 1) {
  OwnedMat made;
  const auto n = static_cast<PetscInt>(rows.offset.size() - 1);
  checked(MatCreate(processes, made.out()));
  checked(MatSetSizes(made, n, own_columns, PETSC_DETERMINE, PETSC_DETERMINE));
  checked(MatSetType(made, MATAIJ));
  checked(MatSetBlockSize(made, block_size));
  checked(MatSeqAIJSetPreallocationCSR(made, rows.offset.data(), rows.column.data(), rows.value.data()));
  checked(MatMPIAIJSetPreallocationCSR(made, rows.offset.data(), rows.column.data(), rows.value.data()));
  return made;
}

}  // namespace lacon
