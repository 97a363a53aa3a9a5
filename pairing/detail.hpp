#pragma once
// pair() for each dimension of the space; a user calls pair() of pairing.hpp.
#include "lacon/pairing/pairing.hpp"

namespace lacon::detail {

/// Chains of SEG2 and SEG3 in the plane.
Pairing pair_in_plane(const Surface& slave, const Surface& master, const PairingOptions& options);

/// TRIA3, TRIA6, QUAD4, QUAD8, QUAD9 in space.
Pairing pair_in_space(const Surface& slave, const Surface& master, const PairingOptions& options);

/// All coordinates of a cell, and nodal normals if there are, are finite numbers.
bool finite(const Surface& surface, std::size_t cell);

/// What PairingOptions::largest_angle asks of -n_e . n_m at least.
double smallest_cosine(const PairingOptions& options);

}  // namespace lacon::detail
