#pragma once
// How thick bodies are behind their skins.
#include <vector>

#include "lacon/pairing/surface.hpp"

namespace lacon {

/// Of each cell of both skins how far it is from its middle, against its normal, to where that leaves the body through another
/// cell of either skin, at the present coordinates; infinite where it does not, as in a body without its far side in the skins.
/// Both surfaces must have Surface::body.
struct Thickness {
  std::vector<double> slave, master;
};
Thickness thickness(const Surface& slave, const Surface& master);

}  // namespace lacon
