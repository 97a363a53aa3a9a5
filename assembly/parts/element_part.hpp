#pragma once
// The cells of one process: evaluated there, their states kept there, and the rows of its nodes put together there.
//
// A process evaluates every cell that meets one of its nodes, so that forces and rows of its nodes are whole, summed in the
// order of the cells: they have the bits that one process gives them.
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lacon/assembly/element_sets.hpp"
#include "lacon/assembly/parts/board.hpp"
#include "lacon/assembly/parts/kept_points.hpp"
#include "lacon/assembly/parts/part_cells.hpp"
#include "lacon/assembly/point_values.hpp"
#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

class ElementPart {
 public:
  /// Throws as Registry does.
  explicit ElementPart(PartCells cells);
  ElementPart(const ElementPart&) = delete;
  ElementPart& operator=(const ElementPart&) = delete;

  /// Forces at own nodes, states, and the matrix where one is wanted, at the board's displacements. What is wrong with an
  /// element stands in the report. @param previous, origin number of a kept state, where laws with a memory and the others
  /// start from; -1: the natural state
  void evaluate(const Board& board, PartReport& report, SolidMatrix wanted, std::int64_t previous, std::int64_t origin);

  /// Keep the present state under a number, the natural one, or one that is kept: as it is, or with no law that flows
  /// (INDIPLAS).
  void keep(std::int64_t number) { kept_[number] = present_; }
  void keep_natural(std::int64_t number);
  void keep_copy(std::int64_t number, std::int64_t of);
  void keep_at_rest(std::int64_t number, std::int64_t of);
  /// Temperatures and initial strains are, from now on, those of a kept state. @param number -1: none act
  void strain_as(std::int64_t number);
  void drop(std::int64_t number) { kept_.erase(number); }
  /// Write the values of own cells into an array of some cells of each set, one set behind the other, or take those of all
  /// cells here from it, into a state that has been copied or is natural. @param number -1: the present state
  void write(std::int64_t number, PointQuantity quantity, std::span<const CellRange> cells, std::span<double> values) const;
  void read(std::int64_t number, PointQuantity quantity, std::span<const CellRange> cells, std::span<const double> values);
  /// Whether internal variables are others than in a kept state: the law flows.
  bool flows(std::int64_t since) const;

  /// The product of own rows with the board's displacements, of magnitudes or not.
  void multiply(const Board& board, bool magnitudes) const;
  /// SparseMatrix::multiply_together. @param x, y (n_nodes, dimension, n_columns)
  void multiply(std::span<const double> x, std::span<double> y, int n_columns) const;
  /// SparseMatrix::row_sizes of own rows: sums, and how many entries.
  void measure(const Board& board) const;
  /// The diagonal of own rows; and their largest |a_ij| d_i d_j, with d in the place of the board's displacements.
  void write_diagonal(const Board& board) const;
  void write_maxima(const Board& board) const;
  /// From now on changes of the matrix are those from what it is now.
  void remember();
  /// The largest one, of a row's and a column's diagonal, squared.
  double change() const;
  /// Entries of the whole matrix in rows of own nodes. @param use(row, column, value): equations, of the lower triangle
  template <class Use>
  void for_each_own(const Use& use) const {
    const std::int64_t own = cells_.n_own * cells_.dimension;
    for (std::int64_t i = 0; i < matrix_->size(); ++i)
      for (std::int64_t k = matrix_->rows()[i]; k < matrix_->rows()[i + 1]; ++k) {
        const std::int64_t j = matrix_->columns()[k];
        const std::int32_t a = cells_.equation[i], b = cells_.equation[j];
        if (a >= 0 && b >= 0 && (a > b ? i : j) < own) use(std::max(a, b), std::min(a, b), matrix_->values()[k]);
      }
  }
  /// Add the entries that this process has to a lower triangle of all equations: those in rows of its own nodes.
  void add_to(std::span<const std::int64_t> row, std::span<const std::int32_t> column, std::span<double> value) const;

  /// Rows and columns are (node, axis) of PartCells::node; rows of own nodes are whole.
  const SparseMatrix& matrix() const { return *matrix_; }
  std::span<const std::int32_t> place() const { return cells_.place; }

 private:
  using State = std::vector<PointValues>;  ///< of each set

  /// Of the whole mesh's nodes those that are here, and back. @param width of what stands in nodal arrays for an unknown
  std::vector<double> gathered(std::span<const double> nodal, int width = 1) const;
  void hand_out(std::span<const double> own, std::span<double> nodal, int width = 1) const;
  /// Call use(set, cell here, its first number in an array of these cells, how many it has) for those that are here.
  template <class Use>
  void for_each_in(std::span<const CellRange> cells, PointQuantity quantity, const Use& use) const;
  const State& state(std::int64_t number) const { return number < 0 ? *present_ : *kept_.at(number); }
  State natural() const;
  /// The present state, to be changed: those that are kept stay as they are.
  State& present();

  PartCells cells_;
  Registry registry_;
  Mesh mesh_;  ///< of these cells alone
  std::vector<ElementSet> sets_;
  Numbering numbering_;
  std::unique_ptr<SparseMatrix> matrix_;
  bool remembers_ = false;
  std::vector<double> remembered_;  ///< values of the matrix, where they have changed since
  std::shared_ptr<State> present_;
  std::map<std::int64_t, std::shared_ptr<State>> kept_;
};

}  // namespace lacon
