#pragma once
// Patches whose sub-cells are turned inside out.
#include <span>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// The patches of these cells (sorted), which are about to be turned. A patch turns as a whole or not at all: ORIE_5.
/// @param where the keyword and the group, for the message
std::vector<std::int32_t> patches_to_turn(const Mesh& mesh, std::span<const std::int32_t> cells, const std::string& where);

/// Give the sub-cells of patches that were turned (their nodes are `mirrored`) the ranks and the first nodes with which the
/// carriers of LAGS_C are again those that catalog/contact.toml says: a turned patch is the patch of a skin cell that was
/// turned before the cut.
void settle_turned(Mesh& mesh, std::span<const std::int32_t> patches);

}  // namespace lacon
