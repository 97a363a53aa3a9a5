#pragma once
// Iterations of PETSc on a block system: displacements by multigrid, multipliers by their Schur complement.
#include <petscksp.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lacon/assembly/petsc/block_rows.hpp"

namespace lacon {

/// What of PETSc is destroyed with its owner.
template <class Object, PetscErrorCode (*destroy)(Object*)>
class Owned {
 public:
  Owned() = default;
  Owned(Owned&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Owned() { destroy(&object_); }
  operator Object() const { return object_; }
  Object* out() { return &object_; }

 private:
  Object object_ = nullptr;
};
using OwnedMat = Owned<Mat, MatDestroy>;
using OwnedVec = Owned<Vec, VecDestroy>;
using OwnedKsp = Owned<KSP, KSPDestroy>;

/// Throws what PETSc says where a call of it failed.
void checked(PetscErrorCode code);
/// From now on calls of PETSc that fail print nothing, and checked() tells what was wrong.
void catch_errors();

struct KrylovOptions {
  std::string algorithm = "GMRES";      ///< SOLVEUR/ALGORITHME
  std::string preconditioner = "GAMG";  ///< SOLVEUR/PRE_COND
  int iterations = 500;
};

struct KrylovResult {
  int iterations = 0;
  double residual = 0;  ///< against the right side
  std::string failure;  ///< why there is no solution, as PETSc names it, or STALLED; empty where there is
};

class Krylov {
 public:
  /// Takes its rows of the system, which need not be there any more. @param entries its own; their diagonal is found here
  Krylov(const BlockSystem& system, OwnEntries entries, const KrylovOptions& options);
  /// Make the preconditioner.
  void set_up();
  /// @param right_side (n), the solution afterwards: each process writes its own  @param share of it that may be left
  KrylovResult solve(std::span<double> right_side, double share);

 private:
  void load(std::span<const double> right_side);
  void set_up_blocks(const BlockSystem& system, BlockRows& rows);
  void set_up_displacements(PC pc) const;

  KrylovOptions options_;
  bool is_symmetric_;
  std::int64_t n_multipliers_, dimension_;
  std::vector<std::int32_t> equation_;  ///< of own rows, displacements first; -1: imposed
  std::vector<double> scale_;           ///< of them
  std::vector<double> weight_;          ///< of own multipliers
  Rows rows_of_k_;                      ///< where k_ has its entries, in one process
  OwnedMat k_, b_, c_, d_, matrix_, schur_;
  OwnedVec side_, solution_, residual_, weighted_, added_;
  OwnedKsp ksp_;
};

}  // namespace lacon
