#pragma once
// The first coarser level of a multigrid, made of a matrix in blocks as it stands: nodes are put together into aggregates,
// whose rigid motions are interpolated with one step of Jacobi's iteration (Vanek, Mandel, Brezina, 1996). All coarser levels
// are GAMG's.
#include <petscksp.h>

#include <cstdint>
#include <span>
#include <vector>

#include "lacon/assembly/petsc/block_kernels.hpp"
#include "lacon/assembly/petsc/owned.hpp"

namespace lacon {

struct CoarseLevel {
  SplitBlocks<float> interpolation;  ///< of own nodes, from the rigid motions of aggregates
  OwnedMat matrix;                   ///< AIJ, in blocks of an aggregate; with its near null space
};

/// @param own_rows of the matrix  @param is_link  of its blocks in own columns: whether it may put two nodes together  @param
/// is_free  of each own displacement  @param coordinates  of own nodes  @param motions  rigid ones of all, orthonormal  @param
/// largest  eigenvalue of the matrix over its diagonal
CoarseLevel coarse_level(MPI_Comm processes, const SplitBlocks<double>& own_rows, std::span<const std::uint8_t> is_link,
                         std::span<const std::uint8_t> is_free, std::span<const double> coordinates,
                         std::span<const OwnedVec> motions, double largest);

}  // namespace lacon
