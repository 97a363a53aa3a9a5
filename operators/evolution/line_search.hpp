#pragma once
// How far to go along an increment of Newton's method.
#include <functional>

namespace lacon {

/// The part, at most 1, of an increment up to which the unbalanced forces do work, roughly: where a whole increment overshoots,
/// the zero of their power between nothing and the whole by regula falsi, to half of `start`. The energy of a step of plastic
/// flow is convex: there it is the minimum along the increment.
/// @param start power of the unbalanced forces along the increment before it  @param power the same at a part; the last call is
/// at the part that is returned
double part_of_increment(double start, const std::function<double(double)>& power);

}  // namespace lacon
