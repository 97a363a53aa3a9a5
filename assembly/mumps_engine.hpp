#pragma once
// MUMPS, in the order of METIS: for symmetric indefinite matrices, whose inertia it knows, and for general ones.
//
// Where the matrix is large the factor is made in single precision, of low-rank blocks where that is less work still. GMRES on
// the matrix in double precision gives the solution all its digits back. Such a factor has to prove itself: no pivot near
// zero, and no vector that it leaves much of, so that the matrix has its inertia and its free motions. That vector goes along
// with the first right sides of a solution, for two cost hardly more than one. Where it does not, or
// GMRES stalls, there is a factor in double precision from then on. Low-rank blocks of a symmetric matrix are eliminated as
// ordered at first, for multipliers come behind what they hold; where such a factor fails, pivots are looked for from then on.
// A factor that processes share (tree/) is one of these: its pivots are looked for within subtrees.
#include <memory>
#include <string>

#include "lacon/assembly/engine.hpp"

namespace lacon {

struct MumpsOptions {
  /// Of what makes a factor cheaper and less exact.
  enum class Use { never, where_it_pays, always };
  enum class Memory { in_core, out_of_core, where_needed };

  int memory_margin = 20;                     ///< PCENT_PIVOT, percent
  double singular_pivot = 1e-13;              ///< a pivot below this fraction of the scaled matrix is zero: a mechanism is left
  double residual_tolerance = 1e-6;           ///< RESI_RELA: largest relative residual of a solution; negative: not checked
  Use single_precision = Use::where_it_pays;  ///< MIXER_PRECISION
  Use low_rank = Use::where_it_pays;          ///< ACCELERATION
  double low_rank_threshold = 0;              ///< LOW_RANK_SEUIL: of the matrix; 0: the engine's own
  Memory memory = Memory::where_needed;       ///< GESTION_MEMOIRE: whether the factor is in files
  std::string folder = "factor";              ///< of these files alone: it is made and removed
  int processes = 1;                          ///< that share a factor
  bool processes_required = true;             ///< false: where they cannot be started one process makes it
  std::int64_t least_shared = 0;              ///< equations from which on they do
  std::string program;                        ///< lacon_mumps; empty: beside the program that runs
};

class MumpsEngine : public FactorEngine {
 public:
  explicit MumpsEngine(const MumpsOptions& options = {});
  ~MumpsEngine() override;
  MumpsEngine(const MumpsEngine&) = delete;
  MumpsEngine& operator=(const MumpsEngine&) = delete;

  void expect(const VertexGraph& graph) override;
  void analyse(const SparseMatrix& matrix) override;
  Factorisation factorise(const SparseMatrix& matrix) override;
  Factorisation factorise_to_solve(const SparseMatrix& matrix) override;
  /// Refined until the residual is at round-off or stops falling. Throws SOLVER_1 where it is above the tolerance.
  Solution solve(std::span<double> right_side) override;
  Care care() const override;
  void take(Care care) override;
  /// Those that share factors, where they have to.
  std::shared_ptr<PartProcesses> processes(std::int64_t n_equations) const override;
  void substitute(std::span<double> right_side) override;
  std::vector<float> substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                std::span<const double> value) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lacon
