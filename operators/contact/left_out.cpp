// Masters that a patch sees in part and that are no part of its contact: far behind others that it sees, or walls beside them.
#include <algorithm>
#include <limits>
#include <map>

#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/operators/contact/patches.hpp"

// The gap of a patch is an average. A patch that reaches past the edge of its master and sees another one behind, the floor of
// a pocket or the table under a pile, would have both in it, and open with its near part deep inside the nearer one. So the far
// one is left out, and the patch is one that its master covers in part. That is decided where bodies are at rest or nearly in
// balance, and holds in between: gaps must not leap from iterate to iterate. A master is far behind where a leap parts the gaps
// at its points from those at all points that are nearer: slopes have none. Walls a patch sees at a grazing angle, far up, and
// now more of them and now less. So they do not count as nearer, and a patch that has a face of the master in front of it sees
// no walls but its own, neither those that it would see now nor those that it would see on the way: their slope is that at
// rest, or where one was found to have turned since. A round goes on in one face, and so do the floor and the walls of a
// pocket.

namespace lacon {
namespace {

constexpr double far_behind = 0.5;      // of the size of the patch
constexpr double still_far = 0.45;      // likewise, of what is left out already
constexpr double deepest_nearest = 1;   // likewise: nothing is behind a master that a patch lies so deep in
constexpr double deepest_crest = 0.02;  // likewise: a sliver that lies deeper is no crest, but what another corner has gone by
constexpr double round_off = 1e-9;      // of the patch: what less is seen of by accident
constexpr double has_turned = 0.1;      // of a cosine: walls are decided anew where they have turned by more
constexpr int most_levels = 4;          // of masters that lie one behind the other

/// What belongs to one patch.
auto of_patch(const std::set<PatchMaster>& all, std::int32_t patch) {
  return std::ranges::subrange(all.lower_bound({patch, -1}), all.lower_bound({patch + 1, -1}));
}

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
    if (counts(cell) && (may_see_far(patch_of(cell)) || !zone_of(cell).one_face) &&
        !(facing_cosine(cell.slave, cell.master, coordinates_) < wall_cosine))
      seen[patch_of(cell)].push_back(&cell);

  LeftOut found;
  for (auto& [patch, cells] : seen) {
    std::ranges::stable_sort(cells, {}, &Cell::least);
    const auto number = static_cast<std::int32_t>(patch);
    double most = cells[0]->most, covered = 0;
    std::set<std::int32_t> near, far;
    std::map<std::int32_t, double> covered_by, least_of;  // faces
    for (const Cell* const cell : cells) {
      if (!far.empty() ||
          cell->least - most > (before.far.contains({number, cell->master}) ? still_far : far_behind) * size_[patch]) {
        far.insert(cell->master);
        continue;
      }
      near.insert(cell->master);
      most = std::max(most, cell->most);
      covered += cell->measure;
      if (zone_of(*cell).one_face) continue;
      covered_by[face_of(*cell)] += cell->measure;
      least_of.try_emplace(face_of(*cell), cell->least);
    }
    for (const auto& [face, part] : covered_by) {
      const bool deep = least_of[face] < -deepest_crest * size_[patch];
      const double enough = before.in_front.contains({number, face}) ? least_coverage : deep ? taking_coverage : least_crest;
      if (cells[0]->least >= -deepest_nearest * size_[patch] && part >= enough * whole_[patch])
        found.in_front.insert({number, face});
    }
    if (covered < taking_coverage * whole_[patch] || !may_see_far(patch)) continue;
    for (const std::int32_t master : far)
      if (!near.contains(master)) found.far.insert({number, master});
  }
  return found;
}

double ContactGeometry::facing_cosine(std::int32_t slave, std::int32_t master, std::span<const double> coordinates) const {
  const auto normal = [&](std::int32_t of) { return normal_of(mesh_.types[of], mesh_.cells[of], coordinates); };
  return -dot(normal(contact_.slaves[slave].cell), normal(master));
}

bool ContactGeometry::walls_have_turned() const {
  if (std::ranges::any_of(walls_, [&](const auto& wall) {
        return facing_cosine(wall.first, wall.second, coordinates_) > wall_cosine + has_turned;
      }))
    return true;
  return std::ranges::any_of(cells_, [&](const Cell& cell) {
    const std::int32_t patch = contact_.slaves[cell.slave].patch;
    return !of_patch(left_out_.in_front, patch).empty() && !left_out_.in_front.contains({patch, face_of(cell)}) &&
           facing_cosine(cell.slave, cell.master, coordinates_) < wall_cosine - has_turned;
  });
}

void ContactGeometry::decide_walls(std::span<const double> coordinates) {
  walls_at_.assign(coordinates.begin(), coordinates.end());
  for (Zone& zone : zones_) zone.slave.walls = zone.master.walls = walls_at_;
}

const ContactGeometry::Zone& ContactGeometry::zone_of(const Cell& cell) const {
  return zones_[static_cast<std::size_t>(zone_of_[contact_.slaves[cell.slave].patch])];
}

std::int32_t ContactGeometry::face_of(const Cell& cell) const {
  const Zone& zone = zone_of(cell);
  return zone.masters[zone.faces[cell.place]];
}

bool ContactGeometry::other_walls(const std::set<PatchMaster>& in_front) const {
  for (const auto& [slave, master] : walls_) {
    const std::int32_t patch = contact_.slaves[slave].patch;
    if (!std::ranges::equal(of_patch(left_out_.in_front, patch), of_patch(in_front, patch))) return true;
  }
  const std::span<const double> decided = walls_at_.empty() ? rest_ : walls_at_;
  return std::ranges::any_of(cells_, [&](const Cell& cell) {
    const std::int32_t patch = contact_.slaves[cell.slave].patch;
    const auto there = of_patch(in_front, patch);
    return !there.empty() && !in_front.contains({patch, face_of(cell)}) &&
           facing_cosine(cell.slave, cell.master, decided) < wall_cosine;
  });
}

bool ContactGeometry::choose_masters() {
  if (contact_.frozen_gap) return false;
  const LeftOut before = left_out_;
  if (!before.far.empty()) {
    leave_out({{}, before.in_front});
    look();
  }
  bool others = walls_have_turned();
  if (others) {
    decide_walls(coordinates_);
    look();
  }
  LeftOut more = to_leave_out(before), all{{}, more.in_front};
  for (int level = 0; level < most_levels; ++level) {
    const bool walls = other_walls(all.in_front), far = !more.far.empty();
    others = others || walls;
    all.far.merge(more.far);
    leave_out(all);
    if (!far && !walls) break;
    look();
    more = to_leave_out(before);  // what was hidden by those
    all.in_front.merge(more.in_front);
  }
  if (coordinates_ == rest_) left_out_at_rest_ = left_out_;
  return others || left_out_.far != before.far;
}

void ContactGeometry::leave_out(LeftOut what) {
  if (what == left_out_) return;
  left_out_ = std::move(what);
  for (Zone& zone : zones_) {
    zone.left_out.clear();
    zone.in_front = {};
    for (std::size_t s = 0; s < zone.slaves.size(); ++s) {
      const std::int32_t patch = contact_.slaves[zone.slaves[s]].patch;
      for (const PatchMaster& one : of_patch(left_out_.far, patch))
        if (const auto master = zone.places.find(one.master); master != zone.places.end())
          zone.left_out.push_back({static_cast<std::int32_t>(s), master->second});
      std::vector<std::int32_t> in_front;
      for (const PatchMaster& one : of_patch(left_out_.in_front, patch))
        if (const auto master = zone.places.find(one.master); master != zone.places.end())
          in_front.push_back(zone.faces[master->second]);
      zone.in_front.push_back(in_front);
    }
    std::ranges::sort(zone.left_out);
    zone.pairing.left_out = zone.left_out;
    zone.pairing.in_front = &zone.in_front;
    zone.pairing.faces = zone.faces;
  }
}

void ContactGeometry::keep_left_out(bool same_rest) {
  if (same_rest)
    leave_out(left_out_at_rest_);
  else
    left_out_at_rest_ = left_out_;
}

}  // namespace lacon
