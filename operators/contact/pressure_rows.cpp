#include "lacon/operators/contact/pressure_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace lacon {

PressureRows::PressureRows(const std::vector<std::vector<std::int32_t>>& nodes, const std::vector<Vec3>& normals,
                           std::size_t shared)
    : directions_(shared) {
  constexpr double same_side = 0.5;  // cosine
  std::map<std::int32_t, std::vector<std::size_t>> around;
  for (std::size_t patch = 0; patch < nodes.size(); ++patch)
    for (const std::int32_t node : nodes[patch]) around[node].push_back(patch);
  const auto in_common = [&](std::size_t patch) {
    std::map<std::size_t, std::size_t> counts;  // of other patches: the nodes that they share
    for (const std::int32_t node : nodes[patch])
      for (const std::size_t other : around[node])
        if (other != patch) ++counts[other];
    return counts;
  };
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> three_of;  // by its middle and a neighbour
  for (std::size_t patch = 0; patch < nodes.size(); ++patch) {
    std::vector<std::size_t> neighbours;
    for (const auto& [other, count] : in_common(patch))
      if (count >= shared && dot(normals[patch], normals[other]) > same_side) neighbours.push_back(other);
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      const auto touching = in_common(neighbours[i]);
      for (std::size_t j = i + 1; j < neighbours.size(); ++j) {
        if (touching.contains(neighbours[j])) continue;
        for (const std::size_t beside : {neighbours[i], neighbours[j]}) three_of[{patch, beside}] = threes_.size();
        threes_.push_back({patch, {neighbours[i], neighbours[j]}, {}});
      }
    }
  }
  for (Three& three : threes_)
    for (std::size_t side = 0; side < 2; ++side)
      if (const auto next = three_of.find({three.beside[side], three.middle}); next != three_of.end())
        three.next[side] = next->second;
}

PressureRows::Waves PressureRows::waves(std::span<const double> pressure, std::span<const double> area,
                                        const std::vector<bool>& whole, const std::vector<bool>& pressed) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  constexpr int most_open = 2;  // in a row: more of them part two contacts
  const auto presses = [&](std::size_t patch) { return whole[patch] && pressed[patch]; };
  // a row from a patch outward: whether one presses before `most_open` others are passed
  const auto presses_beyond = [&](std::size_t three, std::size_t side) {
    for (int passed = 1;; ++passed) {
      const std::size_t here = threes_[three].middle, beside = threes_[three].beside[side];
      if (presses(beside)) return true;
      const std::optional<std::size_t> next = threes_[three].next[side];
      if (passed == most_open || !whole[beside] || !next) return false;
      three = *next;
      side = threes_[three].beside[0] == here ? 1 : 0;
    }
  };
  const auto between = [&](std::size_t three) {
    return whole[threes_[three].middle] && presses_beyond(three, 0) && presses_beyond(three, 1);
  };
  Waves found;
  for (std::size_t i = 0; i < threes_.size(); ++i) {
    const Three& three = threes_[i];
    const double here = presses(three.middle) ? pressure[three.middle] : between(i) ? 0 : unknown;
    double sides[2], spans[2];
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t beside = three.beside[side];
      sides[side] = presses(beside) ? pressure[beside] : three.next[side] && between(*three.next[side]) ? 0 : unknown;
      spans[side] = area[three.middle] + area[beside];
    }
    // linear between the middles of both neighbours; half of what is left, which is the amplitude where signs change
    const double line = (sides[0] * spans[1] + sides[1] * spans[0]) / (spans[0] + spans[1]);
    found.pressure.push_back(here);
    found.difference.push_back(0.5 * (here - line));
  }
  return found;
}

std::optional<AlternatingPressures> PressureRows::measure(const Waves& waves, const std::vector<bool>& counting,
                                                          AlternatingBy by) const {
  constexpr int least_couples = 8;  // of fewer a product says little
  AlternatingPressures found{0, 0, by};
  double largest = -1, squares = 0, product = 0;
  int known = 0, couples = 0;
  for (std::size_t i = 0; i < threes_.size(); ++i) {
    const double difference = waves.difference[i];
    if (std::isnan(difference) || !counting[i]) continue;
    squares += waves.pressure[i] * waves.pressure[i];
    ++known;
    if (std::abs(difference) > largest) largest = std::abs(difference), found.patch = threes_[i].middle;
    for (const auto& next : threes_[i].next)
      if (next && *next > i && counting[*next] && !std::isnan(waves.difference[*next]))
        product += difference * waves.difference[*next], ++couples;
  }
  if (couples < least_couples || squares == 0) return std::nullopt;
  found.share = product < 0 ? std::sqrt(-product / couples / (squares / known)) : 0;
  return found;
}

std::optional<AlternatingPressures> PressureRows::measure(std::span<const double> pressure, std::span<const double> area,
                                                          const std::vector<bool>& whole,
                                                          const std::vector<bool>& pressed) const {
  return measure(waves(pressure, area, whole, pressed), std::vector<bool>(threes_.size(), true), AlternatingBy::facets);
}

std::optional<AlternatingPressures> PressureRows::measure_inside(std::span<const double> pressure, std::span<const double> area,
                                                                 const std::vector<bool>& whole,
                                                                 const std::vector<bool>& pressed,
                                                                 const std::vector<bool>& counting) const {
  const Waves found = waves(pressure, area, whole, pressed);
  const auto is_known = [&](const std::optional<std::size_t>& three) { return three && !std::isnan(found.difference[*three]); };
  std::vector<std::size_t> open_ended(pressure.size(), directions_);  // of a patch: directions in which its row ends near it
  for (std::size_t i = 0; i < threes_.size(); ++i)
    if (const std::size_t patch = threes_[i].middle;
        open_ended[patch] > 0 && is_known(i) && std::ranges::all_of(threes_[i].next, is_known))
      --open_ended[patch];
  std::vector<bool> inside;
  for (const Three& three : threes_) inside.push_back(counting[three.middle] && open_ended[three.middle] == 0);
  return measure(found, inside, AlternatingBy::rows);
}

}  // namespace lacon
