#pragma once
// Line cells that follow each other.
#include <cstdint>
#include <string>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// The nodes of a group of line cells from one end of the chain to the other, in the direction of its first cell; a closed
/// chain begins and ends at that cell's first node. Throws MESH_1, MESH_2, and LIGNCOUPE_4 for a group that is no chain.
std::vector<std::int32_t> chain_of_lines(const Mesh& mesh, const std::string& group, const std::string& keyword);

}  // namespace lacon
