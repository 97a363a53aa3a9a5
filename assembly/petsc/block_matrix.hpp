#pragma once
// Matrices of PETSc that are multiplied from whole blocks, one a pair of nodes: an index for a block instead of one for an
// entry, and in single precision where they precondition. What an iteration costs is what of matrices it reads.
#include <petscksp.h>

#include "lacon/assembly/petsc/owned.hpp"

namespace lacon {

enum class Digits { single_precision, double_precision };

/// Whether there is a kernel for the blocks that a matrix says it has.
bool has_blocks(Mat matrix, Digits digits);

/// A shell of PETSc with the values that an AIJ matrix has now; it needs that one no more. MatMult, MatMultAdd, their
/// transposes and MatGetDiagonal work, with the same bits in every run.
OwnedMat in_blocks(Mat matrix, Digits digits);

/// The same without values, of the sizes of a matrix; they are filled in when the matrix may go.
OwnedMat empty_blocks(Mat matrix);
void fill(Mat blocks, Mat matrix);
/// That matrix again. @param blocks in double precision
OwnedMat without_blocks(Mat blocks);

}  // namespace lacon
