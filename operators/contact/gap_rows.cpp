// The gaps of patches as linear functions of displacements: what open patches would do, and what presses them.
#include "lacon/operators/contact/contact_state.hpp"

namespace lacon {

std::vector<GapRow> ContactState::gap_rows(std::span<const std::size_t> patches) const {
  std::vector<std::int8_t> order(n_patches(), 0);
  std::vector<std::size_t> place(n_patches(), 0);
  std::vector<GapRow> rows(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    order[patches[i]] = 1;
    place[patches[i]] = i;
  }
  for (const ContactGeometry::Variation& variation : geometry_.vary(order, keeps_cover_)) {
    GapRow& row = rows[place[static_cast<std::size_t>(contact_.slaves[variation.slave].patch)]];
    row.gap += variation.of_gap.gap;
    std::size_t at = 0;
    for (const std::int32_t node : variation.nodes)
      for (int d = 0; d < mesh_.dimension; ++d, ++at)
        if (variation.of_gap.gradient[at] != 0) {
          row.unknowns.push_back({node, d});
          row.derivative.push_back(variation.of_gap.gradient[at]);
        }
  }
  return rows;
}

bool ContactState::may_close(std::size_t patch, const Patchwise& patches, double reach) const {
  return patches.status[patch] == Status::open && !held_open_[patch] && !locked_[patch] && takes_contact(patch) &&
         geometry_.gap(patch) <= reach * size_[patch];
}

bool ContactState::may_open(std::size_t patch, const Patchwise& patches) const {
  return patches.status[patch] == Status::active && !gliding_[patch] && !locked_[patch];
}

}  // namespace lacon
