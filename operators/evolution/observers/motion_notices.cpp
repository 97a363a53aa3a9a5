#include "lacon/operators/evolution/observers/motion_notices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {
namespace {

constexpr double most_turned = 0.05;   // radians: taken for a strain of half of its square, 0.1 %, as that of a press fit
constexpr double most_strained = 0.2;  // the strain of a length by its true and by its initial length differ by a tenth of it
constexpr double share = 0.1;          // of the cells of a body: edges that press are strained by any amount

bool is_for_small_displacements(const ElementSet& set) { return set.option.ends_with("/PETIT"); }

/// Which a share of them reach: the motion that one of ten cells exceeds.
const CellMotion& nth(std::vector<CellMotion>& motions, double CellMotion::*value) {
  const auto place = motions.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(motions.size()));
  std::ranges::nth_element(motions, place, std::greater(), value);
  return *place;
}

}  // namespace

std::map<std::int32_t, std::vector<CellMotion>> MotionNotices::motions(bool (*is_one)(const ElementSet&)) const {
  const StaticProblem& problem = present_.problem;
  std::map<std::int32_t, std::vector<CellMotion>> of_body;
  for (const ElementSet& set : problem.solids) {
    if (!is_one(set)) continue;
    for (std::size_t i = 0; i < set.cells.size(); ++i) {
      const std::int32_t body = bodies_.of(problem.mesh.cells[set.cells[i]][0]);
      if (!told_.contains(body)) of_body[body].push_back(motion_of(set, i, problem.mesh, present_.state.displacement));
    }
  }
  return of_body;
}

void MotionNotices::tell(std::string_view id, double instant, const CellMotion& motion, const std::string& what) {
  const std::int32_t node = present_.problem.mesh.cells[motion.cell][0];
  told_.insert(bodies_.of(node));
  inform(id, {{"body", bodies_.name_at(node)},
              {"instant", fmt::format("{:.9g}", instant)},
              {"cell", cell_name(motion.cell)},
              {"what", what}});
}

void MotionNotices::accept(const SolvedInstant& solved) {
  const auto percent = [](double part) { return fmt::format("{:.2g}", 100 * part); };
  for (auto& [body, motions] : motions(is_for_small_displacements)) {
    const CellMotion turned = nth(motions, &CellMotion::turn), strained = nth(motions, &CellMotion::strain);
    if (turned.turn > most_turned)
      tell("EVOLUTION_59", solved.instant, turned,
           part("cells_have_turned", {{"angle", fmt::format("{:.2g}", turned.turn * 180 / std::numbers::pi)},
                                      {"percent", percent(turned.turn * turned.turn / 2)}}));
    else if (strained.strain > most_strained)
      tell("EVOLUTION_59", solved.instant, strained, part("cells_are_strained", {{"percent", percent(strained.strain)}}));
  }
  for (auto& [body, motions] : motions(softens_in_compression))
    if (const CellMotion shortened = nth(motions, &CellMotion::shortening); shortened.shortening > most_shortened)
      tell("EVOLUTION_61", solved.instant, shortened, percent(shortened.shortening));
}

void MotionNotices::save(const hdf5::Group& group) const {
  group.write("told", std::vector<std::int32_t>(told_.begin(), told_.end()));
}

void MotionNotices::resume(const hdf5::Group& group) {
  for (const std::int32_t body : group.read<std::int32_t>("told")) told_.insert(body);
}

}  // namespace lacon
