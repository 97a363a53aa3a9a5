#pragma once
// What MACR_LIGN_COUPE makes of all points of a line: means with first moments, and sums.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lacon/operators/macr_lign_coupe/lines.hpp"

namespace lacon {

/// MOMENT_0, MOMENT_1, MINIMUM, MAXIMUM, MOYE_INT, MOYE_EXT of a component along a line that is longer than nothing: of the
/// pieces with a value at both ends, and the straight line from the first to the last of them that has their mean and slope.
/// @param f one value a point, or none @return without values where no piece has them
std::array<std::optional<double>, 6> moments(const std::vector<LinePoint>& points, const std::vector<std::optional<double>>& f);

/// Sums over the points of a line.
struct Resultant {
  std::vector<double> components;  ///< of each component
  std::array<double, 3> force{};   ///< along X, Y, Z: of the components whose names end so
  std::array<double, 3> moment{};  ///< of these forces about a point
  std::array<bool, 3> along{};     ///< whether a component is along this axis
  double magnitude = 0;            ///< of these forces, added up
};

/// @param at (components, points); what is not there is no part of the sums @param origin of the moments, 3 coordinates
Resultant resultant(const std::vector<std::array<double, 3>>& positions, const std::vector<std::string>& components,
                    const std::vector<std::vector<std::optional<double>>>& at, const std::vector<double>& origin);

}  // namespace lacon
