// Which patches may hold bodies that are loose otherwise.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/operators/contact/facing.hpp"

namespace lacon {
namespace {

constexpr double same_way = 0.7;  // cosine, 45 degrees: what presses along one of two normals presses along the other
constexpr double far_apart =
    0.3;  // of the extent of a contact: what presses at one of two places lets a body tip onto the other

struct Near {
  std::size_t patch;
  std::int32_t node;  // of the body
  double gap;
  Facing facing;
};

/// The contact of a body in a zone.
struct Hold {
  std::vector<Facing> pressed;  // cells of patches in contact
  std::vector<Near> near;       // the others, each once
  std::set<std::size_t> seen;
};

/// The diagonal of the box around all that touches or is near.
double extent(const Hold& hold) {
  std::vector<Vec3> places;
  for (const Facing& one : hold.pressed) places.push_back(one.place);
  for (const Near& one : hold.near) places.push_back(one.facing.place);
  Vec3 diagonal{};
  for (double Vec3::*const axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const auto [least, most] = std::ranges::minmax(places, {}, axis);
    diagonal.*axis = most.*axis - least.*axis;
  }
  return norm(diagonal);
}

}  // namespace

bool ContactState::is_near(std::size_t patch, const Patchwise& patches) const {
  return patches.status[patch] != Status::active && !held_open_[patch] &&
         geometry_.gap(patch) <= tolerances_.holding_gap * size_[patch];
}

bool ContactState::may_hold(std::size_t patch, const Patchwise& patches) const {
  return takes_contact(patch) && is_near(patch, patches);
}

bool ContactState::lacks_cover(std::size_t patch, const Patchwise& patches) const {
  return is_covered(patch) && !takes_contact(patch) && !geometry_.is_beside_wall(patch) && is_near(patch, patches);
}

std::int32_t ContactState::node_at(std::size_t patch, const std::function<bool(std::int32_t node)>& is_loose) const {
  for (const ContactGeometry::Cell& cell : geometry_.cells()) {
    const SlaveElement& slave = contact_.slaves[cell.slave];
    if (static_cast<std::size_t>(slave.patch) != patch) continue;
    for (const std::int32_t owner : {slave.cell, cell.master})
      if (const std::int32_t node = mesh_.cells[owner][0]; is_loose(node)) return node;
  }
  return -1;
}

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
      const Facing faces = facing(mesh_, slave.cell, geometry_.coordinates());
      if (patches.status[patch] == Status::active)
        hold.pressed.push_back(faces);
      else if (may_hold(patch, patches) && hold.seen.insert(patch).second)
        hold.near.push_back({patch, node, geometry_.gap(patch), faces});
    }
  }
  std::vector<NearestPatches> found;
  const auto take = [&](const std::vector<Near>& near) {
    const Near& first = *std::ranges::min_element(near, {}, &Near::gap);
    found.push_back({{first.patch}, first.node});
    for (const Near& other : near)
      if (other.patch != first.patch && other.gap <= first.gap + tolerances_.as_near * size_[other.patch])
        found.back().patches.push_back(other.patch);
    return first.facing;
  };
  // those of `near` that nothing pressed does the same for, the nearest first, until there are none
  const auto take_beside = [&](const Hold& hold, const auto& does_the_same) {
    for (std::vector<Facing> pressed = hold.pressed;;) {
      std::vector<Near> near;
      std::ranges::copy_if(hold.near, std::back_inserter(near), [&](const Near& one) {
        return std::ranges::none_of(pressed, [&](const Facing& other) { return does_the_same(other, one.facing); });
      });
      if (near.empty()) return;
      const Facing nearest = std::ranges::min_element(near, {}, &Near::gap)->facing;
      std::erase_if(near, [&](const Near& other) { return !does_the_same(nearest, other.facing); });
      pressed.push_back(take(near));
    }
  };
  for (const auto& [where, hold] : holds)
    if (hold.pressed.empty() && !hold.near.empty()) take(hold.near);
  if (!found.empty()) return found;
  // in contact in every zone, and loose all the same: what is near across other directions
  for (const auto& [where, hold] : holds)
    take_beside(hold,
                [](const Facing& one, const Facing& other) { return std::abs(dot(one.normal, other.normal)) > same_way; });
  if (!found.empty()) return found;
  // in contact across every direction: what is near beside, that the body tips onto
  for (const auto& [where, hold] : holds) {
    if (hold.near.empty()) continue;
    const double apart = far_apart * extent(hold);
    take_beside(hold, [&](const Facing& one, const Facing& other) { return norm(one.place - other.place) <= apart; });
  }
  for (NearestPatches& beside : found) beside.tips = true;
  return found;
}

}  // namespace lacon
