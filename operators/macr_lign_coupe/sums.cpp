#include "lacon/operators/macr_lign_coupe/sums.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace lacon {

std::array<std::optional<double>, 6> moments(const std::vector<LinePoint>& points,
                                             const std::vector<std::optional<double>>& f) {
  std::array<std::optional<double>, 6> made;
  for (const std::optional<double>& value : f) {
    if (!value) continue;
    made[2] = std::min(made[2].value_or(*value), *value);
    made[3] = std::max(made[3].value_or(*value), *value);
  }
  std::vector<std::size_t> pieces;  // that have a value at both ends
  double length = 0, middle = 0, mean = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (!f[i] || !f[i + 1]) continue;
    const double step = points[i + 1].along - points[i].along;
    pieces.push_back(i);
    length += step;
    middle += step * (points[i].along + points[i + 1].along) / 2;
    mean += step * (*f[i] + *f[i + 1]) / 2;
  }
  if (!(length > 0)) return made;
  middle /= length;
  mean /= length;
  double first = 0, second = 0;  // of f, and of the distance from the middle, about that middle
  for (const std::size_t i : pieces) {
    const double step = points[i + 1].along - points[i].along;
    const double arm = points[i].along - middle, next = points[i + 1].along - middle;
    // Simpson's rule, exact for the product of two linear functions
    first += step * (*f[i] * arm + *f[i + 1] * next + (*f[i] + *f[i + 1]) * (arm + next)) / 6;
    second += step * (arm * arm + arm * next + next * next) / 3;
  }
  const double slope = first / second, begin = points[pieces.front()].along, end = points[pieces.back() + 1].along;
  made[0] = mean;
  made[1] = slope * (end - begin);
  made[4] = mean + slope * (begin - middle);
  made[5] = mean + slope * (end - middle);
  return made;
}

Resultant resultant(const std::vector<std::array<double, 3>>& positions, const std::vector<std::string>& components,
                    const std::vector<std::vector<std::optional<double>>>& at, const std::vector<double>& origin) {
  Resultant sum{.components = std::vector<double>(components.size(), 0.0)};
  for (std::size_t c = 0; c < components.size(); ++c) {
    const std::size_t axis = std::string_view("XYZ").find(components[c].back());
    if (axis != std::string_view::npos) sum.along[axis] = true;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const double value = at[c][i].value_or(0.0);
      sum.components[c] += value;
      if (axis == std::string_view::npos) continue;
      const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
      sum.force[axis] += value;
      sum.magnitude += std::abs(value);
      sum.moment[next] += (positions[i][last] - origin[last]) * value;
      sum.moment[last] -= (positions[i][next] - origin[next]) * value;
    }
  }
  return sum;
}

}  // namespace lacon
