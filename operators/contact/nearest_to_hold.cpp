// Which patches may hold bodies that are loose otherwise.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/pairing/normals.hpp"

namespace lacon {
namespace {

constexpr double same_way = 0.7;  // cosine, 45 degrees: what presses along one of two normals presses along the other

/// Of the cell of a skin at its first vertex, unit.
Vec3 unit_normal(const Mesh& mesh, std::int32_t cell, std::span<const double> coordinates) {
  std::vector<double> points;
  for (const std::int32_t node : mesh.cells[cell]) {
    const auto point = coordinates.subspan(3 * static_cast<std::size_t>(node), 3);
    points.insert(points.end(), point.begin(), point.end());
  }
  const catalog::CellRow& row = mesh.row(cell);
  const Vec3 normal = cell_normal(mesh.types[cell], points, row.nodes.first(static_cast<std::size_t>(row.dimension)));
  return normal / norm(normal);
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
      const Vec3 normal = unit_normal(mesh_, slave.cell, geometry_.coordinates());
      if (patches.status[patch] == Status::active)
        hold.pressed.push_back(normal);
      else if (!held_open_[patch] && geometry_.coverage(patch) >= tolerances_.least_coverage &&
               geometry_.gap(patch) <= tolerances_.holding_gap * size_[patch] && hold.seen.insert(patch).second)
        hold.near.push_back({patch, node, geometry_.gap(patch), normal});
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
