#include "lacon/assembly/tree/tree_mumps.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

/// A pivot of a piece this much larger than a null one is left to the top, where others may take its turn: a body that contact
/// alone holds, say, where multipliers are the border. And how often more of them are looked for.
constexpr double loose = 100;
constexpr int most_rounds = 3;
/// Numbers that a process answers of a factorisation, before the equations of such pivots.
constexpr std::size_t of_a_piece = 4;
/// Columns of a Schur complement that a thread adds up at a time.
constexpr std::size_t columns_added = 64;

/// Places of some equations among themselves, from 1.
std::vector<int> ranks(std::span<const std::int32_t> equations, std::span<const int> place) {
  std::vector<std::size_t> order(equations.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return place[equations[a]] < place[equations[b]]; });
  std::vector<int> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<int>(i) + 1;
  return rank;
}

template <class Real>
std::span<Real> values_in(const SharedMemory& memory) {
  return {reinterpret_cast<Real*>(memory.data()), memory.size() / sizeof(Real)};
}

}  // namespace

template <class Real>
TreeMumps<Real>::TreeMumps(const MumpsSettings& settings, Subtrees subtrees, MumpsProcesses& processes)
    : settings_(settings), subtrees_(std::move(subtrees)), processes_(processes) {
  settings_.scaled = true;
  settings_.singular_pivot = -settings.singular_pivot;  // of entries about 1, also where the largest of a piece is less
  processes_.start();
}

template <class Real>
TreeMumps<Real>::~TreeMumps() {
  processes_.forget();
}

template <class Real>
std::vector<std::vector<double>> TreeMumps<Real>::ask(const char* verb, const char* phase, std::span<const SharedMemory> memory,
                                                      const std::function<void()>& meanwhile,
                                                      std::span<const SharedMemory> more,
                                                      const std::function<void(std::size_t)>& answered) {
  const auto rest = [&](std::size_t piece) {
    return (std::is_same_v<Real, float> ? " float " : " double ") + std::to_string(piece) + ' ' + memory[piece].path() +
           (more.empty() ? "" : ' ' + more[piece].path());
  };
  return processes_.ask({verb, phase, local_.size()}, subtrees_.process, rest, meanwhile, answered);
}

template <class Real>
template <class Use>
void TreeMumps<Real>::for_each_entry(const Use& use) const {
  std::size_t entry = 0;
  if (pattern_.graph)
    return pattern_.graph->for_each_entry(settings_.symmetric,
                                          [&](std::int32_t row, std::int32_t column) { use(entry++, row, column); });
  for (; entry < pattern_.row.size(); ++entry) use(entry, pattern_.row[entry] - 1, pattern_.column[entry] - 1);
}

template <class Real>
void TreeMumps<Real>::number(const MumpsPattern& pattern) {
  pattern_ = pattern;
  const std::size_t n = pattern.place.size();
  pieces_.assign(subtrees_.process.size(), {});
  local_.assign(n, 0);
  top_.clear();
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(n); ++i) {  // in their order: blocks are of what is near each other
    std::vector<std::int32_t>& those = subtrees_.of[i] < 0 ? top_ : pieces_[subtrees_.of[i]].own;
    local_[i] = static_cast<std::int32_t>(those.size());
    those.push_back(i);
  }
  for_each_entry([&](std::size_t, std::int32_t row, std::int32_t column) {
    const std::int32_t piece = subtree_of(row, column);
    if (piece < 0) return;
    ++pieces_[piece].n_entries;
    for (const std::int32_t i : {row, column})
      if (subtrees_.of[i] < 0) pieces_[piece].border.push_back(local_[i]);
  });
  for (Piece& piece : pieces_) {
    std::ranges::sort(piece.border);
    piece.border.erase(std::unique(piece.border.begin(), piece.border.end()), piece.border.end());
  }
}

template <class Real>
std::vector<std::vector<int>> TreeMumps<Real>::borders() const {
  std::vector<std::vector<int>> borders;
  for (const Piece& piece : pieces_) {
    std::vector<int>& number = borders.emplace_back(top_.size());
    for (std::size_t b = 0; b < piece.border.size(); ++b) number[piece.border[b]] = static_cast<int>(piece.own.size() + b);
  }
  return borders;
}

template <class Real>
template <class Use>
void TreeMumps<Real>::for_each_of_pieces(const Use& use) const {
  const std::vector<std::vector<int>> in_border = borders();
  for_each_entry([&](std::size_t entry, std::int32_t row, std::int32_t column) {
    const std::int32_t piece = subtree_of(row, column);
    if (piece < 0) return;
    const auto local = [&](std::int32_t i) { return subtrees_.of[i] < 0 ? in_border[piece][local_[i]] : local_[i]; };
    const int a = local(row), b = local(column);
    settings_.symmetric&& a < b ? use(entry, piece, b, a) : use(entry, piece, a, b);
  });
}

template <class Real>
void TreeMumps<Real>::make_patterns() {
  patterns_.clear();
  for (const Piece& piece : pieces_) {
    const PieceSizes sizes{.size = static_cast<std::int64_t>(piece.size()),
                           .entries = piece.n_entries,
                           .border = static_cast<std::int64_t>(piece.border.size()),
                           .is_symmetric = settings_.symmetric,
                           .memory_margin = settings_.memory_margin,
                           .as_ordered = settings_.as_ordered,
                           .singular_pivot = loose * settings_.singular_pivot,
                           .low_rank = settings_.low_rank};
    patterns_.emplace_back(PieceMemory::bytes(sizes));
    std::memcpy(patterns_.back().data(), &sizes, sizeof sizes);
    const PieceMemory memory = PieceMemory::in(patterns_.back());
    const int first_of_border = static_cast<int>(piece.own.size()) + 1;
    std::ranges::copy(ranks(piece.own, pattern_.place), memory.place.begin());
    std::iota(memory.place.begin() + static_cast<std::ptrdiff_t>(piece.own.size()), memory.place.end(), first_of_border);
    std::iota(memory.in_border.begin(), memory.in_border.end(), first_of_border);
    std::ranges::copy(piece.border, memory.border.begin());
  }
  std::vector<PieceMemory> memory;
  for (const SharedMemory& pattern : patterns_) memory.push_back(PieceMemory::in(pattern));
  for_each_of_pieces([&](std::size_t, std::int32_t piece, int row, int) { ++memory[piece].offset[row + 1]; });
  std::vector<std::vector<std::int64_t>> next;
  for (const PieceMemory& piece : memory) {
    std::partial_sum(piece.offset.begin(), piece.offset.end(), piece.offset.begin());
    next.emplace_back(piece.offset.begin(), piece.offset.end() - 1);
  }
  for_each_of_pieces([&](std::size_t, std::int32_t piece, int row, int column) {  // columns of a row come in their order
    const std::int64_t k = next[piece][row]++;
    memory[piece].row[k] = row + 1;
    memory[piece].column[k] = column + 1;
  });
}

template <class Real>
void TreeMumps<Real>::number_top() {
  const auto m = static_cast<std::int32_t>(top_.size());
  std::vector<std::vector<std::int32_t>> own(top_.size());  // rows of the matrix's entries, by columns
  const auto for_each_own = [&](const auto& use) {
    for_each_entry([&](std::size_t, std::int32_t row, std::int32_t column) {
      const std::int32_t i = local_[row], j = local_[column];
      if (subtree_of(row, column) < 0) settings_.symmetric ? use(std::max(i, j), std::min(i, j)) : use(i, j);
    });
  };
  for_each_own([&](std::int32_t i, std::int32_t j) { own[j].push_back(i); });
  std::vector<std::int32_t> seen(top_.size(), -1);
  top_pattern_ = {};
  for (std::int32_t j = 0; j < m; ++j) {
    for (const std::int32_t i : own[j]) seen[i] = j;
    for (const Piece& piece : pieces_)
      if (std::binary_search(piece.border.begin(), piece.border.end(), j))
        for (const std::int32_t i : piece.border) seen[i] = j;
    for (std::int32_t i = settings_.symmetric ? j : 0; i < m; ++i)
      if (seen[i] == j) {
        top_pattern_.row.push_back(i + 1);
        top_pattern_.column.push_back(j + 1);
      }
    top_pattern_.offset.push_back(static_cast<std::int64_t>(top_pattern_.row.size()));
  }
  top_pattern_.own.clear();
  for_each_own([&](std::int32_t i, std::int32_t j) { top_pattern_.own.push_back(top_pattern_.entry(i, j)); });
}

template <class Real>
void TreeMumps<Real>::add_to_top(const Piece& piece, std::span<const Real> schur, std::span<Real> values) const {
  const std::size_t n = piece.border.size();
  parallel_for(n, columns_added, [&](const LoopBlock& block) {
    const std::size_t first = settings_.symmetric ? block.first : 0;
    std::vector<std::int64_t> next;  // of each column: rows go on from there
    for (std::size_t b = block.first; b < block.last; ++b)
      next.push_back(top_pattern_.entry(piece.border[settings_.symmetric ? b : 0], piece.border[b]));
    for (std::size_t a = first; a < n; ++a) {
      const int row = piece.border[a] + 1;
      for (std::size_t b = block.first; b < (settings_.symmetric ? std::min(a + 1, block.last) : block.last); ++b) {
        std::int64_t& k = next[b - block.first];
        while (top_pattern_.row[k] != row) ++k;
        values[k] += schur[a * n + b];
      }
    }
  });
}

template <class Real>
void TreeMumps<Real>::analyse_top() {
  if (top_factor_ || top_.empty()) return;
  number_top();
  top_pattern_.place = ranks(top_, pattern_.place);
  auto factor = std::make_unique<Mumps<Real>>(settings_);
  factor->analyse({.row = top_pattern_.row, .column = top_pattern_.column, .place = top_pattern_.place, .border = {}});
  top_factor_ = std::move(factor);
}

template <class Real>
MumpsForecast TreeMumps<Real>::analyse(const MumpsPattern& pattern) {
  number(pattern);
  top_factor_.reset();
  full_top_.reset();
  make_patterns();
  const auto found = ask("analyse", "analysis", patterns_);
  const double top = static_cast<double>(top_.size()), entries = top * top / (settings_.symmetric ? 2 : 1);  // all of them
  MumpsForecast whole{.flops = entries * top * 2 / 3, .entries = entries, .bytes = 2 * sizeof(Real) * entries};
  for (const std::vector<double>& numbers : found) {
    whole.flops += numbers.at(0);
    whole.entries += numbers.at(1);
    whole.bytes += numbers.at(2);
  }
  return whole;
}

template <class Real>
void TreeMumps<Real>::fill_in_order(std::span<const Real> entries, Values& values) const {
  std::vector<std::vector<std::int64_t>> next;
  std::vector<Real*> into;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const std::span<const std::int64_t> offset = pattern_of(p).offset;
    next.emplace_back(offset.begin(), offset.end() - 1);
    into.push_back(values_in<Real>(values.pieces[p]).data());
  }
  for_each_of_pieces(
      [&](std::size_t entry, std::int32_t piece, int row, int) { into[piece][next[piece][row]++] = entries[entry]; });
  for_each_entry([&](std::size_t entry, std::int32_t row, std::int32_t column) {
    if (subtree_of(row, column) < 0) values.top.push_back(entries[entry]);
  });
}

template <class Real>
void TreeMumps<Real>::fill_from_all(const SparseMatrix& here, std::span<const double> scale, Values& values) {
  const SharedMemory numbers(EquationMap::bytes(local_.size()));
  const EquationMap map = EquationMap::in(numbers);
  std::ranges::copy(scale, map.scale.begin());
  std::ranges::copy(subtrees_.of, map.piece.begin());
  std::ranges::copy(local_, map.number.begin());
  // the top's own entries, as a piece without a border
  std::int64_t n_top = 0;
  const auto for_each_of_top = [&](const auto& use) {
    for_each_entry([&](std::size_t, std::int32_t row, std::int32_t column) {
      if (subtree_of(row, column) < 0) use(local_[row], local_[column]);
    });
  };
  for_each_of_top([&](std::int32_t, std::int32_t) { ++n_top; });
  const PieceSizes sizes{.size = static_cast<std::int64_t>(top_.size()), .entries = n_top};
  const SharedMemory top(PieceMemory::bytes(sizes)), of_top(sizeof(Real) * static_cast<std::size_t>(n_top));
  std::memcpy(top.data(), &sizes, sizeof sizes);
  const PieceMemory top_pattern = PieceMemory::in(top);
  std::size_t k = 0;
  for_each_of_top([&](std::int32_t row, std::int32_t column) {
    ++top_pattern.offset[row + 1];
    top_pattern.column[k++] = column + 1;
  });
  std::partial_sum(top_pattern.offset.begin(), top_pattern.offset.end(), top_pattern.offset.begin());

  EntryPlaces<Real> places(map);
  std::string line = std::string("fill ") + (std::is_same_v<Real, float> ? "float " : "double ") + numbers.path();
  const auto enter = [&](const SharedMemory& pattern, const SharedMemory& memory) {
    places.add_piece(PieceMemory::in(pattern), values_in<Real>(memory).data());
    line += ' ' + pattern.path() + ' ' + memory.path();
  };
  for (std::size_t p = 0; p < pieces_.size(); ++p) enter(patterns_[p], values.pieces[p]);
  enter(top, of_top);
  require_done(processes_.ask(line));
  for (std::int64_t row = 0; row < here.size(); ++row)
    for (std::int64_t at = here.rows()[row]; at < here.rows()[row + 1]; ++at)
      if (here.values()[at] != 0) places.add(static_cast<std::int32_t>(row), here.columns()[at], here.values()[at]);
  const std::span<const Real> found = values_in<const Real>(of_top);
  values.top.assign(found.begin(), found.end());
}

template <class Real>
std::vector<std::vector<double>> TreeMumps<Real>::factorise_pieces(const Fill& fill, Values& values) {
  values = {};
  for (const Piece& piece : pieces_)
    values.pieces.emplace_back(sizeof(Real) *
                               (static_cast<std::size_t>(piece.n_entries) + piece.border.size() * piece.border.size()));
  fill(values);
  if (!has_full_top()) return ask("factorise", "factorisation", values.pieces, [&] { analyse_top(); });
  return ask(
      "factorise", "factorisation", values.pieces, [&] { make_full_top(values); }, {},
      [&](std::size_t p) { full_top_->add(pieces_[p].border, schur_of(p, values)); });
}

template <class Real>
Factorisation TreeMumps<Real>::factorise(std::span<const Real> entries) {
  return factorise_filled([&](Values& values) { fill_in_order(entries, values); });
}

template <class Real>
Factorisation TreeMumps<Real>::factorise(const SparseMatrix& here, std::span<const double> scale) {
  return factorise_filled([&](Values& values) { fill_from_all(here, scale, values); });
}

template <class Real>
bool TreeMumps<Real>::leave_to_top(const std::vector<std::vector<double>>& found) {
  for (const std::vector<double>& numbers : found)
    if (std::ranges::count(numbers, Factorisation::unknown)) return false;
  bool any = false;
  for (std::size_t p = 0; p < pieces_.size(); ++p)
    for (std::size_t k = of_a_piece; k < found[p].size(); ++k) {
      subtrees_.of[pieces_[p].own.at(static_cast<std::size_t>(found[p][k]))] = -1;
      any = true;
    }
  return any;
}

template <class Real>
Factorisation TreeMumps<Real>::factorise_top(Values& values) {
  std::vector<Real> sum(top_pattern_.row.size(), 0);
  for (std::size_t k = 0; k < values.top.size(); ++k) sum[top_pattern_.own[k]] = values.top[k];
  for (std::size_t p = 0; p < pieces_.size(); ++p) add_to_top(pieces_[p], schur_of(p, values), sum);
  values = {};
  return top_factor_->factorise(sum);
}

template <class Real>
void TreeMumps<Real>::make_full_top(const Values& values) {
  full_top_ = std::make_unique<DenseFactor<Real>>(ranks(top_, pattern_.place));
  std::size_t k = 0;
  for_each_entry([&](std::size_t, std::int32_t row, std::int32_t column) {
    if (subtree_of(row, column) < 0) full_top_->entry(local_[row], local_[column]) = values.top[k++];
  });
}

template <class Real>
Factorisation TreeMumps<Real>::factorise_full_top() {
  Factorisation found{.flops = full_top_->flops(), .entries = full_top_->n_entries(), .whole_entries = full_top_->n_entries()};
  if (!full_top_->eliminate(-settings_.singular_pivot)) found.null_pivots.push_back(Factorisation::unknown);
  found.negative_pivots = full_top_->negative_pivots();
  return found;
}

template <class Real>
Factorisation TreeMumps<Real>::factorise_filled(const Fill& fill) try {
  Values values;
  std::vector<std::vector<double>> found = factorise_pieces(fill, values);
  double wasted = 0;
  for (int round = 0; round < most_rounds && leave_to_top(found); ++round) {
    for (const std::vector<double>& numbers : found) wasted += numbers.at(0);
    analyse(pattern_);
    found = factorise_pieces(fill, values);
  }

  Factorisation whole;
  whole.wasted_flops = wasted;
  if (settings_.symmetric) whole.negative_pivots = 0;
  for (const std::vector<double>& numbers : found) {
    whole.flops += numbers.at(0);
    whole.entries += static_cast<std::int64_t>(numbers.at(1));
    whole.whole_entries += static_cast<std::int64_t>(numbers.at(2));
    if (whole.negative_pivots) *whole.negative_pivots += static_cast<std::int64_t>(numbers.at(3));
    whole.null_pivots.insert(whole.null_pivots.end(), numbers.size() - of_a_piece, 0);
  }
  if (top_.empty() || !whole.null_pivots.empty()) return whole;
  if (has_full_top()) values = {};
  const Factorisation top = has_full_top() ? factorise_full_top() : factorise_top(values);
  whole.flops += top.flops;
  whole.entries += top.entries;
  whole.whole_entries += top.whole_entries;
  if (whole.negative_pivots) *whole.negative_pivots += *top.negative_pivots;
  whole.null_pivots = top.null_pivots;
  return whole;
} catch (const std::bad_alloc&) {
  fail("SOLVER_2", {{"phase", "factorisation"}, {"equations", std::to_string(local_.size())}});
}

template <class Real>
std::vector<SharedMemory> TreeMumps<Real>::memory_of_sides(std::size_t count) const {
  std::vector<SharedMemory> memory;
  for (const Piece& piece : pieces_) memory.emplace_back(sizeof(Real) * count * (piece.size() + piece.border.size()));
  return memory;
}

template <class Real>
void TreeMumps<Real>::substitute_behind(std::vector<SharedMemory>& memory, std::span<Real> top, std::span<Real> solution) {
  const std::size_t n = local_.size(), m = top_.size(), count = solution.size() / n;
  const auto for_each_side = [&](const auto& use) {  // and piece: with its unknowns, and what its border gives and gets
    parallel_for(count, 1, [&](const LoopBlock& side) {
      for (std::size_t p = 0; p < pieces_.size(); ++p) {
        const std::span<Real> values = values_in<Real>(memory[p]);
        const std::size_t size = pieces_[p].size(), border = pieces_[p].border.size(), c = side.first;
        use(c, pieces_[p], values.subspan(c * size, size), values.subspan(count * size + c * border, border));
      }
    });
  };
  for_each_side([&](std::size_t c, const Piece& piece, std::span<Real>, std::span<Real> border) {
    for (std::size_t b = 0; b < border.size(); ++b) top[c * m + piece.border[b]] += border[b];
  });
  if (full_top_)
    full_top_->substitute(top);
  else if (top_factor_)
    top_factor_->substitute(top);
  for_each_side([&](std::size_t c, const Piece& piece, std::span<Real>, std::span<Real> border) {
    for (std::size_t b = 0; b < border.size(); ++b) border[b] = top[c * m + piece.border[b]];
  });
  ask("expand", "solution", memory);
  for_each_side([&](std::size_t c, const Piece& piece, std::span<Real> own, std::span<Real>) {
    for (std::size_t i = 0; i < piece.own.size(); ++i) solution[c * n + piece.own[i]] = own[i];
  });
  for (std::size_t k = 0; k < top.size(); ++k) solution[k / m * n + top_[k % m]] = top[k];
}

template <class Real>
void TreeMumps<Real>::substitute(std::span<Real> right_side) {
  const std::size_t n = local_.size(), m = top_.size(), count = right_side.size() / n;
  std::vector<SharedMemory> memory = memory_of_sides(count);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const std::span<Real> own = values_in<Real>(memory[p]);
    for (std::size_t c = 0; c < count; ++c)
      for (std::size_t i = 0; i < pieces_[p].own.size(); ++i)
        own[c * pieces_[p].size() + i] = right_side[c * n + pieces_[p].own[i]];
  }
  ask("reduce", "solution", memory);
  std::vector<Real> top(count * m);
  for (std::size_t k = 0; k < top.size(); ++k) top[k] = right_side[k / m * n + top_[k % m]];
  substitute_behind(memory, top, right_side);
}

template <class Real>
std::vector<SharedMemory> TreeMumps<Real>::shared_out(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                                      std::span<const Real> value, std::span<Real> top) const {
  const std::size_t count = offset.size() - 1;
  struct Lists {
    std::vector<std::int64_t> offset{0};
    std::vector<std::int32_t> index;
    std::vector<Real> value;
  };
  std::vector<Lists> of_pieces(pieces_.size());
  for (std::size_t c = 0; c < count; ++c) {
    for (std::int64_t k = offset[c]; k < offset[c + 1]; ++k) {
      const std::int32_t piece = subtrees_.of[index[k]], own = local_[index[k]];
      if (piece < 0) {
        top[c * top_.size() + own] += value[k];
        continue;
      }
      of_pieces[piece].index.push_back(own);
      of_pieces[piece].value.push_back(value[k]);
    }
    for (Lists& lists : of_pieces) {
      if (c == 0 && lists.index.empty()) {  // MUMPS takes no sides without an entry
        lists.index.push_back(0);
        lists.value.push_back(0);
      }
      lists.offset.push_back(static_cast<std::int64_t>(lists.index.size()));
    }
  }
  std::vector<SharedMemory> memory;
  for (const Lists& lists : of_pieces) {
    const SparseSideSizes sizes{.count = static_cast<std::int64_t>(count),
                                .entries = static_cast<std::int64_t>(lists.index.size())};
    const std::span<const std::byte> parts[] = {std::as_bytes(std::span(&sizes, 1)), std::as_bytes(std::span(lists.offset)),
                                                std::as_bytes(std::span(lists.value)), std::as_bytes(std::span(lists.index))};
    std::size_t size = 0;
    for (const auto part : parts) size += part.size();
    std::byte* next = memory.emplace_back(size).data();
    for (const auto part : parts) next = std::ranges::copy(part, next).out;
  }
  return memory;
}

template <class Real>
void TreeMumps<Real>::substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                 std::span<const Real> value, std::span<Real> solution) {
  const std::size_t count = offset.size() - 1;
  std::vector<Real> top(count * top_.size(), 0);
  const std::vector<SharedMemory> sides = shared_out(offset, index, value, top);
  std::vector<SharedMemory> memory = memory_of_sides(count);
  ask("reduce", "solution", memory, {}, sides);
  substitute_behind(memory, top, solution);
}

template class TreeMumps<double>;
template class TreeMumps<float>;

}  // namespace lacon
