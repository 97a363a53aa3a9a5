// Which patches may hold bodies that are loose otherwise.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "lacon/operators/contact/contact_state.hpp"

namespace lacon {
namespace {

constexpr double same_way = 0.7;  // cosine, 45 degrees: what presses along one of two normals presses along the other

/// Across the cell of a skin, unit, to either side.
Vec3 across(const Mesh& mesh, std::int32_t cell, std::span<const double> coordinates) {
  const auto nodes = mesh.cells[cell];
  const auto at = [&](std::size_t i) { return vector_at(coordinates.data() + 3 * std::ptrdiff_t{nodes[i]}); };
  const Vec3 along = at(1) - at(0);
  const Vec3 normal = mesh.dimension == 2 ? Vec3{-along.y, along.x, 0} : cross(along, at(2) - at(0));
  return (1 / std::sqrt(dot(normal, normal))) * normal;
}

struct Near {
  std::size_t patch;
  std::int32_t node;  // of the body
  double gap;
  Vec3 normal;
};

/// The contact of a body in a zone.
struct Hold {
  std::vector<Vec3> pressed;  // normals of patches in contact
  std::vector<Near> near;     // the others, each once
  std::set<std::size_t> seen;
};

}  // namespace

std::vector<NearestPatches> ContactState::nearest_to_hold(const Patchwise& patches, const std::set<std::int32_t>& loose,
                                                          const std::function<std::int32_t(std::int32_t node)>& body_of) const {
  std::map<std::pair<std::int32_t, std::int32_t>, Hold> holds;  // by zone and body
  for (const ContactGeometry::Cell& cell : geometry_.cells()) {
    const SlaveElement& slave = contact_.slaves[cell.slave];
    const auto patch = static_cast<std::size_t>(slave.patch);
    for (const std::int32_t owner : {slave.cell, cell.master}) {
      const std::int32_t node = mesh_.cells[owner][0], body = body_of(node);
      if (!loose.contains(body)) continue;
      Hold& hold = holds[{geometry_.zone_of(patch), body}];
      const Vec3 normal = across(mesh_, slave.cell, geometry_.coordinates());
      if (patches.status[patch] == Status::active)
        hold.pressed.push_back(normal);
      else if (!held_open_[patch] && geometry_.coverage(patch) >= tolerances_.least_coverage &&
               geometry_.gap(patch) <= tolerances_.holding_gap * size_[patch])
        if (hold.seen.insert(patch).second) hold.near.push_back({patch, node, geometry_.gap(patch), normal});
    }
  }
  std::vector<NearestPatches> found;
  const auto take = [&](const std::vector<Near>& near) {
    const Near& first = *std::ranges::min_element(near, {}, &Near::gap);
    found.push_back({{first.patch}, first.node});
    for (const Near& other : near)
      if (other.patch != first.patch && other.gap <= first.gap + tolerances_.as_near * size_[other.patch])
        found.back().patches.push_back(other.patch);
  };
  for (const auto& [where, hold] : holds)
    if (hold.pressed.empty() && !hold.near.empty()) take(hold.near);
  if (!found.empty()) return found;
  // in contact in every zone, and loose all the same: what is near across other directions, one after the other
  for (const auto& [where, hold] : holds) {
    std::vector<Vec3> pressed = hold.pressed;
    const auto presses_another_way = [&](const Near& one) {
      return std::ranges::none_of(pressed, [&](const Vec3& normal) { return std::abs(dot(normal, one.normal)) > same_way; });
    };
    for (;;) {
      std::vector<Near> near;
      std::ranges::copy_if(hold.near, std::back_inserter(near), presses_another_way);
      if (near.empty()) break;
      const Vec3 normal = std::ranges::min_element(near, {}, &Near::gap)->normal;
      std::erase_if(near, [&](const Near& other) { return std::abs(dot(normal, other.normal)) <= same_way; });
      take(near);
      pressed.push_back(normal);
    }
  }
  return found;
}

}  // namespace lacon
