#include "lacon/operators/evolution/observers/contact_notices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/observers/zone_records.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

constexpr double gap_that_counts = 0.15;     // of what skins give way by: pressures of a fit are wrong by as much, or more
constexpr double share_that_counts = 1e-3;   // of the largest strain of a zone: pressures below are none to speak of
constexpr double share_of_round_off = 1e-3;  // of the largest pressure of a zone, at the instant that strains it most
constexpr double gap_of_closed = 1e-5;       // of h: below, the average gap of a patch in contact is its round-off
constexpr double inside_at_rest = 0.005;     // of h: points inside from the beginning, where nothing ever presses
constexpr double come_in = 5e-4;             // of h: points that have come inside, where nothing ever presses
constexpr double missed = 0.04;              // of h: a strain that the pressure would make that coarse patches do not feel

}  // namespace

std::string ContactNotices::first_cell(std::size_t patch) const {
  return cell_name(present_.problem.mesh.patches->cells[patch].front());
}

void ContactNotices::tell_what_is_too_deep(double instant) {
  const ContactGeometry& geometry = present_.contact->geometry();
  for (std::size_t zone = 0; zone < geometry.zones().size(); ++zone) {
    const ContactGeometry::TooDeep& deep = geometry.too_deep(zone);
    if (deep.count == 0 || !too_deep_.insert(zone).second) continue;
    const ContactZone& names = present_.problem.contact->zones[zone];
    const PairingOptions& limits = geometry.zones()[zone].pairing;
    const bool by_distance = limits.distance_limit > 0;
    inform(by_distance ? "EVOLUTION_52" : "EVOLUTION_17",
           {{"slave", names.slave_group},
            {"master", names.master_group},
            {"count", std::to_string(deep.count)},
            {"cell", cell_name(deep.slave)},
            {"instant", fmt::format("{:.9g}", instant)},
            {"limit", fmt::format("{:g}", by_distance ? limits.distance_limit : limits.depth_limit)}});
  }
}

void ContactNotices::tell_what_nothing_presses(double instant) {
  if (free_.empty()) return;
  const ContactState& contact = *present_.contact;
  const Mesh& mesh = present_.problem.mesh;
  std::map<std::int32_t, double> strain;  // of each body: the largest pressure on it over the modulus of the softer side
  const auto press = [&](std::int32_t cell, double value) {
    double& largest = strain[bodies_.of(mesh.cells[static_cast<std::size_t>(cell)][0])];
    largest = std::max(largest, value);
  };
  for (const ContactGeometry::Cell& cell : contact.geometry().cells()) {
    const SlaveElement& slave = present_.problem.contact->slaves[cell.slave];
    if (present_.state.patches.status[slave.patch] != Status::active) continue;
    const double value = contact.strain(static_cast<std::size_t>(slave.patch), present_.state.patches);
    press(slave.cell, value);
    press(cell.master, value);
  }
  constexpr double round_off = 1e-12;
  std::erase_if(free_, [&](std::int32_t body) {
    const bool rests = strain[body] <= round_off;
    if (rests) inform("EVOLUTION_23", {{"body", bodies_.name_at(body)}, {"instant", fmt::format("{:.9g}", instant)}});
    return rests;
  });
}

void ContactNotices::tell_what_overlaps(double instant) {
  for (std::size_t zone = 0; zone < present_.problem.contact->zones.size(); ++zone) {
    const auto overlap = present_.contact->unchecked_overlap(static_cast<std::int32_t>(zone));
    if (!overlap) continue;
    const ContactZone& names = present_.problem.contact->zones[zone];
    const auto said = [&](std::string_view id) {
      return message(id, {{"slave", names.slave_group},
                          {"master", names.master_group},
                          {"instant", fmt::format("{:.9g}", instant)},
                          {"cell", first_cell(overlap->patch)},
                          {"depth", fmt::format("{:.6g}", overlap->depth)}});
    };
    if (present_.problem.contact->stops_at_overlap) throw Error(said("EVOLUTION_36"));
    if (overlapping_.insert(zone).second) inform(said("EVOLUTION_35"));
  }
}

std::set<std::size_t> ContactNotices::zones_that_meet() const {
  std::set<std::size_t> meeting;
  const std::vector<ContactZone>& zones = present_.problem.contact->zones;
  for (std::size_t zone = 0; zone < zones.size(); ++zone)
    if (std::ranges::any_of(zones[zone].patches, [&](std::int32_t patch) {
          return present_.contact->geometry().coverage(static_cast<std::size_t>(patch)) > 0;
        }))
      meeting.insert(zone);
  return meeting;
}

void ContactNotices::tell_what_was_flung(double instant) {
  const StaticProblem& problem = present_.problem;
  const std::vector<double>& now = present_.state.displacement;
  const int n_components = problem.n_components();
  const std::vector<ContactZone>& zones = problem.contact->zones;
  std::set<std::size_t> meeting = zones_that_meet();
  const double size = extent(problem.mesh);
  double moved = 0;  // farthest in this step
  for (std::size_t dof = 0; dof < last_displacement_.size(); ++dof)
    if (static_cast<int>(dof) % n_components < problem.dimension)
      moved = std::max(moved, std::abs(now[dof] - last_displacement_[dof]));
  for (const std::size_t zone : last_met_)
    if (moved > size && !meeting.contains(zone) && flung_.insert(zone).second)
      inform("EVOLUTION_66", {{"slave", zones[zone].slave_group},
                              {"master", zones[zone].master_group},
                              {"instant", fmt::format("{:.9g}", instant)},
                              {"times", fmt::format("{:.2g}", moved / size)}});
  met_.insert(meeting.begin(), meeting.end());
  last_displacement_ = now;
  last_met_ = std::move(meeting);
}

void ContactNotices::start(double instant) {
  const ContactState* const contact = present_.contact;
  if (!contact) return;
  started_ = true;
  std::int64_t locked = 0;
  std::size_t first = 0;
  for (std::size_t p = 0; p < contact->n_patches(); ++p)
    if (contact->geometry().coverage(p) > 0 && contact->is_locked(p) && locked++ == 0) first = p;
  tell_what_is_too_deep(instant);
  tell_what_was_flung(instant);
  for (std::int32_t zone = 0; zone < static_cast<std::int32_t>(contact->geometry().zones().size()); ++zone)
    if (const auto pierced = contact->pierced(zone, present_.state.patches, true)) depth_before_[zone] = pierced->depth;
  const std::vector<double>& moved = present_.state.displacement;
  const bool initial = std::all_of(moved.begin(), moved.end(), [](double value) { return value == 0; });
  for (std::int32_t zone = 0; initial && zone < static_cast<std::int32_t>(contact->geometry().zones().size()); ++zone)
    if (const std::optional<FacetOverlap> overlap = facet_gaps_->overlap(zone)) {
      const ContactZone& names = present_.problem.contact->zones[zone];
      inform("EVOLUTION_22", {{"slave", names.slave_group},
                              {"master", names.master_group},
                              {"cell", first_cell(overlap->patch)},
                              {"percent", fmt::format("{:.2g}", 100 * overlap->depth)}});
    }
  if (locked) inform("EVOLUTION_6", {{"count", std::to_string(locked)}, {"cell", first_cell(first)}});
}

void ContactNotices::accept(const SolvedInstant& solved) {
  if (!present_.contact) return;
  if (const HeldOverlap overlap = present_.contact->held_overlap(); overlap.count > 0)
    inform("EVOLUTION_14", {{"count", std::to_string(overlap.count)},
                            {"instant", fmt::format("{:.9g}", solved.instant)},
                            {"cell", first_cell(overlap.deepest)},
                            {"gap", fmt::format("{:.6g}", overlap.gap)}});
  facet_gaps_->renew();
  tell_what_is_too_deep(solved.instant);
  tell_what_overlaps(solved.instant);
  tell_what_was_flung(solved.instant);
  tell_what_nothing_presses(solved.instant);
  const ContactState& contact = *present_.contact;
  const Patchwise& patches = present_.state.patches;
  for (std::int32_t zone = 0; zone < static_cast<std::int32_t>(contact.geometry().zones().size()); ++zone) {
    if (contact.presses(zone, patches)) pressed_.insert(zone);
    double& strain = strain_[zone];
    if (const double now = contact.largest_strain(zone, patches); now >= strain) {
      strain = now;
      const auto facets = facet_gaps_->of(zone, patches, present_.state.displacement);
      faceted_.erase(zone);
      if (facets && std::abs(facets->gap) > gap_that_counts * facets->give)
        faceted_.emplace(zone, Faceted{solved.instant, *facets});
      coarse_.erase(zone);
      undecided_.erase(zone);
      if (const auto share = contact.undecided(zone, patches); share && *share < 1) {  // else all pressures are round-off
        if (const auto coarse = contact.coarse(zone, patches)) coarse_.emplace(zone, Coarse{solved.instant, *coarse});
        if (*share > share_of_round_off) undecided_.emplace(zone, Undecided{solved.instant, *share});
      }
    }
    const auto note = [&](const std::optional<PiercedPatch>& now, PiercedZones& zones) {
      if (const auto before = zones.find(zone); now && (before == zones.end() || now->depth > before->second.worst.depth))
        zones[zone] = {solved.instant, *now};
    };
    note(contact.pierced(zone, patches, false), pierced_);
    note(contact.pierced(zone, patches, true), pierced_at_rest_);
    auto now = contact.alternation(zone, patches,
                                   [&] { return facet_gaps_->of(zone, patches, present_.state.displacement).has_value(); });
    if (!now) now = facet_gaps_->few_press(zone, patches);
    const bool presses_as_before = contact.largest_strain(zone, patches) >= share_that_counts * strain;
    if (now && presses_as_before)
      if (const auto before = alternating_.find(zone); before == alternating_.end() || now->share > before->second.most.share)
        alternating_[zone] = {solved.instant, *now};
    if (const auto split = contact.split(zone, patches, strain); split && strain > 0)
      if (const auto before = split_.find(zone); before == split_.end() || split->depth > before->second.worst.depth)
        split_[zone] = {solved.instant, *split};
    // before a zone presses for the first time its bodies come nearer, and points of coarse patches go in a little
    if (strain > 0) note(contact.missed(zone, patches, strain), missed_);
  }
}

void ContactNotices::end(bool /*completed*/) {
  if (!started_) return;  // what ends the computation came before its first state
  for (std::size_t zone = 0; present_.contact && zone < present_.problem.contact->zones.size(); ++zone)
    if (const ContactZone& names = present_.problem.contact->zones[zone]; !met_.contains(zone))
      inform("EVOLUTION_43", {{"slave", names.slave_group}, {"master", names.master_group}});
  PiercedZones told = pierced_;
  for (const auto& [zone, pierced] : pierced_at_rest_)
    if (!pressed_.contains(zone) && (pierced.worst.depth >= inside_at_rest || came_in_by(zone, pierced) >= come_in))
      told.emplace(zone, pierced);
  const auto tell = [&](std::string_view id, std::int32_t zone, const Pierced& pierced) {
    const ContactZone& names = present_.problem.contact->zones[zone];
    const std::string gap = fmt::format("{:.3g}", pierced.worst.gap);
    const bool is_open = pierced.worst.gap < -gap_of_closed * present_.contact->patch_size(pierced.worst.patch);
    inform(id, {{"slave", names.slave_group},
                {"master", names.master_group},
                {"cell", first_cell(pierced.worst.patch)},
                {"instant", fmt::format("{:.9g}", pierced.instant)},
                {"percent", fmt::format("{:.3g}", 100 * pierced.worst.depth)},
                {"gap", gap},
                {"average", part(is_open ? "cover_takes_no_contact" : "contact_holds_average",
                                 {{"gap", gap}, {"master", names.master_group}})}});
  };
  for (const auto& [zone, pierced] : told) tell("EVOLUTION_16", zone, pierced);
  for (const auto& [zone, pierced] : missed_)
    if (const auto other = told.find(zone); other == told.end() || other->second.worst.patch != pierced.worst.patch)
      tell("EVOLUTION_45", zone, pierced);
  for (const auto& [zone, coarse] : coarse_)
    if (const ContactZone& names = present_.problem.contact->zones[zone]; !told.contains(zone))
      inform("EVOLUTION_72", {{"slave", names.slave_group},
                              {"master", names.master_group},
                              {"cell", first_cell(coarse.contact.patch)},
                              {"instant", fmt::format("{:.9g}", coarse.instant)},
                              {"percent", fmt::format("{:.3g}", 100 * coarse.contact.share)},
                              {"times", fmt::format("{:.2g}", coarse.contact.times)}});
  for (const auto& [zone, alternating] : alternating_) {
    const ContactZone& names = present_.problem.contact->zones[zone];
    const AlternatingBy by = alternating.most.by;
    inform(by == AlternatingBy::triangles     ? "EVOLUTION_47"
           : by == AlternatingBy::few_patches ? "EVOLUTION_74"
           : by == AlternatingBy::scattered   ? "EVOLUTION_80"
           : by == AlternatingBy::facets      ? "EVOLUTION_67"
                                              : "EVOLUTION_70",
           {{"slave", names.slave_group},
            {"master", names.master_group},
            {"cell", first_cell(alternating.most.patch)},
            {"instant", fmt::format("{:.9g}", alternating.instant)},
            {"percent", fmt::format("{:.3g}", 100 * alternating.most.share)},
            {"pressing", fmt::format("{:.2g}", 100 * alternating.most.pressing)}});
  }
  for (const auto& [zone, split] : split_) {
    const ContactZone& names = present_.problem.contact->zones[zone];
    inform("EVOLUTION_68", {{"slave", names.slave_group},
                            {"master", names.master_group},
                            {"cell", first_cell(split.worst.patch)},
                            {"instant", fmt::format("{:.9g}", split.instant)},
                            {"percent", fmt::format("{:.2g}", 100 * split.worst.share)},
                            {"depth", fmt::format("{:.3g}", split.worst.depth)},
                            {"far", fmt::format("{:.3g}", split.worst.far)}});
  }
  for (const auto& [zone, undecided] : undecided_) {
    const ContactZone& names = present_.problem.contact->zones[zone];
    inform("EVOLUTION_65", {{"slave", names.slave_group},
                            {"master", names.master_group},
                            {"instant", fmt::format("{:.9g}", undecided.instant)},
                            {"percent", fmt::format("{:.2g}", 100 * undecided.share)}});
  }
  for (const auto& [zone, faceted] : faceted_) {
    const ContactZone& names = present_.problem.contact->zones[zone];
    const bool apart = faceted.facets.gap > 0;
    inform("EVOLUTION_60", {{"slave", names.slave_group},
                            {"master", names.master_group},
                            {"what", part(apart ? "facets_keep_apart" : "facets_overlap")},
                            {"gap", fmt::format("{:.3g}", std::abs(faceted.facets.gap))},
                            {"instant", fmt::format("{:.9g}", faceted.instant)},
                            {"give", fmt::format("{:.3g}", faceted.facets.give)},
                            {"wrong", part(apart ? "pressure_too_low" : "pressure_too_high")}});
  }
}

double ContactNotices::came_in_by(std::int32_t zone, const Pierced& pierced) const {
  const auto before = depth_before_.find(zone);
  return pierced.worst.depth - (before == depth_before_.end() ? 0 : before->second);
}

void ContactNotices::fail_if_all_missed() const {
  if (!pressed_.empty()) return;
  const auto depth = [&](const auto& of_zone) { return came_in_by(of_zone.first, of_zone.second); };
  const auto most = std::ranges::max_element(pierced_at_rest_, {}, depth);
  if (most == pierced_at_rest_.end() || depth(*most) < missed) return;
  const auto& [zone, pierced] = *most;
  const ContactZone& names = present_.problem.contact->zones[zone];
  const double size = present_.contact->patch_size(pierced.worst.patch), deepest = pierced.worst.depth * size;
  fail("EVOLUTION_64", {{"slave", names.slave_group},
                        {"master", names.master_group},
                        {"cell", first_cell(pierced.worst.patch)},
                        {"instant", fmt::format("{:.9g}", pierced.instant)},
                        {"depth", fmt::format("{:.3g}", deepest)},
                        {"gap", fmt::format("{:.3g}", pierced.worst.gap)},
                        // where one body comes to a point the average gap less that at the point grows like the size
                        {"size", fmt::format("{:.2g}", size * deepest / (deepest + std::max(pierced.worst.gap, 0.0)))}});
}

template <class Notices, class Use>
void ContactNotices::for_each_record(Notices& notices, const Use& use) {
  use("pierced", notices.pierced_);
  use("depth_before", notices.depth_before_);
  use("pierced_at_rest", notices.pierced_at_rest_);
  use("pressed", notices.pressed_);
  use("strain", notices.strain_);
  use("missed", notices.missed_);
  use("alternating", notices.alternating_);
  use("split", notices.split_);
  use("faceted", notices.faceted_);
  use("undecided", notices.undecided_);
  use("coarse", notices.coarse_);
  use("flung", notices.flung_);
  use("met", notices.met_);
  use("too_deep", notices.too_deep_);
  use("overlapping", notices.overlapping_);
  use("free", notices.free_);
}

void ContactNotices::save(const hdf5::Group& group) const {
  for_each_record(*this, [&](std::string_view name, const auto& record) { save_zones(group, name, record); });
}

void ContactNotices::resume(const hdf5::Group& group) {
  for_each_record(*this, [&](std::string_view name, auto& record) { resume_zones(group, name, record); });
  if (present_.contact) {  // the solver has resumed
    last_displacement_ = present_.state.displacement;
    last_met_ = zones_that_meet();
  }
  started_ = true;
}

}  // namespace lacon
