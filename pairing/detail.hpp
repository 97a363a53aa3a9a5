#pragma once
// Pairing for each dimension of the space; a user takes pairing.hpp.
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "lacon/pairing/pairing.hpp"

namespace lacon::detail {

/// Pairs one slave cell after another with the masters that it was made for; every thread has its own.
class CellPairer {
 public:
  virtual ~CellPairer() = default;
  /// Appends what it finds; reasons of rejection in the order of the search, some of them several times.
  /// @param order as PairingInParts::pair() has it
  virtual void pair(std::size_t slave_cell, Pairing& found, int order) = 0;
};
using MakeCellPairer = std::function<std::unique_ptr<CellPairer>()>;

/// Chains of SEG2 and SEG3 in the plane. @param[out] rejected degenerate masters. The surfaces must outlive what is returned.
MakeCellPairer pair_in_plane(const Surface& slave, const Surface& master, const PairingOptions& options,
                             std::vector<RejectedCouple>& rejected);

/// TRIA3, TRIA6, QUAD4, QUAD8, QUAD9 in space.
MakeCellPairer pair_in_space(const Surface& slave, const Surface& master, const PairingOptions& options,
                             std::vector<RejectedCouple>& rejected);

/// All coordinates of a cell, and nodal normals if there are, are finite numbers.
bool finite(const Surface& surface, std::size_t cell);

/// Of a couple: unit, outward.
struct CoupleNormals {
  std::array<double, 3> slave, master;
};
/// By how much the limit of a couple gives way: distance_limit by what both cells have moved since Surface::rest, depth_limit
/// by what they may have come closer along the normal of either: walls behind a body stay there whatever they slide.
double give_way(const PairingOptions& options, const Surface& slave, std::size_t slave_cell, const Surface& master,
                std::size_t master_cell, const CoupleNormals& normals);

/// What limits of a couple depend on.
struct CoupleSize {
  double diameter;  ///< of its larger cell
  double cosine;    ///< between the normal of the slave and the opposite of the master's
  /// Of cells of one body: how far, along the normal of the slave, the master lay behind it when they were at rest (their
  /// middles); of cells of two bodies 0.
  double behind = 0;
  /// Of cells of two bodies: half of what both are thick there (Surface::thickness); infinite where that is unknown.
  double half = std::numeric_limits<double>::infinity();
  bool of_two_bodies = false;  ///< known to be
};
CoupleSize size_of(const Surface& slave, std::size_t slave_cell, const Surface& master, std::size_t master_cell,
                   double diameter, double cosine);
/// Why PairingOptions leave a couple out, if they do.
std::optional<Rejection> left_out(const PairingOptions& options, const Surface& slave, std::size_t slave_cell,
                                  const Surface& master, std::size_t master_cell);
/// Whether no gap up to this one is beyond a limit of `options`.
bool within_limits(const PairingOptions& options, double largest_gap, const CoupleSize& couple);
/// Of the slave cell: what is less sees past a corner.
inline constexpr double past_a_corner = 0.02;

/// Drop slivers of a slave cell that see masters far away, past the ends of others that are near: where ends touch, as of a
/// tooth in its groove, it is round-off whether the cell sees past them. However little that is, its derivative by the ends is
/// as large as the gap. A cell that sees nothing near keeps them: iterates that are far off are led back by what they see.
/// Parts count together, so that it does not matter how fine the masters are.
/// @param far(part) the gap, where may_be_through_bodies() says so, 0 elsewhere  @param share(part) of the slave cell
/// @param is_through(part) Masters::is_through_bodies  @param reject(part, reason)
template <class Part, class Far, class Share, class Through, class Reject>
void drop_past_ends(std::vector<Part>& parts, const Far& far, const Share& share, const Through& is_through,
                    const Reject& reject) {
  constexpr double next_to_nothing = 1e-3;
  double seen = 0;
  bool any_near = false;
  for (const Part& part : parts) {
    any_near = any_near || far(part) == 0;
    if (far(part) != 0) seen += share(part);
  }
  if (!any_near || seen >= past_a_corner) return;
  const bool nothing = seen < next_to_nothing;
  std::erase_if(parts, [&](const Part& part) {
    const bool drops = far(part) != 0 && (nothing || (far(part) > 0 && is_through(part)));
    if (drops) reject(part, nothing ? Rejection::sliver : Rejection::hidden);
    return drops;
  });
}

/// Whether a gap or an overlap is so large that bodies may lie on the way. @param moved give_way()
bool may_be_through_bodies(const PairingOptions& options, double gap, const CoupleSize& couple, double moved);
/// Which limit a gap in the middle of what a couple has in common is beyond. @param moved give_way()
std::optional<Rejection> beyond_limits(const PairingOptions& options, double gap, const CoupleSize& couple, double moved);

/// A master that covers a part of a slave cell.
struct Candidate {
  std::int32_t master;
  double gap;   ///< in the middle of the part
  double size;  ///< of the master
};
/// Which of two masters keeps a part of a slave cell that both cover: the nearer one. But free ends of two masters that have
/// slid over each other by a hair, as of blocks side by side that widen under load, are pushed to the same height: were it
/// always the nearer one, forces would leap there from one to the other, and no iterate would find an equilibrium. Of such
/// ends, where they are about as near, the one keeps it whose place at rest has the smaller coordinates. The end of a sheet
/// that lies on a block looks the other way than any end of the block that is near to it. @param size of the slave cell
bool comes_before(const Surface& masters, const Candidate& one, const Candidate& other, double size);

}  // namespace lacon::detail
