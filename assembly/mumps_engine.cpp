#include "lacon/assembly/mumps_engine.hpp"

#include <dmumps_c.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lacon/assembly/ordering.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

/// Numbered as in the MUMPS manual, from 1.
template <class Array>
auto& at(Array& array, int number) {
  return array[number - 1];
}

constexpr int mumps_communicator = -987654;  // "MPI_COMM_WORLD" of the manual
enum Job { start = -1, end = -2, analyse_job = 1, factorise_job = 2, solve_job = 3 };

double largest(std::span<const double> values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

}  // namespace

struct MumpsEngine::State {
  MumpsOptions options;
  DMUMPS_STRUC_C mumps{};
  const SparseMatrix* matrix = nullptr;  ///< whose factor is kept
  std::vector<MUMPS_INT> row, column;
  std::vector<MUMPS_INT> place;

  explicit State(const MumpsOptions& given) : options(given) { begin(true); }
  ~State() { call(end); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void begin(bool symmetric) {
    mumps = {};
    mumps.sym = symmetric ? 2 : 0;  // general symmetric: multipliers make the matrix indefinite
    mumps.par = 1;
    mumps.comm_fortran = mumps_communicator;
    call(start);
    for (int stream = 1; stream <= 3; ++stream) at(mumps.icntl, stream) = 0;
    at(mumps.icntl, 4) = 0;
    if (!symmetric) at(mumps.icntl, 6) = 0;  // the pattern is symmetric: no columns to exchange
    at(mumps.icntl, 7) = 1;                  // our own order, in perm_in
    at(mumps.icntl, 13) = 1;                 // no parallel root: the inertia is exact
    at(mumps.icntl, 14) = options.memory_margin;
    at(mumps.icntl, 24) = 1;  // report null pivots instead of stopping
    at(mumps.cntl, 3) = options.singular_pivot;
  }
  bool is_symmetric() const { return mumps.sym == 2; }
  void call(int job) {
    mumps.job = job;
    dmumps_c(&mumps);
  }
  [[noreturn]] void refuse(const char* phase) {
    const int code = at(mumps.infog, 1);
    if (code == -13 || code == -19) fail("SOLVER_2", {{"phase", phase}, {"equations", std::to_string(mumps.n)}});
    throw std::runtime_error(fmt::format("MUMPS: {} returned INFOG(1) = {}, INFOG(2) = {}", phase, code, at(mumps.infog, 2)));
  }
};

MumpsEngine::MumpsEngine(const MumpsOptions& options) : state_(std::make_unique<State>(options)) {}
MumpsEngine::~MumpsEngine() = default;

void MumpsEngine::analyse(const SparseMatrix& matrix) {
  State& s = *state_;
  s.matrix = nullptr;
  if (matrix.is_symmetric() != s.is_symmetric()) {
    s.call(end);
    s.begin(matrix.is_symmetric());
  }
  s.row.clear();
  s.column.clear();
  for (std::int64_t row = 0; row < matrix.size(); ++row)
    for (std::int64_t k = matrix.rows()[row]; k < matrix.rows()[row + 1]; ++k) {
      s.row.push_back(static_cast<MUMPS_INT>(row + 1));
      s.column.push_back(matrix.columns()[k] + 1);
    }
  const std::vector<std::int32_t> order = elimination_order(matrix);
  s.place.assign(order.begin(), order.end());
  for (MUMPS_INT& p : s.place) ++p;
  s.mumps.n = static_cast<MUMPS_INT>(matrix.size());
  s.mumps.nnz = matrix.n_entries();
  s.mumps.irn = s.row.data();
  s.mumps.jcn = s.column.data();
  s.mumps.perm_in = s.place.data();
  s.mumps.a = nullptr;  // no values yet
  s.call(analyse_job);
  if (at(s.mumps.infog, 1) < 0) s.refuse("analysis");
}

Factorisation MumpsEngine::factorise(const SparseMatrix& matrix) {
  State& s = *state_;
  s.matrix = &matrix;
  s.mumps.a = const_cast<double*>(matrix.values().data());  // read only
  s.call(factorise_job);
  // -8, -9: delayed pivots took more memory than foreseen
  for (int margin = 2 * s.options.memory_margin; (at(s.mumps.infog, 1) == -8 || at(s.mumps.infog, 1) == -9) && margin < 2000;
       margin *= 2) {
    at(s.mumps.icntl, 14) = margin;
    s.call(factorise_job);
  }
  if (at(s.mumps.infog, 1) < 0) s.refuse("factorisation");
  Factorisation found{.negative_pivots = {}, .null_pivots = {}, .flops = at(s.mumps.rinfog, 3)};
  if (s.is_symmetric()) found.negative_pivots = at(s.mumps.infog, 12);
  const std::int64_t entries = at(s.mumps.infog, 29);  // in millions where negative
  found.entries = entries < 0 ? -1'000'000 * entries : entries;
  for (int i = 0; i < at(s.mumps.infog, 28); ++i) found.null_pivots.push_back(s.mumps.pivnul_list[i] - 1);
  return found;
}

void MumpsEngine::substitute(std::span<double> right_side) {
  State& s = *state_;
  s.mumps.rhs = right_side.data();
  s.mumps.nrhs = 1;
  s.call(solve_job);
  if (at(s.mumps.infog, 1) < 0) s.refuse("solution");
}

std::vector<double> MumpsEngine::substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                            std::span<const double> value) {
  State& s = *state_;
  const std::size_t count = offset.size() - 1;
  std::vector<double> solution(count * static_cast<std::size_t>(s.matrix->size()));
  std::vector<MUMPS_INT> start(offset.begin(), offset.end()), row(index.begin(), index.end());
  for (MUMPS_INT& number : start) ++number;
  for (MUMPS_INT& number : row) ++number;
  at(s.mumps.icntl, 20) = 3;  // sparse, and used to skip what stays zero
  at(s.mumps.icntl, 27) = static_cast<MUMPS_INT>(count);
  s.mumps.nrhs = static_cast<MUMPS_INT>(count);
  s.mumps.lrhs = s.mumps.n;
  s.mumps.rhs = solution.data();
  s.mumps.nz_rhs = static_cast<MUMPS_INT>(index.size());
  s.mumps.irhs_ptr = start.data();
  s.mumps.irhs_sparse = row.data();
  s.mumps.rhs_sparse = const_cast<double*>(value.data());  // read only
  s.call(solve_job);
  at(s.mumps.icntl, 20) = 0;
  if (at(s.mumps.infog, 1) < 0) s.refuse("solution");
  return solution;
}

double MumpsEngine::solve(std::span<double> right_side) {
  State& s = *state_;
  const std::size_t n = right_side.size();
  std::vector<double> x(n, 0.0), step(right_side.begin(), right_side.end()), residual(n), best(n);
  const double norm = s.matrix->norm();
  double error = INFINITY;
  constexpr int most_refinements = 4;
  for (int i = 0; i <= most_refinements; ++i) {
    substitute(step);
    for (std::size_t k = 0; k < n; ++k) x[k] += step[k];
    s.matrix->multiply(x, residual);
    for (std::size_t k = 0; k < n; ++k) residual[k] = right_side[k] - residual[k];
    const double scale = norm * largest(x) + largest(right_side);
    const double now = scale > 0 ? largest(residual) / scale : 0;
    if (!(now < error)) break;  // refinement no longer helps: keep the solution before
    error = now;
    best = x;
    if (error < 1e-15) break;
    step = residual;
  }
  if (!std::isfinite(error) || (s.options.residual_tolerance > 0 && error > s.options.residual_tolerance))
    fail("SOLVER_1",
         {{"error", fmt::format("{:.1e}", error)}, {"tolerance", fmt::format("{:.1e}", s.options.residual_tolerance)}});
  std::copy(best.begin(), best.end(), right_side.begin());
  return error;
}

}  // namespace lacon
