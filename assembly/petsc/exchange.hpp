#pragma once
// What an operator tells the processes of PETSc, in memory that they share, and what lines of text say about it:
//   forget         what was set up         -> forgotten: its memory is free
//   set up PATH    of a system             -> taken, when its memory is of no more use, and behind it ready or
//                                             failed WHY; or failed WHY at once
//   solve SHARE PATH   of a right side (n), of which that share may be left
//                                          -> converged ITERATIONS RESIDUAL, with the solution in its place,
//                                             diverged ITERATIONS RESIDUAL REASON (of PETSc), or failed WHY
// Instead of failed WHY it may be: no memory. Where the processes have cells (parts/), their rows are added to those of a
// system, and more is said (parts/cells.hpp).
#include <cstdint>
#include <cstring>
#include <span>

#include "lacon/assembly/processes/shared_memory.hpp"

namespace lacon {

/// A sparse matrix with what a preconditioner has to know of it. Displacements stand in blocks, one a node, of as many rows as
/// the space has dimensions; a row that no equation has is that of an imposed displacement. All other unknowns are multipliers.
struct BlockSystem {
  struct Sizes {
    std::int64_t n = 0, n_entries = 0, n_blocks = 0, n_multipliers = 0;
    std::int32_t dimension = 3;
    std::int32_t is_symmetric = 1;  ///< the lower triangle alone is there
    std::int64_t n_parts = 1;
  };
  Sizes sizes;
  std::span<std::int64_t> row;          ///< (n + 1)
  std::span<double> value;              ///< (n_entries)
  std::span<double> coordinates;        ///< (n_blocks, dimension)
  std::span<std::int64_t> first_block;  ///< of each process, (n_parts + 1)
  std::span<std::int32_t> place;        ///< (n): row among the displacements; -1 - k: multiplier k
  std::span<std::int32_t> column;       ///< (n_entries)

  static std::size_t bytes(const Sizes& s) {
    return sizeof(Sizes) + 8 * static_cast<std::size_t>(s.n + 1 + s.n_entries + s.n_blocks * s.dimension + s.n_parts + 1) +
           4 * static_cast<std::size_t>(s.n + s.n_entries);
  }
  /// In memory that has sizes at its beginning.
  static BlockSystem in(const SharedMemory& memory) {
    BlockSystem system;
    std::memcpy(&system.sizes, memory.data(), sizeof(Sizes));
    std::byte* next = memory.data() + sizeof(Sizes);
    const auto take = [&]<class T>(std::span<T>& part, std::int64_t size) {
      part = {reinterpret_cast<T*>(next), static_cast<std::size_t>(size)};
      next += part.size_bytes();
    };
    const Sizes& s = system.sizes;
    take(system.row, s.n + 1);
    take(system.value, s.n_entries);
    take(system.coordinates, s.n_blocks * s.dimension);
    take(system.first_block, s.n_parts + 1);
    take(system.place, s.n);
    take(system.column, s.n_entries);
    return system;
  }
};

}  // namespace lacon
