#pragma once
// What a linear solver is to the rest of Lacon: a pattern, then values, then right sides. MUMPS is one engine
// (mumps_engine.hpp).
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

class PartProcesses;

/// What a factorisation found.
struct Factorisation {
  std::optional<std::int64_t> negative_pivots;  ///< the inertia, where the engine knows it
  static constexpr std::int64_t unknown = -1;
  std::vector<std::int64_t> null_pivots;  ///< equations whose pivot is zero: the matrix is singular
  double flops = 0;
  std::int64_t entries = 0;                                              ///< of the factor
  std::int64_t whole_entries = 0;                                        ///< the same before its blocks were compressed
  bool single_precision = false, low_rank = false, out_of_core = false;  ///< how the factor is kept
  int processes = 1;                                                     ///< that share it
  double error = 0;                                                      ///< what a substitution leaves of a residual
  double wasted_flops = 0;                                               ///< of a factor that was no use
  bool is_iterative = false;                                             ///< there is none: iterations have what they need
  std::string stalled;   ///< why iterations were no use, and a factor was made instead
  std::string doubt;     ///< why a cheaper factor was no use, and an exact one was made behind it
  std::string unshared;  ///< why processes share it no more, or not at all; of the first factor after that
};

/// What a solution took.
struct Solution {
  double residual = 0;                 ///< |b - A x| / (|A| |x| + |b|), largest entry
  int iterations = 0;                  ///< of GMRES
  std::optional<double> error;         ///< of a factor that it has proved: Factorisation::error
  std::optional<Factorisation> again;  ///< another factorisation; where it has null pivots there is no solution
};

/// Solves with one matrix at a time, which has at least one equation. After an error in analyse() or factorise() an analysis
/// starts it afresh; one in a solution leaves the factor as it was.
class Engine {
 public:
  virtual ~Engine() = default;

  /// The graph of a matrix that has to be evaluated yet, and is most likely the next one to be analysed: what it says alone may
  /// be found out meanwhile. It may be gone when this returns.
  virtual void expect(const VertexGraph& /*graph*/) {}
  /// Symbolic work for the pattern of a matrix.
  virtual void analyse(const SparseMatrix& matrix) = 0;
  /// Make ready to solve with a matrix of the analysed pattern: factorise it, or set up what iterations need. The matrix must
  /// stay as it is while it is solved with. Throws SOLVER_2 (no memory).
  virtual Factorisation factorise(const SparseMatrix& matrix) = 0;
  /// The same where a solution comes next, and nothing else: it may prove the factor on its way, and make another one.
  virtual Factorisation factorise_to_solve(const SparseMatrix& matrix) { return factorise(matrix); }
  /// Solve in place. Throws SOLVER_1, or another error of severity S that says why there is no solution; `right_side` is then
  /// as it was.
  virtual Solution solve(std::span<double> right_side) = 0;
  /// Likewise, where a part of the right side may be left. @param share of its norm; an engine may leave less
  virtual Solution solve_to(double /*share*/, std::span<double> right_side) { return solve(right_side); }

  /// Where nodes are for the matrices to come, (n_nodes, 3); until then they are where they were at first.
  virtual void place_nodes(std::span<const double> /*coordinates*/) {}

  /// What cheaper factors have failed for, so that later ones take more care: their pivots are looked for, or they are exact.
  enum class Care { none, pivots, exact };
  /// For another process that goes on with the same bits.
  virtual Care care() const { return Care::none; }
  virtual void take(Care) {}
  /// Those that may have cells and rows of so large a matrix themselves; such a matrix (SparseMatrix::elsewhere) is solved
  /// with. None of an engine that needs a matrix in one process.
  virtual std::shared_ptr<PartProcesses> processes(std::int64_t /*n_equations*/) const { return nullptr; }
};

/// An engine that keeps a factor, with which one substitution is cheap and a block of sparse right sides is cheaper still.
class FactorEngine : public Engine {
 public:
  /// One pair of substitutions, in place: the solution without refinement.
  virtual void substitute(std::span<double> right_side) = 0;
  /// The same for a block of sparse right sides. @param offset (n + 1), index, value: entries of each
  /// @return (n, size), one solution after the other
  virtual std::vector<float> substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                        std::span<const double> value) = 0;
};

}  // namespace lacon
