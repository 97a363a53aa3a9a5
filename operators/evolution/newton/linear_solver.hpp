#pragma once
// The linear solver that SOLVEUR asks for.
#include <cstdint>
#include <memory>

#include "lacon/assembly/engine.hpp"
#include "lacon/operators/evolution/problem/static_problem.hpp"
#include "lacon/structures/base.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// MUMPS or PETSc; a METHODE that MUMPS stands in for is told (EVOLUTION_24), and what AUTO takes (EVOLUTION_39). Throws
/// SOLVER_6 where PETSc is asked for and not there. @param base where files of the factor go
std::unique_ptr<Engine> engine_of(const Keywords& solver, const Base& base, const StaticProblem& problem);

/// About what an operator takes that makes a factor, bytes. Measured on the two blocks of docs/performance.md.
double memory_of_factor(std::int64_t n_equations, int dimension, bool in_double_precision = false);
/// Why AUTO takes iterations, a name of catalog/messages/parts.toml; null where a factor suits better. @param factor its
/// memory, bytes  @param memory of the machine
const char* reason_of_iterations(std::int64_t n_equations, int dimension, double factor, double memory);

}  // namespace lacon
