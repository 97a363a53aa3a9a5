#include "lacon/assembly/petsc/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "lacon/assembly/petsc/block_matrix.hpp"
#include "lacon/assembly/petsc/smoothed_aggregation.hpp"

namespace lacon {
namespace {

/// Iterations that a new one takes the time of: as many may be lost before it is made.
constexpr double of_setting_up = 30;
/// A system of so few equations has a factor.
constexpr PetscInt few_equations = 50;
/// Of the polynomials that smooth.
constexpr int degree = 4;
/// Their ends, of the largest eigenvalue that a few iterations see.
constexpr double lower_end = 0.04, upper_end = 1.1;
constexpr int iterations_for_eigenvalue = 10;

/// Of the matrix over its diagonal, from below. @param algorithm CG, or GMRES where the matrix is not positive
double largest_eigenvalue(Mat matrix, KSPType algorithm = KSPCG) {
  OwnedKsp ksp;
  OwnedVec side, solution;
  PC pc = nullptr;
  double largest = 0, least = 0;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  checked(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(matrix)), ksp.out()));
  checked(KSPSetOptionsPrefix(ksp, "eigenvalue_"));
  checked(KSPSetOperators(ksp, matrix, matrix));
  checked(KSPSetType(ksp, algorithm));
  checked(KSPGetPC(ksp, &pc));
  checked(PCSetType(pc, PCJACOBI));
  checked(KSPSetNormType(ksp, KSP_NORM_NONE));
  checked(KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, iterations_for_eigenvalue));
  checked(KSPSetComputeSingularValues(ksp, PETSC_TRUE));
  checked(MatCreateVecs(matrix, solution.out(), side.out()));
  checked(VecSetRandom(side, nullptr));
  checked(KSPSolve(ksp, side, solution));
  checked(KSPGetConvergedReason(ksp, &reason));
  if (reason < 0 && algorithm == std::string(KSPCG)) return largest_eigenvalue(matrix, KSPGMRES);
  checked(KSPComputeExtremeSingularValues(ksp, &largest, &least));
  return largest;
}

/// The polynomials of a level. @param largest  eigenvalue of its matrix over the diagonal
void set_ends(KSP smoother, double largest) {
  checked(KSPChebyshevSetEigenvalues(smoother, upper_end * largest, lower_end * largest));
}

/// Level `level` of a multigrid gets another matrix.
void use_matrix(PC multigrid, PetscInt level, Mat matrix) {
  KSP smoother = nullptr;
  checked(PCMGGetSmoother(multigrid, level, &smoother));
  checked(KSPSetOperators(smoother, matrix, matrix));
  checked(PCMGSetResidual(multigrid, level, PCMGResidualDefault, matrix));
}

PetscInt finest_level(PC multigrid) {
  PetscInt n_levels = 0;
  checked(PCMGGetLevels(multigrid, &n_levels));
  return n_levels - 1;
}

/// Matrices of coarser levels are products that could be made again: for that they keep what they were made of, the matrix
/// above them among it.
void forget_products(PC multigrid) {
  for (PetscInt level = 0; level <= finest_level(multigrid); ++level) {
    KSP smoother = nullptr;
    Mat matrix = nullptr;
    checked(PCMGGetSmoother(multigrid, level, &smoother));
    checked(KSPGetOperators(smoother, nullptr, &matrix));
    checked(MatProductClear(matrix));
  }
}

bool is_of_type(PC pc, PCType type) {
  PetscBool is = PETSC_FALSE;
  checked(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), type, &is));
  return is;
}

/// The levels of a multigrid that LACON_PETSC_OPTIONS of the user have not set otherwise. Squared graphs would cost more
/// iterations than they save (42 for 27 of two blocks, H3). Polynomials end where aggregates take over.
void set_options_of_gamg(PC pc) {
  const char* prefix = nullptr;
  checked(PCGetOptionsPrefix(pc, &prefix));
  const std::string own = std::string("-") + (prefix ? prefix : "");
  set_option(own + "pc_gamg_threshold", "0");
  set_option(own + "pc_gamg_aggressive_coarsening", "0");
  set_option(own + "mg_levels_pc_type", "jacobi");  // SOR stops at an aggregate of one node, whose turns have no diagonal
  set_option(own + "mg_levels_ksp_max_it", std::to_string(degree));
  set_option(own + "mg_levels_ksp_chebyshev_esteig", "0," + std::to_string(lower_end) + ",0," + std::to_string(upper_end));
  // PETSc's own choice adds what others send as it comes: from more than one in an order that changes from run to run
  PetscMPIInt n_ranks = 1;
  MPI_Comm_size(PetscObjectComm(reinterpret_cast<PetscObject>(pc)), &n_ranks);
  if (n_ranks > 2) set_option("-matptap_via", "backend");
}

/// Levels that GAMG has made of AIJ matrices get blocks of single precision.
void use_single_blocks(PC gamg) {
  forget_products(gamg);
  for (PetscInt level = finest_level(gamg); level > 0; --level) {
    KSP smoother = nullptr;
    Mat matrix = nullptr, interpolation = nullptr;
    checked(PCMGGetSmoother(gamg, level, &smoother));
    checked(KSPGetOperators(smoother, nullptr, &matrix));
    checked(PCMGGetInterpolation(gamg, level, &interpolation));
    if (has_blocks(matrix)) use_matrix(gamg, level, in_single_blocks(matrix));
    if (!has_blocks(interpolation)) continue;
    const OwnedMat blocks = in_single_blocks(interpolation);
    checked(PCMGSetInterpolation(gamg, level, blocks));
    checked(PCMGSetRestriction(gamg, level, blocks));
  }
}

/// What GAMG was made of is needed no more where its finest level has blocks.
void let_go_of_products(KSP below, PC gamg) {
  KSP smoother = nullptr;
  Mat matrix = nullptr;
  PetscBool is_shell = PETSC_FALSE;
  checked(PCMGGetSmoother(gamg, finest_level(gamg), &smoother));
  checked(KSPGetOperators(smoother, &matrix, nullptr));
  checked(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(matrix), MATSHELL, &is_shell));
  if (!is_shell) return;
  checked(PCSetReusePreconditioner(gamg, PETSC_TRUE));
  checked(KSPSetOperators(below, matrix, matrix));
}

/// Have PETSC precondition, with a type of its own or with what its options say, and an AIJ matrix.
void leave_all_levels(KSP displacements, PCType type) {
  PC pc = nullptr;
  Mat exact = nullptr;
  checked(KSPGetPC(displacements, &pc));
  checked(KSPGetOperators(displacements, &exact, nullptr));
  const OwnedMat kept = referenced(exact), aij = as_aij(exact);
  checked(KSPSetOperators(displacements, exact, aij));
  if (type) checked(PCSetType(pc, type));
  if (type && type == std::string_view(PCGAMG)) set_options_of_gamg(pc);
  checked(PCSetFromOptions(pc));
  checked(KSPSetUp(displacements));
}

/// A level of polynomials above one of GAMG.
void set_up_levels(PC pc, Mat fine, double largest, CoarseLevel coarse) {
  KSP smoother = nullptr, below = nullptr;
  PC of_level = nullptr;
  PetscInt n_coarse = 0;
  checked(MatGetLocalSize(coarse.matrix, nullptr, &n_coarse));
  const OwnedMat interpolation = in_blocks(std::move(coarse.interpolation), n_coarse);
  checked(PCSetType(pc, PCMG));
  checked(PCMGSetLevels(pc, 2, nullptr));
  checked(PCSetUseAmat(pc, PETSC_FALSE));  // which is in double precision
  checked(PCMGSetInterpolation(pc, 1, interpolation));
  checked(PCMGSetRestriction(pc, 1, interpolation));
  checked(PCMGGetSmoother(pc, 1, &smoother));
  checked(KSPSetType(smoother, KSPCHEBYSHEV));
  checked(KSPSetNormType(smoother, KSP_NORM_NONE));
  checked(KSPSetTolerances(smoother, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, degree));
  checked(KSPGetPC(smoother, &of_level));
  checked(PCSetType(of_level, PCJACOBI));
  set_ends(smoother, largest);
  use_matrix(pc, 1, fine);
  checked(PCMGGetCoarseSolve(pc, &below));
  checked(KSPSetType(below, KSPPREONLY));
  checked(KSPSetOperators(below, coarse.matrix, coarse.matrix));
  checked(KSPGetPC(below, &of_level));
  checked(PCSetType(of_level, PCGAMG));
  set_options_of_gamg(of_level);
}

}  // namespace

bool Multigrid::suits(const OwnNodes& nodes) const {
  int suits_here = pc_ && nodes.is_free == is_free_ && !is_old(), suits_all = 0;
  MPI_Allreduce(&suits_here, &suits_all, 1, MPI_INT, MPI_LAND, PETSC_COMM_WORLD);
  return suits_all;
}

bool Multigrid::is_old() const { return lost_ >= of_setting_up; }

void Multigrid::make(KSP displacements, const OwnNodes& nodes) {
  forget();
  PC pc = nullptr;
  Mat exact = nullptr;
  PetscInt n = 0, dimension = 0, n_coarse = 0;
  checked(KSPGetPC(displacements, &pc));
  checked(KSPGetOperators(displacements, &exact, nullptr));
  checked(MatGetSize(exact, &n, nullptr));
  checked(MatGetBlockSize(exact, &dimension));
  if (n <= few_equations) return leave_all_levels(displacements, PCGAMG);
  const OwnedMat fine = in_single_blocks(exact);
  const double largest = largest_eigenvalue(fine);
  CoarseLevel coarse = coarse_level(PETSC_COMM_WORLD, entries_of(exact), nodes.is_link, nodes.is_free, nodes.coordinates,
                                    rigid_motions(exact, dimension, nodes), largest);
  checked(MatGetSize(coarse.matrix, &n_coarse, nullptr));
  if (n_coarse == 0) return leave_all_levels(displacements, PCJACOBI);  // everything is imposed
  if (n_coarse >= n) return leave_all_levels(displacements, PCGAMG);    // nodes that nothing joins
  checked(KSPSetOperators(displacements, exact, fine));
  set_up_levels(pc, fine, largest, std::move(coarse));
  checked(PCSetFromOptions(pc));
  if (!is_of_type(pc, PCMG)) return leave_all_levels(displacements, nullptr);  // LACON_PETSC_OPTIONS of the user
  checked(KSPSetUp(displacements));                                            // now, not in the first iteration
  KSP below = nullptr;
  PC gamg = nullptr;
  checked(PCMGGetCoarseSolve(pc, &below));
  checked(KSPGetPC(below, &gamg));
  if (is_of_type(gamg, PCGAMG)) {
    use_single_blocks(gamg);
    let_go_of_products(below, gamg);
  }
  checked(PCSetReusePreconditioner(pc, PETSC_TRUE));
  checked(PetscObjectReference(reinterpret_cast<PetscObject>(pc)));
  *pc_.out() = pc;
  is_free_ = nodes.is_free;
  is_new_ = true;
}

void Multigrid::give_to(KSP displacements) {
  Mat exact = nullptr;
  KSP smoother = nullptr;
  checked(KSPGetOperators(displacements, &exact, nullptr));
  const OwnedMat blocks = in_single_blocks(exact);
  const OwnedMat kept = referenced(exact);
  checked(KSPSetPC(displacements, pc_));
  use_matrix(pc_, finest_level(pc_), blocks);
  checked(PCMGGetSmoother(pc_, finest_level(pc_), &smoother));
  set_ends(smoother, largest_eigenvalue(blocks));
  checked(KSPSetOperators(displacements, exact, blocks));
  is_new_ = false;
}

/// The matrix that the finest level has.
Mat Multigrid::finest() const {
  KSP smoother = nullptr;
  Mat blocks = nullptr;
  checked(PCMGGetSmoother(pc_, finest_level(pc_), &smoother));
  checked(KSPGetOperators(smoother, &blocks, nullptr));
  return blocks;
}

void Multigrid::let_go() const {
  if (pc_) checked(PCSetOperators(pc_, finest(), finest()));
}

int Multigrid::most_iterations(double digits) const { return static_cast<int>(2 * of_a_digit_ * digits + of_setting_up); }

void Multigrid::note(int iterations, double digits) {
  if (iterations == 0 || !(digits > 0)) return;
  if (is_new_ || of_a_digit_ == 0)
    of_a_digit_ = iterations / digits;
  else
    lost_ += std::max(0.0, iterations - of_a_digit_ * digits);
}

}  // namespace lacon
