#pragma once
// Bodies that imposed displacements alone do not hold.
#include <set>

#include "lacon/operators/evolution/bodies.hpp"
#include "lacon/operators/evolution/static_problem.hpp"

namespace lacon {

/// Bodies (Bodies::of) that a rigid motion can move as far as imposed displacements and relations go; on the initial geometry.
std::set<std::int32_t> free_bodies(const StaticProblem& problem, const Bodies& bodies);

}  // namespace lacon
