#pragma once
// pair() for each dimension of the space; a user calls pair() of pairing.hpp.
#include "lacon/pairing/pairing.hpp"

namespace lacon::detail {

/// Called behind each slave cell with how many are done; what it finds in the pairing it may take away.
using EndOfCell = std::function<void(std::size_t)>;

/// Chains of SEG2 and SEG3 in the plane.
void pair_in_plane(const Surface& slave, const Surface& master, const PairingOptions& options, Pairing& pairing,
                   const EndOfCell& end_of_cell);

/// TRIA3, TRIA6, QUAD4, QUAD8, QUAD9 in space.
void pair_in_space(const Surface& slave, const Surface& master, const PairingOptions& options, Pairing& pairing,
                   const EndOfCell& end_of_cell);

/// All coordinates of a cell, and nodal normals if there are, are finite numbers.
bool finite(const Surface& surface, std::size_t cell);

/// What PairingOptions::largest_angle asks of -n_e . n_m at least.
double smallest_cosine(const PairingOptions& options);

}  // namespace lacon::detail
