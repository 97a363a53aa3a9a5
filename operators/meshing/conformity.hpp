#pragma once
// Do cells of one body share whole edges and faces with their neighbours?
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Places where cells do not fit their neighbours: how many there are, and the first.
struct Misfit {
  std::int64_t count = 0;
  std::int32_t cell = -1, other = -1;  ///< whose edge or face it is; a cell on its other side, -1 where a node says enough
  std::int32_t node = -1;              ///< between the vertices
  std::vector<std::int32_t> vertices;  ///< of the edge or face, in the order of the cell
};

/// Edges and faces that have a node in their middle in one cell (`cell`) and none in another (`other`).
/// @param least_dimension of cells that count @param counts by cell; empty: all of them
Misfit mixed_orders(const Mesh& mesh, int least_dimension, std::span<const char> counts = {});

struct Misfits {
  Misfit middles;     ///< mixed_orders() of the bodies
  Misfit diagonals;   ///< quadrangular faces with triangular faces of other cells on the same nodes
  Misfit hanging;     ///< edges and faces with vertices of other cells in between, which reach from end to end
  Misfit coincident;  ///< facets at the place of others of the same body, without having all their nodes
};

/// How the cells of one dimension that count fit together. Bodies may touch, and a crack may be open or closed: cells that
/// share no node do not fit only where nothing else explains it. So nodes hang where they are strung from one end of an edge
/// to the other by edges of other cells, and slave skins of a cut mesh never do.
Misfits misfits(const Mesh& mesh, int dimension, std::span<const char> counts = {});

}  // namespace lacon
