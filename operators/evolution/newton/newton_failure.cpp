// What Newton's method says of an instant that it does not solve.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/newton/instant_failure.hpp"
#include "lacon/operators/evolution/newton/newton.hpp"
#include "lacon/operators/evolution/problem/cell_motion.hpp"
#include "lacon/operators/program/program.hpp"

namespace lacon {
namespace {

constexpr double worse = 1.2;  // a residual that changes by this factor an iteration diverges
constexpr double near_round_off = 1e-9;
constexpr int enough_to_leave = 60;  // iterations: from an equilibrium that is unstable to the next one
constexpr int settled = 4;           // iterations without a change of status after which a ratio is that of the residual alone
constexpr int settled_quickly = 3;   // likewise, for an order
constexpr double inside = 1, through = 10;  // sizes of a patch: what coarse patches overlap by stays below the one

bool presses_nowhere(const StaticState& state) {
  return std::ranges::all_of(state.patches.lambda, [](double pressure) { return pressure == 0; });
}

}  // namespace

std::string Newton::said(std::initializer_list<std::string> what) {
  std::string text;
  for (const std::string& words : what) text += (text.empty() || words.empty() ? "" : "; ") + words;
  return text;
}

void Newton::fail_if_endless(double instant) const {
  if (!statuses_.endless()) return;
  const auto& [patches, period] = *statuses_.endless();
  throw InstantFailure(message("EVOLUTION_15", {{"instant", fmt::format("{:.9g}", instant)},
                                                {"count", std::to_string(patches.size())},
                                                {"cells", cells_of(patches)},
                                                {"period", std::to_string(period)}}),
                       {.depends_on_step = false});
}

std::vector<double> Newton::depths(const StaticState& state) const {
  std::vector<double> found;
  for (std::size_t zone = 0; contact() && zone < problem_.contact->zones.size(); ++zone) {
    const auto pierced = contact()->pierced(static_cast<std::int32_t>(zone), state.patches, true);
    found.push_back(pierced && state.patches.status[pierced->patch] != Status::active ? pierced->depth : 0);
  }
  return found;
}

void Newton::fail_if_passed_through(double instant, const StaticState& state) const {
  const std::vector<double> now = depths(state);
  const auto presses = [&](std::int32_t patch) {
    return state.patches.status[static_cast<std::size_t>(patch)] == Status::active;
  };
  for (std::size_t zone = 0; zone < now.size(); ++zone) {
    const ContactZone& names = problem_.contact->zones[zone];
    std::optional<GoneThrough> gone;
    if (now[zone] > through && depths_before_[zone] < inside) {
      const auto deepest = contact()->pierced(static_cast<std::int32_t>(zone), state.patches, true);
      gone = {problem_.mesh.patches->cells[deepest->patch].front(), now[zone]};
    } else if (std::ranges::none_of(names.patches, presses)) {
      gone = contact()->geometry().gone_through(zone);
    }
    if (gone)
      fail("EVOLUTION_63", {{"instant", fmt::format("{:.9g}", instant)},
                            {"slave", names.slave_group},
                            {"master", names.master_group},
                            {"cell", cell_name(gone->cell)},
                            {"sizes", fmt::format("{:.2g}", gone->sizes)}});
  }
}

std::string Newton::cells_of(const std::vector<std::size_t>& patches) const {
  constexpr std::size_t most = 4;
  std::map<std::int32_t, std::string> of_zone;
  for (std::size_t i = 0; i < std::min(most, patches.size()); ++i) {
    std::string& cells = of_zone[contact()->geometry().zone_of(patches[i])];
    cells += (cells.empty() ? "" : ", ") + cell_name(problem_.mesh.patches->cells[patches[i]].front());
  }
  std::string text;
  for (const auto& [zone, cells] : of_zone)
    text += (text.empty() ? "" : ", ") +
            part("cells_of_group", {{"cells", cells}, {"group", problem_.contact->zones[zone].slave_group}});
  return text + (patches.size() > most ? ", ..." : "");
}

std::string Newton::too_little_covered(const std::vector<LooseMotion>& loose, const StaticState& state) const {
  const auto is_loose = [&](std::int32_t node) {
    return std::ranges::any_of(loose, [&](const LooseMotion& motion) { return motion.bodies.contains(bodies_.of(node)); });
  };
  std::vector<std::size_t> patches;
  for (std::size_t patch = 0; contact() && patch < contact()->n_patches(); ++patch)
    if (contact()->lacks_cover(patch, state.patches) && contact()->node_at(patch, is_loose) >= 0) patches.push_back(patch);
  if (patches.empty()) return "";
  double most = 0;
  for (const std::size_t patch : patches) most = std::max(most, contact()->geometry().coverage(patch));
  return part("too_little_covered", {{"cells", cells_of(patches)}, {"percent", fmt::format("{:.2g}", 100 * most)}});
}

void Newton::fail_to_converge(double instant, const IterationReport& line, const StaticState& previous,
                              std::size_t changing) const {
  const double excess = forces_over_asked(options_.criteria, line);
  std::string round_words, turned_words, hanging_words, unstable_words, softened_words;
  if (const auto& round = statuses_.round())
    round_words = part("statuses_went_round", {{"count", std::to_string(round->patches.size())},
                                               {"cells", cells_of(round->patches)},
                                               {"period", std::to_string(round->period)}});
  if (const auto cell = equilibrium_.cell_inside_out())
    turned_words =
        part("cell_inside_out", {{"cell", cell_name(*cell)}, {"body", bodies_.name_at(problem_.mesh.cells[*cell][0])}});
  if (choice_.leaves_unstable()) unstable_words = part("equilibrium_unstable");
  const bool may_soften = choice_.leaves_unstable() || diverges();
  const std::optional<CellMotion> softened = may_soften ? most_softened(problem_, previous.displacement) : std::nullopt;
  if (softened)
    softened_words = part("cell_softened", {{"cell", cell_name(softened->cell)},
                                            {"body", bodies_.name_at(problem_.mesh.cells[softened->cell][0])},
                                            {"percent", fmt::format("{:.2g}", 100 * softened->shortening)}});
  if (!hanging_.empty()) hanging_words = part("body_hangs", {{"body", hanging_}});
  const bool hangs = hangs_on_nothing();  // where nothing pressed before, a part of the load pulls it off as well
  throw InstantFailure(
      message("EVOLUTION_4", {{"instant", fmt::format("{:.9g}", instant)},
                              {"iterations", std::to_string(line.iteration)},
                              {"unmet", said({unmet_criteria(line, changing), hangs ? "" : course_.words(), unstable_words,
                                              softened_words, round_words, turned_words, hanging_words})},
                              {"remedy", remedy(line, softened.has_value())}}),
      {.depends_on_step = !is_at_round_off(line) && !(hangs && presses_nowhere(previous)),
       .ratio = settled_ >= settled && !course_.period() && !course_.smaller_before() ? course_.ratio() : std::nullopt,
       .excess = excess});
}

bool Newton::diverges() const {
  return !course_.finite() || course_.ratio().value_or(1) > worse || equilibrium_.cell_inside_out();
}

bool Newton::is_at_round_off(const IterationReport& line) const {
  return settled_ >= settled && line.rela < near_round_off && !course_.falls() &&
         forces_over_asked(options_.criteria, line) > 1;
}

bool Newton::hangs_on_nothing() const { return !hanging_.empty() && settled_ >= settled && course_.stands() && !comes_near_; }

std::optional<int> Newton::iterations_left(const IterationReport& line) const {
  const double forces = forces_over_asked(options_.criteria, line);
  if (settled_ < (course_.order().value_or(0) >= quadratic ? settled_quickly : settled) || is_at_round_off(line) || diverges())
    return std::nullopt;
  const double motion = contact() ? line.geometry / options_.criteria.resi_geom : 0;
  return course_.iterations_to(1 / std::max(forces, motion));
}

std::string Newton::remedy(const IterationReport& line, bool softened) const {
  if (!hanging_.empty()) return part("remedy_hold_body", {{"body", hanging_}});
  if (line.round_off && !line.rela_met) return part("remedy_less_stiff");
  // more iterations, where a few times as many come to the end
  if (const auto left = iterations_left(line); left && *left <= 2 * options_.iterations)
    return part("remedy_more_iterations", {{"count", std::to_string(options_.iterations + *left + 1)}});
  if (is_at_round_off(line)) return part("remedy_ask_less");
  if (softened) return part("remedy_law_for_compression");
  // without what makes the matrix unstable the residual grows slowly first, and falls behind that
  if (choice_.leaves_unstable() && options_.iterations < enough_to_leave && course_.finite() && !course_.period() &&
      line.status_changes == 0 && !statuses_.round() && !equilibrium_.cell_inside_out())
    return part("remedy_leave_equilibrium", {{"count", std::to_string(enough_to_leave)}});
  if (!options_.cuts) return part("remedy_cut_step");
  if (diverges()) return part("remedy_coarser_load");
  if (line.status_changes > 0 || statuses_.round()) return part("remedy_refine_slave");
  return part("remedy_look_at_table");
}

std::string Newton::unmet_criteria(const IterationReport& line, std::size_t changing) const {
  std::string text;
  const auto add = [&](bool met, const std::string& what) {
    if (!met) text += (text.empty() ? "" : ", ") + what;
  };
  const auto at_its_place = [&](const std::string& residual) {
    if (line.worst_dof < 0) return residual;
    const std::string place = equilibrium_.place(line.worst_dof);
    if (course_.stays() <= 2) return part("residual_at", {{"residual", residual}, {"place", place}});
    return part("residual_stays_at", {{"residual", residual}, {"place", place}, {"count", std::to_string(course_.stays())}});
  };
  add(line.rela_met, at_its_place(fmt::format("RESI_GLOB_RELA {:.1e}", line.rela)));
  add(line.maxi_met, at_its_place(fmt::format("RESI_GLOB_MAXI {:.1e}", line.maxi)));
  add(line.refe_met, at_its_place(fmt::format("RESI_REFE_RELA {:.1e}", line.refe)));
  add(line.geometry_met, fmt::format("RESI_GEOM {:.1e}", line.geometry));
  add(line.constraint_met, part("largest_gap", {{"value", fmt::format("{:.1e}", line.constraint)}}));
  if (line.status_changes)
    add(false, part("patches_change_status", {{"count", std::to_string(line.status_changes)},
                                              {"cell", cell_name(problem_.mesh.patches->cells[changing].front())}}));
  return text;
}

}  // namespace lacon
