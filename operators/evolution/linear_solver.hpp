#pragma once
// The linear solver that SOLVEUR asks for.
#include <memory>

#include "lacon/assembly/engine.hpp"
#include "lacon/operators/evolution/static_problem.hpp"
#include "lacon/structures/base.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// MUMPS or PETSc; a METHODE that MUMPS stands in for is told (EVOLUTION_24). Throws SOLVER_6 where PETSc is asked for and not
/// there. @param base where files of the factor go
std::unique_ptr<Engine> engine_of(const Keywords& solver, const Base& base, const StaticProblem& problem);

}  // namespace lacon
