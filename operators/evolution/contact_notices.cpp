#include "lacon/operators/evolution/contact_notices.hpp"

#include <fmt/format.h>

#include "lacon/catalog/messages.hpp"

namespace lacon {

std::string ContactNotices::first_cell(std::size_t patch) const {
  return cell_name(present_.problem.mesh.patches->cells[patch].front());
}

void ContactNotices::start(double /*instant*/) {
  const ContactState* const contact = present_.contact;
  if (!contact) return;
  std::int64_t locked = 0;
  std::size_t first = 0;
  for (std::size_t p = 0; p < contact->n_patches(); ++p)
    if (contact->geometry().coverage(p) > 0 && contact->is_locked(p) && locked++ == 0) first = p;
  if (locked) inform("EVOLUTION_6", {{"count", std::to_string(locked)}, {"cell", first_cell(first)}});
}

void ContactNotices::accept(const SolvedInstant& solved) {
  if (!present_.contact) return;
  if (const HeldOverlap overlap = present_.contact->held_overlap(); overlap.count > 0)
    inform("EVOLUTION_14", {{"count", std::to_string(overlap.count)},
                            {"instant", fmt::format("{:.9g}", solved.instant)},
                            {"cell", first_cell(overlap.deepest)},
                            {"gap", fmt::format("{:.6g}", overlap.gap)}});
}

}  // namespace lacon
