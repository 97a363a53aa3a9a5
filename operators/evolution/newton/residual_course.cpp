#include "lacon/operators/evolution/newton/residual_course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

constexpr double same = 1e-2;       // of a residual: the one of a period before
constexpr double other = 1e-3;      // and what differs within a period,
constexpr double clearly = 10;      // so many times more than from one period to the next: it does not merely crawl
constexpr int long_enough = 6;      // iterations
constexpr double far = 1e-3;        // of the largest: these were not near an equilibrium, of other statuses or a law
constexpr double no_better = 0.97;  // from one iteration to the next: it does not fall
constexpr double falling = 0.3, falling_at_once = 0.1;  // likewise, of three or of one: round-off does not
constexpr double more = 1e-1;                           // of a residual that was smaller before

}  // namespace

void ResidualCourse::add(double residual, std::int64_t place) {
  residuals_.push_back(residual);
  stays_ = place == place_ ? stays_ + 1 : 1;
  place_ = place;
}

bool ResidualCourse::finite() const {
  return std::all_of(residuals_.begin(), residuals_.end(), [](double residual) { return std::isfinite(residual); });
}

std::optional<double> ResidualCourse::ratio() const {
  const std::size_t n = residuals_.size(), steps = std::min<std::size_t>(3, n - std::min<std::size_t>(n, 1));
  if (steps == 0 || !(residuals_[n - 1 - steps] > 0) || !finite()) return std::nullopt;
  return std::pow(residuals_[n - 1] / residuals_[n - 1 - steps], 1.0 / static_cast<double>(steps));
}

std::optional<std::size_t> ResidualCourse::smaller_before() const {
  if (residuals_.empty() || !finite()) return std::nullopt;
  const auto least = std::min_element(residuals_.rbegin(), residuals_.rend() - 1);
  if (!(*least < residuals_.back())) return std::nullopt;
  return static_cast<std::size_t>(least - residuals_.rbegin());
}

std::optional<double> ResidualCourse::order() const {
  const std::size_t n = residuals_.size();
  if (n < 3 || !finite() || !(residuals_[n - 1] > 0)) return std::nullopt;
  const double last = residuals_[n - 1] / residuals_[n - 2], before = residuals_[n - 2] / residuals_[n - 3];
  if (!(last < 1) || !(before < 1)) return std::nullopt;
  return std::log(last) / std::log(before);
}

bool ResidualCourse::falls() const {
  const std::size_t n = residuals_.size();
  return n > 1 && (residuals_[n - 1] < falling_at_once * residuals_[n - 2] || ratio().value_or(1) < falling);
}

std::optional<int> ResidualCourse::iterations_to(double part) const {
  const std::size_t n = residuals_.size();
  double factor = ratio().value_or(1), power = std::min(order().value_or(0), 2.0);
  if (power < quadratic) {
    if (period() || smaller_before()) return std::nullopt;
    power = 1;
  } else {
    factor = std::pow(residuals_[n - 1] / residuals_[n - 2], power);
  }
  if (!(factor < no_better) || !(part > 0)) return std::nullopt;
  int count = 1;
  for (double reached = factor; reached > part; reached *= factor, ++count) factor = std::pow(factor, power);
  return count;
}

int ResidualCourse::growths() const {
  int count = 0;
  for (auto now = residuals_.rbegin(); now != residuals_.rend() && now + 1 != residuals_.rend() && *now > *(now + 1); ++now)
    ++count;
  return count;
}

std::optional<std::size_t> ResidualCourse::period() const {
  for (std::size_t period = 2; 2 * period <= residuals_.size(); ++period) {
    const auto last = residuals_.end() - static_cast<std::ptrdiff_t>(period);
    bool again = true;
    double change = 0;  // from one period to the next
    for (auto now = last, before = last - static_cast<std::ptrdiff_t>(period); now != residuals_.end(); ++now, ++before) {
      again = again && std::abs(*now - *before) <= same * *before;
      change = std::max(change, std::abs(*now - *before));
    }
    const auto [least, most] = std::minmax_element(last, residuals_.end());
    if (again && *most - *least > std::max(clearly * change, other * *least)) return period;
  }
  return std::nullopt;
}

bool ResidualCourse::stands() const {
  if (residuals_.size() < long_enough || !finite()) return false;
  const auto [least, most] = std::minmax_element(residuals_.end() - long_enough, residuals_.end());
  return *most <= (1 + same) * *least;
}

bool ResidualCourse::wanders(int iterations) const {
  if (std::ssize(residuals_) < iterations || !finite()) return false;
  const auto first = residuals_.end() - iterations, late = residuals_.end() - iterations / 2;
  const double least = *std::min_element(first, late), since = *std::min_element(late, residuals_.end());
  return since >= least && since < residuals_.back() && least >= far * *std::max_element(first, residuals_.end());
}

bool ResidualCourse::drags(int iterations) const {
  return std::ssize(residuals_) > iterations && finite() && residuals_.back() > residuals_.end()[-1 - iterations] / 2;
}

std::string ResidualCourse::words() const {
  if (!finite()) return part("residual_no_number");
  if (const auto again = period()) return part("residual_goes_round", {{"period", std::to_string(*again)}});
  const std::optional<double> changes = ratio(), falls = order();
  if (!changes) return "";
  const std::string factor = fmt::format("{:.2g}", *changes);
  if (const auto before = smaller_before(); before && *changes < 1) {
    const double times = residuals_.back() / *(residuals_.rbegin() + static_cast<std::ptrdiff_t>(*before));
    if (times > 1 + more)
      return part("residual_was_smaller",
                  {{"factor", factor}, {"count", std::to_string(*before)}, {"times", fmt::format("{:.2g}", times)}});
  }
  if (!falls) return part("residual_changes", {{"factor", factor}});
  return part("residual_changes_of_order", {{"factor", factor}, {"order", fmt::format("{:.2g}", *falls)}});
}

}  // namespace lacon
