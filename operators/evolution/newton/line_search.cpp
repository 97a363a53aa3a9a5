#include "lacon/operators/evolution/newton/line_search.hpp"

#include <algorithm>
#include <cmath>

namespace lacon {
namespace {

constexpr double small_enough = 0.1;  // of the power at the start, as RESI_LINE_RELA
constexpr double least = 0.1;         // of the last part
constexpr int evaluations = 6;

}  // namespace

double part_of_increment(double start, const std::function<double(double)>& power) {
  double part = 1;
  for (int count = 1;; ++count) {
    const double found = power(part);
    if (!(start > 0) || found >= -small_enough * start || count == evaluations) return part;
    part *= std::max(start / (start - found), least);
  }
}

double part_without_power(const LineSearch& search, double start, const std::function<double(double)>& power) {
  struct Found {
    double part, power;
  };
  Found before{0, start}, last{1, power(1)}, best = last, low = before, high{search.most, -start};
  bool crossed = false;
  for (int i = 0; i < search.iterations && std::isfinite(last.power); ++i) {
    if (std::abs(last.power) <= search.accepted * std::abs(start) || last.power == before.power) break;
    if ((last.power > 0) == (start > 0)) {
      low = last;
    } else {
      high = last;
      crossed = true;
    }
    double next = last.part - last.power * (last.part - before.part) / (last.power - before.power);
    if (search.keeps_bracket && crossed && !(next > low.part && next < high.part)) next = 0.5 * (low.part + high.part);
    next = std::clamp(next, search.least, search.most);
    if (std::abs(next) < search.excluded) next = next < 0 ? -search.excluded : search.excluded;
    if (next == last.part) break;
    before = last;
    last = {next, power(next)};
    if (std::abs(last.power) < std::abs(best.power) || !std::isfinite(best.power)) best = last;
  }
  if (best.part != last.part) power(best.part);
  return best.part;
}

}  // namespace lacon
