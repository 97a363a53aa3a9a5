#pragma once
// What MACR_LIGN_COUPE makes of all points of a line: means with first moments, and sums.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lacon/operators/macr_lign_coupe/lines.hpp"

namespace lacon {

/// MOMENT_0, MOMENT_1, MINIMUM, MAXIMUM, MOYE_INT, MOYE_EXT of a component along a line that is longer than nothing.
/// @param f one value a point
std::array<double, 6> moments(const std::vector<LinePoint>& points, const std::vector<double>& f);

/// Sums over the points of a line.
struct Resultant {
  std::vector<double> components;  ///< of each component
  std::array<double, 3> force{};   ///< along X, Y, Z: of the components whose names end so
  std::array<double, 3> moment{};  ///< of these forces about a point
  std::array<bool, 3> along{};     ///< whether a component is along this axis
};

/// @param at (components, points); what is not there is no part of the sums @param origin of the moments, 3 coordinates
Resultant resultant(const std::vector<LinePoint>& points, const std::vector<std::string>& components,
                    const std::vector<std::vector<std::optional<double>>>& at, const std::vector<double>& origin);

}  // namespace lacon
