#pragma once
// What a computation leaves: the fields DEPL, SIEF_ELGA, VARI_ELGA and CONT_ELEM of an instant (METHOD.md 4); and what another
// one takes up from there.
#include "lacon/operators/evolution/newton.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

/// Displacements, with LAGS_C on the carriers of the patches, equal on those of one patch.
Field displacement_field(const StaticProblem& problem, const StaticState& state);
/// Stresses at the integration points of the solid elements.
Field stress_field(const StaticProblem& problem, const StaticState& state);
/// Internal variables V1, V2, ... at the integration points of the cells whose law has them; empty where none has.
Field variable_field(const StaticProblem& problem, const StaticState& state);
/// CONT, PRES, JEU, COEFSURF, PRESCOOR on every slave cell, equal in the cells of one patch.
Field contact_field(const StaticProblem& problem, const StaticState& state, const ContactState& contact);

/// The state that a result holds at an order. Its patches are empty where the result is without contact. Throws EVOLUTION_1
/// where it lives on another mesh, RESULT_1 where a field is missing, EVOLUTION_11 where a cell has other points or components.
StaticState archived_state(const StaticProblem& problem, const Base& base, const Result& result, std::int64_t order);

}  // namespace lacon
