#pragma once
// PETSc: iterations for symmetric and general matrices, in processes of their own (petsc/). Displacements by multigrid, which
// knows the rigid motions, multipliers by their Schur complement. Its memory is linear in the number of equations.
//
// A matrix with a rigid motion that nothing resists, and one at which the iterations stall, gets a factor of MUMPS instead.
#include <memory>
#include <string>
#include <vector>

#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/assembly/rigid_motions.hpp"

namespace lacon {

struct PetscOptions {
  std::string algorithm = "GMRES";      ///< ALGORITHME
  std::string preconditioner = "GAMG";  ///< PRE_COND
  double tolerance = 1e-8;              ///< RESI_RELA: of the residual, against the right side
  int iterations = 500;                 ///< NMAX_ITER
  int n_ranks = 1;                      ///< processes, which mpirun starts where there are several
  std::string hosts;      ///< machines where they run, as mpirun takes them; empty: this one, or those of a batch job
  std::string program;    ///< lacon_petsc; empty: beside the program that runs
  BodyGeometry geometry;  ///< of the nodes of the numbering; coordinates must outlive the engine
  MumpsOptions direct;
};

class PetscEngine : public Engine {
 public:
  /// Whether the program that this engine starts lies beside the one that runs.
  static bool is_there();
  /// Whether there is what starts several processes of it.
  static bool has_mpirun();
  /// Throws SOLVER_6 where PETSc is not there.
  explicit PetscEngine(const PetscOptions& options);
  ~PetscEngine() override;
  PetscEngine(const PetscEngine&) = delete;
  PetscEngine& operator=(const PetscEngine&) = delete;

  /// Throws SOLVER_6 where PETSc cannot be started.
  void analyse(const SparseMatrix& matrix) override;
  /// Throws SOLVER_8 where PETSc ends, SOLVER_9 where there is no memory for the factor instead.
  Factorisation factorise(const SparseMatrix& matrix) override;
  /// Likewise, and SOLVER_1.
  Solution solve(std::span<double> right_side) override;
  /// To RESI_RELA, where that is more.
  Solution solve_to(double share, std::span<double> right_side) override;
  /// The multigrid's rigid motions are those of bodies as they are there.
  void place_nodes(std::span<const double> coordinates) override;
  std::shared_ptr<PartProcesses> processes(std::int64_t n_equations) const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lacon
