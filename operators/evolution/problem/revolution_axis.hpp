#pragma once
// Bodies that touch the axis of revolution, where a point moves along the axis alone.
#include "lacon/operators/evolution/problem/static_problem.hpp"

namespace lacon {

/// EVOLUTION_44: an axisymmetric body with nodes on the axis whose radial displacement nothing decides.
void tell_of_axis(const StaticProblem& problem);

}  // namespace lacon
