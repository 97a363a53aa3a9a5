#pragma once
// Solves a sequence of saddle-point systems that differ in their multipliers' rows, with few factorisations.
//
// The last rows of the matrix belong to multipliers. The block before them, the stiffness, is often nearly the same from one
// system to the next; then the factor of an earlier matrix serves on. Rows that were switched on or off since are put right
// by a Schur complement, for which one column of the inverse each is computed and kept. Coefficients that moved with
// the bodies, and a stiffness that changed a little, are left to GMRES, preconditioned with that. A cost model decides when a
// new factorisation is cheaper; it counts operations, so that the choice is the same in every run. A matrix that is not
// symmetric is factorised each time.
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lacon/assembly/engine.hpp"
#include "lacon/assembly/packed_vector.hpp"
#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon::hdf5 {
class Group;
}

namespace lacon {

struct SaddlePointOptions {
  bool reuse = true;         ///< false: every matrix is factorised
  double tolerance = 1e-12;  ///< of GMRES, against the largest right side so far
  double least_gain = 1e-4;  ///< of GMRES, against the right side itself,
  double last_gain = 1e-2;   ///< where that is round-off already: below the tolerance
  double rough_gain = 1e-4;  ///< likewise, where a rough solution will do
  double singular = 1e-6;    ///< reciprocal condition of the Schur complement, in single precision, below which the matrix is
                             ///< factorised anew: a body may have come loose
  double stiffness_drift = 0.02;  ///< largest change of an entry of the stiffness, of its diagonals, that is left to GMRES
  double drift = 0.3;             ///< relative change of a row's coefficients above which its column is computed anew
  double work_limit = 1;          ///< most operations without a new factorisation, of those of a factorisation
  double column_memory = 0.2;     ///< largest memory of whole columns, of a whole factor's in double precision,
  double least_memory = 32e6;     ///< or so much, in doubles
  double more_columns = 0.5;      ///< operations of columns(), of those of a factorisation,
  double least_columns = 1e9;     ///< or so many: in small systems they are not what takes time
};

/// Right sides with few entries. Those that switch a multiplier's row, and say which: of one that is off its coefficients,
/// ascending; of one that is on, 1 in its own equation.
struct SparseSides {
  std::vector<std::int64_t> offset{0};
  std::vector<std::int32_t> index;  ///< entries offset[c] to offset[c + 1] of side c
  std::vector<double> value;
  std::vector<std::int64_t> rows;  ///< that each switches, or -1
  std::vector<std::uint8_t> on;    ///< whether it switches that one on

  std::size_t size() const { return rows.size(); }
  void add_entry(std::int64_t equation, double of_it) {
    index.push_back(static_cast<std::int32_t>(equation));
    value.push_back(of_it);
  }
  void end_side(std::int64_t row = -1, bool switches_on = false) {
    offset.push_back(static_cast<std::int64_t>(index.size()));
    rows.push_back(row);
    on.push_back(switches_on);
  }
  void add_side(const SparseSides& other, std::size_t side) {
    for (auto k = static_cast<std::size_t>(other.offset[side]); k < static_cast<std::size_t>(other.offset[side + 1]); ++k)
      add_entry(other.index[k], other.value[k]);
    end_side(other.rows[side], other.on[side]);
  }
};

/// How exact a solution has to be.
struct Accuracy {
  bool rough = false;  ///< another one corrects it: GMRES need not go further than the rough gain
  double share = 0;    ///< of the right side, that may be left where the engine iterates itself
};

/// How a system was solved.
struct SolutionReport {
  bool factorised = false;
  Factorisation factorisation;  ///< what the factorisation found, where there was one
  int columns = 0;              ///< of the inverse, computed anew
  int iterations = 0;           ///< of GMRES
  bool rough = false;           ///< iterations went no further than a rough solution
  double analysis_seconds = 0, factorisation_seconds = 0, solution_seconds = 0;
};

class SaddlePointSolver {
 public:
  /// With an engine that keeps no factor (FactorEngine), every matrix is factorised.
  explicit SaddlePointSolver(std::unique_ptr<Engine> engine, const SaddlePointOptions& options = {});

  /// Solve A x = b in place. @param first_multiplier rows from here on are multipliers'
  /// Where the report has null pivots, the matrix is singular and `right_side` is left as it was.
  /// Throws SOLVER_1, SOLVER_2.
  SolutionReport solve(const SparseMatrix& matrix, std::int64_t first_multiplier, std::span<double> right_side,
                       const Accuracy& accuracy = {});
  /// Another right side of the matrix that was solved with last.
  SolutionReport solve_again(const SparseMatrix& matrix, std::span<double> right_side, const Accuracy& accuracy = {});
  /// How many columns of its inverse are worth their price beside a solution.
  std::size_t affordable_columns(const SparseMatrix& matrix) const;
  /// What right sides give with that matrix, to about the digits of its factor: nobody looks at residuals. Where memory allows,
  /// those that switch rows are there already for a matrix in which these are switched.
  /// @param sides at most affordable_columns()  @param use gets the solution of each in turn, (size), which lives as long as
  /// that call; is not called where there is no way to them
  SolutionReport columns(const SparseMatrix& matrix, const SparseSides& sides,
                         const std::function<void(std::span<const float>)>& use);
  /// The graph of the matrix to be solved with next (Engine::expect): of the first one, for its factor may serve others.
  void expect(const VertexGraph& graph) {
    if (kept_ == Kept::nothing) engine_->expect(graph);
  }
  /// Where nodes are for the matrices to come (Engine::place_nodes), (n_nodes, 3).
  void place_nodes(std::span<const double> coordinates) { engine_->place_nodes(coordinates); }
  /// Right sides so far were those of a computation that failed: they say nothing of how exact the next solution has to be.
  void forget_right_sides() { reference_ = 0; }

  /// What later solutions depend on, for another process that goes on with the same bits: what save_base() saves and, in
  /// save(), how it is used. The base is large and changes only where base_number() does; 0: there is
  /// none, or other processes have it: a new one is made then, with the digits of this one.
  void save(const hdf5::Group& group) const;
  void save_base(const hdf5::Group& group) const;
  std::int64_t base_number() const { return kept_ == Kept::factor && !base_->elsewhere() ? factorisations_ : 0; }
  /// Of a solver that has solved nothing yet. @param base what save_base() made; nullptr where base_number() was 0
  /// Throws BASE_2, SOLVER_2.
  void resume(const hdf5::Group& group, const hdf5::Group* base, const Numbering& numbering);

 private:
  /// The part of the inverse that a switched row needs: for a row switched on, of its coefficients; for one switched off, of
  /// its own unit vector.
  struct Column {
    std::vector<std::int32_t> index;
    std::vector<double> coefficient;
    std::int64_t block = 0;    ///< in which it was computed
    std::vector<float> whole;  ///< (n); GMRES makes up for the digits, and the memory is half;
    PackedVector packed;       ///< or so,
    std::vector<float> seen;   ///< with what rows of multipliers see of it
    bool is_bare() const { return whole.empty() && packed.empty(); }
  };
  /// Multipliers' rows that are not what they were when the factor was made, ascending.
  struct Switched {
    std::vector<std::int64_t> on, off;
    std::vector<std::int64_t> scaled;  ///< off then and now, with another diagonal
  };
  class Preconditioner;
  /// What of the engine's work stands.
  enum class Kept { nothing, analysis, factor };

  Kept kept_behind(const Factorisation& factor) const;
  /// With that of the last factorisation, of the matrix as it is.
  void solve_with_factor(const SparseMatrix& matrix, std::span<double> right_side, const Accuracy& accuracy,
                         SolutionReport& report);
  /// Nothing where rows of multipliers meet each other.
  std::optional<Switched> switched_rows(const SparseMatrix& matrix) const;
  bool corrected(const SparseMatrix& matrix, std::span<double> right_side, bool rough, SolutionReport& report);
  /// Whether no motion is free in the matrix itself, where the factor is too inexact for its complement to tell.
  /// @param scale of the equations, (n)
  bool holds_all(const SparseMatrix& matrix, const Preconditioner& preconditioner, std::span<const double> scale,
                 SolutionReport& report) const;
  bool make_columns(const SparseMatrix& matrix, const Switched& switched, SolutionReport& report);
  /// Columns of rows that are as they were when the factor was made: those that are there, and all others if memory allows.
  std::vector<const Column*> columns_ahead(const Switched& switched, const SparseSides& sides, SolutionReport& report);
  const Column* known(const SparseSides& sides, std::size_t side) const;
  bool has_room_for(std::size_t more) const;
  void drop_columns_but(const Switched& switched);
  void compute(SparseSides block);
  /// Whether whole columns are packed: a factor of low rank has no more digits.
  bool packs() const { return factor_.low_rank; }
  /// All of a column that is not bare, (n). @param room for one that is packed
  std::span<const float> unpacked(const Column& column, std::vector<float>& room) const;
  /// Of a column what rows of multipliers see is kept. Where its motion is needed a substitution makes it anew, together with
  /// those of all such columns.
  void make_bare(Column& column);
  const std::vector<std::int32_t>& interface();
  bool has_bare_columns() const;
  /// What makes the residuals of displacements and of multipliers comparable, (n).
  std::vector<double> scales(const SparseMatrix& matrix);
  double factorisation_cost() const;
  double solution_cost() const;
  double column_cost() const;
  int most_iterations() const;

  SaddlePointOptions options_;
  std::unique_ptr<Engine> engine_;
  FactorEngine* substitution_;  ///< the same, where it keeps a factor
  std::int64_t first_multiplier_ = 0;
  Kept kept_ = Kept::nothing;
  bool ready_ = false;                ///< the engine, for the matrix that was solved with last
  std::optional<SparseMatrix> base_;  ///< the matrix that this is of
  Factorisation factor_;
  std::int64_t factorisations_ = 0;  ///< so far
  std::map<std::int64_t, Column> columns_;
  std::vector<std::int32_t> interface_;  ///< equations that rows of multipliers see in the base, and these themselves
  /// Columns that were computed together, as their bits may depend on their company: those that some are from, by number.
  std::map<std::int64_t, SparseSides> blocks_;
  std::map<std::int64_t, double> multiplier_scale_;  ///< c.c / K of rows when they last had coefficients
  double reference_ = 0;                             ///< largest right side so far, scaled
  int expected_iterations_ = 4;
};

}  // namespace lacon
