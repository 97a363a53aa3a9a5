#pragma once
// MUMPS for symmetric indefinite matrices: analysis once for a pattern, then factorisations and solutions.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lacon/assembly/symmetric_matrix.hpp"

namespace lacon {

struct SolverOptions {
  int memory_margin = 20;            ///< PCENT_PIVOT, percent
  double singular_pivot = 1e-13;     ///< a pivot below this fraction of the scaled matrix is zero: a mechanism is left
  double residual_tolerance = 1e-6;  ///< RESI_RELA: largest relative residual of a solution; negative: not checked
};

/// What a factorisation found.
struct Factorisation {
  std::int64_t negative_pivots = 0;
  std::vector<std::int64_t> null_pivots;  ///< equations whose pivot is zero: the matrix is singular
  double flops = 0;
  std::int64_t entries = 0;  ///< of the factor
};

class DirectSolver {
 public:
  explicit DirectSolver(const SolverOptions& options = {});
  ~DirectSolver();
  DirectSolver(const DirectSolver&) = delete;
  DirectSolver& operator=(const DirectSolver&) = delete;

  /// Symbolic analysis of a pattern, in the order of METIS. The matrix must live as long as it is solved with.
  void analyse(const SymmetricMatrix& matrix);
  /// Factorise the values that the analysed matrix has now.
  Factorisation factorise();
  /// Solve in place, refined until the residual is at round-off or stops falling.
  /// @return the relative residual |b - A x| / (|A| |x| + |b|), largest entry
  /// Throws SOLVER_1 (S) where it is above the tolerance.
  double solve(std::span<double> right_side);
  /// One pair of substitutions, in place: the solution without refinement.
  void substitute(std::span<double> right_side);
  /// The same for a block of sparse right sides. @param offset (n + 1), index, value: entries of each
  /// @return (n, size), one solution after the other
  std::vector<double> substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                 std::span<const double> value);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lacon
