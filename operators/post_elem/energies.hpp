#pragma once
// ENER_ELAS, ENER_POT and TRAV_EXT: energies of a result, instant by instant, as rows of a table.
#include "lacon/structures/base.hpp"

namespace lacon {

/// @param keyword of POST_ELEM, ENER_ELAS or ENER_POT. Throws POSTELEM_2 for a group without body cells, POSTELEM_4 for large
/// strains, RESULT_1 where a field is missing.
Table energies(const Order& order, const Base& base, const std::string& keyword);

/// Work of the external forces: of those in equilibrium with the stresses (FORC_NODA), along the displacements.
Table external_work(const Order& order, const Base& base);

}  // namespace lacon
