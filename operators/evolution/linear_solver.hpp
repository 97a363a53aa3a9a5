#pragma once
// The linear solver that SOLVEUR asks for.
#include <memory>

#include "lacon/assembly/engine.hpp"
#include "lacon/structures/base.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// MUMPS; a METHODE that it stands in for is told (EVOLUTION_24). @param base where files of the factor go
std::unique_ptr<Engine> engine_of(const Keywords& solver, const Base& base);

}  // namespace lacon
