#include "lacon/assembly/parts/element_part.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include "lacon/assembly/solid_step.hpp"

namespace lacon {

ElementPart::ElementPart(PartCells cells)
    : cells_(std::move(cells)), registry_(std::vector<std::filesystem::path>(cells_.plugins.begin(), cells_.plugins.end())) {
  mesh_.coordinates = std::exchange(cells_.coordinates, {});
  std::int32_t next = 0;
  for (PartSet& given : cells_.sets) {
    const catalog::ElementRow* const row = registry_.find_element(given.element);
    if (!row) fail("PLUGIN_4", {{"element", given.element}});
    ElementSet& set = sets_.emplace_back(solid_set(*row, registry_, given.option, cells_.unknowns));
    set.parameters = std::exchange(given.parameters, {});
    set.curve = std::exchange(given.curve, {});
    set.numbers = std::exchange(given.number, {});
    const auto width = static_cast<std::size_t>(set.n_nodes());
    for (std::size_t i = 0; i < set.numbers.size(); ++i) {
      set.cells.push_back(next++);
      mesh_.cells.push_back(std::span(given.nodes).subspan(i * width, width));
    }
    given.nodes = {};
  }
  const auto n_nodes = std::ssize(cells_.node);
  numbering_ = number_equations(n_nodes, cells_.dimension,
                                std::vector<std::uint8_t>(static_cast<std::size_t>(n_nodes * cells_.dimension), 1), 0);
  matrix_ = std::make_unique<SparseMatrix>(numbering_, mesh_.cells, std::span<const Coupling>());
  present_ = std::make_shared<State>(natural());
}

ElementPart::State ElementPart::natural() const {
  State state;
  for (const ElementSet& set : sets_) state.push_back(natural_points(set));
  return state;
}

ElementPart::State& ElementPart::present() {
  if (present_.use_count() > 1) present_ = std::make_shared<State>(*present_);
  return *present_;
}

std::vector<double> ElementPart::gathered(std::span<const double> nodal, int width) const {
  const auto w = static_cast<std::size_t>(cells_.dimension * width);
  std::vector<double> own(cells_.node.size() * w);
  for (std::size_t n = 0; n < cells_.node.size(); ++n)
    std::copy_n(nodal.data() + static_cast<std::size_t>(cells_.node[n]) * w, w, own.data() + n * w);
  return own;
}

void ElementPart::hand_out(std::span<const double> own, std::span<double> nodal, int width) const {
  const auto w = static_cast<std::size_t>(cells_.dimension * width);
  for (std::size_t n = 0; n < static_cast<std::size_t>(cells_.n_own); ++n)
    std::copy_n(own.data() + n * w, w, nodal.data() + static_cast<std::size_t>(cells_.node[n]) * w);
}

void ElementPart::evaluate(const Board& board, PartReport& report, SolidMatrix wanted, std::int64_t previous,
                           std::int64_t origin) {
  report.set = report.cell = -1;
  report.failed = 0;
  State& now = present();
  if (wanted != SolidMatrix::none) {
    if (remembers_ && remembered_.empty()) remembered_.assign(matrix_->values().begin(), matrix_->values().end());
    matrix_->set_zero();
  }
  const std::vector<double> displacement = gathered(board.displacement);
  const std::vector<double> before = previous < 0 ? std::vector<double>() : gathered(board.previous);
  const std::vector<double> at_first = origin < 0 ? std::vector<double>() : gathered(board.origin);
  std::vector<double> force(displacement.size(), 0.0);
  try {
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      const bool remembers = sets_[s].kernel->has_memory;
      SolidStart start;
      if (const std::int64_t from = remembers ? previous : origin; from >= 0)
        start = {remembers ? before : at_first, &kept_.at(from)->at(s)};
      const auto inverted =
          evaluate_step(sets_[s], mesh_, displacement, now[s], start, wanted, [&](const ElementValues& element) {
            for (std::size_t i = 0; i < element.dofs.size(); ++i) force[element.dofs[i]] += element.force[i];
            if (!element.matrix.empty()) matrix_->add(element.dofs, element.matrix);
          });
      if (inverted && report.cell < 0) {
        report.set = static_cast<std::int32_t>(s);
        report.cell = *inverted;
      }
    }
  } catch (const Error& error) {
    report.take(error.message());
  }
  hand_out(force, board.force);
}

void ElementPart::keep_natural(std::int64_t number) { kept_[number] = std::make_shared<State>(natural()); }

void ElementPart::keep_copy(std::int64_t number, std::int64_t of) { kept_[number] = std::make_shared<State>(state(of)); }

void ElementPart::keep_at_rest(std::int64_t number, std::int64_t of) {
  keep_copy(number, of);
  State& still = *kept_.at(number);
  for (std::size_t s = 0; s < sets_.size(); ++s) stop_flow(sets_[s], still[s].variable);
}

void ElementPart::strain_as(std::int64_t number) {
  State& now = present();
  for (std::size_t s = 0; s < sets_.size(); ++s)
    for (const PointQuantityRow& row : point_quantities)
      if (row.is_given) now[s].*row.values = number < 0 ? std::vector<double>() : (*kept_.at(number))[s].*row.values;
}

template <class Use>
void ElementPart::for_each_in(std::span<const CellRange> cells, PointQuantity quantity, const Use& use) const {
  std::size_t before = 0;
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    const std::vector<std::int32_t>& at = cells_.sets[s].at;
    const std::size_t width = width_of(sets_[s], quantity), first = cells[s].first, end = first + cells[s].count;
    const auto place = [&](std::size_t i) { return static_cast<std::size_t>(at[i]); };
    for (auto i = static_cast<std::size_t>(std::ranges::lower_bound(at, static_cast<std::int32_t>(first)) - at.begin());
         i < at.size() && place(i) < end; ++i)
      use(s, i, before + (place(i) - first) * width, width);
    before += cells[s].count * width;
  }
}

void ElementPart::write(std::int64_t number, PointQuantity quantity, std::span<const CellRange> cells,
                        std::span<double> values) const {
  const State& from = state(number);
  const auto held = member_of(quantity);
  for_each_in(cells, quantity, [&](std::size_t set, std::size_t cell, std::size_t at, std::size_t width) {
    if (cells_.sets[set].is_own[cell]) std::copy_n((from[set].*held).data() + cell * width, width, values.data() + at);
  });
}

void ElementPart::read(std::int64_t number, PointQuantity quantity, std::span<const CellRange> cells,
                       std::span<const double> values) {
  State& to = number < 0 ? present() : *kept_.at(number);
  const auto held = member_of(quantity);
  for (std::size_t s = 0; s < sets_.size(); ++s)
    if (cells[s].count > 0) (to[s].*held).resize(sets_[s].cells.size() * width_of(sets_[s], quantity));
  for_each_in(cells, quantity, [&](std::size_t set, std::size_t cell, std::size_t at, std::size_t width) {
    std::copy_n(values.data() + at, width, (to[set].*held).data() + cell * width);
  });
}

bool ElementPart::flows(std::int64_t since) const {
  for (std::size_t s = 0; s < sets_.size(); ++s)
    if (has_flowed(sets_[s], (*present_)[s].variable, state(since)[s].variable)) return true;
  return false;
}

void ElementPart::multiply(const Board& board, bool magnitudes) const {
  const std::vector<double> x = gathered(board.displacement);
  std::vector<double> y(x.size());
  magnitudes ? matrix_->multiply_magnitudes(x, y) : matrix_->multiply(x, y);
  hand_out(y, board.other);
}

void ElementPart::multiply(std::span<const double> x, std::span<double> y, int n_columns) const {
  const std::vector<double> own = gathered(x, n_columns);
  std::vector<double> product(own.size());
  matrix_->multiply_together(own, product, n_columns);
  hand_out(product, y, n_columns);
}

void ElementPart::measure(const Board& board) const {
  std::vector<double> sum(cells_.equation.size(), 0.0), entries(cells_.equation.size(), 0.0);
  const auto count = [&](std::int64_t row, std::int64_t column, double value) {
    if (cells_.equation[column] < 0) return;
    sum[row] += std::abs(value);
    ++entries[row];
  };
  for (std::int64_t row = 0; row < matrix_->size(); ++row)
    for (std::int64_t k = matrix_->rows()[row]; k < matrix_->rows()[row + 1]; ++k) {
      const std::int32_t column = matrix_->columns()[k];
      count(row, column, matrix_->values()[k]);
      if (column != row) count(column, row, matrix_->values()[k]);
    }
  hand_out(sum, board.force);
  hand_out(entries, board.other);
}

void ElementPart::write_diagonal(const Board& board) const {
  std::vector<double> diagonal(cells_.equation.size());
  for (std::size_t i = 0; i < diagonal.size(); ++i) diagonal[i] = matrix_->diagonal(static_cast<std::int64_t>(i));
  hand_out(diagonal, board.other);
}

void ElementPart::write_maxima(const Board& board) const {
  const std::vector<double> scale = gathered(board.displacement);
  std::vector<double> most(scale.size(), 0.0);
  for (std::int64_t row = 0; row < matrix_->size(); ++row)
    for (std::int64_t k = matrix_->rows()[row]; k < matrix_->rows()[row + 1]; ++k) {
      const std::int32_t column = matrix_->columns()[k];
      const double value = std::abs(matrix_->values()[k]) * scale[row] * scale[column];
      most[row] = std::max(most[row], value);
      most[column] = std::max(most[column], value);
    }
  hand_out(most, board.other);
}

void ElementPart::remember() {
  remembers_ = true;
  remembered_ = {};
}

double ElementPart::change() const {
  if (remembered_.empty()) return 0;
  const std::span<const std::int64_t> rows = matrix_->rows();
  const std::int64_t own = cells_.n_own * cells_.dimension;
  double largest = 0;
  for (std::int64_t i = 0; i < matrix_->size(); ++i)
    for (std::int64_t k = rows[i]; k < rows[i + 1]; ++k) {
      const std::int32_t j = matrix_->columns()[k];
      const double difference = matrix_->values()[k] - remembered_[k];
      if (difference == 0 || (i >= own && j >= own) || cells_.equation[i] < 0 || cells_.equation[j] < 0) continue;
      const std::int64_t a = i < own ? i : j, b = j < own ? j : i;  // a diagonal is whole where the node is an own one
      const double size = std::abs(remembered_[rows[a + 1] - 1] * remembered_[rows[b + 1] - 1]);
      largest = std::max(largest, difference * difference / size);
    }
  return largest;
}

void ElementPart::add_to(std::span<const std::int64_t> row, std::span<const std::int32_t> column,
                         std::span<double> value) const {
  for_each_own([&](std::int32_t i, std::int32_t j, double entry) {
    const auto columns = column.subspan(row[i], row[i + 1] - row[i]);
    const auto found = std::ranges::lower_bound(columns, j);
    value[row[i] + (found - columns.begin())] += entry;
  });
}

}  // namespace lacon
