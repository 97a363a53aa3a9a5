#include "lacon/operators/evolution/system.hpp"

#include <algorithm>

namespace lacon {

System::System(const Numbering& numbering, const Ragged<std::int32_t>& elements) : numbering_(numbering), elements_(elements) {
  residual_.assign(numbering.equation.size() + (numbering.n_vertices() - numbering.n_nodes), 0.0);
  make_pattern();
}

std::int64_t System::equation(std::int64_t unknown) const {
  return unknown < n_displacements() ? numbering_.equation[unknown] : numbering_.of_patch(unknown - n_displacements());
}

void System::make_pattern() { matrix_ = std::make_unique<SymmetricMatrix>(numbering_, elements_, couplings_); }

void System::start(std::span<const Coupling> couplings, bool keep_stiffness) {
  if (!matrix_->has_room_for(couplings)) {
    // the pattern only grows: couples that come back find their room, and the analysis stands
    couplings_.insert(couplings_.end(), couplings.begin(), couplings.end());
    const auto less = [](const Coupling& x, const Coupling& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); };
    const auto same = [](const Coupling& x, const Coupling& y) { return x.a == y.a && x.b == y.b; };
    std::sort(couplings_.begin(), couplings_.end(), less);
    couplings_.erase(std::unique(couplings_.begin(), couplings_.end(), same), couplings_.end());
    const std::unique_ptr<SymmetricMatrix> before = std::move(matrix_);
    make_pattern();
    if (keep_stiffness) matrix_->copy_rows(*before, first_multiplier());
  }
  matrix_->set_zero(keep_stiffness ? first_multiplier() : 0);
  std::fill(residual_.begin(), residual_.end(), 0.0);
  imposed_terms_.resize(keep_stiffness ? n_stiffness_terms_ : 0);
}

void System::add(std::span<const std::int64_t> unknowns, std::span<const double> lower, std::span<const double> residual) {
  thread_local std::vector<std::int64_t> equations;
  equations.resize(unknowns.size());
  bool meets_imposed = false;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    equations[i] = equation(unknowns[i]);
    residual_[unknowns[i]] += residual[i];
    meets_imposed = meets_imposed || equations[i] < 0;
  }
  if (lower.empty()) return;
  matrix_->add(equations, lower);
  if (!meets_imposed) return;
  for (std::size_t i = 0, at = 0; i < unknowns.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j, ++at) {
      if (lower[at] == 0 || (equations[i] < 0) == (equations[j] < 0)) continue;
      const bool first_free = equations[i] >= 0;
      imposed_terms_.push_back({first_free ? equations[i] : equations[j], first_free ? unknowns[j] : unknowns[i], lower[at]});
    }
}

void System::add_diagonal(std::int64_t unknown, double value) { matrix_->add_diagonal(equation(unknown), value); }

std::vector<double> System::right_side(std::span<const double> external, std::span<const double> step) const {
  std::vector<double> side(numbering_.n_equations());
  for (std::int64_t unknown = 0; unknown < static_cast<std::int64_t>(residual_.size()); ++unknown)
    if (const std::int64_t e = equation(unknown); e >= 0)
      side[e] = (unknown < static_cast<std::int64_t>(external.size()) ? external[unknown] : 0.0) - residual_[unknown];
  for (const ImposedTerm& term : imposed_terms_) side[term.equation] -= term.coefficient * step[term.dof];
  return side;
}

}  // namespace lacon
