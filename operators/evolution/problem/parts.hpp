#pragma once
// Whether the processes that solve the linear systems have the cells as well.
#include <memory>

#include "lacon/assembly/engine.hpp"
#include "lacon/assembly/parts/solid_parts.hpp"
#include "lacon/operators/evolution/problem/static_problem.hpp"

namespace lacon {

/// In the plane laws whose tangent is not symmetric have a matrix that is not, where gaps are derived exactly: one half is
/// worth little without the other. In space its factorisations, twice as long and each for one system, take more than it saves.
Symmetry symmetry_of(const StaticProblem& problem);

/// The processes of an engine with the cells of a problem; nothing where there is one process, and where cells need what only
/// one process has, which is told (EVOLUTION_46). Throws SOLVER_6.
std::shared_ptr<SolidParts> parts_of(const StaticProblem& problem, const Engine& engine);

}  // namespace lacon
