#pragma once
// The tangent system of one Newton iteration: matrix, residual, and what imposed displacements bring to the right side.
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// Unknowns are counted as those of nodes (node * n_components + component, displacements first) and behind them the
/// multipliers of the patches, then those of relations; only some of them have an equation.
class System {
 public:
  /// @param elsewhere entries of elements that are not among these
  System(const Numbering& numbering, const Ragged<std::int32_t>& elements, Symmetry symmetry = Symmetry::symmetric,
         const RowsElsewhere* elsewhere = nullptr);

  std::int64_t n_nodal() const { return static_cast<std::int64_t>(numbering_.equation.size()); }
  std::int64_t multiplier(std::int64_t patch) const { return n_nodal() + patch; }
  /// Of a vertex of the numbering: a node's, or a multiplier.
  std::int64_t unknown(std::int64_t vertex, int component) const {
    return vertex < numbering_.n_nodes ? vertex * numbering_.n_components + component : multiplier(vertex - numbering_.n_nodes);
  }
  std::int64_t equation(std::int64_t unknown) const;

  /// @param use what is done with the graph of a matrix that has a new pattern, before there is one; not where other processes
  /// have entries of it
  void on_new_graph(std::function<void(const VertexGraph&)> use) { on_new_graph_ = std::move(use); }
  /// Empty the matrix and the residual, and make room for these couplings.
  /// @param keep_stiffness what was added before stiffness_is_complete() stays in the matrix, and what was added behind it is
  /// gone: add() takes residuals alone of what belongs to the stiffness
  void start(std::span<const Coupling> couplings, bool keep_stiffness = false);
  /// What the matrix holds now may be kept by the next start().
  void stiffness_is_complete();
  /// Couplings that start() has made room for so far. The order of elimination depends on them.
  std::span<const Coupling> couplings() const { return couplings_; }
  /// Add an element. @param lower (n (n + 1) / 2): lower triangle of its matrix, or empty  @param residual (n)
  void add(std::span<const std::int64_t> unknowns, std::span<const double> lower, std::span<const double> residual);
  /// The same of one whose matrix is not symmetric, to a general system. @param matrix (n, n), row by row
  void add_unsymmetric(std::span<const std::int64_t> unknowns, std::span<const double> matrix,
                       std::span<const double> residual);
  void add_diagonal(std::int64_t unknown, double value);

  std::vector<double>& residual() { return residual_; }  ///< (unknowns of nodes, multipliers)
  const std::vector<double>& residual() const { return residual_; }
  /// There is none before the first start().
  const SparseMatrix& matrix() const { return *matrix_; }
  bool is_symmetric() const { return symmetry_ == Symmetry::symmetric; }
  /// The first equation of a multiplier.
  std::int64_t first_multiplier() const { return numbering_.first[numbering_.n_nodes]; }

  /// The right side -residual + external - K du of the imposed displacements, (n_equations).
  /// @param external external forces, and behind them what the multipliers' rows are to be; 0 where it ends early
  /// @param step (n_nodal): change of what is imposed, 0 elsewhere
  std::vector<double> right_side(std::span<const double> external, std::span<const double> step) const;

 private:
  struct ImposedTerm {
    std::int64_t equation, dof;
    double coefficient;
  };
  void make_pattern();
  /// Add a residual, and set `equations_`. @return whether some of the unknowns are imposed
  bool enter(std::span<const std::int64_t> unknowns, std::span<const double> residual);
  /// Whether an element matrix has entries between unknowns of nodes.
  bool couples_nodes(std::span<const std::int64_t> unknowns, std::span<const double> lower) const;
  /// Before something is added to rows of nodes, behind the stiffness: remember what they are without it.
  void save_rows(std::span<const std::int64_t> equations);
  void restore_rows();

  const Numbering& numbering_;
  const Ragged<std::int32_t>& elements_;
  Symmetry symmetry_;
  const RowsElsewhere* elsewhere_;
  std::function<void(const VertexGraph&)> on_new_graph_;
  std::vector<Coupling> couplings_;
  std::unique_ptr<SparseMatrix> matrix_;
  std::vector<double> residual_;
  std::vector<ImposedTerm> imposed_terms_;
  std::size_t n_stiffness_terms_ = 0;                  ///< the first of imposed_terms_, which belong to the stiffness
  bool is_complete_ = false;                           ///< the stiffness, which may be kept
  std::map<std::int64_t, std::vector<double>> saved_;  ///< of its rows those that others were added to, by equation
  std::vector<std::int64_t> equations_;                ///< of the element that is added
};

}  // namespace lacon
