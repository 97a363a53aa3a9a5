#pragma once
// How far to go along an increment of Newton's method.
#include <functional>

namespace lacon {

/// The part, at most 1, of an increment up to which the unbalanced forces do work, roughly: where a whole increment overshoots,
/// the zero of their power between nothing and the whole by regula falsi, to a tenth of `start`. The energy of a step of
/// plastic flow is convex: there it is the minimum along the increment.
/// @param start power of the unbalanced forces along the increment before it, or of what resists it, where gaps that close
/// drive it
/// @param power the same at a part; the last call is
/// at the part that is returned
double part_of_increment(double start, const std::function<double(double)>& power);

/// RECH_LINEAIRE: the part of an increment at which the power of the unbalanced forces vanishes.
struct LineSearch {
  bool keeps_bracket = false;  ///< METHODE='MIXTE': never beyond a change of sign; 'CORDE': the secant of the last two parts
  double accepted = 0.1;       ///< RESI_LINE_RELA: power over that before the increment
  int iterations = 3;          ///< ITER_LINE_MAXI
  double least = 1e-2, most = 10,
         excluded = 0.9e-2;  ///< RHO_MIN, RHO_MAX, RHO_EXCL: of parts, these between -excluded and excluded
};

/// The part with the least power of those that the search comes to. @param start, power as above: the last call is at the part
/// that is returned
double part_without_power(const LineSearch& search, double start, const std::function<double(double)>& power);

}  // namespace lacon
