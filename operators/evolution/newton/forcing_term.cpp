#include "lacon/operators/evolution/newton/forcing_term.hpp"

#include <algorithm>

namespace lacon {
namespace {

constexpr double most = 1e-5;      // of a right side: what is left tells which patches open
constexpr double factor = 0.9;     // of choice 2, whose exponent is 2
constexpr double balanced = 1e-4;  // of one that the criteria would leave as it is; slender bodies lose two of the digits

}  // namespace

double ForcingTerm::next(const IterationReport& line, bool rough) {
  const double ratio = last_residual_ > 0 ? line.longest_share / last_residual_ : 1;
  last_residual_ = line.longest_share;
  if (rough) return std::min(most, factor * ratio * ratio);
  return line.rela_met && line.maxi_met && line.refe_met && line.constraint_met ? balanced : 0;
}

}  // namespace lacon
