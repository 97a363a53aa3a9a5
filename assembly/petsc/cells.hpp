#pragma once
// What an operator says to a process of PETSc about its cells, and how that obeys; the answer is always done:
//   board PATH                           Board, from now on
//   part RANK PATH                       PartCells of that process alone
//   evaluate MATRIX PREVIOUS ORIGIN      ElementPart::evaluate
//   keep N, natural N, rest N OF, drop N ...      states by number
//   put N SET QUANTITY PATH, collect N SET QUANTITY PATH     values of all cells of a set
//   flows SINCE                          into the report
//   multiply MAGNITUDES, measure         own rows
//   products N PATH                      x and y of own rows, N columns each
//   whole PATH                           adds them to a lower triangle: n_rows, n_entries, rows, values, columns
#include <istream>
#include <optional>
#include <string>

#include "lacon/assembly/parts/element_part.hpp"
#include "lacon/assembly/petsc/block_rows.hpp"

namespace lacon {

class Cells {
 public:
  Cells(int rank, int n_ranks) : rank_(rank), n_ranks_(n_ranks) {}
  /// @return whether the line is about cells
  bool obey(const std::string& line);
  /// For a system; no matrix where there are no cells.
  OwnEntries entries() const;

 private:
  void exchange(bool put, std::istream& said);
  void add_to(const std::string& path) const;

  int rank_, n_ranks_;
  std::optional<SharedMemory> memory_;
  Board board_;
  std::optional<ElementPart> part_;
};

}  // namespace lacon
