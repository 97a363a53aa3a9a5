#pragma once
// The fields of an instant: DEPL, SIEF_ELGA, VARI_ELGA, CONT_ELEM (METHOD.md 4), CONT_NOEU, FORC_NODA; and the state that a
// result holds in them.
#include <functional>
#include <map>
#include <string>

#include "lacon/operators/evolution/newton/equilibrium.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

/// What observers of a computation look at: the instant that was solved last, or the one that is being solved.
struct Present {
  const StaticProblem& problem;
  const StaticState& state;
  const ContactState* contact;                                ///< nullptr without contact
  std::function<std::vector<double>()> internal_forces = {};  ///< Equilibrium::internal_forces of the state
  std::function<std::vector<double>()> unbalanced = {};       ///< Equilibrium::unbalanced of the last iterate
};

/// Fields by name, each made when it is asked for.
using FieldMakers = std::map<std::string, std::function<FieldRows()>>;
/// Those that this computation has. What `present` refers to must outlive them.
FieldMakers fields_of(const Present& present);
/// These, and FORC_NODA, which no result holds.
FieldMakers observed_fields_of(const Present& present);

/// Displacements and the other unknowns of nodes, with LAGS_C on the carriers of the patches, equal on those of one patch.
/// @param contact makes stand-ins of LAGS_C at the other nodes of the slave skins: nodal_pressures()
Field displacement_field(const StaticProblem& problem, const StaticState& state, const ContactState* contact = nullptr);
/// Values at nodes, (n_nodes, n_components), under the names of the unknowns: forces FORC_NODA, or what else they are named
/// then.
Field nodal_field(const StaticProblem& problem, std::span<const double> values);
/// Stresses at the integration points of the solid elements, fetched some rows at a time where processes have the cells.
/// Problem and state must outlive them.
FieldRows stress_field(const StaticProblem& problem, const StaticState& state);
/// Likewise internal variables V1, V2, ... at the points of the cells whose law has them; empty where none has.
FieldRows variable_field(const StaticProblem& problem, const StaticState& state);

/// The state that a result holds at an order. Its patches are empty where the result is without contact. Throws EVOLUTION_1
/// where it lives on another mesh, RESULT_1 where a field is missing, EVOLUTION_11 where a cell has other points or components.
StaticState archived_state(const StaticProblem& problem, const Base& base, const Result& result, std::int64_t order);

/// The state of the fields DEPL, SIGM and VARI of ETAT_INIT; zero where one is not given. Throws EVOLUTION_1, EVOLUTION_11 as
/// archived_state().
StaticState given_state(const StaticProblem& problem, const Base& base, const Keywords& given);

}  // namespace lacon
