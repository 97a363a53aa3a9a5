#pragma once
// How thick bodies are behind their skins, and what lies on the way through them.
#include <cstdint>
#include <utility>
#include <vector>

#include "lacon/pairing/box_tree.hpp"
#include "lacon/pairing/surface.hpp"

namespace lacon {

/// Both skins of a zone, for straight ways through their bodies; facets are taken as flat. The surfaces, which must have
/// Surface::body, must outlive it.
class WaysThrough {
 public:
  WaysThrough(const Surface& slave, const Surface& master);
  /// How far it is from a point to where a way leaves a body, infinite where it does not through what is known of its skin.
  /// @param along unit
  double to_leave(std::int32_t body, Vec3 from, Vec3 along) const;

 private:
  std::pair<const Surface*, std::size_t> cell_at(std::size_t i) const;

  const Surface &slave_, &master_;
  std::vector<Vec3> normals_;  ///< of the slave's cells, then of the master's
  BoxTree<3> tree_;
};

/// Of each cell of both skins how far it is from its middle, against its normal, to where that leaves the body through another
/// cell of either skin, at the present coordinates; infinite where it does not, as in a body without its far side in the skins.
/// Both surfaces must have Surface::body.
struct Thickness {
  std::vector<double> slave, master;
};
Thickness thickness(const Surface& slave, const Surface& master);

}  // namespace lacon
