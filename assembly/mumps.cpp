#include "lacon/assembly/mumps.hpp"

#include <dmumps_c.h>
#include <fmt/format.h>
#include <smumps_c.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

/// Numbered as in the MUMPS manual, from 1.
template <class Array>
auto& at(Array& array, int number) {
  return array[number - 1];
}

/// A count of MUMPS; in millions where it is negative.
double count(int value) { return value < 0 ? -1e6 * value : value; }

/// Codes of MUMPS: arrays that it could not have, of real numbers and of integers in the analysis, of any kind later, and one
/// that has to be larger than its limit. What it has set apart too little of (-8, -9) is another matter.
constexpr int without_room = -13, without_memory[] = {-5, -7, without_room, -19};
constexpr int singular = -10;          // a pivot is zero, and nobody looked for another one
constexpr int communicator = -987654;  // "MPI_COMM_WORLD" of the manual
/// Columns that MUMPS eliminates one by one before they go to what follows as one product. Its own 32 take a quarter of the
/// time of a large factor in single precision: one by one they wait for memory.
constexpr int panel = 8;
enum Job { start = -1, end = -2, analyse_job = 1, factorise_job = 2, solve_job = 3 };

void call(DMUMPS_STRUC_C& mumps) { dmumps_c(&mumps); }
void call(SMUMPS_STRUC_C& mumps) { smumps_c(&mumps); }

template <class Real>
struct Structure;
template <>
struct Structure<double> {
  using type = DMUMPS_STRUC_C;
};
template <>
struct Structure<float> {
  using type = SMUMPS_STRUC_C;
};

}  // namespace

template <class Real>
struct Mumps<Real>::State {
  MumpsSettings settings;
  typename Structure<Real>::type mumps{};
  std::vector<MUMPS_INT> first, row;  ///< of sparse right sides

  explicit State(const MumpsSettings& given) : settings(given) {
    mumps.sym = settings.symmetric ? 2 : 0;  // general symmetric: multipliers make the matrix indefinite
    mumps.par = 1;
    mumps.comm_fortran = communicator;
    run(start);
    if (at(mumps.infog, 1) == without_room) throw std::bad_alloc();
    for (int stream = 1; stream <= 3; ++stream) at(mumps.icntl, stream) = 0;
    at(mumps.icntl, 4) = 0;
    if (!settings.symmetric) at(mumps.icntl, 6) = 0;  // the pattern is symmetric: no columns to exchange
    at(mumps.icntl, 7) = 1;                           // our own order, in perm_in
    if (settings.scaled) at(mumps.icntl, 8) = 0;
    at(mumps.icntl, 13) = 1;  // no parallel root: the inertia is exact
    at(mumps.icntl, 14) = settings.symmetric && settings.as_ordered ? 0 : settings.memory_margin;  // it is for pivots that wait
    at(mumps.icntl, 24) = 1;  // report null pivots instead of stopping
    at(mumps.cntl, 3) = static_cast<Real>(settings.singular_pivot);
    if (settings.symmetric && std::is_same_v<Real, float>) at(mumps.keep, 5) = at(mumps.keep, 6) = panel;
    if (settings.low_rank > 0) {
      at(mumps.icntl, 35) = 2;  // in the factorisation and in the solutions
      at(mumps.keep, 482) = 3;  // blocks of what follows in our order: SCOTCH takes long, and others in every run
      at(mumps.cntl, 7) = static_cast<Real>(settings.low_rank);
    }
    if (settings.symmetric && settings.as_ordered) {
      at(mumps.cntl, 1) = 0;
      at(mumps.icntl, 36) = 1;  // blocks are compressed before they are substituted in: no pivot is looked for in them
    }
    if (settings.out_of_core) {
      at(mumps.icntl, 22) = 1;
      if (settings.folder.size() >= sizeof mumps.ooc_tmpdir) fail("SOLVER_5", {{"folder", settings.folder}});
      std::copy(settings.folder.begin(), settings.folder.end(), mumps.ooc_tmpdir);
      mumps.ooc_tmpdir[settings.folder.size()] = '\0';
    }
  }
  ~State() { run(end); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void run(int job) {
    mumps.job = job;
    call(mumps);
  }
  /// -8, -9: delayed pivots took more memory than foreseen
  bool lacks_room() {
    const int code = at(mumps.infog, 1);
    return code == -8 || code == -9;
  }
  /// One half of a substitution, without the border. @param half as ICNTL(26) numbers them
  void substitute_within(int half, std::span<Real> sides, std::span<Real> border) {
    at(mumps.icntl, 26) = half;
    mumps.rhs = sides.data();
    mumps.lrhs = mumps.n;
    mumps.nrhs = static_cast<MUMPS_INT>(sides.size() / static_cast<std::size_t>(mumps.n));
    mumps.redrhs = border.data();
    mumps.lredrhs = mumps.size_schur;
    run(solve_job);
    at(mumps.icntl, 26) = at(mumps.icntl, 20) = 0;
    require("solution");
  }
  /// The next substitution is of sparse right sides. @param solution (n, size)
  void take_sparse(std::span<const std::int64_t> offset, std::span<const std::int32_t> index, std::span<const Real> value,
                   std::span<Real> solution) {
    first.assign(offset.begin(), offset.end());
    row.assign(index.begin(), index.end());
    for (MUMPS_INT& number : first) ++number;
    for (MUMPS_INT& number : row) ++number;
    at(mumps.icntl, 20) = 3;  // used to skip what stays zero
    at(mumps.icntl, 27) = static_cast<MUMPS_INT>(offset.size() - 1);
    mumps.nrhs = static_cast<MUMPS_INT>(offset.size() - 1);
    mumps.lrhs = mumps.n;
    mumps.rhs = solution.data();
    mumps.nz_rhs = static_cast<MUMPS_INT>(index.size());
    mumps.irhs_ptr = first.data();
    mumps.irhs_sparse = row.data();
    mumps.rhs_sparse = const_cast<Real*>(value.data());  // read only
  }
  void require(const char* phase) {
    const int code = at(mumps.infog, 1);
    if (code >= 0) return;
    if (std::ranges::find(without_memory, code) != std::end(without_memory))
      fail("SOLVER_2", {{"phase", phase}, {"equations", std::to_string(mumps.n)}});
    if (code == -90) fail("SOLVER_5", {{"folder", settings.folder}});
    throw std::runtime_error(fmt::format("MUMPS: {} returned INFOG(1) = {}, INFOG(2) = {}", phase, code, at(mumps.infog, 2)));
  }
};

template <class Real>
Mumps<Real>::Mumps(const MumpsSettings& settings) : state_(std::make_unique<State>(settings)) {}
template <class Real>
Mumps<Real>::~Mumps() = default;

template <class Real>
MumpsForecast Mumps<Real>::analyse(const MumpsPattern& pattern) {
  auto& mumps = state_->mumps;
  mumps.n = static_cast<MUMPS_INT>(pattern.place.size());
  mumps.nnz = static_cast<MUMPS_INT8>(pattern.row.size());
  move_entries(pattern.row, pattern.column);
  mumps.perm_in = pattern.place.data();
  if (!pattern.block.empty()) {
    at(mumps.icntl, 15) = 1;  // the analysis is one of blocks: a graph of a ninth of the size in space
    mumps.nblk = static_cast<MUMPS_INT>(pattern.block.size()) - 1;
    mumps.blkptr = pattern.block.data();
  }
  if (!pattern.border.empty()) {
    at(mumps.icntl, 19) = 1;
    mumps.size_schur = static_cast<MUMPS_INT>(pattern.border.size());
    mumps.listvar_schur = pattern.border.data();
  }
  state_->run(analyse_job);
  state_->require("analysis");
  const int megabytes = at(mumps.infog, state_->settings.out_of_core ? 26 : state_->settings.low_rank > 0 ? 36 : 16);
  return {.flops = at(mumps.rinfog, 1), .entries = count(at(mumps.infog, 20)), .bytes = 1e6 * megabytes};
}

template <class Real>
void Mumps<Real>::move_entries(std::span<int> row, std::span<int> column) {
  state_->mumps.irn = row.data();
  state_->mumps.jcn = column.data();
}

template <class Real>
Factorisation Mumps<Real>::factorise(std::span<const Real> values) {
  return factorise(values, {});
}

template <class Real>
Factorisation Mumps<Real>::factorise(std::span<const Real> values, std::span<Real> schur) {
  State& s = *state_;
  s.mumps.a = const_cast<Real*>(values.data());  // read only
  s.mumps.schur = schur.data();
  s.run(factorise_job);
  for (int margin = 2 * s.settings.memory_margin; s.lacks_room() && margin < 2000; margin *= 2) {
    at(s.mumps.icntl, 14) = margin;
    s.run(factorise_job);
  }
  s.mumps.a = s.mumps.schur = nullptr;
  if (s.settings.as_ordered && at(s.mumps.infog, 1) == singular)
    return {.null_pivots = {Factorisation::unknown}, .flops = at(s.mumps.rinfog, 1)};
  s.require("factorisation");
  const bool low_rank = s.settings.low_rank > 0;
  Factorisation found{.flops = at(s.mumps.rinfog, low_rank ? 14 : 3),
                      .entries = static_cast<std::int64_t>(count(at(s.mumps.infog, low_rank ? 35 : 29))),
                      .whole_entries = static_cast<std::int64_t>(count(at(s.mumps.infog, 29)))};
  if (s.settings.symmetric) found.negative_pivots = at(s.mumps.infog, 12);
  for (int i = 0; i < at(s.mumps.infog, 28); ++i) found.null_pivots.push_back(s.mumps.pivnul_list[i] - 1);
  return found;
}

template <class Real>
void Mumps<Real>::substitute(std::span<Real> right_side) {
  auto& mumps = state_->mumps;
  mumps.rhs = right_side.data();
  mumps.lrhs = mumps.n;
  mumps.nrhs = static_cast<MUMPS_INT>(right_side.size() / static_cast<std::size_t>(mumps.n));
  state_->run(solve_job);
  state_->require("solution");
}

template <class Real>
void Mumps<Real>::substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                             std::span<const Real> value, std::span<Real> solution) {
  state_->take_sparse(offset, index, value, solution);
  state_->run(solve_job);
  at(state_->mumps.icntl, 20) = 0;
  state_->require("solution");
}

template <class Real>
void Mumps<Real>::reduce(std::span<Real> sides, std::span<Real> border) {
  state_->substitute_within(1, sides, border);
}

template <class Real>
void Mumps<Real>::reduce(std::span<const std::int64_t> offset, std::span<const std::int32_t> index, std::span<const Real> value,
                         std::span<Real> sides, std::span<Real> border) {
  state_->take_sparse(offset, index, value, sides);
  state_->substitute_within(1, sides, border);
}

template <class Real>
void Mumps<Real>::expand(std::span<Real> border, std::span<Real> sides) {
  state_->substitute_within(2, sides, border);
}

template class Mumps<double>;
template class Mumps<float>;

}  // namespace lacon
