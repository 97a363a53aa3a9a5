#pragma once
// Iterations of PETSc on a block system: displacements by multigrid, multipliers by their Schur complement.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lacon/assembly/petsc/block_rows.hpp"
#include "lacon/assembly/petsc/multigrid.hpp"
#include "lacon/assembly/petsc/owned.hpp"

namespace lacon {

struct KrylovOptions {
  std::string algorithm = "GMRES";      ///< SOLVEUR/ALGORITHME
  std::string preconditioner = "GAMG";  ///< SOLVEUR/PRE_COND
  int iterations = 500;
};

struct KrylovResult {
  int iterations = 0;
  double residual = 0;  ///< against the right side
  std::string failure;  ///< why there is no solution, as PETSc names it, STALLED or SLOW; empty where there is
};

class Krylov {
 public:
  /// Takes its rows of the system, which need not be there any more. @param entries its own; their diagonal is found here
  /// @param multigrid  of the system before, where it has one
  Krylov(const BlockSystem& system, OwnEntries entries, const KrylovOptions& options, Multigrid& multigrid);
  ~Krylov();
  Krylov(const Krylov&) = delete;
  Krylov& operator=(const Krylov&) = delete;
  /// Make the preconditioner.
  void set_up();
  /// @param right_side (n), the solution afterwards: each process writes its own  @param share of it that may be left
  KrylovResult solve(std::span<double> right_side, double share);

 private:
  void load(std::span<const double> right_side);
  void set_up_blocks(BlockRows& rows);
  void set_up_displacements(KSP displacements);
  KrylovResult iterate(double share);

  KrylovOptions options_;
  Multigrid& multigrid_;
  OwnNodes nodes_;
  bool is_symmetric_;
  std::int64_t n_multipliers_, dimension_;
  std::vector<std::int32_t> equation_;  ///< of own rows, displacements first; -1: imposed
  std::vector<double> scale_;           ///< of them
  std::vector<double> weight_;          ///< of own multipliers
  OwnedMat k_, b_, c_, d_, matrix_, schur_;
  OwnedVec side_, solution_, residual_, weighted_, added_;
  OwnedKsp ksp_;
};

}  // namespace lacon
