#pragma once
// What flat facets leave of a curved skin.
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/pairing/surface.hpp"

namespace lacon {

/// The quadratic surface through the corners of a facet with the nodal normals there, in the mean: the curve that a cell, or a
/// patch of several, stands for.
class FacetArc {
 public:
  /// @param corners and normals there, unit, of two corners in the plane, three or more in space @param outward about a normal
  /// of the facet
  FacetArc(std::span<const Vec3> corners, std::span<const Vec3> normals, Vec3 outward);
  /// Through the same corners, curved as another one: where a skin ends normals are those of what is there, and do not turn.
  /// Not where these turn by more than on a curve.
  void bend_as(const FacetArc& neighbour);
  /// By how much it lies further outward than a place on the facet.
  double missing(Vec3 place) const;
  double curvature() const { return curvature_; }  ///< the larger one, positive
  /// Whether normals turn from corner to corner as on a curve: by no more than those of ten edges a turn, and to both sides.
  /// At the corner of a body normals are means of what meets there, and stand for no curve.
  bool is_of_curve() const { return is_of_curve_; }

 private:
  /// Height and slope in the middle, of its bend.
  void pass_corners();

  std::vector<Vec3> corners_;  ///< from the middle
  Vec3 middle_{}, outward_{};
  Vec3 along_[2] = {};  ///< the facet; the second one is zero in the plane
  double height_ = 0, slope_[2] = {};
  double bend_[3] = {};  ///< derivatives of slopes: along the first direction, of one along the other, along the second one
  double turn_ = 0;      ///< radians: the largest angle to a normal at a corner
  double curvature_ = 0;
  bool is_of_curve_ = false;
};

/// Nodes that lie inside of a facet of several cells, (n_nodes). @param facet_of each cell, any numbers
std::vector<std::uint8_t> inner_nodes(const Surface& skin, std::span<const std::int32_t> facet_of);

/// That of the facet of each cell. @param facet_of each cell, 0 and up
std::vector<FacetArc> arcs_of_cells(const Surface& skin, std::span<const std::int32_t> facet_of);

}  // namespace lacon
