#pragma once
// MUMPS, in the order of METIS: for symmetric indefinite matrices, whose inertia it knows, and for general ones.
#include <memory>

#include "lacon/assembly/engine.hpp"

namespace lacon {

struct MumpsOptions {
  int memory_margin = 20;            ///< PCENT_PIVOT, percent
  double singular_pivot = 1e-13;     ///< a pivot below this fraction of the scaled matrix is zero: a mechanism is left
  double residual_tolerance = 1e-6;  ///< RESI_RELA: largest relative residual of a solution; negative: not checked
};

class MumpsEngine : public FactorEngine {
 public:
  explicit MumpsEngine(const MumpsOptions& options = {});
  ~MumpsEngine() override;
  MumpsEngine(const MumpsEngine&) = delete;
  MumpsEngine& operator=(const MumpsEngine&) = delete;

  void analyse(const SparseMatrix& matrix) override;
  Factorisation factorise(const SparseMatrix& matrix) override;
  /// Refined until the residual is at round-off or stops falling. Throws SOLVER_1 where it is above the tolerance.
  double solve(std::span<double> right_side) override;
  void substitute(std::span<double> right_side) override;
  std::vector<double> substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                 std::span<const double> value) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lacon
