// Patches that lie inside their master, all of them or in part, though they are open or closed on average.
#include <algorithm>
#include <cmath>
#include <map>

#include "lacon/operators/contact/contact_state.hpp"

namespace lacon {

std::optional<PiercedPatch> ContactState::pierced(std::int32_t zone, const Patchwise& patches, bool at_rest) const {
  const double of_open = at_rest ? tolerances_.pierced_at_rest : tolerances_.pierced_open;
  return deepest(zone, [&](std::size_t p) { return patches.status[p] == Status::active ? tolerances_.pierced : of_open; });
}

std::optional<PiercedPatch> ContactState::missed(std::int32_t zone, const Patchwise& patches, double strain) const {
  const auto is_active = [&](std::int32_t p) { return patches.status[static_cast<std::size_t>(p)] == Status::active; };
  const double limit = std::max(tolerances_.missed_depth, tolerances_.missed_pressure * strain);
  return deepest(zone, [&](std::size_t p) {
    const bool alone = !is_active(static_cast<std::int32_t>(p)) && std::ranges::none_of(neighbours_[p], is_active);
    return alone ? limit : INFINITY;
  });
}

std::optional<PiercedPatch> ContactState::deepest(std::int32_t zone,
                                                  const std::function<double(std::size_t patch)>& limit) const {
  std::optional<PiercedPatch> worst;
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (geometry_.zone_of(p) != zone || locked_[p] || held_open_[p] || !is_covered(p)) continue;
    const double depth = -geometry_.smallest_gap(p) / size_[p];
    if (depth < limit(p)) continue;
    if (!worst || depth > worst->depth) worst = PiercedPatch{p, depth, geometry_.gap(p)};
  }
  return worst;
}

std::optional<SplitPatch> ContactState::split(std::int32_t zone, const Patchwise& patches, double strain) const {
  struct Parts {
    double nearest = INFINITY;
    double gap[2] = {0, 0}, measure[2] = {0, 0};  // integrals: of what is near, and of the rest
  };
  const auto is_asked = [&](std::size_t p) {
    return geometry_.zone_of(p) == zone && patches.status[p] != Status::active && !locked_[p] && !held_open_[p] &&
           takes_contact(p);
  };
  std::map<std::size_t, Parts> parts;
  const auto for_each_cell = [&](const auto& use) {
    for (const ContactGeometry::Cell& cell : geometry_.cells())
      if (const auto patch = static_cast<std::size_t>(contact_.slaves[cell.slave].patch); cell.measure > 0 && is_asked(patch))
        use(patch, cell);
  };
  for_each_cell([&](std::size_t patch, const ContactGeometry::Cell& cell) {
    parts[patch].nearest = std::min(parts[patch].nearest, cell.gap / cell.measure);
  });
  for_each_cell([&](std::size_t patch, const ContactGeometry::Cell& cell) {
    Parts& of_patch = parts[patch];
    const bool is_far = cell.gap / cell.measure > of_patch.nearest + tolerances_.far_behind * size_[patch];
    of_patch.gap[is_far] += cell.gap;
    of_patch.measure[is_far] += cell.measure;
  });
  std::optional<SplitPatch> worst;
  for (const auto& [patch, of_patch] : parts) {
    const double share = of_patch.measure[0] / geometry_.whole(patch);
    if (of_patch.measure[1] == 0 || share < taking_coverage) continue;
    const double depth = -of_patch.gap[0] / of_patch.measure[0];
    if (depth < std::max(tolerances_.touching, tolerances_.missed_pressure * strain) * size_[patch]) continue;
    if (!worst || depth > worst->depth) worst = SplitPatch{patch, share, depth, of_patch.gap[1] / of_patch.measure[1]};
  }
  return worst;
}

std::optional<CoarseContact> ContactState::coarse(std::int32_t zone, const Patchwise& patches) const {
  double whole = 0, carried = 0, largest = 0;
  CoarseContact found{};
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (geometry_.zone_of(p) != zone || patches.status[p] != Status::active || locked_[p]) continue;
    const double force = std::abs(patches.lambda[p]) * geometry_.covered(p);
    whole += force;
    const double depth = -geometry_.smallest_gap(p), pressed_in = strain(p, patches) * size_[p];
    // where bodies fit, points lie inside by what facets leave, and patches around are pressed too or open by no more than that
    const auto ends_contact = [&](std::int32_t neighbour) {
      const auto q = static_cast<std::size_t>(neighbour);
      return patches.status[q] != Status::active && (!is_covered(q) || geometry_.gap(q) > depth);
    };
    const bool is_end = neighbours_[p].empty() || std::ranges::any_of(neighbours_[p], ends_contact);
    if (!is_end || depth <= tolerances_.unpressed * pressed_in) continue;
    carried += force;
    if (force > largest) largest = force, found = {p, 0, depth / pressed_in};
  }
  if (carried <= whole / 2) return std::nullopt;
  found.share = carried / whole;
  return found;
}

std::optional<UncheckedOverlap> ContactState::unchecked_overlap(std::int32_t zone) const {
  if (contact_.zones[zone].resolution != "NON") return std::nullopt;
  std::optional<UncheckedOverlap> worst;
  for (std::size_t p = 0; p < n_patches(); ++p) {
    if (geometry_.zone_of(p) != zone || !is_covered(p)) continue;
    const double depth = -geometry_.smallest_gap(p);
    if (depth > std::max(contact_.zones[zone].overlap_tolerance, tolerances_.touching * size_[p]) &&
        (!worst || depth > worst->depth))
      worst = UncheckedOverlap{p, depth};
  }
  return worst;
}

}  // namespace lacon
