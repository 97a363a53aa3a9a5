#pragma once
// What the machine can do, measured in the same run as the rest: multiplication of matrices, copies of memory, and a matrix to
// factorise.
#include <functional>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon::bench {

/// Wall time.
double seconds(const std::function<void()>& work);

/// dgemm of OpenBLAS, 1500 x 1500, best of three, Gflop/s. Processor time: what one thread can do, however loaded the machine
/// is.
double dgemm_gflops();

/// Copy of 320 MB, best of three, GB/s read and written; processor time.
double copy_gbytes();

/// Equations of a cube of n^3 HEXA8, three displacements a node, nothing held.
Numbering cube_numbering(int n);

/// The pattern of elasticity on that cube (nodes of a cell are coupled), positive definite values.
SparseMatrix cube_matrix(const Numbering& numbering, int n);

}  // namespace lacon::bench
