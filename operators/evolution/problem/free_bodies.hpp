#pragma once
// Where the bodies of a problem are, and which of them imposed displacements alone do not hold.
#include <set>

#include "lacon/assembly/rigid_motions.hpp"
#include "lacon/operators/evolution/problem/static_problem.hpp"
#include "lacon/structures/bodies.hpp"

namespace lacon {

/// Of nodes of solid elements; others are of no body.
BodyGeometry geometry_of(const StaticProblem& problem, const Bodies& bodies);

/// Bodies (Bodies::of) that a rigid motion can move as far as imposed displacements and relations go; on the initial geometry.
std::set<std::int32_t> free_bodies(const StaticProblem& problem, const Bodies& bodies);

}  // namespace lacon
