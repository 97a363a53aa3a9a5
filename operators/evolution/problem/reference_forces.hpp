#pragma once
// The force of each degree of freedom that stresses make there, without what cancels: of a reference stress (RESI_REFE_RELA),
// and of those of a state.
#include <optional>
#include <vector>

#include "lacon/operators/evolution/problem/state.hpp"
#include "lacon/operators/evolution/problem/static_problem.hpp"

namespace lacon {

/// A stress component of the size `stress` at one integration point alone makes forces at the nodes of its element. The
/// reference of a degree of freedom is the sum of their magnitudes over elements, points and components, of each element
/// divided by the number of its points; a spring adds `effort` in each direction at its ends. On the initial geometry.
/// @param stress SIGM_REFE @param effort EFFORT_REFE; throws EVOLUTION_41 where there are springs and none is given
/// @return (n_nodes, n_components), zero where nothing resists
std::vector<double> reference_forces(const StaticProblem& problem, double stress, std::optional<double> effort);

/// What internal forces of these stresses are summed up from: their round-off is a unit of that. The largest component of each
/// point, in size, on the initial geometry.
/// @return (n_nodes, n_components); nothing where all stresses are zero
std::vector<double> summed_forces(const StaticProblem& problem, const StaticState& state);

}  // namespace lacon
