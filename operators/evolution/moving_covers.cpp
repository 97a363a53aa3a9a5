#include "lacon/operators/evolution/moving_covers.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>

#include "lacon/operators/evolution/convergence.hpp"
#include "lacon/operators/evolution/equilibrium.hpp"

namespace lacon {
namespace {

constexpr double singular = 1e-3;  // of the complement, which is 1 where covers stay

double moved(const MovingCover& cover, const std::vector<double>& x) {
  double sum = 0;
  for (const auto& [equation, value] : cover.row) sum += value * x[static_cast<std::size_t>(equation)];
  return sum;
}

}  // namespace

std::int64_t follow_covers(std::span<const MovingCover> covers, double size,
                           const std::function<void(std::vector<double>&)>& solve, std::vector<double>& x) {
  if (covers.empty() || !(size > 0)) return 0;
  const auto n = static_cast<Eigen::Index>(covers.size());
  std::vector<std::vector<double>> answers;
  Eigen::MatrixXd complement = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd motion(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const MovingCover& cover = covers[static_cast<std::size_t>(k)];
    std::vector<double>& answer = answers.emplace_back(cover.column);
    const double factor = size / largest_entry(cover.column);
    if (!std::isfinite(factor)) return 0;
    for (double& value : answer) value *= factor;
    solve(answer);
    for (double& value : answer) value /= factor;
    for (Eigen::Index i = 0; i < n; ++i) complement(i, k) += moved(covers[static_cast<std::size_t>(i)], answer);
    motion[k] = moved(cover, x);
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> factor(complement);
  if (!(factor.rcond() > singular)) return 0;
  const Eigen::VectorXd by = factor.solve(motion);
  for (Eigen::Index k = 0; k < n; ++k)
    for (std::size_t i = 0; i < x.size(); ++i) x[i] -= by[k] * answers[static_cast<std::size_t>(k)][i];
  // the determinants of A and of the sum differ by that of the complement
  const Eigen::VectorXcd values = complement.eigenvalues();
  return std::ranges::count_if(values, [](const std::complex<double>& value) { return value.imag() == 0 && value.real() < 0; });
}

std::vector<MovingCover> Equilibrium::moving_covers(const StaticState& state, std::span<const double> step) const {
  std::vector<MovingCover> covers;
  if (!contact_) return covers;
  for (const CoverEnd& end : contact_->moving_ends(state.patches)) {
    MovingCover& cover = covers.emplace_back();
    cover.column.assign(static_cast<std::size_t>(problem_.numbering.n_equations()), 0.0);
    for (std::size_t i = 0; i < end.unknowns.size(); ++i) {
      const std::int64_t unknown = system_.unknown(end.unknowns[i].vertex, end.unknowns[i].component);
      if (const std::int64_t e = system_.equation(unknown); e >= 0) {
        cover.column[static_cast<std::size_t>(e)] += end.column[i];
        cover.row.emplace_back(e, end.row[i]);
      } else {
        cover.step += end.row[i] * step[static_cast<std::size_t>(unknown)];
      }
    }
  }
  return covers;
}

}  // namespace lacon
