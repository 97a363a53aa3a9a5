#include "lacon/operators/evolution/problem/system.hpp"

#include <algorithm>

namespace lacon {

System::System(const Numbering& numbering, const Ragged<std::int32_t>& elements, Symmetry symmetry,
               const RowsElsewhere* elsewhere)
    : numbering_(numbering), elements_(elements), symmetry_(symmetry), elsewhere_(elsewhere) {
  residual_.assign(numbering.equation.size() + (numbering.n_vertices() - numbering.n_nodes), 0.0);
}

std::int64_t System::equation(std::int64_t unknown) const {
  return unknown < n_nodal() ? numbering_.equation[unknown] : numbering_.of_patch(unknown - n_nodal());
}

void System::make_pattern() {
  Ragged<std::int32_t> graph = vertex_graph(numbering_.n_vertices(), elements_, couplings_);
  if (on_new_graph_ && !elsewhere_) on_new_graph_({graph, numbering_});
  matrix_ = std::make_unique<SparseMatrix>(std::move(graph), numbering_, symmetry_);
  matrix_->add_elsewhere(elsewhere_);
}

void System::start(std::span<const Coupling> couplings, bool keep_stiffness) {
  if (keep_stiffness) restore_rows();
  saved_.clear();
  is_complete_ = keep_stiffness;
  if (!matrix_ || !matrix_->has_room_for(couplings)) {
    // the pattern only grows: couples that come back find their room, and the analysis stands
    couplings_.insert(couplings_.end(), couplings.begin(), couplings.end());
    const auto less = [](const Coupling& x, const Coupling& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); };
    const auto same = [](const Coupling& x, const Coupling& y) { return x.a == y.a && x.b == y.b; };
    std::sort(couplings_.begin(), couplings_.end(), less);
    couplings_.erase(std::unique(couplings_.begin(), couplings_.end(), same), couplings_.end());
    const std::unique_ptr<SparseMatrix> before = std::move(matrix_);
    make_pattern();
    if (keep_stiffness) matrix_->copy_rows(*before, first_multiplier());
  }
  matrix_->set_zero(keep_stiffness ? first_multiplier() : 0);
  std::fill(residual_.begin(), residual_.end(), 0.0);
  imposed_terms_.resize(keep_stiffness ? n_stiffness_terms_ : 0);
}

void System::stiffness_is_complete() {
  n_stiffness_terms_ = imposed_terms_.size();
  is_complete_ = true;
}

bool System::couples_nodes(std::span<const std::int64_t> unknowns, std::span<const double> lower) const {
  for (std::size_t i = 0, at = 0; i < unknowns.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j, ++at)
      if (lower[at] != 0 && unknowns[i] < n_nodal() && unknowns[j] < n_nodal()) return true;
  return false;
}

void System::save_rows(std::span<const std::int64_t> equations) {
  for (const std::int64_t row : equations) {
    if (row < 0 || row >= first_multiplier()) continue;
    const auto [saved, is_new] = saved_.try_emplace(row);
    if (!is_new) continue;
    const std::span<const double> values = matrix_->row_values(row);
    saved->second.assign(values.begin(), values.end());
  }
}

void System::restore_rows() {
  for (const auto& [row, values] : saved_) matrix_->set_row(row, values);
}

bool System::enter(std::span<const std::int64_t> unknowns, std::span<const double> residual) {
  equations_.resize(unknowns.size());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    equations_[i] = equation(unknowns[i]);
    residual_[unknowns[i]] += residual[i];
  }
  return std::any_of(equations_.begin(), equations_.end(), [](std::int64_t e) { return e < 0; });
}

void System::add(std::span<const std::int64_t> unknowns, std::span<const double> lower, std::span<const double> residual) {
  const bool meets_imposed = enter(unknowns, residual);
  if (lower.empty()) return;
  if (is_complete_ && (!matrix_->is_symmetric() || couples_nodes(unknowns, lower))) save_rows(equations_);
  matrix_->add(equations_, lower);
  if (!meets_imposed) return;
  for (std::size_t i = 0, at = 0; i < unknowns.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j, ++at) {
      if (lower[at] == 0 || (equations_[i] < 0) == (equations_[j] < 0)) continue;
      const bool first_free = equations_[i] >= 0;
      imposed_terms_.push_back({first_free ? equations_[i] : equations_[j], first_free ? unknowns[j] : unknowns[i], lower[at]});
    }
}

void System::add_unsymmetric(std::span<const std::int64_t> unknowns, std::span<const double> matrix,
                             std::span<const double> residual) {
  const bool meets_imposed = enter(unknowns, residual);
  if (is_complete_) save_rows(equations_);
  matrix_->add_unsymmetric(equations_, matrix);
  if (!meets_imposed) return;
  for (std::size_t i = 0, at = 0; i < unknowns.size(); ++i)
    for (std::size_t j = 0; j < unknowns.size(); ++j, ++at)
      if (matrix[at] != 0 && equations_[i] >= 0 && equations_[j] < 0)
        imposed_terms_.push_back({equations_[i], unknowns[j], matrix[at]});
}

void System::add_diagonal(std::int64_t unknown, double value) {
  const std::int64_t row = equation(unknown);
  if (is_complete_) save_rows({&row, 1});
  matrix_->add_diagonal(row, value);
}

std::vector<double> System::right_side(std::span<const double> external, std::span<const double> step) const {
  std::vector<double> side(numbering_.n_equations());
  for (std::int64_t unknown = 0; unknown < static_cast<std::int64_t>(residual_.size()); ++unknown)
    if (const std::int64_t e = equation(unknown); e >= 0)
      side[e] = (unknown < static_cast<std::int64_t>(external.size()) ? external[unknown] : 0.0) - residual_[unknown];
  for (const ImposedTerm& term : imposed_terms_) side[term.equation] -= term.coefficient * step[term.dof];
  if (elsewhere_ && std::ranges::any_of(step, [](double value) { return value != 0; })) {
    const std::span<const double> product = elsewhere_->product(step, false);
    for (std::size_t dof = 0; dof < product.size(); ++dof)
      if (const std::int64_t e = numbering_.equation[dof]; e >= 0) side[e] -= product[dof];
  }
  return side;
}

}  // namespace lacon
