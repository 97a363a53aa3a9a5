#pragma once
// Where the cover of a slave cell ends, near an end of that cell.
#include <cmath>

// Beyond the last node of a master skin nothing is integrated. Where the normal of that node passes an end of a slave, G would
// have a kink: before, its derivative by that way is the gap there, behind, nothing. The forces lambda dG/du would jump, and
// where they drive two ends that are aligned towards each other, equilibrium would lie in the jump, where no iterate finds it.
// So within a narrow band the cover leaves the slave's end slowly, and catches up with the normal at the band's other side: G
// has a continuous derivative, and is what it would be both outside the band and where the ends are aligned.

namespace lacon {

/// The end of the cover as a function of the place c where that normal crosses the slave, in reference coordinates.
struct FadedEnd {
  double at, slope, curvature;  ///< its place and its derivatives by c
};

/// At a distance of t widths from the end of the slave the cover ends 2 t^2 - t^3 widths from it.
inline FadedEnd faded_end(double c, double width) {
  const double end = c > 0 ? 1 : -1, t = (1 - std::abs(c)) / width;
  if (!(t < 1)) return {c, 1, 0};
  return {end * (1 - width * t * t * (2 - t)), t * (4 - 3 * t), -end * (4 - 6 * t) / width};
}

}  // namespace lacon
