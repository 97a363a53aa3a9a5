#pragma once
// What DECOUPE_LAC and refinement share: sub-cells that stand in the place of a cell.
#include <array>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// The image of a reference point of a cell (isoparametric, METHOD.md 1.2-3). @param coordinates (n, 3)
std::array<double, 3> image(CellType type, std::span<const std::int32_t> nodes, std::span<const double> xi,
                            std::span<const double> coordinates);

/// These of the nodes.
std::vector<std::int32_t> pick(std::span<const std::int32_t> from, std::span<const std::int8_t> which);

/// The groups with, in place of each cell, what replaces it.
/// @param first_heir of each cell of the old mesh, and behind the last: cell c has become the cells first_heir[c] to
/// first_heir[c + 1] - 1 of the new one
std::vector<Group> inherited(std::span<const Group> groups, std::span<const std::int32_t> first_heir);

}  // namespace lacon
