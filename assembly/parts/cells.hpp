#pragma once
// What an operator says to a process about its cells, and how that obeys; the answer is always done:
//   board PATH                           Board, from now on
//   parts FIRST PATH ...                 PartCells of the process FIRST alone, of the one behind it, ...
//   evaluate MATRIX PREVIOUS ORIGIN      ElementPart::evaluate
//   keep N, natural N, copy N OF, rest N OF, drop N ...      states by number
//   strain OF                            ElementPart::strain_as
//   put N QUANTITY PATH FIRST COUNT ..., collect N QUANTITY PATH FIRST COUNT ...     values of some cells of each set; N is
//                                        -1 for the present state
//   flows SINCE                          into the report
//   multiply MAGNITUDES, measure         own rows
//   products N PATH                      x and y of own rows, N columns each
//   diagonal                             of own rows
//   maxima                               largest entries of own rows, scaled from both sides
//   remember, change                     ElementPart::remember; its change() into the report
//   whole PATH                           adds them to a lower triangle: n_rows, n_entries, rows, values, columns
#include <istream>
#include <memory>
#include <optional>
#include <string>

#include "lacon/assembly/parts/element_part.hpp"
#include "lacon/assembly/processes/loan.hpp"

namespace lacon {

class Cells {
 public:
  /// @param lender must outlive this
  Cells(int rank, int n_ranks, const Lender& lender) : rank_(rank), n_ranks_(n_ranks), lender_(lender) {}
  /// @return whether the line is about cells
  bool obey(const std::string& line);
  /// Nothing where it has no cells.
  const ElementPart* part() const { return part_ ? &*part_ : nullptr; }

 private:
  /// Those that read the board, or write there. @return whether it is one
  bool obey_by_board(const std::string& verb, std::istream& said);
  void take_part(std::istream& said);
  void exchange(bool put, std::istream& said);
  void add_to(const std::string& path) const;

  int rank_, n_ranks_;
  const Lender& lender_;
  std::unique_ptr<Loan> loan_;  ///< of the board
  Board board_;
  std::optional<ElementPart> part_;
};

}  // namespace lacon
