#include "lacon/operators/evolution/observers/table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lacon/catalog/wording.hpp"
#include "lacon/operators/contact/pairing_view.hpp"

namespace lacon {

struct NewtonColumn {
  const char* title[3];
  std::string (*value)(const IterationReport&, const StaticProblem&);
  enum { always, with_contact, with_place, with_reference } shown = always;
};

namespace {

constexpr int width = 16;

/// A number, and behind it an X as long as its criterion is not met.
std::string judged(double value, bool met) { return fmt::format("{:.5E} {}", value, met ? ' ' : 'X'); }

const NewtonColumn columns[] = {
    {{"NEWTON", "ITERATION", ""},
     [](const IterationReport& r, const StaticProblem&) {
       return fmt::format("{}{}", r.iteration, r.converged() ? ' ' : 'X');
     }},
    {{"RESIDU", "RELATIF", "RESI_GLOB_RELA"},
     [](const IterationReport& r, const StaticProblem&) { return judged(r.rela, r.rela_met); }},
    {{"RESIDU", "ABSOLU", "RESI_GLOB_MAXI"},
     [](const IterationReport& r, const StaticProblem&) { return judged(r.maxi, r.maxi_met); }},
    {{"RESIDU", "REFERENCE", "RESI_REFE_RELA"},
     [](const IterationReport& r, const StaticProblem&) { return judged(r.refe, r.refe_met); },
     NewtonColumn::with_reference},
    {{"RESIDU", "MAXIMUM", "AU POINT"},
     [](const IterationReport& r, const StaticProblem& p) { return r.worst_dof < 0 ? std::string() : p.dof_name(r.worst_dof); },
     NewtonColumn::with_place},
    {{"OPTION", "ASSEMBLAGE", ""},
     [](const IterationReport& r, const StaticProblem&) { return std::string(r.solution.factorised ? "TANGENTE" : "-"); }},
    {{"CONTACT", "NEWTON GENE", "VARI. CONT."},
     [](const IterationReport& r, const StaticProblem&) {
       return fmt::format("{} {}", r.status_changes, r.status_changes ? 'X' : ' ');
     },
     NewtonColumn::with_contact},
    {{"CONTACT", "NEWTON GENE", "CRIT. GEOM."},
     [](const IterationReport& r, const StaticProblem&) { return judged(r.geometry, r.geometry_met); },
     NewtonColumn::with_contact},
    {{"CONTACT", "MAX. GAP / SIZE", "ACTIVE PATCHES"},
     [](const IterationReport& r, const StaticProblem&) { return judged(r.constraint, r.constraint_met); },
     NewtonColumn::with_contact},
    {{"SOLVER", "NEGATIVE", "PIVOTS"},
     [](const IterationReport& r, const StaticProblem&) {
       const std::optional<std::int64_t>& found = r.solution.factorisation.negative_pivots;
       if (!found) return std::string("-");
       return *found == r.constraints ? fmt::format("{}", *found) : fmt::format("{} of {}", *found, r.constraints);
     }},
    {{"TIME", "SECONDS", ""}, [](const IterationReport& r, const StaticProblem&) { return fmt::format("{:.4f}", r.seconds); }},
};

}  // namespace

std::vector<const NewtonColumn*> NewtonTable::shown() const {
  std::vector<const NewtonColumn*> list;
  for (const NewtonColumn& column : columns)
    if (column.shown == NewtonColumn::always || (column.shown == NewtonColumn::with_contact && present_.problem.contact) ||
        (column.shown == NewtonColumn::with_place && where_) || (column.shown == NewtonColumn::with_reference && reference_))
      list.push_back(&column);
  return list;
}

std::string NewtonTable::components(Vec3 vector) const {
  std::string text;
  for (int d = 0; d < present_.problem.dimension; ++d) text += fmt::format("{}{:.6g}", d ? ", " : "(", component(vector, d));
  return text + ")";
}

void NewtonTable::rule() { out_ << ' ' << std::string(shown().size() * (width + 1) + 1, '-') << '\n'; }

void NewtonTable::begin(double instant) {
  out_ << fmt::format("\n Instant de calcul: {:.12e}\n", instant);
  rule();
  for (int i = 0; i < 3; ++i) {
    out_ << " |";
    for (const NewtonColumn* column : shown()) out_ << fmt::format("{:^{}}|", column->title[i], width);
    out_ << '\n';
  }
  rule();
  out_.flush();
}

void NewtonTable::iterate(double /*instant*/, const IterationReport& report) {
  out_ << " |";
  for (const NewtonColumn* column : shown())
    out_ << fmt::format("{:>{}}|", column->value(report, present_.problem) + " ", width);
  out_ << std::endl;  // as it goes: a long computation shows where it is
}

void NewtonTable::accept(const SolvedInstant& solved) {
  rule();
  out_ << ' '
       << part("converged_at",
               {{"instant", fmt::format("{:.9g}", solved.instant)}, {"count", std::to_string(solved.iterations)}})
       << '\n';
  if (present_.contact) prove(*present_.contact);
  out_.flush();
}

void NewtonTable::prove(const ContactState& contact) {
  const Patchwise& patches = present_.state.patches;
  constexpr double half = 0.5, much = 1.1, none = std::numeric_limits<double>::infinity();
  double least = none, most = -none, least_of_covered = none;
  for (std::size_t p = 0; p < contact.n_patches(); ++p) {
    if (patches.status[p] != Status::active) continue;
    least = std::min(least, patches.lambda[p]);
    most = std::max(most, patches.lambda[p]);
    if (contact.geometry().coverage(p) >= half) least_of_covered = std::min(least_of_covered, patches.lambda[p]);
  }
  if (least <= most)
    out_ << ' ' << part("pressures_from_to", {{"least", fmt::format("{:.9g}", least)}, {"most", fmt::format("{:.9g}", most)}});
  const bool is_covered = least_of_covered < none;
  if (least <= most && !(is_covered && least >= much * least_of_covered))
    out_ << (is_covered ? part("largest_of_covered", {{"least", fmt::format("{:.9g}", least_of_covered)}})
                        : part("largest_on_little"));
  if (least <= most) out_ << '\n';
  for (const ZoneBalance& zone : contact.balance(patches)) {
    out_ << ' '
         << part("zone_statuses", {{"slave", zone.slave_group},
                                   {"master", zone.master_group},
                                   {"active", std::to_string(zone.active)},
                                   {"open", std::to_string(zone.open)},
                                   {"unpaired", std::to_string(zone.unpaired)},
                                   {"covered", fmt::format("{:.6g}", zone.covered)},
                                   {"whole", fmt::format("{:.6g}", zone.whole)}})
         << "\n   "
         << part(present_.problem.is_of_revolution() ? "zone_forces_of_one_radian" : "zone_forces",
                 {{"slave", components(zone.on_slave)},
                  {"master", components(zone.on_master)},
                  {"sum", fmt::format("{:.1e}", norm(zone.on_slave + zone.on_master))},
                  {"moment", fmt::format("{:.1e}", norm(zone.moment))},
                  {"work", fmt::format("{:.1e}", zone.work)}})
         << '\n';
  }
  if (rejections_) {
    std::vector<std::string> reasons;
    for (int r = 0; r < n_rejections; ++r)
      reasons.push_back(fmt::format("{} {}", contact.geometry().rejected()[r], rejection_words(static_cast<Rejection>(r))));
    out_ << ' ' << part("pairing_rejected", {{"reasons", fmt::format("{}", fmt::join(reasons, ", "))}}) << '\n';
  }
}

}  // namespace lacon
