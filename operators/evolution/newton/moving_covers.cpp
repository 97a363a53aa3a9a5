#include "lacon/operators/evolution/newton/moving_covers.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>

#include "lacon/assembly/gmres.hpp"
#include "lacon/operators/evolution/newton/convergence.hpp"
#include "lacon/operators/evolution/newton/equilibrium.hpp"

namespace lacon {
namespace {

constexpr double singular = 1e-3;  // of the complement, which is 1 where covers stay
constexpr std::size_t few = 12;    // terms
constexpr double enough = 1e-4;    // of the motion, that GMRES may leave: iterations of Newton's method gain as much
constexpr int iterations = 15;
constexpr double in_vain = 0.3;  // of it: what is left is no better than nothing

using Entries = std::vector<std::pair<std::int64_t, double>>;

double product(const Entries& row, const std::vector<double>& x) {
  double sum = 0;
  for (const auto& [equation, value] : row) sum += value * x[static_cast<std::size_t>(equation)];
  return sum;
}

void add(double factor, const Entries& column, std::vector<double>& to) {
  for (const auto& [equation, value] : column) to[static_cast<std::size_t>(equation)] += factor * value;
}

/// A^-1 side, by a right side of the size given. @return whether there is one
bool solve_scaled(std::vector<double>& side, double size, const std::function<void(std::vector<double>&)>& solve) {
  const double factor = size / largest_entry(side);
  if (!std::isfinite(factor)) return false;
  for (double& value : side) value *= factor;
  solve(side);
  for (double& value : side) value /= factor;
  return true;
}

std::int64_t follow_few(std::span<const MovingCover> covers, double size,
                        const std::function<void(std::vector<double>&)>& solve, std::vector<double>& x) {
  const auto n = static_cast<Eigen::Index>(covers.size());
  std::vector<std::vector<double>> answers;
  Eigen::MatrixXd complement = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd motion(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    std::vector<double>& answer = answers.emplace_back(x.size());
    add(1, covers[static_cast<std::size_t>(k)].column, answer);
    if (!solve_scaled(answer, size, solve)) return 0;
    for (Eigen::Index i = 0; i < n; ++i) complement(i, k) += product(covers[static_cast<std::size_t>(i)].row, answer);
    motion[k] = product(covers[static_cast<std::size_t>(k)].row, x);
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

void follow_many(std::span<const MovingCover> covers, double size, const std::function<void(std::vector<double>&)>& solve,
                 std::vector<double>& x) {
  const std::vector<double> alike(covers.size(), 1.0);
  std::vector<double> motion;
  double squares = 0;
  for (const MovingCover& cover : covers) {
    motion.push_back(product(cover.row, x));
    squares += motion.back() * motion.back();
  }
  if (!(squares > 0)) return;
  std::vector<double> answer;
  const auto multiply = [&](std::span<const double> by, std::span<double> moved) {
    answer.assign(x.size(), 0.0);
    for (std::size_t k = 0; k < covers.size(); ++k) add(by[k], covers[k].column, answer);
    if (!solve_scaled(answer, size, solve)) answer.assign(x.size(), 0.0);
    for (std::size_t k = 0; k < covers.size(); ++k) moved[k] = by[k] + product(covers[k].row, answer);
  };
  const GmresResult found = gmres(multiply, [](std::span<double>) {}, alike, motion,
                                  {.goal = enough * std::sqrt(squares), .iterations = iterations, .cycles = 1});
  if (!(found.residual < in_vain * std::sqrt(squares))) return;
  // what the last product was made of: it says what is left
  for (std::size_t i = 0; i < x.size(); ++i) x[i] -= answer[i];
}

}  // namespace

std::int64_t follow_covers(std::span<const MovingCover> covers, double size,
                           const std::function<void(std::vector<double>&)>& solve, std::vector<double>& x) {
  if (covers.empty() || !(size > 0)) return 0;
  if (covers.size() <= few) return follow_few(covers, size, solve, x);
  follow_many(covers, size, solve, x);
  return 0;
}

std::vector<MovingCover> Equilibrium::moving_covers(const StaticState& state, std::span<const double> step) const {
  std::vector<MovingCover> covers;
  if (!contact_) return covers;
  for (const CoverEnd& end : contact_->moving_ends(state.patches)) {
    // all move by displacements of the same size: lines of small masters and of large ones are alike
    const double size = largest_entry(end.row);
    if (!(size > 0)) continue;
    MovingCover& cover = covers.emplace_back();
    for (std::size_t i = 0; i < end.unknowns.size(); ++i) {
      const std::int64_t unknown = system_.unknown(end.unknowns[i].vertex, end.unknowns[i].component);
      if (const std::int64_t e = system_.equation(unknown); e >= 0) {
        cover.column.emplace_back(e, size * end.column[i]);
        cover.row.emplace_back(e, end.row[i] / size);
      } else {
        cover.step += end.row[i] / size * step[static_cast<std::size_t>(unknown)];
      }
    }
  }
  return covers;
}

}  // namespace lacon
