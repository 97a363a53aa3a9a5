#pragma once
// What an operator tells the processes that have subtrees, in memory that they share, and the lines of text about it. PIECE is
// a precision and a number, as in "float 3"; numbers in the memory are of that precision, but where it says otherwise:
//   analyse PIECE PATH       PieceMemory
//                                                              -> done FLOPS ENTRIES BYTES
//   factorise PIECE PATH     values (entries), and room for the Schur complement (border, border)
//                                                              -> done FLOPS ENTRIES WHOLE-ENTRIES NEGATIVE-PIVOTS
//                                                                 and the equations of null pivots
//   reduce PIECE PATH        right sides (k, size), and room for what they leave to the border (k, border)  -> done
//   reduce PIECE PATH PATH   likewise of sparse ones, which the second memory has (SparseSideSizes)             -> done
//   expand PIECE PATH        the same memory, with solutions of the border: right sides become solutions    -> done
//   open PATH                to see whether it can                                                           -> done
//   order PATH               OrderMemory: the order of elimination is found, and its subtrees
//                                                              -> done FLOPS ENTRIES LONGEST, and the process of each subtree
//   fill PRECISION MAP PATH PATH ...   entries that the process has itself, into values of pieces (EntryPlaces): PieceMemory
//                                      and values of each, and of the top                             -> done
//   forget                   all pieces                                                                     -> done
// Any of them may be answered by: no memory, or failed WHY. About cells more is said (parts/cells.hpp).
#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lacon/assembly/processes/shared_memory.hpp"

namespace lacon {

/// The next numbers of a memory.
template <class T>
void take(std::byte*& next, std::span<T>& part, std::int64_t size) {
  part = {reinterpret_cast<T*>(next), static_cast<std::size_t>(size)};
  next += part.size_bytes();
}

struct PieceSizes {
  std::int64_t size = 0, entries = 0, border = 0;
  std::int32_t is_symmetric = 1, memory_margin = 20, as_ordered = 0;
  double singular_pivot = 0, low_rank = 0;
};

/// The pattern of a piece in the order in which its values stand: row by row in its own numbers, which are those of its own
/// equations and behind them those of its border; where symmetric of the lower triangle.
struct PieceMemory {
  PieceSizes sizes;
  std::span<std::int64_t> offset;                ///< of rows, (size + 1)
  std::span<int> row, column, place, in_border;  ///< MumpsPattern
  std::span<int> border;                         ///< what the top calls its border, ascending

  static std::size_t bytes(const PieceSizes& s) {
    return sizeof s + sizeof(std::int64_t) * static_cast<std::size_t>(s.size + 1) +
           sizeof(int) * static_cast<std::size_t>(2 * s.entries + s.size + 2 * s.border);
  }
  /// Of memory that has sizes at its beginning.
  static PieceMemory in(const SharedMemory& memory) {
    PieceMemory piece{.sizes = *reinterpret_cast<const PieceSizes*>(memory.data())};
    const PieceSizes& s = piece.sizes;
    std::byte* next = memory.data() + sizeof s;
    take(next, piece.offset, s.size + 1);
    take(next, piece.row, s.entries);
    take(next, piece.column, s.entries);
    take(next, piece.place, s.size);
    take(next, piece.in_border, s.border);
    take(next, piece.border, s.border);
    return piece;
  }
};

struct OrderSizes {
  std::int64_t vertices = 0, nodes = 0, neighbours = 0, equations = 0;
  std::int32_t processes = 1;
};

/// A graph of vertices, and what is found of it: the place of each equation in the order of elimination, and its subtree.
struct OrderMemory {
  OrderSizes sizes;
  std::span<std::int64_t> offset, first;   ///< of neighbours and of equations, (vertices + 1)
  std::span<std::int32_t> neighbours;      ///< of each vertex
  std::span<std::int32_t> order, subtree;  ///< (equations)

  static std::size_t bytes(const OrderSizes& s) {
    return sizeof s + 2 * sizeof(std::int64_t) * static_cast<std::size_t>(s.vertices + 1) +
           sizeof(std::int32_t) * static_cast<std::size_t>(s.neighbours + 2 * s.equations);
  }
  /// Of memory that has sizes at its beginning.
  static OrderMemory in(const SharedMemory& memory) {
    OrderMemory graph{.sizes = *reinterpret_cast<const OrderSizes*>(memory.data())};
    const OrderSizes& s = graph.sizes;
    std::byte* next = memory.data() + sizeof s;
    take(next, graph.offset, s.vertices + 1);
    take(next, graph.first, s.vertices + 1);
    take(next, graph.neighbours, s.neighbours);
    take(next, graph.order, s.equations);
    take(next, graph.subtree, s.equations);
    return graph;
  }
};

/// What becomes of equations: the scale of each (n), double; its piece, -1 where it is of the top, and its number there, int32.
struct EquationMap {
  std::span<double> scale;
  std::span<std::int32_t> piece, number;

  static std::size_t bytes(std::size_t n) { return n * (sizeof(double) + 2 * sizeof(std::int32_t)); }
  static EquationMap in(const SharedMemory& memory) {
    const std::size_t n = memory.size() / bytes(1);
    auto* const scale = reinterpret_cast<double*>(memory.data());
    auto* const piece = reinterpret_cast<std::int32_t*>(scale + n);
    return {.scale = {scale, n}, .piece = {piece, n}, .number = {piece + n, n}};
  }
};

/// Where an entry of a symmetric matrix stands: in a piece, or in the top, which is the last one here.
template <class Real>
class EntryPlaces {
 public:
  explicit EntryPlaces(EquationMap map) : map_(map) {}
  void add_piece(const PieceMemory& pattern, Real* values) { pieces_.push_back({pattern, values}); }

  /// Add an entry, scaled from both sides; whoever else adds at the same time adds others.
  void add(std::int32_t i, std::int32_t j, double value) const {
    const std::int32_t piece = std::max(map_.piece[i], map_.piece[j]);
    const Piece& of = piece < 0 ? pieces_.back() : pieces_[piece];
    int a = number(of, piece, i), b = number(of, piece, j);
    if (a < b) std::swap(a, b);
    const auto columns = of.pattern.column.subspan(of.pattern.offset[a], of.pattern.offset[a + 1] - of.pattern.offset[a]);
    const auto found = std::lower_bound(columns.begin(), columns.end(), b + 1);
    if (found == columns.end() || *found != b + 1) {
      if (value == 0) return;
      throw std::logic_error("an entry does not fit the pattern of a piece");
    }
    of.values[of.pattern.offset[a] + (found - columns.begin())] += static_cast<Real>(map_.scale[i] * value * map_.scale[j]);
  }

 private:
  struct Piece {
    PieceMemory pattern;
    Real* values;
  };
  int number(const Piece& of, std::int32_t piece, std::int32_t equation) const {
    const std::int32_t number = map_.number[equation];
    if (piece < 0 || map_.piece[equation] >= 0) return number;
    const auto at = std::lower_bound(of.pattern.border.begin(), of.pattern.border.end(), number);
    return static_cast<int>(of.pattern.sizes.size - of.pattern.sizes.border + (at - of.pattern.border.begin()));
  }

  EquationMap map_;
  std::vector<Piece> pieces_;
};

/// Behind it in its memory: offset (count + 1), int64; value (entries) in the precision; index (entries), int32.
struct SparseSideSizes {
  std::int64_t count = 0, entries = 0;
};

}  // namespace lacon
