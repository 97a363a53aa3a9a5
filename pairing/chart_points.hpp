#pragma once
// Integration points of what a slave facet and a master have in common.
#include <cstdint>
#include <vector>

#include "lacon/pairing/slave_facet.hpp"

namespace lacon::space {

/// Whether polygons of a couple are exact, or nearly so.
inline bool exact_polygons(const SlaveFacet& slave, const FacetKind& master) { return slave.nearly_flat && master.straight; }

/// The degree to which a couple is integrated. The integrand is analytic in the plane; the nearest singularity of an inverse
/// map lies at about 1 / distortion, so that a rule of degree p leaves rho^-p with rho as in the code (METHOD.md 5.4 has
/// measured figures). Where polygons are themselves approximate a higher degree than 8 serves nothing.
int integration_degree(const SlaveFacet& slave, const FacetKind& master);

/// By how much the derivatives of the integrand have a higher degree than it is, on flat facets. @param smooth slaves have
/// nodal normals
int of_derivatives(CellType slave, CellType master, bool smooth);

/// Points of the chart, with their weights there.
struct ChartPoints {
  std::vector<Vec2> y;
  std::vector<double> weight;
  /// Where there is nothing but a fan: in the triangle of the vertices 0, last - 1 and last, at these coordinates.
  struct InFan {
    std::int32_t last;
    double r, s;
    double weight;  ///< of the rule
  };
  std::vector<InFan> fan;
  Polygon corners;  ///< used again for every polygon

  void add(Vec2 at, double of_it) {
    y.push_back(at);
    weight.push_back(of_it);
  }
};

/// Integration points of a convex polygon: as a quadrangle where it has four corners, which takes fewer points for the same
/// degree, else on a fan of triangles. Where the degree is not enough (polygons that are approximate) the smaller triangles are
/// the more accurate ones.
///
/// Where edges of slave and master coincide to round-off, vertices come and go: C must not jump by the error of quadrature
/// there, Newton's method would never end. So vertices that cut off next to nothing are no corners, and have small triangles of
/// their own; a fan has them by itself.
/// @param traced nothing but a fan, and all of its triangles: those without area too, for they may get one
void place_points(const Polygon& polygon, int degree, bool enough, bool traced, ChartPoints& points);

}  // namespace lacon::space
