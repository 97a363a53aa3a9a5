#include "lacon/operators/evolution/forcing_term.hpp"

#include <algorithm>

namespace lacon {
namespace {

constexpr double most = 1e-5;    // of a right side: pressures have to tell which patches open
constexpr double enough = 1e-2;  // of a criterion: no solution need leave less
constexpr double factor = 0.9;   // of choice 2, whose exponent is 2

}  // namespace

double ForcingTerm::next(const ConvergenceCriteria& criteria, const IterationReport& line, bool rough) {
  double least = most;  // what meets the criteria, by what is left of them
  const auto meet = [&](double criterion, double value) {
    if (value > 0) least = std::min(least, enough * criterion / value);
  };
  if (criteria.resi_glob_rela) meet(*criteria.resi_glob_rela, line.rela);
  if (criteria.resi_glob_maxi) meet(*criteria.resi_glob_maxi, line.maxi);
  if (criteria.resi_refe_rela) meet(*criteria.resi_refe_rela, line.refe);
  meet(criteria.constraint, line.constraint);
  const double ratio = rough && last_residual_ > 0 ? line.rela / last_residual_ : 1;
  last_residual_ = line.rela;
  return rough ? std::clamp(factor * ratio * ratio, least, most) : least;
}

}  // namespace lacon
