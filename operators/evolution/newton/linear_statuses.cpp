#include "lacon/operators/evolution/newton/linear_statuses.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "lacon/operators/evolution/newton/complementarity.hpp"

namespace lacon {
namespace {

constexpr double reach = 0.5;          // of h: average gap up to which an open patch may take contact within an iteration
constexpr double digits = 1e-6;        // of columns of the inverse: they come in single precision
constexpr double nothing = 1e-9;       // of the unit: what a patch may be pulled or gone into by
constexpr std::size_t together = 128;  // columns

}  // namespace

template <class Number>
double LinearStatuses::along(const Pair& pair, std::span<const Number> x) const {
  if (pair.opens) return -static_cast<double>(x[static_cast<std::size_t>(multiplier(pair))]);
  double sum = 0;
  for (std::size_t i = 0; i < pair.equations.size(); ++i)
    sum += pair.derivative[i] * static_cast<double>(x[static_cast<std::size_t>(pair.equations[i])]);
  return sum;
}

LinearStatuses::LinearStatuses(const ContactState& contact, const System& system, const Patchwise& patches,
                               std::span<const double> solution, std::span<const double> step)
    : contact_(contact), system_(system), patches_(patches) {
  std::vector<std::size_t> open;
  for (std::size_t p = 0; p < patches.status.size(); ++p) {
    if (contact.may_open(p, patches))
      pairs_.push_back({.patch = p, .opens = true, .equations = {}, .derivative = {}, .start = -patches.lambda[p]});
    if (contact.may_close(p, patches, reach)) open.push_back(p);
  }
  const std::vector<GapRow> rows = contact.gap_rows(open);
  for (std::size_t i = 0; i < open.size(); ++i) pairs_.push_back(closing(open[i], rows[i], step));

  double pressure = 0;
  first_.resize(std::ssize(pairs_));
  for (Eigen::Index i = 0; i < first_.size(); ++i) {
    const Pair& pair = pairs_[static_cast<std::size_t>(i)];
    first_[i] = w(pair, solution);
    pressure = std::max(pressure, pair.opens ? std::abs(first_[i]) : -first_[i] * contact.pressure_of_gap(pair.patch));
  }
  for (Eigen::Index i = 0; i < first_.size(); ++i) {
    Pair& pair = pairs_[static_cast<std::size_t>(i)];
    const double gap = pressure / contact.pressure_of_gap(pair.patch);
    pair.unit_w = pair.opens ? pressure : gap;
    pair.unit_z = pair.opens ? gap : pressure;
    const double round_off = contact.gap_round_off(pair.patch) * (pair.opens ? contact.pressure_of_gap(pair.patch) : 1);
    if (first_[i] < -nothing * pair.unit_w - round_off) wanted_.push_back(i);
    first_[i] /= pair.unit_w;
  }
}

LinearStatuses::Pair LinearStatuses::closing(std::size_t patch, const GapRow& row, std::span<const double> step) const {
  Pair pair{.patch = patch, .opens = false, .equations = {}, .derivative = {}, .start = row.gap};
  std::map<std::int32_t, double> derivative;
  for (std::size_t k = 0; k < row.unknowns.size(); ++k) {
    const std::int64_t dof = system_.unknown(row.unknowns[k].vertex, row.unknowns[k].component);
    if (const std::int64_t equation = system_.equation(dof); equation >= 0)
      derivative[static_cast<std::int32_t>(equation)] += row.derivative[k];
    else
      pair.start += row.derivative[k] * step[static_cast<std::size_t>(dof)];
  }
  for (const auto& [equation, of_it] : derivative) {
    pair.equations.push_back(equation);
    pair.derivative.push_back(of_it);
  }
  return pair;
}

void LinearStatuses::add_side(const Pair& pair, SparseSides& sides) const {
  if (pair.opens) sides.add_entry(multiplier(pair), 1);
  for (std::size_t k = 0; k < pair.equations.size(); ++k) sides.add_entry(pair.equations[k], pair.derivative[k]);
  sides.end_side(multiplier(pair), !pair.opens);
}

bool LinearStatuses::find(std::size_t most,
                          const std::function<void(const SparseSides& sides, const UseColumn& use)>& columns) {
  bool found = false;
  while (!wanted_.empty() && taken_.size() + wanted_.size() <= most) {
    while (!wanted_.empty()) {
      SparseSides sides;
      for (std::size_t i = 0; i < std::min(together, wanted_.size()); ++i)
        add_side(pairs_[static_cast<std::size_t>(wanted_[i])], sides);
      const std::size_t before = taken_.size();
      columns(sides, [&](std::span<const float> column) { note(column); });
      if (taken_.size() < before + sides.size()) return false;
    }
    if (!solve()) return false;
    found = true;
  }
  return found;
}

void LinearStatuses::note(std::span<const float> column) {
  const Eigen::Index at = std::ssize(taken_);
  if (at == matrix_.cols()) matrix_.conservativeResize(std::ssize(pairs_), std::max(2 * at, at + std::ssize(wanted_)));
  const Pair& of = pairs_[static_cast<std::size_t>(wanted_.front())];
  for (Eigen::Index i = 0; i < matrix_.rows(); ++i) {
    const Pair& pair = pairs_[static_cast<std::size_t>(i)];
    matrix_(i, at) = along(pair, column) * of.unit_z / pair.unit_w;
  }
  taken_.push_back(wanted_.front());
  wanted_.erase(wanted_.begin());
}

bool LinearStatuses::solve() {
  const auto so_far = matrix_.leftCols(std::ssize(taken_));
  const std::optional<Eigen::VectorXd> found = solve_complementarity(so_far(taken_, Eigen::all), first_(taken_), digits);
  if (!found) return false;
  z_ = *found;
  const Eigen::VectorXd w = first_ + so_far * z_, error = digits * (first_.cwiseAbs() + so_far.cwiseAbs() * z_.cwiseAbs());
  std::vector<bool> has_column(pairs_.size(), false);
  for (const Eigen::Index i : taken_) has_column[static_cast<std::size_t>(i)] = true;
  for (Eigen::Index i = 0; i < w.size(); ++i)
    if (w[i] < -error[i] && !has_column[static_cast<std::size_t>(i)]) wanted_.push_back(i);
  return true;
}

std::vector<double> LinearStatuses::correction(std::span<const double> solution) {
  std::vector<Eigen::Index> changed, pairs;
  for (Eigen::Index i = 0; i < z_.size(); ++i)
    if (z_[i] != 0) {
      changed.push_back(i);
      pairs.push_back(taken_[static_cast<std::size_t>(i)]);
    }
  Eigen::VectorXd left(std::ssize(changed)), more = Eigen::VectorXd::Zero(z_.size());
  for (Eigen::Index i = 0; i < left.size(); ++i)
    left[i] = w(pairs_[static_cast<std::size_t>(pairs[static_cast<std::size_t>(i)])], solution);
  const Eigen::MatrixXd matrix = matrix_(pairs, changed);
  const Eigen::VectorXd found = matrix.partialPivLu().solve(-left);
  more(changed) = found;
  z_ += more;
  std::vector<double> side(solution.size(), 0.0);
  add(more, side);
  return side;
}

void LinearStatuses::add(const Eigen::VectorXd& z, std::vector<double>& right_side) const {
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const Pair& pair = pairs_[static_cast<std::size_t>(taken_[static_cast<std::size_t>(i)])];
    SparseSides side;
    add_side(pair, side);
    for (std::size_t k = 0; k < side.index.size(); ++k)
      right_side[static_cast<std::size_t>(side.index[k])] += z[i] * pair.unit_z * side.value[k];
  }
}

void LinearStatuses::change_all(Patchwise& patches) const {
  for (const Eigen::Index i : wanted_) {
    const Pair& pair = pairs_[static_cast<std::size_t>(i)];
    patches.status[pair.patch] = pair.opens ? Status::open : Status::active;
  }
}

void LinearStatuses::take(Patchwise& patches, std::vector<double>& solution) const {
  for (Eigen::Index i = 0; i < z_.size(); ++i) {
    const Pair& pair = pairs_[static_cast<std::size_t>(taken_[static_cast<std::size_t>(i)])];
    const double z = z_[i] * pair.unit_z;
    if (z == 0) continue;
    patches.status[pair.patch] = pair.opens ? Status::open : Status::active;
    solution[static_cast<std::size_t>(multiplier(pair))] = (pair.opens ? 0 : -z) - patches.lambda[pair.patch];
  }
}

}  // namespace lacon
