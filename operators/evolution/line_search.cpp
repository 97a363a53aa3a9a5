#include "lacon/operators/evolution/line_search.hpp"

#include <algorithm>

namespace lacon {
namespace {

constexpr double small_enough = 0.5;  // of the power at the start: what Newton's next matrix finds by itself
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

}  // namespace lacon
