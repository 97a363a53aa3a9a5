#include "lacon/operators/affe_char/ties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/affe_char/relations.hpp"
#include "lacon/operators/fields/axes.hpp"
#include "lacon/operators/fields/cell_locator.hpp"
#include "lacon/operators/program/study_function.hpp"

namespace lacon {
namespace {

constexpr const char* translation[] = {"DX", "DY", "DZ"};
constexpr double round_off = 1e-15;  // of a direction's cosine

/// The cells of GROUP_MA_MAIT that have the mesh's dimension and elements.
std::vector<std::int32_t> master_cells(const LoadScene& scene, const Keywords& factor) {
  std::vector<std::int32_t> cells;
  for (const std::string& group : factor.texts("GROUP_MA_MAIT"))
    for (const std::int32_t cell : cells_of_group(scene.mesh, group, factor.path("GROUP_MA_MAIT")))
      if (scene.element(cell) &&
          catalog::cell(scene.mesh.types[static_cast<std::size_t>(cell)]).dimension == scene.mesh.dimension)
        cells.push_back(cell);
  if (cells.empty()) fail("CHARGE_22", {{"keyword", factor.path("GROUP_MA_MAIT")}});
  return cells;
}

}  // namespace

void hold_oblique(Load& load, const LoadScene& scene, const Keywords& factor) {
  std::size_t lost = 0;
  const Eigen::Matrix3d axes = Frame(scene.mesh, factor, false).at(Eigen::Vector3d::Zero(), lost);
  for (int axis = 0; axis < 3; ++axis) {
    const char* const keyword = translation[axis];
    if (!factor.has(keyword)) continue;
    const LoadValue value = value_of(scene.base, factor, keyword);
    for (const std::int32_t node : distinct_nodes(named_nodes(scene, factor))) {
      std::vector<RelationTerm> terms;
      for (int d = 0; d < 3; ++d)
        if (std::abs(axes(axis, d)) > round_off) terms.push_back({node, translation[d], axes(axis, d)});
      add_relation(load, scene, factor.path(keyword), std::move(terms), value);
    }
  }
}

void tie_to_cells(Load& load, const LoadScene& scene, const Keywords& factor) {
  const CellLocator locator(scene.mesh, master_cells(scene, factor));
  const std::optional<double> most = factor.optional_real("DISTANCE_MAX");
  std::size_t outside = 0;
  double farthest = 0;
  for (const NamedPlaces& named : named_nodes(scene, factor, "_ESCL"))
    for (const std::int32_t node : named.members) {
      const auto at = scene.mesh.point(static_cast<std::size_t>(node));
      const std::optional<PointInCell> found = locator.find({at[0], at[1], at[2]}, most.value_or(HUGE_VAL));
      if (!found) fail("CHARGE_21", {{"keyword", named.source}, {"node", node_name(node)}});
      if (found->outside) {
        ++outside;
        farthest = std::max(farthest, found->distance);
      }
      const auto masters = scene.mesh.cells[static_cast<std::size_t>(found->cell)];
      if (std::find(masters.begin(), masters.end(), node) != masters.end()) continue;  // it moves with itself
      for (int d = 0; d < scene.mesh.dimension; ++d) {
        std::vector<RelationTerm> terms{{node, translation[d], 1.0}};
        for (std::size_t a = 0; a < found->weights.size(); ++a)
          if (std::abs(found->weights[a]) > CellLocator::margin)
            terms.push_back({masters[a], translation[d], -found->weights[a]});
        add_relation(load, scene, named.source, std::move(terms), {});
      }
    }
  if (outside > 0 && farthest > factor.optional_real("DISTANCE_ALARME").value_or(0))
    inform("CHARGE_23", {{"keyword", factor.path("GROUP_MA_MAIT")},
                         {"count", std::to_string(outside)},
                         {"distance", fmt::format("{:.3g}", farthest)}});
}

}  // namespace lacon
