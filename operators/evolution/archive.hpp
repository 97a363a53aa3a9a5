#pragma once
// What a computation leaves: the fields DEPL, SIEF_ELGA and CONT_ELEM of an instant (METHOD.md 4).
#include "lacon/operators/evolution/newton.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

/// Displacements, with LAGS_C on the carriers of the patches, equal on those of one patch.
Field displacement_field(const StaticProblem& problem, const StaticState& state);
/// Stresses at the integration points of the solid elements.
Field stress_field(const StaticProblem& problem, const std::vector<std::vector<double>>& stresses);
/// CONT, PRES, JEU, COEFSURF, PRESCOOR on every slave cell, equal in the cells of one patch.
Field contact_field(const StaticProblem& problem, const StaticState& state, const ContactState& contact);

}  // namespace lacon
