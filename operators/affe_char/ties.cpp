#include "lacon/operators/affe_char/ties.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/affe_char/component_names.hpp"
#include "lacon/operators/affe_char/relations.hpp"
#include "lacon/operators/fields/axes.hpp"
#include "lacon/operators/fields/cell_locator.hpp"
#include "lacon/operators/program/study_function.hpp"

namespace lacon {
namespace {

constexpr double no_cosine = 1e-15;  // of a direction's cosine

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
        if (std::abs(axes(axis, d)) > no_cosine) terms.push_back({node, translation[d], axes(axis, d)});
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

namespace {

/// The components of a DDL_ESCL, 'DX-DY-DZ', as places among the translations.
std::vector<int> components_of(const Keywords& factor, const std::string& text) {
  std::vector<int> found;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('-', begin), text.size());
    const auto at = std::find(std::begin(translation), std::end(translation), text.substr(begin, end - begin));
    if (at == std::end(translation))
      fail("CHARGE_24", {{"keyword", factor.path("DDL_ESCL")},
                         {"reason", part("no_translation", {{"name", text.substr(begin, end - begin)}})}});
    found.push_back(static_cast<int>(at - std::begin(translation)));
    begin = end + 1;
  }
  return found;
}

/// One value a node, or one for all.
template <class Value>
const Value& of_node(const Keywords& factor, const char* keyword, const std::vector<Value>& values, std::size_t node,
                     std::size_t n_nodes) {
  if (values.size() != 1 && values.size() != n_nodes)
    fail("CHARGE_11",
         {{"keyword", factor.path(keyword)}, {"found", std::to_string(values.size())}, {"expected", std::to_string(n_nodes)}});
  return values[values.size() == 1 ? 0 : node];
}

}  // namespace

void follow_on_average(Load& load, const LoadScene& scene, const Keywords& factor) {
  const std::string source = factor.path("DDL_MAIT");
  const auto refuse = [&](const std::string& reason) { fail("CHARGE_24", {{"keyword", source}, {"reason", reason}}); };
  for (const std::string& element : scene.model.elements)
    if (const catalog::ElementRow* row = scene.registry.find_element(element); row && row->geometry == catalog::Geometry::axis)
      refuse(part("no_rotation_in_axisymmetry"));
  const std::vector<std::int32_t> masters = distinct_nodes(named_nodes(scene, factor, "_MAIT")),
                                  slaves = distinct_nodes(named_nodes(scene, factor, "_ESCL"));
  if (masters.size() != 1) refuse(part("one_master_node", {{"count", std::to_string(masters.size())}}));
  const std::vector<std::string> followed = factor.texts("DDL_ESCL");
  const std::vector<double> weights = factor.reals("COEF_ESCL");
  const auto place = [&](std::int32_t node) {
    const auto at = scene.mesh.point(static_cast<std::size_t>(node));
    return Eigen::Vector3d(at[0], at[1], at[2]);
  };
  const Eigen::Vector3d origin = place(masters.front());
  double size = 0;
  for (const std::int32_t node : slaves) size = std::max(size, (place(node) - origin).norm());
  if (!(size > 0)) size = 1;

  // a rigid motion is t + w x r; rows of what it does to each followed displacement, lengths by the size
  struct Row {
    RelationTerm term;  ///< with the weight for its coefficient
    Eigen::Matrix<double, 6, 1> motion;
  };
  std::vector<Row> rows;
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  const bool in_plane = scene.mesh.dimension == 2;
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    const Eigen::Vector3d r = (place(slaves[i]) - origin) / size;
    const double weight = of_node(factor, "COEF_ESCL", weights, i, slaves.size());
    for (const int d : components_of(factor, of_node(factor, "DDL_ESCL", followed, i, slaves.size()))) {
      Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Zero();
      motion[d] = 1;
      for (int axis = in_plane ? 2 : 0; axis < 3; ++axis) motion[3 + axis] = Eigen::Vector3d::Unit(axis).cross(r)[d];
      rows.push_back({{slaves[i], translation[d], weight}, motion});
      normal += weight * motion * motion.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(normal);
  const double least = 1e-10 * solver.eigenvalues().cwiseAbs().maxCoeff();
  Eigen::Matrix<double, 6, 6> inverse = Eigen::Matrix<double, 6, 6>::Zero(), unknown = inverse;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix<double, 6, 1> mode = solver.eigenvectors().col(k);
    if (solver.eigenvalues()[k] > least)
      inverse += mode * mode.transpose() / solver.eigenvalues()[k];
    else
      unknown += mode * mode.transpose();
  }
  for (const std::string& component : factor.texts("DDL_MAIT")) {
    const auto d = std::find(std::begin(translation), std::end(translation), component) - std::begin(translation);
    if (unknown.row(d).norm() > 1e-8) refuse(part("motion_not_said", {{"component", component}}));
    std::vector<RelationTerm> terms{{masters.front(), component, 1.0}};
    for (const Row& row : rows) {
      const double coefficient = row.term.coefficient * inverse.row(d).dot(row.motion);
      if (std::abs(coefficient) > no_cosine) terms.push_back({row.term.node, row.term.component, -coefficient});
    }
    add_relation(load, scene, source, std::move(terms), {});
  }
}

}  // namespace lacon
