#pragma once
// A sparse matrix, row by row: its pattern from a graph of vertices; where it is symmetric, its lower triangle alone.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lacon/assembly/numbering.hpp"
#include "lacon/assembly/rows_elsewhere.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Two vertices whose unknowns meet in the matrix.
struct Coupling {
  std::int32_t a, b;
};

enum class Symmetry { symmetric, general };

/// The sorted neighbours of each vertex, where those of each clique and of each coupling meet.
Ragged<std::int32_t> vertex_graph(std::int64_t n_vertices, const Ragged<std::int32_t>& cliques,
                                  std::span<const Coupling> couplings);

/// The graph behind a pattern, of which rows need not be there.
struct VertexGraph {
  const Ragged<std::int32_t>& neighbours;
  const Numbering& numbering;

  /// Call use(row, column) for the entries of a pattern, row by row, as a SparseMatrix has them. @param lower triangle alone
  template <class Use>
  void for_each_entry(bool lower, const Use& use) const {
    const std::vector<std::int64_t>& first = numbering.first;
    for (std::int32_t v = 0; v < numbering.n_vertices(); ++v)
      for (std::int64_t row = first[v]; row < first[v + 1]; ++row) {
        const auto add = [&](std::int64_t from, std::int64_t to) {
          for (; from < to; ++from) use(static_cast<std::int32_t>(row), static_cast<std::int32_t>(from));
        };
        bool is_own_there = false;
        for (const std::int32_t w : neighbours[v]) {
          if (w > v && lower) break;
          if (w > v && !is_own_there) add(first[v], first[v + 1]), is_own_there = true;
          add(first[w], first[w + 1]);
        }
        if (!is_own_there) add(first[v], lower ? row + 1 : first[v + 1]);
      }
  }
};

/// Copies share their pattern, and their values until one of them changes.
class SparseMatrix {
 public:
  /// The pattern in which neighbouring vertices meet. @param neighbours of each vertex, ascending, without itself
  SparseMatrix(Ragged<std::int32_t> neighbours, const Numbering& numbering, Symmetry symmetry);
  /// The pattern in which the vertices of each clique (an element's nodes) and of each coupling (of nodes, of multipliers, or
  /// of one with the other) meet. It is symmetric, whatever the values are.
  SparseMatrix(const Numbering& numbering, const Ragged<std::int32_t>& cliques, std::span<const Coupling> couplings,
               Symmetry symmetry = Symmetry::symmetric);

  /// Whether the pattern has room for all these couplings.
  bool has_room_for(std::span<const Coupling> couplings) const;

  /// @param first_row rows before it keep their values
  void set_zero(std::int64_t first_row = 0);
  /// Give the first rows, or all of them, the values that values() had there.
  void restore(std::span<const double> values);
  /// The same of one row. @param values as row_values() has them
  void set_row(std::int64_t row, std::span<const double> values);
  /// Take the values of the first rows from a matrix whose pattern there is a part of this one's; what is new is zero.
  void copy_rows(const SparseMatrix& other, std::int64_t n_rows);
  /// Add an element matrix. @param equations of its degrees of freedom, -1: left out; an equation may stand there more than
  /// once (tied multipliers), and then gets the sum  @param lower (n (n + 1) / 2): lower triangle, row by row
  void add(std::span<const std::int64_t> equations, std::span<const double> lower);
  /// The same of one that is not symmetric, to a general matrix. @param values (n, n), row by row
  void add_unsymmetric(std::span<const std::int64_t> equations, std::span<const double> values);
  void add_diagonal(std::int64_t equation, double value);

  bool is_symmetric() const { return symmetry_ == Symmetry::symmetric; }
  std::int64_t size() const { return static_cast<std::int64_t>(row_.size()) - 1; }
  std::int64_t n_entries() const { return row_.back(); }
  std::span<const std::int64_t> rows() const { return row_; }  ///< (size + 1)
  std::span<const std::int32_t> columns() const { return column_; }
  std::span<const double> values() const { return value_; }
  std::span<const double> row_values(std::int64_t row) const { return value_.subspan(row_[row], row_[row + 1] - row_[row]); }
  double diagonal(std::int64_t equation) const { return value_[diagonal_place(equation)]; }
  /// All of it, with what is elsewhere.
  std::vector<double> diagonals() const;

  /// Entries that other processes have, which products and sizes of rows count in; they must outlive the matrix. Rows, columns
  /// and values are those of this one.
  void add_elsewhere(const RowsElsewhere* rows) { elsewhere_ = rows; }
  const RowsElsewhere* elsewhere() const { return elsewhere_; }
  /// y += A x, or |A| |x|, of those alone.
  void multiply_elsewhere(std::span<const double> x, std::span<double> y, bool magnitudes) const;

  /// y = A x
  void multiply(std::span<const double> x, std::span<double> y) const;
  /// y = |A| |x|, of magnitudes
  void multiply_magnitudes(std::span<const double> x, std::span<double> y) const;
  /// Some products of a symmetric matrix at once, each with the bits of multiply(), the last one with those of
  /// multiply_magnitudes(); what is elsewhere is left out. @param x, y (size, n_columns)
  void multiply_together(std::span<const double> x, std::span<double> y, int n_columns) const;
  /// Powers of two, at most 1, (size), for multipliers whose couplings, but those that are next to nothing, are all larger than
  /// the diagonals that they meet: one is no larger then. Areas in square nanometres would make stiffnesses in N/nm look like
  /// zeros.
  std::vector<double> multiplier_scale() const;
  /// Powers of two d that make the largest entry of each row and column of d A d about 1, (size), from multiplier_scale() on.
  std::vector<double> equilibration() const;
  /// Unknowns that their row alone decides: nothing but a diagonal stands in it. Ascending; multipliers alone, where other
  /// processes have entries.
  std::vector<std::int64_t> rows_alone() const;
  /// How large a row is: the sum of |a_ij|, and how many entries it has.
  struct RowSize {
    double sum = 0;
    std::int32_t entries = 0;
  };
  /// Of the rows of the leading n x n block.
  std::vector<RowSize> row_sizes(std::int64_t n) const;
  /// The largest sum of magnitudes in a row of the whole matrix.
  double norm() const;

  /// The graph behind the pattern: neighbours of each vertex, without itself.
  const Ragged<std::int32_t>& neighbours() const { return pattern_->neighbours; }
  const Numbering& numbering() const { return *numbering_; }
  operator VertexGraph() const { return {neighbours(), *numbering_}; }

 private:
  struct Pattern {
    Ragged<std::int32_t> neighbours;
    std::vector<std::int64_t> row;           ///< where the matrix is symmetric, the diagonal is the last entry of each row
    std::unique_ptr<std::int32_t[]> column;  ///< ascending in each row
  };
  /// The values, of this matrix alone from now on.
  double* own_values();
  /// An equation of an element that add() has in hand.
  struct Added {
    std::int32_t equation, local, start;  ///< start: of its row in the element's triangle
    std::int32_t place;                   ///< in the row where it was met last
  };
  /// Add value(i, j) of every two equations in hand, of those up to the diagonal where `lower`.
  template <bool lower, class Value>
  void add_rows(std::span<const std::int64_t> equations, const Value& value);
  /// Of equations those of nodes, (n_nodes, n_components), 0 where there is none.
  std::vector<double> nodal(std::span<const double> x) const;
  std::int64_t diagonal_place(std::int64_t equation) const;
  /// y = f(A) f(x), of numbers or of magnitudes.
  template <class Function>
  void multiply(std::span<const double> x, std::span<double> y, const Function& f) const;
  /// Gather in y, (size, width), what the entries give to their rows and to their columns, in threads: work(first row, last
  /// row, sums) does it for some rows, in sums that begin as zeros and are joined in the order of rows. The same bits for any
  /// number of threads.
  template <class Work, class Join>
  void gather(std::span<double> y, std::size_t width, const Work& work, const Join& join) const;
  /// First rows of the parts in which gather() takes them, and their end.
  std::vector<std::int64_t> parts_of_rows() const;

  const Numbering* numbering_;
  Symmetry symmetry_;
  std::shared_ptr<const Pattern> pattern_;
  std::shared_ptr<double[]> values_;
  std::span<const std::int64_t> row_;     ///< of the pattern
  std::span<const std::int32_t> column_;  ///< likewise
  std::span<const double> value_;         ///< of the values
  std::vector<Added> adding_;
  const RowsElsewhere* elsewhere_ = nullptr;
};

}  // namespace lacon
