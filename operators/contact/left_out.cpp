// Masters that a patch sees in part and that are no part of its contact: far behind others that it sees, or walls beside them.
#include <algorithm>
#include <limits>
#include <map>

#include "lacon/operators/contact/contact_geometry.hpp"

// The gap of a patch is an average. A patch that reaches past the edge of its master and sees another one behind, the floor of
// a pocket or the table under a pile, would have both in it, and open with its near part deep inside the nearer one. So the far
// one is left out, and the patch is one that its master covers in part. That is decided where bodies are at rest or nearly in
// balance, and holds in between: gaps must not leap from iterate to iterate. A master is far behind where a leap parts the gaps
// at its points from those at all points that are nearer: slopes have none. Walls a patch sees at a grazing angle, far up, and
// now more of them and now less. So they do not count as nearer, and a patch that has a master in front of it sees none,
// neither those that it would see now nor those that it would see on the way: their slope is that at rest.

namespace lacon {
namespace {

constexpr double far_behind = 0.5;      // of the size of the patch
constexpr double still_far = 0.45;      // likewise, of what is left out already
constexpr double deepest_nearest = 1;   // likewise: nothing is behind a master that a patch lies so deep in
constexpr double least_nearest = 2e-2;  // of the patch: what the nearer ones cover, so that it can take contact there
constexpr double round_off = 1e-9;      // of the patch: what less is seen of by accident
constexpr int most_levels = 4;          // of masters that lie one behind the other

}  // namespace

LeftOut ContactGeometry::to_leave_out(const LeftOut& before) const {
  const auto patch_of = [&](const Cell& cell) { return static_cast<std::size_t>(contact_.slaves[cell.slave].patch); };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> nearest(n_patches(), infinite), farthest(n_patches(), -infinite);
  const auto counts = [&](const Cell& cell) { return cell.measure > round_off * whole_[patch_of(cell)]; };
  for (const Cell& cell : cells_) {
    const std::size_t patch = patch_of(cell);
    if (!counts(cell)) continue;
    nearest[patch] = std::min(nearest[patch], cell.least);
    farthest[patch] = std::max(farthest[patch], cell.most);
  }
  const auto may_see_far = [&](std::size_t patch) {
    return nearest[patch] >= -deepest_nearest * size_[patch] && farthest[patch] - nearest[patch] > still_far * size_[patch];
  };
  std::map<std::size_t, std::vector<const Cell*>> seen;  // by patches
  for (const Cell& cell : cells_)
    if (counts(cell) && !is_wall(cell, coordinates_)) seen[patch_of(cell)].push_back(&cell);

  LeftOut found{{}, std::vector<std::uint8_t>(n_patches(), 0)};
  for (auto& [patch, cells] : seen) {
    std::ranges::stable_sort(cells, {}, &Cell::least);
    double most = cells[0]->most, covered = 0;
    std::set<std::int32_t> near, far;
    for (const Cell* const cell : cells) {
      const FarMaster one{static_cast<std::int32_t>(patch), cell->master};
      if (!far.empty() || cell->least - most > (before.far.contains(one) ? still_far : far_behind) * size_[patch]) {
        far.insert(cell->master);
        continue;
      }
      near.insert(cell->master);
      most = std::max(most, cell->most);
      covered += cell->measure;
    }
    const bool had_none = patch < before.no_walls.size() && before.no_walls[patch] != 0;
    found.no_walls[patch] =
        cells[0]->least >= -deepest_nearest * size_[patch] && covered >= (had_none ? 0.5 : 1) * least_nearest * whole_[patch];
    if (covered < least_nearest * whole_[patch] || !may_see_far(patch)) continue;
    for (const std::int32_t master : far)
      if (!near.contains(master)) found.far.insert({static_cast<std::int32_t>(patch), master});
  }
  return found;
}

bool ContactGeometry::is_wall(const Cell& cell, std::span<const double> coordinates) const {
  const auto normal = [&](std::int32_t of) { return normal_of(mesh_.types[of], mesh_.cells[of], coordinates); };
  return -dot(normal(contact_.slaves[cell.slave].cell), normal(cell.master)) < wall_cosine;
}

bool ContactGeometry::other_walls(std::span<const std::uint8_t> no_walls) const {
  const auto had_none = [&](std::size_t patch) { return patch < left_out_.no_walls.size() && left_out_.no_walls[patch] != 0; };
  for (std::size_t patch = 0; patch < no_walls.size() && rejected_[static_cast<std::size_t>(Rejection::wall)] > 0; ++patch)
    if (no_walls[patch] == 0 && had_none(patch)) return true;
  return std::ranges::any_of(cells_, [&](const Cell& cell) {
    const auto patch = static_cast<std::size_t>(contact_.slaves[cell.slave].patch);
    return no_walls[patch] != 0 && !had_none(patch) && is_wall(cell, rest_);
  });
}

bool ContactGeometry::choose_masters() {
  if (contact_.frozen_gap) return false;
  const LeftOut before = left_out_;
  if (!before.far.empty()) {
    leave_out({{}, before.no_walls});
    look();
  }
  LeftOut all, more = to_leave_out(before);
  all.no_walls = more.no_walls;
  bool others = false;
  for (int level = 0; level < most_levels; ++level) {
    const bool walls = other_walls(all.no_walls);
    const bool far = !more.far.empty();
    others = others || walls;
    all.far.merge(more.far);
    leave_out(all);
    if (!far && !walls) break;
    look();
    more = to_leave_out(before);  // what was hidden by those
    for (std::size_t patch = 0; patch < n_patches(); ++patch) all.no_walls[patch] |= more.no_walls[patch];
  }
  if (coordinates_ == rest_) left_out_at_rest_ = left_out_;
  return others || left_out_.far != before.far;
}

void ContactGeometry::leave_out(LeftOut what) {
  left_out_ = std::move(what);
  const std::set<FarMaster>& far = left_out_.far;
  for (Zone& zone : zones_) {
    zone.left_out.clear();
    zone.no_walls.clear();
    const std::map<std::int32_t, std::int32_t> place = far.empty() ? std::map<std::int32_t, std::int32_t>() : zone.places();
    for (std::size_t s = 0; s < zone.slaves.size(); ++s) {
      const std::int32_t patch = contact_.slaves[zone.slaves[s]].patch;
      if (!left_out_.no_walls.empty()) zone.no_walls.push_back(left_out_.no_walls[static_cast<std::size_t>(patch)]);
      for (auto one = far.lower_bound({patch, -1}); one != far.end() && one->patch == patch; ++one)
        if (const auto master = place.find(one->master); master != place.end())
          zone.left_out.push_back({static_cast<std::int32_t>(s), master->second});
    }
    std::ranges::sort(zone.left_out);
    zone.pairing.left_out = zone.left_out;
    zone.pairing.no_walls = zone.no_walls;
  }
}

void ContactGeometry::keep_left_out(bool same_rest) {
  if (same_rest)
    leave_out(left_out_at_rest_);
  else
    left_out_at_rest_ = left_out_;
}

}  // namespace lacon
