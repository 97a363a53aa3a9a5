#pragma once
// Bodies that touch the axis of revolution, where a point moves along the axis alone.
#include "lacon/operators/evolution/static_problem.hpp"

namespace lacon {

/// Unknowns that loads decide at every instant, (n_nodes, n_components): imposed, or the last one of a relation whose others
/// are decided.
std::vector<std::uint8_t> decided_unknowns(const StaticProblem& problem);

/// EVOLUTION_44: an axisymmetric body with nodes on the axis whose radial displacement nothing decides.
void warn_of_axis(const StaticProblem& problem);

}  // namespace lacon
