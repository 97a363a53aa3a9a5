#include "lacon/operators/affe_char/nodal_forces.hpp"

#include <array>
#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/operators/fields/axes.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

constexpr const char* forces[] = {"FX", "FY", "FZ"};

/// What a force of 1 for each unit of length gives each node of an edge.
std::vector<double> shares_of(const Mesh& mesh, std::int32_t cell) {
  const auto nodes = mesh.cells[static_cast<std::size_t>(cell)];
  const Tabulation table = tabulate(mesh.types[static_cast<std::size_t>(cell)], integration_rule(Family::SEG, 4));
  std::vector<double> shares(nodes.size(), 0.0);
  for (std::size_t p = 0; p < table.weight.size(); ++p) {
    Vec3 tangent{};
    for (std::size_t a = 0; a < nodes.size(); ++a)
      tangent =
          tangent + table.gradient[p * nodes.size() + a] * vector_at(mesh.coordinates.data() + 3 * std::ptrdiff_t{nodes[a]});
    for (std::size_t a = 0; a < nodes.size(); ++a)
      shares[a] += table.weight[p] * norm(tangent) * table.shape[p * nodes.size() + a];
  }
  return shares;
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
    for (int d = 0; d < 3; ++d) given[d] = factor.optional_real(forces[d]).value_or(0);
    const Eigen::Vector3d force = axes.transpose() * given;
    nlohmann::json values = factor.values();
    for (int d = 0; d < 3; ++d) {
      values.erase(forces[d]);
      if (d < scene.mesh.dimension) values[forces[d]] = force[d];
    }
    turned.back() = Keywords(std::move(values), factor.path(""));
  }
  return turned;
}

void load_edges(Load& load, const LoadScene& scene, const Keywords& keywords) {
  std::map<std::int32_t, std::pair<std::array<double, 3>, std::string>> of_cell;
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
        auto& [values, last] = of_cell[cell];
        for (std::size_t d = 0; d < 3; ++d)
          if (factor.has(forces[d])) values[d] = factor.real(forces[d]);
        last = source;
      }
    }
  std::map<std::pair<std::int32_t, std::size_t>, double> of_node;  // and direction
  for (const auto& [cell, given] : of_cell) {
    const std::vector<double> shares = shares_of(scene.mesh, cell);
    const auto nodes = scene.mesh.cells[static_cast<std::size_t>(cell)];
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t d = 0; d < 3; ++d) {
        if (given.first[d] == 0) continue;
        scene.check_dof(nodes[a], std::string("D") + forces[d][1], given.second);
        of_node[{nodes[a], d}] += shares[a] * given.first[d];
      }
  }
  for (const auto& [at, value] : of_node) load.nodal.push_back({at.first, forces[at.second], {value, ""}});
}

}  // namespace lacon
