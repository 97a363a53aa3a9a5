#pragma once
// What an operator tells the processes that have subtrees, in memory that they share, and the lines of text about it. PIECE is
// a precision and a number, as in "float 3"; numbers in the memory are of that precision, but where it says otherwise:
//   analyse PIECE PATH       PieceSizes and, int, its rows, columns, places, border (MumpsPattern)
//                                                              -> done FLOPS ENTRIES BYTES
//   factorise PIECE PATH     values (entries), and room for the Schur complement (border, border)
//                                                              -> done FLOPS ENTRIES WHOLE-ENTRIES NEGATIVE-PIVOTS
//                                                                 and the equations of null pivots
//   reduce PIECE PATH        right sides (k, size), and room for what they leave to the border (k, border)  -> done
//   reduce PIECE PATH PATH   likewise of sparse ones, which the second memory has (SparseSides)             -> done
//   expand PIECE PATH        the same memory, with solutions of the border: right sides become solutions    -> done
//   open PATH                to see whether it can                                                           -> done
//   forget                   all pieces                                                                     -> done
// Any of them may be answered by: no memory, or failed WHY.
#include <cstdint>

namespace lacon {

struct PieceSizes {
  std::int64_t size = 0, entries = 0, border = 0;
  std::int32_t is_symmetric = 1, memory_margin = 20;
  double singular_pivot = 0, low_rank = 0;
};

/// Behind it in its memory: offset (count + 1), int64; value (entries) in the precision; index (entries), int32.
struct SparseSides {
  std::int64_t count = 0, entries = 0;
};

}  // namespace lacon
