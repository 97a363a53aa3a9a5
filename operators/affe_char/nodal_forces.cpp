#include "lacon/operators/affe_char/nodal_forces.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/operators/affe_char/component_names.hpp"
#include "lacon/operators/fields/axes.hpp"
#include "lacon/operators/fields/timed_values.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

constexpr std::size_t edge_points = 4;  // integration points of an edge

/// The integration points of an edge on the initial geometry.
struct EdgePoints {
  std::vector<double> shape;     ///< (n_points, n_nodes)
  std::vector<double> length;    ///< (n_points): weight times length of the tangent
  std::vector<double> position;  ///< (n_points, 3)
};

EdgePoints points_of(const Mesh& mesh, std::int32_t cell) {
  const auto nodes = mesh.cells[static_cast<std::size_t>(cell)];
  const Tabulation table = tabulate(mesh.types[static_cast<std::size_t>(cell)], integration_rule(Family::SEG, edge_points));
  EdgePoints points{table.shape, {}, {}};
  for (std::size_t p = 0; p < table.weight.size(); ++p) {
    Vec3 tangent{}, place{};
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const Vec3 node = vector_at(mesh.coordinates.data() + 3 * std::ptrdiff_t{nodes[a]});
      tangent = tangent + table.gradient[p * nodes.size() + a] * node;
      place = place + table.shape[p * nodes.size() + a] * node;
    }
    points.length.push_back(table.weight[p] * norm(tangent));
    points.position.insert(points.position.end(), {place.x, place.y, place.z});
  }
  return points;
}

/// What FORCE_ARETE gives an edge.
struct EdgeForce {
  std::array<LoadValue, 3> values;
  std::string source;
};

/// Its values at the integration points of all edges, (edges, edge_points, 3); functions are asked once.
std::vector<double> values_at(const Base& base, const std::map<std::int32_t, EdgeForce>& edges,
                              const std::vector<EdgePoints>& points) {
  TimedValues values(edges.size() * edge_points * 3);
  std::map<std::string, std::shared_ptr<const StudyFunction>> functions;
  std::size_t edge = 0;
  for (const auto& [cell, given] : edges) {
    for (std::size_t d = 0; d < 3; ++d)
      for (std::size_t p = 0; p < edge_points; ++p) {
        const std::size_t at = (edge * edge_points + p) * 3 + d;
        const LoadValue& value = given.values[d];
        if (value.function.empty()) {
          values.set(at, value.value);
          continue;
        }
        auto& function = functions[value.function];
        if (!function) {
          function = std::make_shared<StudyFunction>(base, value.function);
          constexpr std::array<std::string_view, 3> places{"X", "Y", "Z"};
          function->check_parameters(places, given.source);
        }
        values.set(at, function, std::span(points[edge].position).subspan(3 * p, 3));
      }
    ++edge;
  }
  return values.at(0.0);
}

}  // namespace

std::vector<Keywords> along_the_mesh(const LoadScene& scene, const std::vector<Keywords>& factors) {
  std::vector<Keywords> turned;
  for (const Keywords& factor : factors) {
    turned.push_back(factor);
    if (!factor.has("ANGL_NAUT")) continue;
    std::size_t lost = 0;
    const Eigen::Matrix3d axes = Frame(scene.mesh, factor, false).at(Eigen::Vector3d::Zero(), lost);
    Eigen::Vector3d given;
    for (int d = 0; d < 3; ++d) given[d] = factor.optional_real(force_along[d]).value_or(0);
    const Eigen::Vector3d force = axes.transpose() * given;
    nlohmann::json values = factor.values();
    for (int d = 0; d < 3; ++d) {
      values.erase(std::string(force_along[d]));
      if (d < scene.mesh.dimension) values[std::string(force_along[d])] = force[d];
    }
    turned.back() = Keywords(std::move(values), factor.path(""));
  }
  return turned;
}

void load_edges(Load& load, const LoadScene& scene, const Keywords& keywords) {
  std::map<std::int32_t, EdgeForce> edges;
  for (const Keywords& factor : keywords.factors("FORCE_ARETE"))
    for (const std::string& group : factor.texts("GROUP_MA")) {
      const std::string source = factor.path("GROUP_MA") + " '" + group + "'";
      for (const std::int32_t cell : cells_of_group(scene.mesh, group, factor.path("GROUP_MA"))) {
        const catalog::CellRow& row = scene.mesh.row(static_cast<std::size_t>(cell));
        if (row.dimension != 1 || scene.mesh.dimension != 3)
          fail("CHARGE_6", {{"keyword", source},
                            {"cell", cell_name(cell)},
                            {"type", std::string(row.name)},
                            {"carrier", part("edge_in_space")}});
        EdgeForce& edge = edges[cell];
        for (std::size_t d = 0; d < 3; ++d)
          if (factor.has(force_along[d])) edge.values[d] = value_of(scene.base, factor, force_along[d]);
        edge.source = source;
      }
    }
  std::vector<EdgePoints> points;
  for (const auto& [cell, given] : edges) points.push_back(points_of(scene.mesh, cell));
  const std::vector<double> values = values_at(scene.base, edges, points);
  std::map<std::pair<std::int32_t, std::size_t>, double> of_node;  // and direction
  std::size_t edge = 0;
  for (const auto& [cell, given] : edges) {
    const auto nodes = scene.mesh.cells[static_cast<std::size_t>(cell)];
    for (std::size_t d = 0; d < 3; ++d) {
      if (given.values[d] == LoadValue{}) continue;
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        scene.check_dof(nodes[a], std::string("D") + force_along[d][1], given.source);
        for (std::size_t p = 0; p < edge_points; ++p)
          of_node[{nodes[a], d}] +=
              points[edge].length[p] * points[edge].shape[p * nodes.size() + a] * values[(edge * edge_points + p) * 3 + d];
      }
    }
    ++edge;
  }
  for (const auto& [at, value] : of_node) load.nodal.push_back({at.first, std::string(force_along[at.second]), {value, ""}});
}

}  // namespace lacon
