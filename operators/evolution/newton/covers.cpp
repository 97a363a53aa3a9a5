// Patches on which masters end, and which keep their cover in Newton's method.
#include <fmt/format.h>

#include "lacon/operators/evolution/newton/instant_failure.hpp"
#include "lacon/operators/evolution/newton/newton.hpp"
#include "lacon/operators/program/program.hpp"

namespace lacon {

void Newton::keep_lost_masters(double instant, const std::vector<Status>& before, const std::vector<Status>& wanted,
                               const StaticState& state) {
  if (!contact() || problem_.contact->frozen_gap) return;
  const auto lost = lost_masters_.note(before, wanted, state.patches.lambda, statuses_.keeps(),
                                       [&](std::size_t patch) { return contact()->is_covered(patch); });
  for (const std::size_t patch : lost) {
    if (contact()->keeps_cover(patch))
      throw InstantFailure(about_cover("EVOLUTION_51", instant, patch), {.depends_on_step = true});
    keep_cover(instant, patch);
    lost_masters_.forget(patch);
    statuses_.start_instant();  // sets that come back from here on answer to other forces
  }
}

bool Newton::keep_covers_that_sway(double instant, const StaticState& state, bool last) {
  if (!contact() || problem_.contact->frozen_gap) return false;
  if (equilibrium_.go_on_where_flush()) {
    choice_.start_again();
    return true;
  }
  if (course_.period() && ++times_round_ < 2 && !last) return false;
  bool any = false;
  for (std::size_t p = 0; p < contact()->n_patches(); ++p) {
    const bool moves = !contact()->keeps_cover(p) && contact()->is_covered_in_part(p);
    if (state.patches.status[p] != Status::active || !moves) continue;
    keep_cover(instant, p);
    any = true;
  }
  return any;
}

void Newton::keep_cover(double instant, std::size_t patch) {
  equilibrium_.keep_cover(patch);
  other_covers_ = true;
  choice_.start_again();
  covers_since_.try_emplace(contact()->geometry().zone_of(patch), instant);
}

void Newton::tell_of_covers() {
  for (std::size_t p = 0; contact() && p < contact()->n_patches(); ++p) {
    const std::int32_t zone = contact()->geometry().zone_of(p);
    if (!contact()->keeps_cover(p) || !covers_told_.insert(zone).second) continue;
    const auto since = covers_since_.find(zone);
    inform(about_cover("EVOLUTION_50", since == covers_since_.end() ? options_.start : since->second, p));
  }
  covers_since_.clear();
}

Message Newton::about_cover(std::string_view id, double instant, std::size_t patch) const {
  const ContactZone& zone = problem_.contact->zones[contact()->geometry().zone_of(patch)];
  return message(id, {{"instant", fmt::format("{:.9g}", instant)},
                      {"cell", cell_name(problem_.mesh.patches->cells[patch].front())},
                      {"slave", zone.slave_group},
                      {"master", zone.master_group}});
}

}  // namespace lacon
