#include "lacon/assembly/petsc/block_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace lacon {
namespace {

/// Of the weights, in stiffnesses of the displacements of a row; and what a Schur complement has beside them.
constexpr double weight_of_rows = 1, rest_of_schur = 0.5;

struct Entry {
  std::int32_t column;
  double value;
};

/// A row of C, the column of B beside it, and the row of D: of a multiplier, not scaled yet.
struct Multiplier {
  std::vector<Entry> c, b, d;
};

/// Entries gathered row by row, in two passes.
class Gathering {
 public:
  Gathering(std::int64_t first, std::int64_t last) : first_(first), last_(last), next_(last - first + 1, 0) {}
  bool has(std::int64_t row) const { return row >= first_ && row < last_; }
  void count(std::int64_t row, std::int64_t n = 1) { next_[row - first_ + 1] += n; }
  void make_room() {
    for (std::size_t i = 1; i < next_.size(); ++i) next_[i] += next_[i - 1];
    entries_.resize(next_.back());
  }
  void add(std::int64_t row, std::int32_t column, double value) { entries_[next_[row - first_]++] = {column, value}; }
  /// The entries of a row, of which some columns may be there more than once.
  std::span<Entry> row(std::int64_t row) {
    const std::int64_t i = row - first_, begin = i ? next_[i - 1] : 0;
    return {entries_.data() + begin, static_cast<std::size_t>(next_[i] - begin)};
  }

 private:
  std::int64_t first_, last_;
  std::vector<std::int64_t> next_;
  std::vector<Entry> entries_;
};

std::span<Entry> summed(std::span<Entry> entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& x, const Entry& y) { return x.column < y.column; });
  std::size_t n = 0;
  for (const Entry& entry : entries)
    if (n > 0 && entries[n - 1].column == entry.column)
      entries[n - 1].value += entry.value;
    else
      entries[n++] = entry;
  return entries.first(n);
}

template <class Use>
void for_each_entry(const BlockSystem& system, const Use& use) {
  for (std::int64_t i = 0; i < system.sizes.n; ++i)
    for (std::int64_t k = system.row[i]; k < system.row[i + 1]; ++k) {
      const std::int32_t j = system.column[k];
      if (system.value[k] == 0) continue;
      use(system.place[i], system.place[j], system.value[k]);
      if (system.sizes.is_symmetric && i != j) use(system.place[j], system.place[i], system.value[k]);
    }
}

/// What joins two nodes, row by row; zeros in rows and columns of imposed displacements.
using Block = std::array<double, 9>;

/// The entries that a process has itself, a block of two nodes at a time: calls use(block row, block column, block) for those
/// that are not zero, in both triangles.
template <int D, class Use>
void for_each_block(const OwnEntries& own, const Use& use) {
  const SparseMatrix& matrix = *own.matrix;
  const std::int64_t n_nodes = matrix.size() / D;
  std::vector<std::int32_t> place(n_nodes, -1);
  for (std::int64_t i = 0; i < n_nodes * D; ++i)
    if (own.place[i] >= 0) place[i / D] = own.place[i] / D;
  for (std::int64_t a = 0; a < n_nodes; ++a) {
    if (place[a] < 0) continue;
    const std::int64_t n_before = (matrix.rows()[a * D + 1] - matrix.rows()[a * D]) / D;  // neighbours; then comes the diagonal
    for (std::int64_t n = 0; n <= n_before; ++n) {
      const bool is_diagonal = n == n_before;
      const std::int64_t b = matrix.columns()[matrix.rows()[a * D] + n * D] / D;
      if (place[b] < 0) continue;
      Block block{}, transposed{};
      bool is_there = false;
      for (int r = 0; r < D; ++r)
        for (int c = 0; c <= (is_diagonal ? r : D - 1); ++c) {
          const double value = matrix.values()[matrix.rows()[a * D + r] + n * D + c];
          if (value == 0 || own.place[a * D + r] < 0 || own.place[b * D + c] < 0) continue;
          is_there = true;
          block[r * D + c] = transposed[c * D + r] = value;
          if (is_diagonal) block[c * D + r] = value;
        }
      if (!is_there) continue;
      use(place[a], place[b], block);
      if (!is_diagonal) use(place[b], place[a], transposed);
    }
  }
}

template <class Use>
void for_each_block(const OwnEntries& own, int dimension, const Use& use) {
  if (!own.matrix) return;
  if (dimension == 3)
    for_each_block<3>(own, use);
  else
    for_each_block<2>(own, use);
}

void append(Rows& rows, std::span<const Entry> entries) {
  for (const auto& [column, value] : entries) {
    rows.column.push_back(column);
    rows.value.push_back(value);
  }
  if (rows.column.size() > std::numeric_limits<std::int32_t>::max()) throw std::length_error("PETSc: 2^31");
  rows.offset.push_back(static_cast<std::int32_t>(rows.column.size()));
}

/// Which blocks of K are there: own rows of blocks, with ascending columns.
struct BlockPattern {
  std::vector<std::int64_t> offset;
  std::vector<std::int32_t> column;

  /// @param for_each  goes through entries, often several of a block: calls what it is given with block row, from 0, and column
  template <class ForEach>
  BlockPattern(std::int64_t n_rows, const ForEach& for_each) : offset(n_rows + 1, 0) {
    std::vector<std::int32_t> last;
    const auto for_each_new = [&](const auto& use) {  // of an element's rows most are not; the others are found below
      last.assign(n_rows, -1);
      for_each([&](std::int64_t row, std::int32_t block) {
        if (last[row] != block) use(row, last[row] = block);
      });
    };
    for_each_new([&](std::int64_t row, std::int32_t) { ++offset[row + 1]; });
    for (std::int64_t row = 0; row < n_rows; ++row) offset[row + 1] += offset[row];
    column.resize(offset.back());
    std::vector<std::int64_t> next(offset.begin(), offset.end() - 1);
    for_each_new([&](std::int64_t row, std::int32_t block) { column[next[row]++] = block; });
    std::int64_t end = 0;
    for (std::int64_t row = 0; row < n_rows; ++row) {
      const std::int64_t begin = std::exchange(offset[row], end);
      const auto own = std::span(column).subspan(begin, next[row] - begin);
      std::sort(own.begin(), own.end());
      end = std::copy(own.begin(), std::unique(own.begin(), own.end()), column.begin() + end) - column.begin();
    }
    offset.back() = end;
    column.resize(end);
  }
  std::span<const std::int32_t> row(std::int64_t row) const {
    return std::span(column).subspan(offset[row], offset[row + 1] - offset[row]);
  }
};

/// Rows of K in whole blocks. Entries are summed up as they come. @param is_symmetric  half of the own columns will do
/// @param for_each  goes through all entries of own rows: calls the first thing that it is given with row, column, value, and
/// whether it is K's, the second one with block row, block column and a block of K  @param[out] is_of_k  as in BlockRows
template <class ForEach>
SplitBlocks<double> rows_of_blocks(const Range& blocks, int dimension, bool is_symmetric, const ForEach& for_each,
                                   std::vector<std::uint8_t>& is_of_k) {
  const auto block_of = [&](std::int32_t row) { return dimension == 3 ? row / 3 : row / dimension; };  // division by 3 is quick
  const auto is_left_out = [&](std::int32_t own_row, std::int32_t block) {
    return is_symmetric && block >= blocks.first && block < own_row;
  };
  const BlockPattern pattern(blocks.last - blocks.first, [&](const auto& use) {
    for (std::int64_t block = blocks.first; block < blocks.last; ++block)
      use(block - blocks.first, static_cast<std::int32_t>(block));
    const auto use_block = [&](std::int32_t own_row, std::int32_t block, const Block&) {
      if (!is_left_out(own_row, block)) use(own_row - blocks.first, block);
    };
    for_each([&](std::int32_t row, std::int32_t column, double, bool) { use_block(block_of(row), block_of(column), {}); },
             use_block);
  });
  const int size = dimension * dimension;
  if (size * std::ssize(pattern.column) > std::numeric_limits<std::int32_t>::max()) throw std::length_error("PETSc: 2^31");
  const auto is_own = [&](std::int32_t block) { return block >= blocks.first && block < blocks.last; };
  SplitBlocks<double> rows;
  std::vector<std::int32_t>& of_others = rows.column_of_others;
  std::ranges::remove_copy_if(pattern.column, std::back_inserter(of_others), is_own);
  std::ranges::sort(of_others);
  of_others.erase(std::unique(of_others.begin(), of_others.end()), of_others.end());
  const auto number_of = [&](std::int32_t block) {
    return static_cast<std::int32_t>(is_own(block) ? block - blocks.first
                                                   : std::ranges::lower_bound(of_others, block) - of_others.begin());
  };
  for (std::int64_t row = 0; row < blocks.last - blocks.first; ++row) {
    for (const std::int32_t block : pattern.row(row))
      (is_own(block) ? rows.own : rows.others).column.push_back(number_of(block));
    for (BlockEntries<double>* const part : {&rows.own, &rows.others})
      part->offset.push_back(static_cast<std::int32_t>(part->column.size()));
  }
  for (BlockEntries<double>* const part : {&rows.own, &rows.others}) {
    part->rows = part->columns = dimension;
    part->value.assign(part->column.size() * size + read_behind, 0.0);
  }
  rows.own.is_half = is_symmetric;
  is_of_k.assign(rows.own.column.size(), 0);
  const auto place_of = [&](const BlockEntries<double>& part, std::int32_t own_row, std::int32_t block) {
    const std::int64_t i = own_row - blocks.first;
    const auto first = part.column.begin() + part.offset[i], last = part.column.begin() + part.offset[i + 1];
    return std::lower_bound(first, last, number_of(block)) - part.column.begin();
  };
  std::int32_t row_before = -1, block_before = -1;  // entries of a block follow each other
  std::int64_t at = 0;
  const auto add = [&](std::int32_t row, std::int32_t column, double value, bool is_k) {
    const std::int32_t block = block_of(column), own_row = block_of(row);
    if (is_left_out(own_row, block)) return;
    BlockEntries<double>& part = is_own(block) ? rows.own : rows.others;
    if (own_row != row_before || block != block_before) {
      at = place_of(part, own_row, block);
      row_before = own_row, block_before = block;
    }
    if (is_k && is_own(block)) is_of_k[at] = 1;
    const std::int64_t r = row - own_row * dimension, c = column - block * dimension;
    part.value[at * size + (part.is_half ? r * dimension + c : c * dimension + r)] += value;
  };
  const auto add_block = [&](std::int32_t own_row, std::int32_t block, const Block& values) {
    if (is_left_out(own_row, block)) return;
    BlockEntries<double>& part = is_own(block) ? rows.own : rows.others;
    const std::int64_t there = place_of(part, own_row, block);
    if (is_own(block)) is_of_k[there] = 1;
    double* const sum = part.value.data() + there * size;
    for (int r = 0; r < dimension; ++r)
      for (int c = 0; c < dimension; ++c)
        sum[part.is_half ? r * dimension + c : c * dimension + r] += values[r * dimension + c];
  };
  for_each(add, add_block);
  return rows;
}

/// What all processes know.
struct Known {
  std::vector<double> diagonal;  ///< of K
  double mean;                   ///< of its sizes that are not zero; 1 without any
  std::vector<Multiplier> multipliers;
};

double mean_size(std::span<const double> values) {
  double sum = 0;
  std::int64_t n = 0;
  for (const double value : values)
    if (value != 0) sum += std::abs(value), ++n;
  return n ? sum / static_cast<double>(n) : 1;
}

Known known_of(const BlockSystem& system, const OwnEntries& entries) {
  Known known{.diagonal = entries.diagonal, .mean = 1, .multipliers = std::vector<Multiplier>(system.sizes.n_multipliers)};
  known.diagonal.resize(system.sizes.n_blocks * system.sizes.dimension, 0.0);
  for_each_entry(system, [&](std::int32_t row, std::int32_t column, double value) {
    if (row >= 0 && column >= 0) {
      if (row == column) known.diagonal[row] += value;
    } else if (row >= 0) {
      known.multipliers[-1 - column].b.push_back({row, value});
    } else {
      Multiplier& m = known.multipliers[-1 - row];
      (column >= 0 ? m.c : m.d).push_back({column, value});
    }
  });
  for (Multiplier& m : known.multipliers) {
    for (std::vector<Entry>* const entries_of_row : {&m.b, &m.c}) {
      entries_of_row->resize(summed(*entries_of_row).size());
      entries_of_row->shrink_to_fit();
    }
  }
  known.mean = mean_size(known.diagonal);
  return known;
}

/// C diag(K)^-1 B of a multiplier.
double flexibility_of(const Multiplier& m, std::span<const double> diagonal) {
  double sum = 0;
  for (std::size_t p = 0, q = 0; p < m.c.size() && q < m.b.size();) {
    const std::int32_t column = m.c[p].column;
    if (column < m.b[q].column) {
      ++p;
    } else if (m.b[q].column < column) {
      ++q;
    } else {
      if (diagonal[column] != 0) sum += m.c[p].value * m.b[q].value / diagonal[column];
      ++p, ++q;
    }
  }
  return sum;
}

/// Of each multiplier, as in BlockRows.
struct Scales {
  std::vector<double> scale, schur, weight;
};

/// @param[in,out] known its rows of B and C are scaled
Scales take_scales(Known& known) {
  const std::size_t n = known.multipliers.size();
  const double mean = known.mean;
  Scales made{std::vector<double>(n, 1.0), std::vector<double>(n, 1.0), std::vector<double>(n, 0.0)};
  for (std::size_t i = 0; i < n; ++i) {
    Multiplier& m = known.multipliers[i];
    const double flexibility = flexibility_of(m, known.diagonal);
    double own_diagonal = 0;
    for (const Entry& entry : m.d)
      if (entry.column == -1 - static_cast<std::int32_t>(i)) own_diagonal = entry.value;
    const double size = std::max(std::abs(flexibility), std::abs(own_diagonal));
    if (size == 0) continue;
    made.scale[i] = std::sqrt(mean / size);
    if (m.d.empty()) {
      made.weight[i] = weight_of_rows / mean * (flexibility < 0 ? -1 : 1);
      made.schur[i] = -(flexibility < 0 ? -mean : mean) / (weight_of_rows + rest_of_schur);
    } else {
      made.schur[i] = mean * (own_diagonal - flexibility) / size;
    }
    if (made.schur[i] == 0) made.schur[i] = mean;
    for (Entry& entry : m.b) entry.value *= made.scale[i];
    for (Entry& entry : m.c) entry.value *= made.scale[i];
  }
  return made;
}

/// Own rows of B, which is known by its columns.
Rows rows_of_b(const Range& own, std::span<const Multiplier> multipliers) {
  Gathering gathered(own.first, own.last);
  for (const Multiplier& m : multipliers)
    for (const Entry& entry : m.b)
      if (gathered.has(entry.column)) gathered.count(entry.column);
  gathered.make_room();
  for (std::size_t i = 0; i < multipliers.size(); ++i)
    for (const Entry& entry : multipliers[i].b)
      if (gathered.has(entry.column)) gathered.add(entry.column, static_cast<std::int32_t>(i), entry.value);
  Rows rows{.first = own.first, .last = own.last};
  for (std::int64_t row = own.first; row < own.last; ++row) append(rows, gathered.row(row));
  return rows;
}

/// Scaled, and summed up. @param d as it is known: columns are places of multipliers
std::vector<Entry> row_of_d(std::vector<Entry> d, double own_scale, std::span<const double> scale) {
  for (Entry& entry : d) {
    entry.column = -1 - entry.column;
    entry.value *= own_scale * scale[entry.column];
  }
  d.resize(summed(d).size());
  return d;
}

}  // namespace

BlockRows rows_of_part(const BlockSystem& system, const OwnEntries& entries, int part) {
  const int dimension = system.sizes.dimension;
  BlockRows made{.blocks = {system.first_block[part], system.first_block[part + 1]},
                 .multipliers = Range::of_part(system.sizes.n_multipliers, part, static_cast<int>(system.sizes.n_parts))};
  const Range own{made.blocks.first * dimension, made.blocks.last * dimension};
  const auto is_own = [&](std::int32_t row) { return row >= own.first && row < own.last; };
  Known known = known_of(system, entries);
  const Scales scales = take_scales(known);

  made.is.assign(own.last - own.first, 0);
  for (const std::int32_t place : system.place)
    if (is_own(place)) made.is[place - own.first] = 1;

  made.k = rows_of_blocks(
      made.blocks, dimension, system.sizes.is_symmetric,
      [&](const auto& use, const auto& use_block) {  // K + B W C
        for_each_entry(system, [&](std::int32_t row, std::int32_t column, double value) {
          if (column >= 0 && is_own(row)) use(row, column, value, true);
        });
        for_each_block(entries, dimension, [&](std::int32_t row, std::int32_t column, const Block& block) {
          if (row >= made.blocks.first && row < made.blocks.last) use_block(row, column, block);
        });
        for (std::size_t i = 0; i < known.multipliers.size(); ++i) {
          const double weight = scales.weight[i];
          if (weight == 0) continue;
          for (const Entry& b : known.multipliers[i].b)
            if (is_own(b.column))
              for (const Entry& c : known.multipliers[i].c) use(b.column, c.column, weight * b.value * c.value, false);
        }
        for (auto row = static_cast<std::int32_t>(own.first); row < own.last; ++row)
          if (known.diagonal[row] == 0) use(row, row, made.is[row - own.first] ? 0.0 : known.mean, true);
      },
      made.is_of_k);
  made.b = rows_of_b(own, known.multipliers);
  made.c = made.d = {.first = made.multipliers.first, .last = made.multipliers.last};
  for (std::int64_t i = made.multipliers.first; i < made.multipliers.last; ++i) {
    append(made.c, known.multipliers[i].c);
    append(made.d, row_of_d(std::move(known.multipliers[i].d), scales.scale[i], scales.scale));
    made.scale.push_back(scales.scale[i]);
    made.schur.push_back(scales.schur[i]);
    made.weight.push_back(scales.weight[i]);
  }
  return made;
}

}  // namespace lacon
