#include "lacon/assembly/sparse_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

constexpr std::size_t vertices_at_once = 2048;  // in one block of a loop
constexpr std::size_t values_at_once = 65536;   // likewise
// of rows, in which sums are gathered: not more than this, however many threads there are, and one where sums take no time
constexpr std::int64_t most_parts = 4, rows_of_a_part = 8192;

/// In threads, for pages that are touched first take longer than all else.
void fill_with_zeros(std::span<double> values) {
  parallel_for(values.size(), values_at_once,
               [&](const LoopBlock& block) { std::fill(values.begin() + block.first, values.begin() + block.last, 0.0); });
}
void copy_values(std::span<const double> from, double* to) {
  parallel_for(from.size(), values_at_once, [&](const LoopBlock& block) {
    std::copy(from.begin() + block.first, from.begin() + block.last, to + block.first);
  });
}

/// The transposed list: for each vertex the cliques it belongs to.
Ragged<std::int32_t> cliques_of_vertices(std::int64_t n_vertices, const Ragged<std::int32_t>& cliques) {
  Ragged<std::int32_t> transposed;
  transposed.offset.assign(n_vertices + 1, 0);
  for (const std::int32_t v : cliques.values) ++transposed.offset[v + 1];
  for (std::int64_t v = 0; v < n_vertices; ++v) transposed.offset[v + 1] += transposed.offset[v];
  transposed.values.resize(cliques.values.size());
  std::vector<std::int64_t> next(transposed.offset.begin(), transposed.offset.end() - 1);
  for (std::size_t c = 0; c < cliques.size(); ++c)
    for (const std::int32_t v : cliques[c]) transposed.values[next[v]++] = static_cast<std::int32_t>(c);
  return transposed;
}

}  // namespace

Ragged<std::int32_t> vertex_graph(std::int64_t n_vertices, const Ragged<std::int32_t>& cliques,
                                  std::span<const Coupling> couplings) {
  const Ragged<std::int32_t> own = cliques_of_vertices(n_vertices, cliques);
  std::vector<std::vector<std::int32_t>> extra(couplings.empty() ? 0 : n_vertices);
  for (const Coupling& c : couplings) {
    extra[c.a].push_back(c.b);
    extra[c.b].push_back(c.a);
  }
  Ragged<std::int32_t> neighbours;
  neighbours.offset.reserve(n_vertices + 1);
  struct Rows {
    std::vector<std::int32_t> seen, values, sizes;
  };
  parallel_in_turn(n_vertices, vertices_at_once, [&] {
    const auto rows = std::make_shared<Rows>();
    rows->seen.assign(n_vertices, -1);
    const auto find = [rows, &own, &extra, &cliques](const LoopBlock& block) {
      rows->values.clear();
      rows->sizes.clear();
      for (auto v = static_cast<std::int32_t>(block.first); v < static_cast<std::int32_t>(block.last); ++v) {
        const std::size_t first = rows->values.size();
        rows->seen[v] = v;
        const auto take = [&](std::int32_t w) {
          if (rows->seen[w] == v) return;
          rows->seen[w] = v;
          rows->values.push_back(w);
        };
        for (const std::int32_t c : own[v])
          for (const std::int32_t w : cliques[c]) take(w);
        if (!extra.empty())
          for (const std::int32_t w : extra[v]) take(w);
        std::sort(rows->values.begin() + static_cast<std::ptrdiff_t>(first), rows->values.end());
        rows->sizes.push_back(static_cast<std::int32_t>(rows->values.size() - first));
      }
    };
    const auto append = [rows, &neighbours](const LoopBlock&) {
      neighbours.values.insert(neighbours.values.end(), rows->values.begin(), rows->values.end());
      for (const std::int32_t size : rows->sizes) neighbours.offset.push_back(neighbours.offset.back() + size);
    };
    return LoopWorker{find, append};
  });
  return neighbours;
}

SparseMatrix::SparseMatrix(const Numbering& numbering, const Ragged<std::int32_t>& cliques, std::span<const Coupling> couplings,
                           Symmetry symmetry)
    : SparseMatrix(vertex_graph(numbering.n_vertices(), cliques, couplings), numbering, symmetry) {}

SparseMatrix::SparseMatrix(Ragged<std::int32_t> neighbours, const Numbering& numbering, Symmetry symmetry)
    : numbering_(&numbering), symmetry_(symmetry) {
  const auto pattern = std::make_shared<Pattern>();
  pattern->neighbours = std::move(neighbours);
  pattern_ = pattern;
  const auto& first = numbering.first;
  std::vector<std::int64_t>& rows = pattern->row;
  rows.reserve(numbering.n_equations() + 1);
  rows.push_back(0);
  // neighbours of v whose columns come before its own
  const auto before = [&](std::int64_t v) {
    const auto row = pattern_->neighbours[v];
    return row.first(std::lower_bound(row.begin(), row.end(), v) - row.begin());
  };
  const auto behind = [&](std::int64_t v) { return pattern_->neighbours[v].subspan(before(v).size()); };
  const auto n_equations = [&](std::span<const std::int32_t> vertices) {
    return std::accumulate(vertices.begin(), vertices.end(), std::int64_t{0},
                           [&](std::int64_t sum, std::int32_t w) { return sum + first[w + 1] - first[w]; });
  };
  for (std::int64_t v = 0; v < numbering.n_vertices(); ++v) {
    const std::int64_t width = n_equations(is_symmetric() ? before(v) : pattern_->neighbours[v]), own = first[v + 1] - first[v];
    for (std::int64_t i = 1; i <= own; ++i) rows.push_back(rows.back() + width + (is_symmetric() ? i : own));
  }
  const auto n_entries = static_cast<std::size_t>(rows.back());
  pattern->column = std::make_unique_for_overwrite<std::int32_t[]>(n_entries);
  row_ = rows;
  column_ = {pattern->column.get(), n_entries};
  values_ = std::make_shared_for_overwrite<double[]>(n_entries);
  value_ = {values_.get(), n_entries};
  fill_with_zeros({values_.get(), n_entries});
  parallel_for(numbering.n_vertices(), vertices_at_once, [&](const LoopBlock& block) {
    for (std::size_t v = block.first; v < block.last; ++v)
      for (std::int64_t row = first[v]; row < first[v + 1]; ++row) {
        std::int32_t* column = pattern->column.get() + row_[row];
        const auto add = [&](std::int64_t from, std::int64_t to) {
          for (; from < to; ++from) *column++ = static_cast<std::int32_t>(from);
        };
        for (const std::int32_t w : before(v)) add(first[w], first[w + 1]);
        add(first[v], is_symmetric() ? row + 1 : first[v + 1]);
        if (is_symmetric()) continue;
        for (const std::int32_t w : behind(v)) add(first[w], first[w + 1]);
      }
  });
}

bool SparseMatrix::has_room_for(std::span<const Coupling> couplings) const {
  return std::all_of(couplings.begin(), couplings.end(), [&](const Coupling& c) {
    const auto row = pattern_->neighbours[c.a];
    return c.a == c.b || std::binary_search(row.begin(), row.end(), c.b);
  });
}

double* SparseMatrix::own_values() {
  if (values_.use_count() > 1) {
    const std::span<const double> shared = value_;
    std::shared_ptr<double[]> own = std::make_shared_for_overwrite<double[]>(shared.size());
    copy_values(shared, own.get());
    values_ = std::move(own);
    value_ = {values_.get(), shared.size()};
  }
  return values_.get();
}

void SparseMatrix::set_zero(std::int64_t first_row) {
  double* const values = own_values();
  fill_with_zeros({values + row_[first_row], values + row_.back()});
}

void SparseMatrix::restore(std::span<const double> values) { copy_values(values, own_values()); }

void SparseMatrix::set_row(std::int64_t row, std::span<const double> values) {
  std::copy(values.begin(), values.end(), own_values() + row_[row]);
}

void SparseMatrix::copy_rows(const SparseMatrix& other, std::int64_t n_rows) {
  double* const values = own_values();
  for (std::int64_t row = 0; row < n_rows; ++row) {
    std::int64_t k = other.row_[row];
    const std::int64_t last = other.row_[row + 1];
    for (std::int64_t own = row_[row]; own < row_[row + 1]; ++own) {
      const bool known = k < last && other.column_[k] == column_[own];
      values[own] = known ? other.value_[k] : 0;
      k += known;
    }
    if (k < last) throw std::logic_error("rows of another pattern");
  }
}

template <bool lower, class Value>
void SparseMatrix::add_rows(std::span<const std::int64_t> equations, const Value& value) {
  // by ascending equation: each entry of a triangle then belongs to the row of the later one, and the columns of a row follow
  // each other
  adding_.clear();
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(equations.size()); ++i)
    if (equations[i] >= 0) adding_.push_back({static_cast<std::int32_t>(equations[i]), i, i * (i + 1) / 2, 0});
  std::sort(adding_.begin(), adding_.end(), [](const Added& a, const Added& b) { return a.equation < b.equation; });
  double* const all = own_values();
  for (std::size_t i = 0; i < adding_.size(); ++i) {
    const Added own = adding_[i];
    const std::int32_t* const columns = column_.data() + row_[own.equation];
    double* const values = all + row_[own.equation];
    const auto width = static_cast<std::int32_t>(row_[own.equation + 1] - row_[own.equation]);
    std::int32_t next = 0;  // behind the last column that was found in this row
    for (std::size_t j = 0; j < (lower ? i + 1 : adding_.size()); ++j) {
      Added& other = adding_[j];
      const double part = value(own, other);
      // most often it is where it was in the row before, which the same node has, or behind the column before
      if (other.place >= width || columns[other.place] != other.equation) {
        if (part == 0) continue;  // needs no place
        other.place = next;
        if (next >= width || columns[next] != other.equation) {
          other.place = static_cast<std::int32_t>(std::lower_bound(columns, columns + width, other.equation) - columns);
          if (other.place == width || columns[other.place] != other.equation)
            throw std::logic_error("an element matrix does not fit the pattern of the matrix");
        }
      }
      // an entry and its mirror image fall on one diagonal entry where two degrees of freedom share their equation
      values[other.place] += lower && i != j && own.equation == other.equation ? 2 * part : part;
      next = other.place + 1;
    }
  }
}

void SparseMatrix::add(std::span<const std::int64_t> equations, std::span<const double> lower) {
  const auto value = [lower](const Added& own, const Added& other) {
    return lower[own.local > other.local ? own.start + other.local : other.start + own.local];
  };
  is_symmetric() ? add_rows<true>(equations, value) : add_rows<false>(equations, value);
}

void SparseMatrix::add_unsymmetric(std::span<const std::int64_t> equations, std::span<const double> values) {
  if (is_symmetric()) throw std::logic_error("an unsymmetric element matrix for a symmetric matrix");
  add_rows<false>(equations,
                  [&](const Added& own, const Added& other) { return values[own.local * equations.size() + other.local]; });
}

std::int64_t SparseMatrix::diagonal_place(std::int64_t equation) const {
  if (is_symmetric()) return row_[equation + 1] - 1;
  const auto row = column_.begin() + row_[equation];
  return std::lower_bound(row, column_.begin() + row_[equation + 1], equation) - column_.begin();
}

std::vector<double> SparseMatrix::diagonals() const {
  std::vector<double> values(static_cast<std::size_t>(size()));
  for (std::int64_t i = 0; i < size(); ++i) values[i] = diagonal(i);
  if (!elsewhere_) return values;
  const std::span<const double> more = elsewhere_->diagonal();
  for (std::size_t dof = 0; dof < more.size(); ++dof)
    if (const std::int64_t e = numbering_->equation[dof]; e >= 0) values[e] += more[dof];
  return values;
}

void SparseMatrix::add_diagonal(std::int64_t equation, double value) { own_values()[diagonal_place(equation)] += value; }

std::vector<std::int64_t> SparseMatrix::parts_of_rows() const {
  const std::int64_t count = is_symmetric() ? std::clamp<std::int64_t>(size() / rows_of_a_part, 1, most_parts) : 1;
  std::vector<std::int64_t> first{0};
  for (std::int64_t part = 1; part < count; ++part)
    first.push_back(std::lower_bound(row_.begin(), row_.end(), n_entries() / count * part) - row_.begin());
  first.push_back(size());
  return first;
}

template <class Work, class Join>
void SparseMatrix::gather(std::span<double> y, std::size_t width, const Work& work, const Join& join) const {
  const std::vector<std::int64_t> first = parts_of_rows();
  const std::size_t last_part = first.size() - 2;
  std::vector<std::vector<double>> sums(last_part);  // the last one's are y
  parallel_for(last_part + 1, 1, [&](const LoopBlock& block) {
    const std::int64_t from = first[block.first], to = first[block.last];
    if (block.first < last_part) sums[block.first].assign(static_cast<std::size_t>(to) * width, 0.0);
    const std::span<double> own = block.first < last_part ? std::span(sums[block.first]) : y;
    if (block.first == last_part) std::fill(y.begin(), y.end(), 0.0);
    work(from, to, own);
  });
  if (sums.empty()) return;
  parallel_for(sums.back().size(), values_at_once, [&](const LoopBlock& block) {
    for (std::size_t i = block.first; i < block.last; ++i) {
      double joined = 0;
      for (const std::vector<double>& own : sums)
        if (i < own.size()) joined = join(joined, own[i]);
      y[i] = join(joined, y[i]);
    }
  });
}

std::vector<SparseMatrix::RowSize> SparseMatrix::row_sizes(std::int64_t n) const {
  std::vector<double> counted(2 * static_cast<std::size_t>(size()));  // sums, and numbers of entries behind each
  gather(
      counted, 2,
      [&](std::int64_t first, std::int64_t last, std::span<double> sums) {
        const auto count = [&](std::int64_t row, double value) {
          sums[2 * static_cast<std::size_t>(row)] += std::abs(value);
          ++sums[2 * static_cast<std::size_t>(row) + 1];
        };
        for (std::int64_t row = first; row < std::min(last, n); ++row)
          for (std::int64_t k = row_[row]; k < row_[row + 1]; ++k) {
            if (column_[k] >= n) continue;
            count(row, value_[k]);
            if (is_symmetric() && column_[k] != row) count(column_[k], value_[k]);
          }
      },
      std::plus());
  std::vector<RowSize> sizes;
  for (std::size_t row = 0; row < static_cast<std::size_t>(n); ++row)
    sizes.push_back({counted[2 * row], static_cast<std::int32_t>(counted[2 * row + 1])});
  if (!elsewhere_) return sizes;
  const auto [sum, entries] = elsewhere_->row_sizes();
  for (std::size_t dof = 0; dof < sum.size(); ++dof)
    if (const std::int64_t row = numbering_->equation[dof]; row >= 0 && row < n) {
      sizes[row].sum += sum[dof];
      sizes[row].entries = std::max(sizes[row].entries, static_cast<std::int32_t>(entries[dof]));
    }
  return sizes;
}

template <class Function>
void SparseMatrix::multiply(std::span<const double> x, std::span<double> y, const Function& f) const {
  const auto rows = [&](std::int64_t first, std::int64_t end, std::span<double> sums) {
    for (std::int64_t row = first; row < end; ++row) {
      double sum = 0;
      const std::int64_t last = row_[row + 1] - 1;
      for (std::int64_t k = row_[row]; k < last; ++k) {
        sum += f(value_[k]) * f(x[column_[k]]);
        if (is_symmetric()) sums[column_[k]] += f(value_[k]) * f(x[row]);
      }
      sums[row] += sum + f(value_[last]) * f(x[column_[last]]);
    }
  };
  gather(y, 1, rows, std::plus());
}

void SparseMatrix::multiply(std::span<const double> x, std::span<double> y) const {
  multiply(x, y, [](double v) { return v; });
  if (elsewhere_) multiply_elsewhere(x, y, false);
}

void SparseMatrix::multiply_magnitudes(std::span<const double> x, std::span<double> y) const {
  multiply(x, y, [](double v) { return std::abs(v); });
  if (elsewhere_) multiply_elsewhere(x, y, true);
}

void SparseMatrix::multiply_together(std::span<const double> x, std::span<double> y, int n_columns) const {
  const auto n = static_cast<std::size_t>(n_columns);
  const auto rows = [&](std::int64_t first, std::int64_t end, std::span<double> sums) {
    std::vector<double> sum(n);
    for (auto row = static_cast<std::size_t>(first); row < static_cast<std::size_t>(end); ++row) {
      std::fill(sum.begin(), sum.end(), 0.0);
      const double* const own = &x[row * n];
      const std::int64_t last = row_[row + 1] - 1;
      for (std::int64_t k = row_[row]; k < last; ++k) {
        const double value = value_[k], magnitude = std::abs(value);
        const std::size_t at = static_cast<std::size_t>(column_[k]) * n;
        for (std::size_t c = 0; c + 1 < n; ++c) {
          sum[c] += value * x[at + c];
          sums[at + c] += value * own[c];
        }
        sum[n - 1] += magnitude * std::abs(x[at + n - 1]);
        sums[at + n - 1] += magnitude * std::abs(own[n - 1]);
      }
      for (std::size_t c = 0; c + 1 < n; ++c) sums[row * n + c] += sum[c] + value_[last] * own[c];
      sums[row * n + n - 1] += sum[n - 1] + std::abs(value_[last]) * std::abs(own[n - 1]);
    }
  };
  gather(y, n, rows, std::plus());
}

std::vector<double> SparseMatrix::nodal(std::span<const double> x) const {
  const std::vector<std::int64_t>& equation = numbering_->equation;
  std::vector<double> values(equation.size(), 0.0);
  for (std::size_t dof = 0; dof < values.size(); ++dof)
    if (equation[dof] >= 0) values[dof] = x[equation[dof]];
  return values;
}

void SparseMatrix::multiply_elsewhere(std::span<const double> x, std::span<double> y, bool magnitudes) const {
  const std::vector<std::int64_t>& equation = numbering_->equation;
  const std::span<const double> product = elsewhere_->product(nodal(x), magnitudes);
  for (std::size_t dof = 0; dof < equation.size(); ++dof)
    if (equation[dof] >= 0) y[equation[dof]] += product[dof];
}

std::vector<std::int64_t> SparseMatrix::rows_alone() const {
  std::vector<std::uint8_t> alone(static_cast<std::size_t>(size()), 1);
  for (std::int64_t row = 0; row < size(); ++row)
    for (std::int64_t k = rows()[row]; k < rows()[row + 1]; ++k)
      if (const std::int32_t column = columns()[k]; column != row && values()[k] != 0) {
        alone[row] = 0;
        if (is_symmetric()) alone[column] = 0;  // of its row the lower triangle alone is there
      }
  std::vector<std::int64_t> found;
  for (std::int64_t i = elsewhere_ ? numbering_->first[numbering_->n_nodes] : 0; i < size(); ++i)
    if (alone[i] && diagonal(i) != 0) found.push_back(i);
  return found;
}

std::vector<double> SparseMatrix::multiplier_scale() const {
  constexpr double counts = 0.01;  // of a multiplier's largest coupling: others may be next to nothing
  const std::int64_t first = numbering_->first[numbering_->n_nodes], n_multipliers = size() - first;
  const auto for_each_coupling = [&](const auto& use) {
    for (std::int64_t row = is_symmetric() ? first : 0; row < size(); ++row)
      for (std::int64_t k = row_[row]; k < row_[row + 1]; ++k)
        if (const std::int64_t column = column_[k], node = std::min(row, column), multiplier = std::max(row, column) - first;
            node < first && multiplier >= 0)
          use(node, multiplier, std::abs(value_[k]));
  };
  std::vector<double> largest(n_multipliers, 0.0);
  for_each_coupling([&](std::int64_t, std::int64_t i, double coupling) { largest[i] = std::max(largest[i], coupling); });
  const std::vector<double> stiffness = diagonals();
  std::vector<double> ratio(n_multipliers, 0.0);  // the largest one of a diagonal to its coupling
  for_each_coupling([&](std::int64_t node, std::int64_t i, double coupling) {
    if (coupling > counts * largest[i]) ratio[i] = std::max(ratio[i], std::abs(stiffness[node]) / coupling);
  });
  std::vector<double> scale(size(), 1.0);
  for (std::int64_t i = 0; i < n_multipliers; ++i)
    if (ratio[i] > 0 && ratio[i] < 1) scale[first + i] = std::exp2(std::floor(std::log2(ratio[i])));
  return scale;
}

std::vector<double> SparseMatrix::equilibration() const {
  std::vector<double> scale = multiplier_scale(), largest(size());
  constexpr int most_rounds = 20;  // each takes the square root of what is still to be done, at once where diagonals are large
  bool done = false;
  for (int round = 0; round < most_rounds && !done; ++round) {
    done = true;
    gather(
        largest, 1,
        [&](std::int64_t first, std::int64_t last, std::span<double> most) {
          for (std::int64_t row = first; row < last; ++row)
            for (std::int64_t k = row_[row]; k < row_[row + 1]; ++k) {
              const double value = std::abs(value_[k]) * scale[row] * scale[column_[k]];
              most[row] = std::max(most[row], value);
              most[column_[k]] = std::max(most[column_[k]], value);
            }
        },
        [](double a, double b) { return std::max(a, b); });
    if (elsewhere_) {
      const std::span<const double> more = elsewhere_->row_maxima(nodal(scale));
      for (std::size_t dof = 0; dof < more.size(); ++dof)
        if (const std::int64_t e = numbering_->equation[dof]; e >= 0) largest[e] = std::max(largest[e], more[dof]);
    }
    for (std::int64_t row = 0; row < size(); ++row) {
      if (largest[row] > 0) scale[row] /= std::sqrt(largest[row]);
      done = done && (largest[row] == 0 || std::abs(std::log2(largest[row])) < 1);
    }
  }
  for (double& value : scale) value = std::exp2(std::round(std::log2(value)));
  return scale;
}

double SparseMatrix::norm() const {
  double largest = 0;
  for (const RowSize& row : row_sizes(size())) largest = std::max(largest, row.sum);
  return largest;
}

}  // namespace lacon
