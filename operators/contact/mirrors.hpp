#pragma once
// Planes in which both skins of a zone end, in space: of symmetry, or free faces that are aligned.
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lacon/pairing/surface.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {

struct EndPlane {
  Vec3 normal{};                                    ///< of the plane, out of the skins
  std::vector<std::int32_t> slave;                  ///< nodes of the slave's edges that end in it
  std::vector<std::pair<std::int32_t, int>> ends;   ///< such edges of the master: cell of its surface, edge
  std::vector<std::pair<std::int32_t, int>> flush;  ///< likewise, free ones that lie along the slave's
};

/// Of each cell of a skin in space the cells behind its edges, -1 where there is none; empty in the plane.
std::vector<std::array<std::int32_t, 4>> edge_neighbours(const Surface& skin);

/// Planes x, y or z = constant, and those that an edge of the master is held in, beyond which no skin reaches and in which both
/// end; of the master's edges there those that meet the border of the slave at points at most, and where no node can leave the
/// plane, as by symmetry, all. Where free borders lie on each other a face that slides past the other one is what ends the
/// contact: those are apart. None in the plane.
std::vector<EndPlane> end_planes(const Surface& slave, const Surface& master, std::span<const HeldDirection> held);

/// Surface::mirrored of the master: its edges in such planes that still end where the slave does, to less than what the outline
/// goes on by there. @param coordinates (n_nodes, 3), of a state in equilibrium: forces would jump where an iterate adds an
/// edge
/// @return empty where there are none
std::vector<std::uint8_t> mirrored_edges(std::span<const EndPlane> planes, const Surface& master,
                                         std::span<const double> coordinates);

/// Likewise of those edges that lie along the slave's, where they still do, to a thousandth of their cells.
std::vector<std::uint8_t> flush_edges(std::span<const EndPlane> planes, const Surface& master,
                                      std::span<const double> coordinates);

}  // namespace lacon
