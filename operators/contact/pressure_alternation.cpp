#include "lacon/operators/contact/pressure_alternation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace lacon {

PressureAlternation::PressureAlternation(const std::vector<std::vector<std::int32_t>>& corners) {
  constexpr std::size_t triangle = 3;
  std::map<std::int32_t, std::vector<std::size_t>> around;
  for (std::size_t patch = 0; patch < corners.size(); ++patch)
    for (const std::int32_t corner : corners[patch]) around[corner].push_back(patch);
  std::map<std::int32_t, std::size_t> ring_of;
  for (const auto& [vertex, patches] : around) {
    std::set<std::int32_t> others;
    bool triangles = true;
    for (const std::size_t patch : patches) {
      triangles = triangles && corners[patch].size() == triangle;
      others.insert(corners[patch].begin(), corners[patch].end());
    }
    // on the border of the skin there is one vertex more
    if (!triangles || others.size() != patches.size() + 1) continue;
    ring_of[vertex] = rings_.size();
    rings_.push_back(patches);
  }
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> at_edge;
  for (std::size_t patch = 0; patch < corners.size(); ++patch) {
    Inner inner{patch, {}};
    std::size_t found = 0;
    for (const std::int32_t corner : corners[patch])
      if (const auto ring = ring_of.find(corner); ring != ring_of.end()) inner.rings[found++] = ring->second;
    if (found != triangle) continue;
    for (std::size_t i = 0; i < triangle; ++i) {
      const auto edge = std::minmax({corners[patch][i], corners[patch][(i + 1) % triangle]});
      const auto [other, is_new] = at_edge.try_emplace(edge, inner_.size());
      if (!is_new) couples_.emplace_back(other->second, inner_.size());
    }
    inner_.push_back(inner);
  }
}

std::optional<AlternatingPressures> PressureAlternation::measure(std::span<const double> pressure, std::span<const double> area,
                                                                 const std::vector<bool>& whole,
                                                                 const std::vector<bool>& pressed) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  constexpr int least_couples = 8;    // of fewer a product says little
  constexpr int least_pressing = 10;  // of fewer exact pressures are scattered as well
  std::vector<double> mean;
  for (const std::vector<std::size_t>& ring : rings_) {
    double force = 0, measure = 0;
    bool known = true, presses = false;
    for (const std::size_t patch : ring) {
      known = known && whole[patch];
      presses = presses || pressed[patch];
      force += pressed[patch] ? pressure[patch] * area[patch] : 0;
      measure += area[patch];
    }
    mean.push_back(known && presses ? force / measure : unknown);
  }
  AlternatingPressures found{0, 0, AlternatingBy::triangles};
  std::vector<double> differences;
  double largest = -1, squares = 0;
  int known = 0, pressing = 0;
  for (const Inner& inner : inner_) {
    const double here = pressed[inner.patch] ? pressure[inner.patch] : 0;
    const double difference = here - (mean[inner.rings[0]] + mean[inner.rings[1]] + mean[inner.rings[2]]) / 3;
    differences.push_back(difference);
    if (std::isnan(difference)) continue;
    squares += here * here;
    found.scatter += difference * difference;
    ++known;
    pressing += pressed[inner.patch];
    if (std::abs(difference) > largest) largest = std::abs(difference), found.patch = inner.patch;
  }
  double product = 0;
  int couples = 0;
  for (const auto& [one, other] : couples_)
    if (const double both = differences[one] * differences[other]; !std::isnan(both)) product += both, ++couples;
  if (couples < least_couples || squares == 0) return std::nullopt;
  found.share = product < 0 ? std::sqrt(-product / couples / (squares / known)) : 0;
  found.pressing = static_cast<double>(pressing) / known;
  found.scatter = pressing < least_pressing ? 0 : std::sqrt(found.scatter / squares);
  return found;
}

}  // namespace lacon
