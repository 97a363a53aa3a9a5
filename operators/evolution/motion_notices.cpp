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
constexpr double share = 0.1;          // of the cells of a body: edges that press are strained by any amount

/// What small displacements make of the motion of a cell: its turn and its largest strain, at one of its points.
struct CellMotion {
  std::int32_t cell;
  double turn, strain;
};

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
          strain.selfadjointView<Eigen::Lower>().eigenvalues().cwiseAbs().maxCoeff()};
}

/// Which a share of them reach: the motion that one of ten cells exceeds.
const CellMotion& nth(std::vector<CellMotion>& motions, double CellMotion::*value) {
  const auto place = motions.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(motions.size()));
  std::ranges::nth_element(motions, place, std::greater(), value);
  return *place;
}

}  // namespace

void MotionNotices::accept(const SolvedInstant& solved) {
  const StaticProblem& problem = present_.problem;
  std::map<std::int32_t, std::vector<CellMotion>> of_body;
  for (const ElementSet& set : problem.solids) {
    if (!set.option.ends_with("/PETIT")) continue;
    for (std::size_t i = 0; i < set.cells.size(); ++i) {
      const std::int32_t body = bodies_.of(problem.mesh.cells[set.cells[i]][0]);
      if (!told_.contains(body)) of_body[body].push_back(motion_of(set, i, problem.mesh, present_.state.displacement));
    }
  }
  for (auto& [body, motions] : of_body) {
    const CellMotion turned = nth(motions, &CellMotion::turn), strained = nth(motions, &CellMotion::strain);
    const bool turns = turned.turn > most_turned;
    if (!turns && strained.strain <= most_strained) continue;
    told_.insert(body);
    const std::string what =
        turns ? part("cells_have_turned", {{"angle", fmt::format("{:.2g}", turned.turn * 180 / std::numbers::pi)},
                                           {"percent", fmt::format("{:.2g}", 50 * turned.turn * turned.turn)}})
              : part("cells_are_strained", {{"percent", fmt::format("{:.2g}", 100 * strained.strain)}});
    inform("EVOLUTION_59", {{"body", bodies_.name_at(problem.mesh.cells[turned.cell][0])},
                            {"instant", fmt::format("{:.9g}", solved.instant)},
                            {"cell", cell_name((turns ? turned : strained).cell)},
                            {"what", what}});
  }
}

void MotionNotices::save(const hdf5::Group& group) const {
  group.write("told", std::vector<std::int32_t>(told_.begin(), told_.end()));
}

void MotionNotices::resume(const hdf5::Group& group) {
  for (const std::int32_t body : group.read<std::int32_t>("told")) told_.insert(body);
}

}  // namespace lacon
