#include "lacon/operators/evolution/linear_statuses.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "lacon/operators/evolution/complementarity.hpp"

namespace lacon {
namespace {

constexpr double reach = 0.5;     // of h: average gap up to which an open patch may take contact within an iteration
constexpr double digits = 1e-6;   // of columns of the inverse: they come in single precision
constexpr double nothing = 1e-9;  // of the unit: what a patch may be pulled or gone into by

}  // namespace

template <class Number>
double LinearStatuses::along(const GapRow& row, std::span<const Number> x) const {
  double sum = 0;
  for (std::size_t i = 0; i < row.unknowns.size(); ++i)
    if (const std::int64_t e = equation(row.unknowns[i]); e >= 0)
      sum += row.derivative[i] * static_cast<double>(x[static_cast<std::size_t>(e)]);
  return sum;
}

LinearStatuses::LinearStatuses(const ContactState& contact, const System& system, const Patchwise& patches,
                               std::span<const double> solution, std::span<const double> step)
    : contact_(contact), system_(system), patches_(patches), first_(solution) {
  std::vector<std::size_t> open;
  for (std::size_t p = 0; p < patches.status.size(); ++p) {
    if (contact.may_open(p, patches))
      pairs_.push_back({.patch = p, .opens = true, .row = {}, .start = -patches.lambda[p], .unit_z = 1, .unit_w = 1});
    if (contact.may_close(p, patches, reach)) open.push_back(p);
  }
  std::vector<GapRow> rows = contact.gap_rows(open);
  for (std::size_t i = 0; i < open.size(); ++i) {
    GapRow& row = rows[i];
    double start = row.gap;
    for (std::size_t k = 0; k < row.unknowns.size(); ++k)
      if (equation(row.unknowns[k]) < 0)
        start += row.derivative[k] *
                 step[static_cast<std::size_t>(system.unknown(row.unknowns[k].vertex, row.unknowns[k].component))];
    pairs_.push_back({.patch = open[i], .opens = false, .row = std::move(row), .start = start, .unit_z = 1, .unit_w = 1});
  }

  double pressure = 0;
  for (const Pair& pair : pairs_) {
    const double found = w(pair, first_);
    pressure = std::max(pressure, pair.opens ? std::abs(found) : -found * contact.pressure_of_gap(pair.patch));
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    const double gap = pressure / contact.pressure_of_gap(pair.patch);
    pair.unit_w = pair.opens ? pressure : gap;
    pair.unit_z = pair.opens ? gap : pressure;
    const double round_off = contact.gap_round_off(pair.patch) * (pair.opens ? contact.pressure_of_gap(pair.patch) : 1);
    if (w(pair, first_) < -nothing * pair.unit_w - round_off) wrong_.push_back(i);
  }
}

bool LinearStatuses::narrow(std::size_t most) {
  if (wrong_.size() > most) return false;
  if (pairs_.size() <= most) return true;
  std::vector<std::ptrdiff_t> place(patches_.status.size(), -1);  // of each patch among the pairs, until it is taken
  for (std::size_t i = 0; i < pairs_.size(); ++i) place[pairs_[i].patch] = static_cast<std::ptrdiff_t>(i);
  std::vector<std::size_t> taken = wrong_;
  for (const std::size_t i : taken) place[pairs_[i].patch] = -1;
  for (std::size_t i = 0; i < taken.size() && taken.size() < most; ++i)
    for (const std::int32_t next : contact_.neighbours(pairs_[taken[i]].patch))
      if (const std::ptrdiff_t there = std::exchange(place[static_cast<std::size_t>(next)], -1);
          there >= 0 && taken.size() < most)
        taken.push_back(static_cast<std::size_t>(there));
  std::sort(taken.begin(), taken.end());
  std::vector<Pair> some;
  for (const std::size_t i : taken) some.push_back(std::move(pairs_[i]));
  pairs_ = std::move(some);
  return true;
}

SparseSides LinearStatuses::sides(std::size_t first, std::size_t last) const {
  SparseSides sides;
  for (const Pair& pair : std::span(pairs_).subspan(first, last - first)) {
    if (pair.opens) sides.add_entry(multiplier(pair.patch), 1);
    for (std::size_t k = 0; k < pair.row.unknowns.size(); ++k)
      if (const std::int64_t e = equation(pair.row.unknowns[k]); e >= 0) sides.add_entry(e, pair.row.derivative[k]);
    sides.end_side();
  }
  return sides;
}

void LinearStatuses::note(std::size_t first, std::size_t last, std::span<const float> columns) {
  const auto n = static_cast<Eigen::Index>(pairs_.size());
  if (matrix_.size() == 0) matrix_.resize(n, n);
  const std::size_t length = columns.size() / (last - first);
  for (std::size_t c = first; c < last; ++c) {
    const std::span<const float> column = columns.subspan((c - first) * length, length);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Pair& pair = pairs_[static_cast<std::size_t>(i)];
      const double w =
          pair.opens ? -static_cast<double>(column[static_cast<std::size_t>(multiplier(pair.patch))]) : along(pair.row, column);
      matrix_(i, static_cast<Eigen::Index>(c)) = w * pairs_[c].unit_z / pair.unit_w;
    }
  }
}

bool LinearStatuses::solve() {
  Eigen::VectorXd q(static_cast<Eigen::Index>(pairs_.size()));
  for (std::size_t i = 0; i < pairs_.size(); ++i) q[static_cast<Eigen::Index>(i)] = w(pairs_[i], first_) / pairs_[i].unit_w;
  const std::optional<Eigen::VectorXd> found = solve_complementarity(matrix_, q, digits);
  if (found) z_ = *found;
  return found.has_value();
}

std::vector<double> LinearStatuses::correction(std::span<const double> solution) {
  std::vector<Eigen::Index> changed;
  for (Eigen::Index i = 0; i < z_.size(); ++i)
    if (z_[i] != 0) changed.push_back(i);
  Eigen::VectorXd left(static_cast<Eigen::Index>(changed.size())), more = Eigen::VectorXd::Zero(z_.size());
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    const Pair& pair = pairs_[static_cast<std::size_t>(changed[static_cast<std::size_t>(i)])];
    left[i] = w(pair, solution) / pair.unit_w;
  }
  const Eigen::MatrixXd matrix = matrix_(changed, changed);
  const Eigen::VectorXd found = matrix.partialPivLu().solve(-left);
  more(changed) = found;
  z_ += more;
  std::vector<double> side(solution.size(), 0.0);
  add(more, side);
  return side;
}

void LinearStatuses::add(const Eigen::VectorXd& z, std::vector<double>& right_side) const {
  const SparseSides all = sides(0, pairs_.size());
  for (std::size_t c = 0; c < pairs_.size(); ++c)
    for (auto k = static_cast<std::size_t>(all.offset[c]); k < static_cast<std::size_t>(all.offset[c + 1]); ++k)
      right_side[static_cast<std::size_t>(all.index[k])] += z[static_cast<Eigen::Index>(c)] * pairs_[c].unit_z * all.value[k];
}

void LinearStatuses::take(Patchwise& patches, std::vector<double>& solution) const {
  for (std::size_t c = 0; c < pairs_.size(); ++c) {
    const double z = z_[static_cast<Eigen::Index>(c)] * pairs_[c].unit_z;
    if (z == 0) continue;
    const std::size_t patch = pairs_[c].patch;
    patches.status[patch] = pairs_[c].opens ? Status::open : Status::active;
    solution[static_cast<std::size_t>(multiplier(patch))] = (pairs_[c].opens ? 0 : -z) - patches.lambda[patch];
  }
}

}  // namespace lacon
