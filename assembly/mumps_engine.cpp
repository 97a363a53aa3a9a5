#include "lacon/assembly/mumps_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <type_traits>

#include "lacon/assembly/factor_proof.hpp"
#include "lacon/assembly/gmres.hpp"
#include "lacon/assembly/mumps.hpp"
#include "lacon/assembly/ordering.hpp"
#include "lacon/assembly/tree/ordering_ahead.hpp"
#include "lacon/assembly/tree/tree_mumps.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

using Use = MumpsOptions::Use;

/// Below so many equations nothing is gained, and nothing is tried.
constexpr std::int64_t least_equations = 20'000;
/// Operations of a factorisation for each entry of its factor from which on half of their time is worth the substitutions that
/// single precision takes more, and low-rank blocks are worth their analysis. Measured (docs/performance.md).
constexpr double single_precision_pays = 500, low_rank_pays = 1500;
constexpr double own_low_rank_threshold = 1e-5;

/// A factor that is not exact has to have no smaller pivot, of the scaled matrix.
constexpr double doubtful_pivot = 1e-6;
/// Rows that a thread scales at a time.
constexpr std::size_t rows_together = 4096;
/// GMRES between two residuals that are computed anew.
constexpr double gain = 1e-7;
constexpr int most_iterations = 30;

/// What is no better than round-off, and what has to be reached with a factor that is not exact.
constexpr double round_off = 1e-15, least_accuracy = 1e-13;

double largest(std::span<const double> values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

/// What the system would give without taking it from others, bytes.
double available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string name, unit;
  for (double kilobytes; file >> name >> kilobytes; std::getline(file, unit))
    if (name == "MemAvailable:") return 1024 * kilobytes;
  return INFINITY;
}

/// How a factor is made.
struct Form {
  bool single_precision = false, low_rank = false, out_of_core = false, shared = false, as_ordered = false;
  bool is_exact() const { return !single_precision && !low_rank && !shared; }
};

}  // namespace

struct MumpsEngine::State {
  using Care = Engine::Care;
  MumpsOptions options;
  Care care = Care::none;           ///< from now on
  std::vector<int> row, column;     ///< of entries, where one process makes the factor
  std::vector<int> place, block;    ///< of MumpsPattern
  Ragged<std::int32_t> neighbours;  ///< of the whole matrix
  std::optional<VertexGraph> graph;
  Form form;
  std::optional<Subtrees> subtrees;  ///< where processes may share the factor
  std::shared_ptr<MumpsProcesses> processes;
  OrderingAhead ahead;
  std::optional<std::string> unshared;        ///< Factorisation::unshared, empty once it is told
  std::unique_ptr<MumpsFactor<double>> full;  ///< one of the two
  std::unique_ptr<MumpsFactor<float>> single;
  const SparseMatrix* matrix = nullptr;  ///< whose factor is kept
  std::vector<double> scale;             ///< of its rows and columns, where it is scaled before
  std::vector<std::int64_t> alone;       ///< likewise: unknowns that their row alone decides, such as pressures of open patches
  bool has_folder = false;
  std::optional<FactorProof> proof;  ///< of a factor that is not exact, where it is to be given yet

  explicit State(const MumpsOptions& given)
      : options(given), processes(std::make_shared<MumpsProcesses>(given.processes, given.program)) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    full.reset();
    single.reset();
    std::error_code ignored;
    if (has_folder) std::filesystem::remove_all(options.folder, ignored);
  }

  /// An empty folder for files: whoever was ended may have left some there.
  void make_folder() {
    if (has_folder) return;
    std::error_code error;
    std::filesystem::remove_all(options.folder, error);
    std::filesystem::create_directories(options.folder, error);
    if (error) fail("SOLVER_5", {{"folder", options.folder}});
    has_folder = true;
  }

  double low_rank_threshold() const {
    return options.low_rank_threshold != 0 ? std::abs(options.low_rank_threshold) : own_low_rank_threshold;
  }

  MumpsForecast prepare(const Form& wanted, bool symmetric) {
    form = wanted;
    form.as_ordered = form.low_rank && symmetric && care == Care::none;
    full.reset();
    single.reset();
    if (form.out_of_core) make_folder();
    const MumpsSettings settings{.symmetric = symmetric,
                                 .memory_margin = options.memory_margin,
                                 .singular_pivot = form.is_exact() ? options.singular_pivot : doubtful_pivot,
                                 .scaled = !form.is_exact(),
                                 .low_rank = form.low_rank ? low_rank_threshold() : 0,
                                 .as_ordered = form.as_ordered,
                                 .out_of_core = form.out_of_core,
                                 .folder = options.folder};
    if (!form.shared) list_entries(symmetric);
    const MumpsPattern pattern{
        .row = row, .column = column, .place = place, .block = block, .border = {}, .graph = form.shared ? &*graph : nullptr};
    if (!form.single_precision) return (full = made<double>(settings))->analyse(pattern);
    return (single = made<float>(settings))->analyse(pattern);
  }
  void list_entries(bool symmetric) {
    std::size_t count = 0;
    graph->for_each_entry(symmetric, [&](std::int32_t, std::int32_t) { ++count; });
    row.clear();
    column.clear();
    row.reserve(count);
    column.reserve(count);
    graph->for_each_entry(symmetric, [&](std::int32_t i, std::int32_t j) {
      row.push_back(i + 1);
      column.push_back(j + 1);
    });
  }
  template <class Real>
  std::unique_ptr<MumpsFactor<Real>> made(const MumpsSettings& settings) {
    if (form.shared) return std::make_unique<TreeMumps<Real>>(settings, *subtrees, *processes);
    return std::make_unique<Mumps<Real>>(settings);
  }

  bool may_share(std::int64_t n_equations) const { return options.processes > 1 && n_equations >= options.least_shared; }
  /// Of the graph. @param[out] subtrees where processes may share the factor
  std::vector<std::int32_t> ordered() {
    subtrees.reset();
    if (!may_share(graph->numbering.n_equations())) return elimination_order(*graph);
    SharedOrder found = ahead.take(*graph, *processes);
    subtrees = std::move(found.subtrees);
    if (subtrees->process.size() < 2 || !has_processes()) subtrees.reset();  // one alone would wait for the others
    return std::move(found.order);
  }
  /// Throws SOLVER_8 where there have to be some.
  bool has_processes() {
    try {
      processes->start();
      return true;
    } catch (const std::exception& error) {  // of the system too: no descriptors left, say
      if (options.processes_required) throw;
      const Error* const told = dynamic_cast<const Error*>(&error);
      if (!unshared) unshared = told ? told->message().text : error.what();
      return false;
    }
  }

  /// The cheapest form that the options allow. @param order of elimination
  void choose(const SparseMatrix& of, std::span<const std::int32_t> order) {
    const bool symmetric = of.is_symmetric();
    const bool in_files = options.memory == MumpsOptions::Memory::out_of_core;
    const bool exact = care == Care::exact;
    const auto asks = [&](Use use) { return !exact && use == Use::always; };
    const auto may = [&](Use use) { return !exact && use == Use::where_it_pays && of.size() >= least_equations; };
    Form wanted{.single_precision = asks(options.single_precision) || may(options.single_precision),
                .low_rank = asks(options.low_rank) && !in_files,  // MUMPS has no low-rank factors in files
                .out_of_core = in_files,
                .shared = subtrees && !exact && !in_files};
    if (may(options.single_precision) || (may(options.low_rank) && wanted.single_precision)) {
      const EliminationCounts counts = subtrees ? subtrees->whole : elimination_counts(*graph, order);
      const double work = counts.flops / counts.entries;
      const bool is_cheap = may(options.single_precision) && work < single_precision_pays;
      if (is_cheap)
        wanted.single_precision = false;
      else if (may(options.low_rank) && wanted.single_precision && !in_files && work > low_rank_pays)
        wanted.low_rank = true;
    }
    const MumpsForecast forecast = prepare(wanted, symmetric);
    if (options.memory == MumpsOptions::Memory::where_needed && of.size() >= least_equations &&
        forecast.bytes > available_memory())
      prepare({.single_precision = wanted.single_precision, .out_of_core = true}, symmetric);
  }

  Factorisation factorise_as_prepared() {
    Factorisation found;
    std::optional<SparseMatrix> whole;  // where one process makes the factor
    if (matrix->elsewhere() && !form.shared) whole = matrix->elsewhere()->whole(*matrix);
    const SparseMatrix& of = whole ? *whole : *matrix;
    if (!form.shared && row.empty()) {
      list_entries(of.is_symmetric());
      single ? single->move_entries(row, column) : full->move_entries(row, column);
    }
    scale = form.is_exact() ? of.multiplier_scale() : of.equilibration();
    if (form.is_exact() && std::ranges::all_of(scale, [](double d) { return d == 1; })) {
      scale.clear();
      found = full->factorise(of.values());
    } else {
      alone = matrix->rows_alone();
      found = single ? factorise_scaled(*single, of) : factorise_scaled(*full, of);
    }
    row = std::vector<int>();  // with its memory
    column = std::vector<int>();
    found.single_precision = form.single_precision;
    found.low_rank = form.low_rank;
    found.out_of_core = form.out_of_core;
    found.processes = form.shared ? processes->size() : 1;
    return found;
  }
  template <class Real>
  Factorisation factorise_scaled(MumpsFactor<Real>& mumps, const SparseMatrix& of) {
    if (of.elsewhere()) return dynamic_cast<TreeMumps<Real>&>(mumps).factorise(of, scale);
    const auto n = static_cast<std::size_t>(of.n_entries());
    const auto values = std::make_unique_for_overwrite<Real[]>(n);
    parallel_for(of.size(), rows_together, [&](const LoopBlock& rows) {
      for (std::size_t i = rows.first; i < rows.last; ++i)
        for (std::int64_t k = of.rows()[i]; k < of.rows()[i + 1]; ++k)
          values[k] = static_cast<Real>(scale[i] * of.values()[k] * scale[of.columns()[k]]);
    });
    return mumps.factorise(std::span<const Real>(values.get(), n));
  }

  void take(const SparseMatrix& of) {
    matrix = &of;
    if (care == Care::exact && !form.is_exact()) prepare({.out_of_core = form.out_of_core}, of.is_symmetric());
  }

  /// In files where there is no memory.
  Factorisation factorise() {
    try {
      return factorise_as_prepared();
    } catch (const Error& error) {
      if (error.message().id != "SOLVER_2" || form.out_of_core || options.memory != MumpsOptions::Memory::where_needed) throw;
    }
    prepare({.single_precision = form.single_precision, .out_of_core = true}, matrix->is_symmetric());
    return factorise_as_prepared();
  }

  /// One that is exact, or has a proof to give.
  Factorisation factorise_with_proof() {
    proof.reset();
    Factorisation found = factorise();
    if (form.is_exact()) return found;
    if (!found.null_pivots.empty())
      return factorise_with_more_care(part("pivot_too_small", {{"limit", fmt::format("{:.0e}", doubtful_pivot)}}),
                                      found.flops + found.wasted_flops);
    proof.emplace(*matrix, scale);
    return found;
  }
  /// One that has proved itself, or is exact.
  Factorisation factorise_safely() {
    Factorisation found = factorise_with_proof();
    if (!proof) return found;
    try {
      found.error = proved_error();
    } catch (const Unproved& unproved) {
      return factorise_with_more_care(unproved.doubt, found.flops + found.wasted_flops);
    }
    return found;
  }

  /// With what has not been said yet of processes that do not share it.
  Factorisation telling(Factorisation found) {
    if (unshared) found.unshared = std::exchange(*unshared, std::string());
    return found;
  }

  /// A factor that does without what has failed, now and from now on.
  Factorisation factorise_with_more_care(const std::string& doubt, double wasted) {
    care = form.as_ordered ? Care::pivots : Care::exact;
    prepare(care == Care::pivots ? form : Form{.out_of_core = form.out_of_core}, matrix->is_symmetric());
    Factorisation found = factorise_safely();
    found.wasted_flops += wasted;
    if (care == Care::exact && found.doubt.empty()) found.doubt = doubt;
    return found;
  }

  void substitute(std::span<double> right_side) {
    if (scale.empty())
      full->substitute(right_side);
    else
      substitute_scaled({&right_side, 1});
  }
  void substitute_scaled(std::span<const std::span<double>> sides) {
    single ? substitute_scaled(*single, sides) : substitute_scaled(*full, sides);
  }
  template <class Real>
  void substitute_scaled(MumpsFactor<Real>& mumps, std::span<const std::span<double>> sides) {
    const std::size_t n = scale.size();
    std::vector<double> most, decided;
    std::vector<Real> x;
    x.reserve(n * sides.size());
    for (const std::span<double> side : sides) {
      double& size = most.emplace_back(0);
      for (std::size_t i = 0; i < n; ++i) size = std::max(size, std::abs(scale[i] * side[i]));
      for (const std::int64_t i : alone) decided.push_back(side[i] / matrix->diagonal(i));
      for (std::size_t i = 0; i < n; ++i) x.push_back(static_cast<Real>(size == 0 ? 0 : scale[i] * side[i] / size));
    }
    if (largest(most) == 0) return;
    mumps.substitute(x);
    for (std::size_t c = 0; c < sides.size(); ++c) {
      for (std::size_t i = 0; i < n; ++i) sides[c][i] = most[c] * scale[i] * static_cast<double>(x[c * n + i]);
      for (std::size_t k = 0; k < alone.size(); ++k) sides[c][alone[k]] = decided[c * alone.size() + k];
    }
  }

  /// A factor that has failed to prove itself.
  struct Unproved {
    std::string doubt;
  };
  /// One more step of the proof. @param x the factor's solution for the next right side  Throws Unproved.
  void look(std::span<const double> x) {
    if (!proof->look(x)) throw Unproved{part("motion_left", {{"share", fmt::format("{:.1g}", proof->error())}})};
  }
  /// What is still to be proved. @return Factorisation::error  Throws Unproved.
  double proved_error() {
    while (std::optional<std::vector<double>> x = proof->next()) {
      substitute(*x);
      look(*x);
    }
    const double error = proof->error();
    proof.reset();
    return error;
  }
  /// With a step of the proof where there is one to be taken. Throws Unproved.
  void substitute_and_look(std::span<double> right_side) {
    std::optional<std::vector<double>> x = proof ? proof->next() : std::nullopt;
    if (!x) return substitute(right_side);
    const std::span<double> both[] = {right_side, *x};
    substitute_scaled(both);
    look(*x);
  }

  /// Refined; likewise.
  Solution solve(std::span<double> right_side);
  /// With another factor.
  Solution solve_with_more_care(const std::string& doubt, std::span<double> right_side) {
    const Factorisation again = factorise_with_more_care(doubt, 0);
    Solution second = again.null_pivots.empty() ? solve(right_side) : Solution{};
    if (!second.again)
      second.again = again;
    else
      second.again->wasted_flops += again.flops + again.wasted_flops;
    return second;
  }
};

MumpsEngine::MumpsEngine(const MumpsOptions& options) : state_(std::make_unique<State>(options)) {}
MumpsEngine::~MumpsEngine() = default;

Engine::Care MumpsEngine::care() const { return state_->care; }
void MumpsEngine::take(Care care) { state_->care = care; }

std::shared_ptr<PartProcesses> MumpsEngine::processes(std::int64_t n_equations) const {
  const MumpsOptions& options = state_->options;
  const bool share = options.processes > 1 && options.processes_required && n_equations >= options.least_shared &&
                     options.memory != MumpsOptions::Memory::out_of_core;
  return share ? state_->processes : nullptr;
}

void MumpsEngine::expect(const VertexGraph& graph) {
  const bool has_factor = state_->full || state_->single;  // its processes have to hear first that they may forget it
  if (!has_factor && state_->may_share(graph.numbering.n_equations())) state_->ahead.begin(graph, *state_->processes);
}

void MumpsEngine::analyse(const SparseMatrix& matrix) {
  State& s = *state_;
  s.matrix = nullptr;
  s.full.reset();
  s.single.reset();
  s.neighbours = matrix.elsewhere() ? matrix.elsewhere()->graph(matrix) : matrix.neighbours();
  s.graph.emplace(VertexGraph{s.neighbours, matrix.numbering()});
  const std::vector<std::int32_t> order = s.ordered();
  s.place.assign(order.begin(), order.end());
  for (int& p : s.place) ++p;
  s.block.clear();
  const std::vector<std::int64_t>& first = matrix.numbering().first;
  for (std::size_t v = 0; v + 1 < first.size(); ++v)
    if (first[v] < first[v + 1]) s.block.push_back(static_cast<int>(first[v]) + 1);
  s.block.push_back(static_cast<int>(first.back()) + 1);
  s.choose(matrix, order);
}

Factorisation MumpsEngine::factorise(const SparseMatrix& matrix) {
  state_->take(matrix);
  return state_->telling(state_->factorise_safely());
}

Factorisation MumpsEngine::factorise_to_solve(const SparseMatrix& matrix) {
  state_->take(matrix);
  return state_->telling(state_->factorise_with_proof());
}

void MumpsEngine::substitute(std::span<double> right_side) { state_->substitute(right_side); }

std::vector<float> MumpsEngine::substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                           std::span<const double> value) {
  State& s = *state_;
  const std::size_t n = static_cast<std::size_t>(s.matrix->size()), size = (offset.size() - 1) * n;
  const auto solve = [&]<class Real>(MumpsFactor<Real>& mumps) {
    std::vector<Real> values(value.begin(), value.end()), solution(size);
    std::vector<double> most(offset.size() - 1, 0.0);
    if (!s.scale.empty())
      for (std::size_t c = 0; c < most.size(); ++c) {
        for (std::int64_t k = offset[c]; k < offset[c + 1]; ++k)
          most[c] = std::max(most[c], std::abs(s.scale[index[k]] * value[k]));
        for (std::int64_t k = offset[c]; k < offset[c + 1]; ++k)
          values[k] = static_cast<Real>(s.scale[index[k]] * value[k] / most[c]);
      }
    mumps.substitute(offset, index, values, solution);
    if (!s.scale.empty())
      parallel_for(most.size(), 1, [&](const LoopBlock& side) {
        const std::size_t c = side.first;
        for (std::size_t i = 0; i < n; ++i)
          solution[c * n + i] = static_cast<Real>(most[c] * s.scale[i] * static_cast<double>(solution[c * n + i]));
        for (const std::int64_t i : s.alone) solution[c * n + static_cast<std::size_t>(i)] = 0;
        for (std::int64_t k = offset[c]; k < offset[c + 1]; ++k)
          if (std::binary_search(s.alone.begin(), s.alone.end(), index[k]))
            solution[c * n + static_cast<std::size_t>(index[k])] += static_cast<Real>(value[k] / s.matrix->diagonal(index[k]));
      });
    if constexpr (std::is_same_v<Real, float>)
      return solution;
    else
      return std::vector<float>(solution.begin(), solution.end());
  };
  return s.single ? solve(*s.single) : solve(*s.full);
}

Solution MumpsEngine::solve(std::span<double> right_side) {
  try {
    return state_->solve(right_side);
  } catch (const State::Unproved& unproved) {
    return state_->solve_with_more_care(unproved.doubt, right_side);
  }
}

Solution MumpsEngine::State::solve(std::span<double> right_side) {
  const std::size_t n = right_side.size();
  std::vector<double> x(n, 0.0), step(right_side.begin(), right_side.end()), residual(step), best(n);
  const double norm = matrix->norm();
  Solution solution{.residual = INFINITY};
  const bool exact = form.is_exact();
  double error = INFINITY;
  constexpr int most_refinements = 4;
  for (int i = 0; i <= most_refinements; ++i) {
    if (exact) {
      substitute(step);
    } else {
      GmresResult found = gmres([&](std::span<const double> v, std::span<double> y) { matrix->multiply(v, y); },
                                [&](std::span<double> v) { substitute_and_look(v); }, scale, residual,
                                {.goal = gain * scaled_norm(scale, residual), .iterations = most_iterations, .cycles = 1});
      solution.iterations += found.iterations;
      step = std::move(found.x);
    }
    for (std::size_t k = 0; k < n; ++k) x[k] += step[k];
    matrix->multiply(x, residual);
    for (std::size_t k = 0; k < n; ++k) residual[k] = right_side[k] - residual[k];
    const double magnitude = norm * largest(x) + largest(right_side);
    const double relative = magnitude > 0 ? largest(residual) / magnitude : 0,
                 now = scale.empty() ? relative : residual_share(*matrix, scale, residual, x, right_side);
    if (!(now < error)) break;  // refinement no longer helps: keep the solution before
    error = now;
    solution.residual = relative;
    best = x;
    if (error < round_off) break;
    step = residual;
  }
  if (proof) solution.error = proved_error();
  if (!exact && !(error <= least_accuracy)) {
    Solution second = solve_with_more_care(part("gmres_leaves", {{"share", fmt::format("{:.0e}", error)}}), right_side);
    second.iterations += solution.iterations;
    return second;
  }
  if (!std::isfinite(error) || (options.residual_tolerance >= 0 && solution.residual > options.residual_tolerance))
    fail("SOLVER_1", {{"error", fmt::format("{:.1e}", solution.residual)},
                      {"tolerance", fmt::format("{:.1e}", options.residual_tolerance)}});
  if (!exact)  // refined as the others, they would be so to round-off alone
    for (const std::int64_t i : alone) best[static_cast<std::size_t>(i)] = right_side[i] / matrix->diagonal(i);
  std::copy(best.begin(), best.end(), right_side.begin());
  return solution;
}

}  // namespace lacon
