#include "lacon/assembly/petsc/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lacon/assembly/petsc/block_matrix.hpp"

namespace lacon {
namespace {

/// Iterations that a new one takes the time of: as many may be lost before it is made.
constexpr double of_setting_up = 30;
/// Ends of the polynomials, of the largest eigenvalue that a few iterations see.
constexpr double lower_end = 0.04, upper_end = 1.1;
constexpr int iterations_for_eigenvalue = 10;

/// Of the matrix over its diagonal, from below.
double largest_eigenvalue(Mat matrix) {
  OwnedKsp ksp;
  OwnedVec side, solution;
  PC pc = nullptr;
  double largest = 0, least = 0;
  checked(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(matrix)), ksp.out()));
  checked(KSPSetOptionsPrefix(ksp, "eigenvalue_"));
  checked(KSPSetOperators(ksp, matrix, matrix));
  checked(KSPSetType(ksp, KSPCG));
  checked(KSPGetPC(ksp, &pc));
  checked(PCSetType(pc, PCJACOBI));
  checked(KSPSetNormType(ksp, KSP_NORM_NONE));
  checked(KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, iterations_for_eigenvalue));
  checked(KSPSetComputeSingularValues(ksp, PETSC_TRUE));
  checked(MatCreateVecs(matrix, solution.out(), side.out()));
  checked(VecSetRandom(side, nullptr));
  checked(KSPSolve(ksp, side, solution));
  checked(KSPComputeExtremeSingularValues(ksp, &largest, &least));
  return largest;
}

/// The polynomials of a level, whose matrix is in blocks.
void set_ends(KSP smoother) {
  Mat matrix = nullptr;
  checked(KSPGetOperators(smoother, &matrix, nullptr));
  const double largest = largest_eigenvalue(matrix);
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

}  // namespace

bool Multigrid::suits(const Nodes& nodes) const {
  int suits_here = pc_ && nodes.is_free == is_free_ && !is_old(), suits_all = 0;
  MPI_Allreduce(&suits_here, &suits_all, 1, MPI_INT, MPI_LAND, PETSC_COMM_WORLD);
  return suits_all;
}

bool Multigrid::is_old() const { return lost_ >= of_setting_up; }

void Multigrid::take_from(KSP displacements, const Nodes& nodes) {
  forget();
  PC pc = nullptr;
  checked(KSPGetPC(displacements, &pc));
  if (finest_level(pc) == 0) return;  // a factor
  checked(PetscObjectReference(reinterpret_cast<PetscObject>(pc)));
  *pc_.out() = pc;
  forget_products(pc);
  for (PetscInt level = finest_level(pc); level > 0; --level) {
    KSP smoother = nullptr;
    Mat matrix = nullptr, interpolation = nullptr;
    checked(PCMGGetSmoother(pc, level, &smoother));
    checked(KSPGetOperators(smoother, nullptr, &matrix));
    checked(PCMGGetInterpolation(pc, level, &interpolation));
    if (has_blocks(matrix)) use_matrix(pc, level, in_single_blocks(matrix));
    if (!has_blocks(interpolation)) continue;
    const OwnedMat blocks = in_single_blocks(interpolation);
    checked(PCMGSetInterpolation(pc, level, blocks));
    checked(PCMGSetRestriction(pc, level, blocks));
  }
  checked(PCSetReusePreconditioner(pc, PETSC_TRUE));
  is_free_ = nodes.is_free;
  is_new_ = true;
  KSP smoother = nullptr;
  checked(PCMGGetSmoother(pc, finest_level(pc), &smoother));
  set_ends(smoother);
  Mat exact = nullptr;
  checked(KSPGetOperators(displacements, &exact, nullptr));
  checked(KSPSetOperators(displacements, exact, finest()));
}

void Multigrid::give_to(KSP displacements) {
  Mat exact = nullptr;
  checked(KSPGetOperators(displacements, &exact, nullptr));
  const OwnedMat blocks = in_single_blocks(exact);
  const OwnedMat kept = referenced(exact);
  checked(KSPSetPC(displacements, pc_));
  use_matrix(pc_, finest_level(pc_), blocks);
  KSP smoother = nullptr;
  checked(PCMGGetSmoother(pc_, finest_level(pc_), &smoother));
  set_ends(smoother);
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
