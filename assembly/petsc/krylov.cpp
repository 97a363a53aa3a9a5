#include "lacon/assembly/petsc/krylov.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "lacon/assembly/petsc/aij_matrix.hpp"
#include "lacon/assembly/petsc/block_matrix.hpp"
#include "lacon/assembly/petsc/near_null_space.hpp"
#include "lacon/assembly/petsc/pace.hpp"

namespace lacon {
namespace {

constexpr int restart = Pace::window;
/// Solutions of the residual that is left, where what the iterations follow is not the residual itself.
constexpr int most_rounds = 4;

/// The diagonal that all processes have together.
std::vector<double> whole_diagonal(const BlockSystem& system, const OwnEntries& entries, int part) {
  const int dimension = system.sizes.dimension;
  std::vector<int> first, size;
  for (std::int64_t p = 0; p < system.sizes.n_parts; ++p) {
    first.push_back(static_cast<int>(system.first_block[p] * dimension));
    size.push_back(static_cast<int>(system.first_block[p + 1] * dimension) - first.back());
  }
  std::vector<double> whole(system.sizes.n_blocks * dimension, 0.0);
  for (std::int64_t i = 0; i < entries.matrix->size(); ++i)
    if (const int at = entries.place[i] - first[part]; at >= 0 && at < size[part])
      whole[entries.place[i]] = entries.matrix->diagonal(i);
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, whole.data(), size.data(), first.data(), MPI_DOUBLE, PETSC_COMM_WORLD);
  return whole;
}

/// Owned rows of a matrix, of all columns.
OwnedMat make_matrix(const Rows& rows, std::int64_t own_columns) {
  return aij_matrix(PETSC_COMM_WORLD, {rows.offset, rows.column, rows.value}, static_cast<PetscInt>(own_columns));
}

/// When iterations end: as PETSc has it, or as soon as they will not do.
struct Ending {
  bool watches;
  Pace pace;
  bool is_given_up = false;
  void* standard = nullptr;

  Ending(bool watches_pace, int most, double goal) : watches(watches_pace), pace(most, goal) {
    checked(KSPConvergedDefaultCreate(&standard));
  }
  ~Ending() { KSPConvergedDefaultDestroy(standard); }
  Ending(const Ending&) = delete;
  Ending& operator=(const Ending&) = delete;

  static PetscErrorCode test(KSP ksp, PetscInt iteration, PetscReal residual, KSPConvergedReason* reason, void* own) {
    auto& ending = *static_cast<Ending*>(own);
    const PetscErrorCode error = KSPConvergedDefault(ksp, iteration, residual, reason, ending.standard);
    if (!error && *reason == KSP_CONVERGED_ITERATING && ending.watches &&
        ending.pace.is_too_slow(static_cast<int>(iteration), residual)) {
      ending.is_given_up = true;
      *reason = KSP_DIVERGED_ITS;
    }
    return error;
  }
};

/// How PETSc spells a name of SOLVEUR; whether its preconditioner has to be symmetric and positive, and whether residuals fall
/// steadily (Pace).
struct Algorithm {
  KSPType type;
  bool is_symmetric = false, is_steady = true;
};
Algorithm algorithm_of(const std::string& name) {
  if (name == "CG" || name == "CR") return {KSPMINRES, true, false};
  if (name == "GCR") return {KSPGCR};
  if (name == "BCGS") return {KSPBCGS, false, false};
  if (name == "GMRES" || name == "GMRES_LMP") return {KSPGMRES};
  return {KSPFGMRES};
}

/// Any name but those that set_up_displacements() knows: what PETSc may have under it is no better here.
bool is_multigrid(const std::string& name) {
  constexpr std::string_view others[] = {"BOOMER", "JACOBI", "SOR", "LDLT_INC", "SANS"};
  return std::ranges::find(others, name) == std::end(others);
}

}  // namespace

Krylov::Krylov(const BlockSystem& system, OwnEntries entries, const KrylovOptions& options, Multigrid& multigrid)
    : options_(options),
      multigrid_(multigrid),
      is_symmetric_(system.sizes.is_symmetric),
      n_multipliers_(system.sizes.n_multipliers),
      dimension_(system.sizes.dimension) {
  int part = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &part);
  if (entries.matrix) entries.diagonal = whole_diagonal(system, entries, part);
  BlockRows rows = rows_of_part(system, entries, part);
  const std::int64_t first_row = rows.blocks.first * dimension_, n_rows = rows.blocks.last * dimension_ - first_row;
  equation_.assign(n_rows + (rows.c.last - rows.c.first), -1);
  for (std::int64_t i = 0; i < system.sizes.n; ++i) {
    const std::int64_t place = system.place[i], multiplier = -1 - place;
    if (place >= first_row && place < first_row + n_rows) equation_[place - first_row] = static_cast<std::int32_t>(i);
    if (place < 0 && multiplier >= rows.c.first && multiplier < rows.c.last)
      equation_[n_rows + multiplier - rows.c.first] = static_cast<std::int32_t>(i);
  }
  scale_.assign(n_rows, 1.0);
  scale_.insert(scale_.end(), rows.scale.begin(), rows.scale.end());
  weight_ = rows.weight;
  nodes_.coordinates.assign(system.coordinates.begin() + rows.blocks.first * dimension_,
                            system.coordinates.begin() + rows.blocks.last * dimension_);
  nodes_.is_free = rows.is;
  nodes_.is_link = std::move(rows.is_of_k);
  for (std::int64_t node = 0; node < system.sizes.n_blocks; ++node)
    for (int i = 0; i < dimension_; ++i)
      nodes_.middle[i] += system.coordinates[node * dimension_ + i] / static_cast<double>(system.sizes.n_blocks);
  set_up_blocks(rows);
}

Krylov::~Krylov() {
  ksp_ = {};
  multigrid_.let_go();
}

void Krylov::set_up_blocks(BlockRows& rows) {
  const std::int64_t own = (rows.blocks.last - rows.blocks.first) * dimension_, own_multipliers = rows.c.last - rows.c.first;
  k_ = in_blocks(std::move(rows.k));
  if (n_multipliers_ == 0) {
    checked(MatCreateVecs(k_, solution_.out(), side_.out()));
  } else {
    b_ = make_matrix(rows.b, own_multipliers);
    c_ = make_matrix(rows.c, own);
    d_ = make_matrix(rows.d, own_multipliers);
    Mat blocks[] = {k_, b_, c_, d_};
    checked(MatCreateNest(PETSC_COMM_WORLD, 2, nullptr, 2, nullptr, blocks, matrix_.out()));
    Rows diagonal{.first = rows.d.first, .last = rows.d.last};
    for (std::int64_t i = 0; i < own_multipliers; ++i) {
      diagonal.column.push_back(static_cast<std::int32_t>(rows.d.first + i));
      // PETSc changes the sign of a preconditioner that has to be positive
      diagonal.value.push_back(algorithm_of(options_.algorithm).is_symmetric ? -std::abs(rows.schur[i]) : rows.schur[i]);
      diagonal.offset.push_back(i + 1);
    }
    schur_ = make_matrix(diagonal, own_multipliers);
    checked(MatCreateVecs(matrix_, solution_.out(), side_.out()));
    checked(MatCreateVecs(b_, weighted_.out(), added_.out()));
  }
  checked(VecDuplicate(side_, residual_.out()));
}

void Krylov::set_up_displacements(KSP displacements) {
  const std::string& name = options_.preconditioner;
  const char* prefix = nullptr;
  PC pc = nullptr;
  checked(KSPSetOperators(displacements, k_, k_));
  if (is_multigrid(name) && multigrid_.suits(nodes_)) return multigrid_.give_to(displacements);
  if (is_multigrid(name)) return multigrid_.make(displacements, nodes_);
  const OwnedMat aij = as_aij(k_);
  checked(KSPSetOperators(displacements, k_, aij));
  checked(KSPGetPC(displacements, &pc));
  checked(PCGetOptionsPrefix(pc, &prefix));
  const std::string own = std::string("-") + (prefix ? prefix : "");
  if (name == "BOOMER") {
    set_near_null_space(aij, rigid_motions(aij, static_cast<int>(dimension_), nodes_));
    checked(PCSetType(pc, PCHYPRE));
    checked(PCHYPRESetType(pc, "boomeramg"));
    set_option(own + "pc_hypre_boomeramg_strong_threshold", dimension_ == 3 ? "0.5" : "0.25");
    set_option(own + "pc_hypre_boomeramg_nodal_coarsen", "4");
    set_option(own + "pc_hypre_boomeramg_vec_interp_variant", "2");
  } else if (name == "JACOBI") {
    checked(PCSetType(pc, PCJACOBI));
  } else if (name == "SOR") {
    checked(PCSetType(pc, PCSOR));
  } else if (name == "LDLT_INC") {
    checked(PCSetType(pc, PCBJACOBI));
  } else {
    checked(PCSetType(pc, PCNONE));
  }
  checked(PCSetFromOptions(pc));
  checked(KSPSetUp(displacements));  // now, not in the first iteration
}

void Krylov::set_up() {
  const Algorithm algorithm = algorithm_of(options_.algorithm);
  ksp_ = {};
  checked(KSPCreate(PETSC_COMM_WORLD, ksp_.out()));
  Mat const matrix = n_multipliers_ ? matrix_ : k_;
  checked(KSPSetOperators(ksp_, matrix, matrix));
  checked(KSPSetType(ksp_, algorithm.type));
  if (!algorithm.is_symmetric) checked(KSPSetPCSide(ksp_, PC_RIGHT));
  set_option("-ksp_gmres_restart", std::to_string(restart));
  set_option("-ksp_gcr_restart", std::to_string(restart));
  PC pc = nullptr;
  checked(KSPGetPC(ksp_, &pc));
  if (n_multipliers_) {
    IS rows[2];
    checked(MatNestGetISs(matrix_, rows, nullptr));
    checked(PCSetType(pc, PCFIELDSPLIT));
    checked(PCFieldSplitSetIS(pc, "u", rows[0]));
    checked(PCFieldSplitSetIS(pc, "p", rows[1]));
    checked(PCFieldSplitSetType(pc, PC_COMPOSITE_SCHUR));
    checked(PCFieldSplitSetSchurFactType(
        pc, algorithm.is_symmetric ? PC_FIELDSPLIT_SCHUR_FACT_DIAG : PC_FIELDSPLIT_SCHUR_FACT_UPPER));
    checked(PCFieldSplitSetSchurPre(pc, PC_FIELDSPLIT_SCHUR_PRE_USER, schur_));
    set_option("-fieldsplit_p_ksp_type", "preonly");
    set_option("-fieldsplit_p_pc_type", "jacobi");
    set_option("-fieldsplit_u_ksp_type", "preonly");
  }
  checked(KSPSetFromOptions(ksp_));
  if (n_multipliers_) {
    checked(PCSetUp(pc));
    PetscInt n_parts = 0;
    KSP* parts = nullptr;
    checked(PCFieldSplitSchurGetSubKSP(pc, &n_parts, &parts));
    KSP const displacements = parts[0];
    checked(PetscFree(parts));
    set_up_displacements(displacements);
  } else {
    set_up_displacements(ksp_);
  }
  checked(KSPSetUp(ksp_));
  checked(KSPSetUpOnBlocks(ksp_));
}

void Krylov::load(std::span<const double> right_side) {
  double* values = nullptr;
  checked(VecGetArray(side_, &values));
  for (std::size_t i = 0; i < equation_.size(); ++i) values[i] = equation_[i] < 0 ? 0 : scale_[i] * right_side[equation_[i]];
  if (n_multipliers_) {
    const std::size_t n_rows = equation_.size() - weight_.size();
    double* own = nullptr;
    checked(VecGetArray(weighted_, &own));
    for (std::size_t i = 0; i < weight_.size(); ++i) own[i] = weight_[i] * values[n_rows + i];
    checked(VecRestoreArray(weighted_, &own));
    checked(MatMult(b_, weighted_, added_));
    checked(VecGetArray(added_, &own));
    for (std::size_t i = 0; i < n_rows; ++i) values[i] += own[i];
    checked(VecRestoreArray(added_, &own));
  }
  checked(VecRestoreArray(side_, &values));
}

KrylovResult Krylov::iterate(double share) {
  KrylovResult result;
  double size = 0, left = 0;
  checked(VecNorm(side_, NORM_2, &size));
  checked(VecSet(solution_, 0));
  checked(VecCopy(side_, residual_));
  OwnedVec step;
  checked(VecDuplicate(solution_, step.out()));
  Mat matrix = nullptr;
  checked(KSPGetOperators(ksp_, &matrix, nullptr));
  left = size;
  for (int round = 0; round < most_rounds && left > share * size; ++round) {
    const double before = left;
    int most = options_.iterations - result.iterations;
    if (multigrid_.is_kept()) most = std::min(most, multigrid_.most_iterations(std::log10(left / (share * size))));
    checked(KSPSetTolerances(ksp_, share * size / left, PETSC_DEFAULT, PETSC_DEFAULT, std::max(1, most)));
    Ending ending(algorithm_of(options_.algorithm).is_steady, most, share * size / left);
    checked(KSPSetConvergenceTest(ksp_, Ending::test, &ending, nullptr));
    checked(KSPSolve(ksp_, residual_, step));
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    PetscInt iterations = 0;
    checked(KSPGetConvergedReason(ksp_, &reason));
    checked(KSPGetIterationNumber(ksp_, &iterations));
    result.iterations += static_cast<int>(iterations);
    checked(VecAXPY(solution_, 1, step));
    checked(MatMult(matrix, solution_, residual_));
    checked(VecAYPX(residual_, -1, side_));
    checked(VecNorm(residual_, NORM_2, &left));
    result.failure = ending.is_given_up ? "SLOW" : reason < 0 ? KSPConvergedReasons[reason] : "";
    if (reason < 0 || !std::isfinite(left)) break;
    multigrid_.note(static_cast<int>(iterations), std::log10(before / left));
  }
  result.residual = size > 0 ? left / size : 0;
  if (left <= share * size)
    result.failure.clear();
  else if (result.failure.empty())
    result.failure = "STALLED";
  return result;
}

KrylovResult Krylov::solve(std::span<double> right_side, double share) {
  load(right_side);
  KrylovResult result = iterate(share);
  if (!result.failure.empty() && multigrid_.is_kept() &&
      result.iterations < options_.iterations) {  // which may be what is wrong
    const int lost = result.iterations;
    multigrid_.forget();
    set_up();
    result = iterate(share);
    result.iterations += lost;
  }
  if (!result.failure.empty()) return result;
  const double* values = nullptr;
  checked(VecGetArrayRead(solution_, &values));
  for (std::size_t i = 0; i < equation_.size(); ++i)
    if (equation_[i] >= 0) right_side[equation_[i]] = scale_[i] * values[i];
  checked(VecRestoreArrayRead(solution_, &values));
  return result;
}

}  // namespace lacon
