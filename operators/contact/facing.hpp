#pragma once
// Where a cell of a skin is, which way it looks, and how large it is.
#include <span>

#include "lacon/elements/reference.hpp"
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

struct Facing {
  Vec3 place;   ///< the mean of its nodes
  Vec3 normal;  ///< at its first vertex, unit
};

/// @param coordinates (n_nodes, 3)
Facing facing(const Mesh& mesh, std::int32_t cell, std::span<const double> coordinates);

/// The rule that measures a whole skin cell: of degree 4 or 5 if it is linear, of 8 or 9, as fine as the points of pairing, if
/// it may be curved.
const Rule& measuring_rule(CellType type);

/// Length or area of a skin cell at the initial geometry: a size, without the radius that weighs coverage in axisymmetry.
double cell_extent(const Mesh& mesh, std::int32_t cell);

}  // namespace lacon
