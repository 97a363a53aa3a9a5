#pragma once
// A symmetric sparse matrix: its pattern from a graph of vertices, its lower triangle row by row.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/assembly/numbering.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Two vertices whose unknowns meet in the matrix.
struct Coupling {
  std::int32_t a, b;
};

class SymmetricMatrix {
 public:
  /// The pattern in which the vertices of each clique (an element's nodes) and of each coupling meet.
  SymmetricMatrix(const Numbering& numbering, const Ragged<std::int32_t>& cliques, std::span<const Coupling> couplings);

  /// Whether the pattern has room for all these couplings.
  bool has_room_for(std::span<const Coupling> couplings) const;

  /// @param first_row rows before it keep their values
  void set_zero(std::int64_t first_row = 0);
  /// Take the values of the first rows from a matrix that has the same pattern there.
  void copy_rows(const SymmetricMatrix& other, std::int64_t n_rows);
  /// Add an element matrix. @param equations of its degrees of freedom, -1: left out; an equation may stand there more than
  /// once (tied multipliers), and then gets the sum  @param lower (n (n + 1) / 2): lower triangle, row by row
  void add(std::span<const std::int64_t> equations, std::span<const double> lower);
  void add_diagonal(std::int64_t equation, double value);

  std::int64_t size() const { return static_cast<std::int64_t>(row_.size()) - 1; }
  std::int64_t n_entries() const { return row_.back(); }
  std::span<const std::int64_t> rows() const { return row_; }  ///< (size + 1)
  std::span<const std::int32_t> columns() const { return column_; }
  std::span<const double> values() const { return value_; }
  double diagonal(std::int64_t equation) const { return value_[row_[equation + 1] - 1]; }

  /// y = A x
  void multiply(std::span<const double> x, std::span<double> y) const;

  /// The graph behind the pattern: neighbours of each vertex, without itself.
  const Ragged<std::int32_t>& neighbours() const { return neighbours_; }
  const Numbering& numbering() const { return *numbering_; }

 private:
  /// An equation of an element that add() has in hand.
  struct Added {
    std::int32_t equation, local, start;  ///< start: of its row in the element's triangle
    std::int32_t place;                   ///< in the row where it was met last
  };

  const Numbering* numbering_;
  Ragged<std::int32_t> neighbours_;
  std::vector<std::int64_t> row_;     ///< the diagonal is the last entry of each row
  std::vector<std::int32_t> column_;  ///< ascending in each row
  std::vector<double> value_;
  std::vector<Added> adding_;
};

}  // namespace lacon
