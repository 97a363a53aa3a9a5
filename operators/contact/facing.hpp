#pragma once
// Where a cell of a skin is, and which way it looks.
#include <span>

#include "lacon/structures/mesh.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

struct Facing {
  Vec3 place;   ///< the mean of its nodes
  Vec3 normal;  ///< at its first vertex, unit
};

/// @param coordinates (n_nodes, 3)
Facing facing(const Mesh& mesh, std::int32_t cell, std::span<const double> coordinates);

}  // namespace lacon
