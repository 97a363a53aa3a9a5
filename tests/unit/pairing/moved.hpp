#pragma once
// Where the nodes of a skin were before a motion, or are behind it.
#include <array>
#include <cstddef>
#include <vector>

namespace lacon::test {

/// @param coordinates (n, 3)
inline std::vector<double> moved(std::vector<double> coordinates, std::array<double, 3> by) {
  for (std::size_t i = 0; i < coordinates.size(); ++i) coordinates[i] += by[i % 3];
  return coordinates;
}

}  // namespace lacon::test
