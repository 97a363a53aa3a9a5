#pragma once
// The rows of a block system that one process has, made ready for iterations:
//   [K + B W C  B] [u]   [f + B W g]
//   [C          D] [p] = [g        ]
// Multipliers are scaled so that their rows are of the size of K. The weights W have a stiffness of the size of K where a row
// of D vanishes: they change no solution, they hold bodies that contact alone holds, and make the Schur complement nearly a
// multiple of the identity.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/assembly/petsc/block_kernels.hpp"
#include "lacon/assembly/petsc/exchange.hpp"
#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// Rows [first, last) of one of the blocks, with columns of all of it; numbers as PETSc has them.
struct Rows {
  std::int64_t first = 0, last = 0;
  std::vector<std::int32_t> offset{0}, column;
  std::vector<double> value;
};

/// From here to there, of `size` things: those of one of `n_parts`.
struct Range {
  std::int64_t first, last;
  static Range of_part(std::int64_t size, int part, int n_parts) {
    return {size * part / n_parts, size * (part + 1) / n_parts};
  }
};

struct BlockRows {
  Range blocks, multipliers;          ///< own ones
  SplitBlocks<double> k;              ///< K with its weights; own rows
  std::vector<std::uint8_t> is_of_k;  ///< of its blocks in own columns: 0 where weights alone make them
  Rows b, c, d;                       ///< likewise
  std::vector<double> scale;          ///< of multipliers, own ones
  std::vector<double> schur;          ///< what stands for the Schur complement: its diagonal, own rows
  std::vector<double> weight;         ///< W, own ones
  std::vector<std::uint8_t> is;       ///< own rows of displacements: 0 where one is imposed
};

/// Entries between displacements that processes have themselves: those of one of them, beside the system.
struct OwnEntries {
  const SparseMatrix* matrix = nullptr;      ///< a lower triangle; rows of own blocks are whole
  std::span<const std::int32_t> place = {};  ///< of its rows; negative: of none
  std::vector<double> diagonal = {};         ///< of the rows of all processes
};

/// @param entries what the process has of K itself  @param part the process, of system.sizes.n_parts. Throws std::length_error
/// beyond 2^31 entries that are stored.
BlockRows rows_of_part(const BlockSystem& system, const OwnEntries& entries, int part);

}  // namespace lacon
