#pragma once
// Matrices of PETSc that are multiplied from whole blocks, one a pair of nodes: an index for a block instead of one for an
// entry, and in single precision where they precondition. What an iteration costs is what of matrices it reads.
#include <petscksp.h>

#include "lacon/assembly/petsc/block_kernels.hpp"
#include "lacon/assembly/petsc/owned.hpp"

namespace lacon {

/// A shell of PETSC_COMM_WORLD with these own rows of a square matrix. MatMult, MatMultAdd, their transposes and
/// MatGetDiagonal work, with the same bits in every run.
OwnedMat in_blocks(SplitBlocks<double> rows);
/// The same of any matrix, for a preconditioner. @param n_columns  own ones
OwnedMat in_blocks(SplitBlocks<float> rows, PetscInt n_columns);
/// What a shell in double precision has.
const SplitBlocks<double>& entries_of(Mat blocks);

/// Whether there is a kernel in single precision for the blocks that an AIJ matrix says it has.
bool has_blocks(Mat matrix);
/// A shell in single precision with the values that an AIJ matrix, or a shell in double precision, has now; it needs that one
/// no more.
OwnedMat in_single_blocks(Mat matrix);

/// An AIJ matrix of the values of a shell in double precision. Throws std::length_error beyond 2^31 entries.
OwnedMat as_aij(Mat blocks);

}  // namespace lacon
