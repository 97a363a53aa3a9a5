#include "lacon/operators/macr_lign_coupe/sums.hpp"

#include <algorithm>
#include <string_view>

namespace lacon {

std::array<double, 6> moments(const std::vector<LinePoint>& points, const std::vector<double>& f) {
  const double length = points.back().along;
  double mean = 0, first = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double step = points[i + 1].along - points[i].along;
    const double arm = points[i].along - length / 2, next = points[i + 1].along - length / 2;
    mean += step * (f[i] + f[i + 1]) / 2 / length;
    // Simpson's rule, exact for the product of two linear functions
    first += step * (f[i] * arm + f[i + 1] * next + (f[i] + f[i + 1]) * (arm + next)) / 6 * 12 / (length * length);
  }
  return {mean,
          first,
          *std::min_element(f.begin(), f.end()),
          *std::max_element(f.begin(), f.end()),
          mean - first / 2,
          mean + first / 2};
}

Resultant resultant(const std::vector<LinePoint>& points, const std::vector<std::string>& components,
                    const std::vector<std::vector<std::optional<double>>>& at, const std::vector<double>& origin) {
  Resultant sum{.components = std::vector<double>(components.size(), 0.0)};
  for (std::size_t c = 0; c < components.size(); ++c) {
    const std::size_t axis = std::string_view("XYZ").find(components[c].back());
    if (axis != std::string_view::npos) sum.along[axis] = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double value = at[c][i].value_or(0.0);
      sum.components[c] += value;
      if (axis == std::string_view::npos) continue;
      const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
      sum.force[axis] += value;
      sum.moment[next] += (points[i].position[last] - origin[last]) * value;
      sum.moment[last] -= (points[i].position[next] - origin[next]) * value;
    }
  }
  return sum;
}

}  // namespace lacon
