#include "lacon/operators/evolution/motion_notices.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
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

constexpr double most_turned = 0.1;    // radians: taken for a strain of half of its square, 0.5 %
constexpr double most_strained = 0.2;  // the strain of a length by its true and by its initial length differ by a tenth of it
// Of a bar under the law of St. Venant and Kirchhoff: its force E (l^3 - l) / 2 at the stretch l is largest in compression
// here.
constexpr double least_stretch = 1 / std::numbers::sqrt3;
constexpr double share = 0.1;  // of the cells of a body: edges that press are strained by any amount

CellMotion motion_of(const ElementSet& set, std::size_t i, const Mesh& mesh, std::span<const double> displacement) {
  const int d = set.dimension(), n = set.n_nodes();
  const auto nodes = mesh.cells[set.cells[i]];
  const double* const slope = set.tabulation.gradient.data();  // of the first point
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity(), moved = Eigen::Matrix3d::Zero();
  map.topLeftCorner(d, d).setZero();
  for (int a = 0; a < n; ++a) {
    const auto node = static_cast<std::size_t>(nodes[a]);
    for (int r = 0; r < d; ++r)
      for (int k = 0; k < d; ++k) {
        map(k, r) += mesh.point(node)[static_cast<std::size_t>(k)] * slope[a * d + r];
        moved(k, r) += displacement[node * static_cast<std::size_t>(set.n_components) +
                                    static_cast<std::size_t>(set.columns[static_cast<std::size_t>(k)])] *
                       slope[a * d + r];
      }
  }
  const Eigen::Matrix3d gradient = moved * map.inverse(), strain = 0.5 * (gradient + gradient.transpose()),
                        turn = 0.5 * (gradient - gradient.transpose());
  return {set.cells[i], turn.norm() / std::numbers::sqrt2,
          strain.selfadjointView<Eigen::Lower>().eigenvalues().cwiseAbs().maxCoeff(),
          1 - (Eigen::Matrix3d::Identity() + gradient).jacobiSvd().singularValues().minCoeff()};
}

/// Which a share of them reach: the motion that one of ten cells exceeds.
const CellMotion& nth(std::vector<CellMotion>& motions, double CellMotion::*value) {
  const auto place = motions.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(motions.size()));
  std::ranges::nth_element(motions, place, std::greater(), value);
  return *place;
}

}  // namespace

std::map<std::int32_t, std::vector<CellMotion>> MotionNotices::motions(
    std::initializer_list<std::string_view> behaviours) const {
  const StaticProblem& problem = present_.problem;
  std::map<std::int32_t, std::vector<CellMotion>> of_body;
  for (const ElementSet& set : problem.solids) {
    if (std::ranges::none_of(behaviours, [&](std::string_view name) { return set.option.ends_with(name); })) continue;
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
  for (auto& [body, motions] : motions({"/PETIT"})) {
    const CellMotion turned = nth(motions, &CellMotion::turn), strained = nth(motions, &CellMotion::strain);
    if (turned.turn > most_turned)
      tell("EVOLUTION_59", solved.instant, turned,
           part("cells_have_turned", {{"angle", fmt::format("{:.2g}", turned.turn * 180 / std::numbers::pi)},
                                      {"percent", percent(turned.turn * turned.turn / 2)}}));
    else if (strained.strain > most_strained)
      tell("EVOLUTION_59", solved.instant, strained, part("cells_are_strained", {{"percent", percent(strained.strain)}}));
  }
  for (auto& [body, motions] : motions({"ELAS/GREEN_LAGRANGE", "ELAS/GROT_GDEP"}))
    if (const CellMotion shortened = nth(motions, &CellMotion::shortening); shortened.shortening > 1 - least_stretch)
      tell("EVOLUTION_61", solved.instant, shortened, percent(shortened.shortening));
}

void MotionNotices::save(const hdf5::Group& group) const {
  group.write("told", std::vector<std::int32_t>(told_.begin(), told_.end()));
}

void MotionNotices::resume(const hdf5::Group& group) {
  for (const std::int32_t body : group.read<std::int32_t>("told")) told_.insert(body);
}

}  // namespace lacon
