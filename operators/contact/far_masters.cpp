// Masters that a patch sees in part, far behind the others that it sees.
#include <algorithm>
#include <limits>
#include <map>

#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/operators/contact/facing.hpp"

// The gap of a patch is an average. A patch that reaches past the edge of its master and sees another one behind, the floor of
// a pocket or the table under a pile, would have both in it, and open with its near part deep inside the nearer one. So the far
// one is left out, and the patch is one that its master covers in part. That is decided where bodies are at rest or nearly in
// balance, and holds in between: gaps must not leap from iterate to iterate. A master is far behind where a leap parts the gaps
// at its points from those at all points that are nearer: slopes have none. Walls, which a patch sees at a grazing angle, now
// more of them and now less, are neither left out nor count as nearer.

namespace lacon {
namespace {

constexpr double far_behind = 0.5;      // of the size of the patch
constexpr double still_far = 0.45;      // likewise, of what is left out already
constexpr double deepest_nearest = 1;   // likewise: nothing is behind a master that a patch lies so deep in
constexpr double least_nearest = 2e-2;  // of the patch: what the nearer ones cover, so that it can take contact there
constexpr double facing_cosine = 0.5;   // between the slave's normal and the opposite of the master's: less is a wall
constexpr double round_off = 1e-9;      // of the patch: what less is seen of by accident
constexpr int most_levels = 4;          // of masters that lie one behind the other

}  // namespace

std::set<FarMaster> ContactGeometry::far_masters(const std::set<FarMaster>& before) const {
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
  const auto is_wall = [&](const Cell& cell) {
    const Vec3 slave = facing(mesh_, contact_.slaves[cell.slave].cell, coordinates_).normal,
               master = facing(mesh_, cell.master, coordinates_).normal;
    return -dot(slave, master) < facing_cosine;
  };
  const auto may_see_far = [&](std::size_t patch) {
    return nearest[patch] >= -deepest_nearest * size_[patch] && farthest[patch] - nearest[patch] > still_far * size_[patch];
  };
  std::map<std::size_t, std::vector<const Cell*>> seen;  // by patches
  for (const Cell& cell : cells_)
    if (counts(cell) && may_see_far(patch_of(cell)) && !is_wall(cell)) seen[patch_of(cell)].push_back(&cell);

  std::set<FarMaster> found;
  for (auto& [patch, cells] : seen) {
    std::ranges::stable_sort(cells, {}, &Cell::least);
    double most = cells[0]->most, covered = 0;
    std::set<std::int32_t> near, far;
    for (const Cell* const cell : cells) {
      const FarMaster one{static_cast<std::int32_t>(patch), cell->master};
      if (!far.empty() || cell->least - most > (before.contains(one) ? still_far : far_behind) * size_[patch]) {
        far.insert(cell->master);
        continue;
      }
      near.insert(cell->master);
      most = std::max(most, cell->most);
      covered += cell->measure;
    }
    if (covered < least_nearest * whole_[patch]) continue;
    for (const std::int32_t master : far)
      if (!near.contains(master)) found.insert({static_cast<std::int32_t>(patch), master});
  }
  return found;
}

bool ContactGeometry::leave_far_masters() {
  if (contact_.frozen_gap) return false;
  const std::set<FarMaster> before = left_out_;
  if (!before.empty()) {
    leave_out({});
    look();
  }
  std::set<FarMaster> more = far_masters(before), all;
  for (int level = 0; level < most_levels && !more.empty(); ++level) {
    all.merge(more);
    leave_out(all);
    look();
    more = far_masters(before);  // what was hidden by those
  }
  if (coordinates_ == rest_) left_out_at_rest_ = left_out_;
  return left_out_ != before;
}

void ContactGeometry::leave_out(std::set<FarMaster> masters) {
  if (masters == left_out_) return;
  left_out_ = std::move(masters);
  for (Zone& zone : zones_) {
    zone.left_out.clear();
    const std::map<std::int32_t, std::int32_t> place =
        left_out_.empty() ? std::map<std::int32_t, std::int32_t>() : zone.places();
    for (std::size_t s = 0; !left_out_.empty() && s < zone.slaves.size(); ++s) {
      const std::int32_t patch = contact_.slaves[zone.slaves[s]].patch;
      for (auto one = left_out_.lower_bound({patch, -1}); one != left_out_.end() && one->patch == patch; ++one)
        if (const auto master = place.find(one->master); master != place.end())
          zone.left_out.push_back({static_cast<std::int32_t>(s), master->second});
    }
    std::ranges::sort(zone.left_out);
    zone.pairing.left_out = zone.left_out;
  }
}

void ContactGeometry::keep_left_out(bool same_rest) {
  if (same_rest)
    leave_out(left_out_at_rest_);
  else
    left_out_at_rest_ = left_out_;
}

}  // namespace lacon
