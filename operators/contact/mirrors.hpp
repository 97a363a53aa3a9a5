#pragma once
// Planes of symmetry, in space: where both skins of a zone end in one plane that their nodes cannot leave.
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lacon/pairing/surface.hpp"

namespace lacon {

struct MirrorPlane {
  int axis = 0;                                    ///< at a right angle to the plane
  double close = 0;                                ///< nodes are in one plane to this distance
  std::vector<std::int32_t> nodes;                 ///< of both skins, on the edges that end in it
  std::vector<std::pair<std::int32_t, int>> ends;  ///< such edges of the master: cell of its surface, edge
};

/// Planes x, y or z = constant beyond which no skin reaches, in which both end, with edges whose displacement across it is
/// imposed: by symmetry, as by a wall, what lies behind one is what lies before it. None in the plane.
/// @param free (n_nodes, dimension): 1 where a displacement is an unknown
std::vector<MirrorPlane> mirror_planes(const Surface& slave, const Surface& master, std::span<const std::uint8_t> free);

/// Surface::mirrored of the master, of those planes whose nodes still lie in one. @param coordinates (n_nodes, 3), current
/// @param n_cells of the master @return empty where no plane is left
std::vector<std::uint8_t> mirrored_edges(std::span<const MirrorPlane> planes, std::span<const double> coordinates,
                                         std::size_t n_cells);

}  // namespace lacon
