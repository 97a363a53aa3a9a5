#pragma once
// How much a couple counts whose skins are nearly at a right angle.

// A wall beside an edge is not contact, whatever side of 90 degrees a deformation puts it on. It covers a width that goes to
// zero there, with any gap, so that the integrated gap G has a kink where the wall comes upright: forces jump, by the pressure
// times the gap, and where they drive the wall to that angle no iterate is in equilibrium. So all that such a couple adds, gap
// and measure, is multiplied by a share that goes from one to zero between an angle and 90 degrees, and G has a continuous
// derivative. Angles are those between the mean normals of both cells.

namespace lacon {

/// The share of a couple and its derivatives by the cosine of the angle between the slave's normal and the opposite of the
/// master's.
struct Share {
  double value, slope, curvature;
};

/// @param steep the cosine from which on couples count as a whole; not positive: all do
inline Share share_of_couple(double cosine, double steep) {
  if (!(steep > 0) || cosine >= steep) return {1, 0, 0};
  if (!(cosine > 0)) return {0, 0, 0};
  const double t = cosine / steep;
  return {t * t * (3 - 2 * t), 6 * t * (1 - t) / steep, (6 - 12 * t) / (steep * steep)};
}

}  // namespace lacon
