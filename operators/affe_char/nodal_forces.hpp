#pragma once
// Forces that act on nodes: FORCE_NODALE, FORCE_ARETE.
#include "lacon/operators/affe_char/places.hpp"

namespace lacon {

/// FORCE_NODALE in axes of its own (ANGL_NAUT): the same force along those of the mesh.
std::vector<Keywords> along_the_mesh(const LoadScene& scene, const std::vector<Keywords>& factors);

/// FORCE_ARETE: forces for each unit of length of edges in space, as those of their nodes, which add up with what
/// FORCE_NODALE gives; functions are those of the place alone. Of two occurrences that load an edge the later one holds. Throws
/// CHARGE_6 for a cell that is no edge, FUNCTION_2 for a function of time.
void load_edges(Load& load, const LoadScene& scene, const Keywords& keywords);

}  // namespace lacon
