#include "lacon/operators/evolution/problem/revolution_axis.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/bodies.hpp"

namespace lacon {
namespace {

/// As a part of the body's greatest radius: what round-off and the digits of mesh files leave of a zero.
constexpr double on_the_axis = 1e-6;
/// A coefficient of a relation below this part of its largest one is round-off.
constexpr double negligible = 1e-9;
constexpr std::size_t named_nodes = 6;

using Nodes = std::vector<std::int32_t>;

/// Nodes of axisymmetric solids by their body.
std::map<std::int32_t, Nodes> nodes_of_revolution(const StaticProblem& problem, const Bodies& bodies) {
  std::map<std::int32_t, Nodes> nodes;
  for (const ElementSet& set : problem.solids) {
    if (set.row->geometry != catalog::Geometry::axis) continue;
    for (const std::int32_t cell : set.cells)
      for (const std::int32_t node : problem.mesh.cells[static_cast<std::size_t>(cell)]) nodes[bodies.of(node)].push_back(node);
  }
  for (auto& [body, own] : nodes) {
    std::ranges::sort(own);
    const auto twice = std::ranges::unique(own);
    own.erase(twice.begin(), twice.end());
  }
  return nodes;
}

/// "GROUP_MA='AXIS'": the smallest group that has all of these nodes and none off the axis; without one the nodes themselves
/// where they are few, otherwise how to make such a group.
std::string keyword_for(const Mesh& mesh, const Nodes& nodes, const std::vector<std::uint8_t>& is_on_axis) {
  std::string found;
  std::size_t size = 0;
  const auto consider = [&](const std::string& keyword, const Group& group, Nodes own) {
    std::ranges::sort(own);
    const auto twice = std::ranges::unique(own);
    own.erase(twice.begin(), twice.end());
    const auto on_axis = [&](std::int32_t node) { return is_on_axis[static_cast<std::size_t>(node)] != 0; };
    if (std::ranges::includes(own, nodes) && std::ranges::all_of(own, on_axis) && (found.empty() || own.size() < size)) {
      found = keyword + "='" + group.name + "'";
      size = own.size();
    }
  };
  for (const Group& group : mesh.cell_groups) {
    Nodes own;
    for (const std::int32_t cell : group.members)
      own.insert(own.end(), mesh.cells[static_cast<std::size_t>(cell)].begin(),
                 mesh.cells[static_cast<std::size_t>(cell)].end());
    consider("GROUP_MA", group, std::move(own));
  }
  for (const Group& group : mesh.node_groups) consider("GROUP_NO", group, group.members);
  if (!found.empty()) return found;
  if (nodes.size() > named_nodes) return part("group_of_axis");
  std::string names;
  for (const std::int32_t node : nodes) names += (names.empty() ? "'" : ", '") + node_name(node) + "'";
  return nodes.size() == 1 ? "NOEUD=" + names : "NOEUD=(" + names + ")";
}

/// Unknowns that loads decide at every instant, (n_nodes, n_components): imposed, or the last one of a relation whose others
/// are decided.
std::vector<std::uint8_t> decided_unknowns(const StaticProblem& problem) {
  std::vector<std::uint8_t> decided = problem.imposed;
  std::vector<const DofRelation*> open;
  for (const TimedLoad& load : problem.loads)
    for (const DofRelation& relation : load.relations) open.push_back(&relation);
  const auto decides = [&](const DofRelation* relation) {
    double largest = 0;
    for (const double coefficient : relation->coefficients) largest = std::max(largest, std::abs(coefficient));
    std::int64_t last = -1;
    for (std::size_t i = 0; i < relation->dofs.size(); ++i) {
      const std::int64_t dof = relation->dofs[i];
      if (decided[static_cast<std::size_t>(dof)] || dof == last || std::abs(relation->coefficients[i]) <= negligible * largest)
        continue;
      if (last >= 0) return false;
      last = dof;
    }
    if (last >= 0) decided[static_cast<std::size_t>(last)] = 1;
    return true;
  };
  while (std::erase_if(open, decides) > 0) {
  }
  return decided;
}

}  // namespace

void tell_of_axis(const StaticProblem& problem) {
  if (!problem.is_of_revolution()) return;
  const Bodies bodies(problem.mesh);
  std::vector<std::uint8_t> decided = decided_unknowns(problem), is_on_axis(problem.mesh.n_nodes(), 0);
  for (const Spring& spring : problem.springs)  // a support, if a soft one
    if (spring.second < 0 && spring.stiffness[0] > 0)
      decided[static_cast<std::size_t>(spring.first) * problem.components.size()] = 1;
  const auto nodes_of = nodes_of_revolution(problem, bodies);
  const auto radius = [&](std::int32_t node) { return std::abs(problem.mesh.point(static_cast<std::size_t>(node))[0]); };
  for (const auto& [body, nodes] : nodes_of) {
    const double greatest = radius(*std::ranges::max_element(nodes, {}, radius));
    for (const std::int32_t node : nodes) is_on_axis[static_cast<std::size_t>(node)] = radius(node) <= on_the_axis * greatest;
  }
  for (const auto& [body, nodes] : nodes_of) {
    Nodes free;
    for (const std::int32_t node : nodes)
      if (is_on_axis[static_cast<std::size_t>(node)] && !decided[static_cast<std::size_t>(node) * problem.components.size()])
        free.push_back(node);
    if (!free.empty())
      inform("EVOLUTION_44", {{"body", bodies.name_at(body)},
                              {"count", std::to_string(free.size())},
                              {"node", node_name(free.front())},
                              {"where", keyword_for(problem.mesh, free, is_on_axis)}});
  }
}

}  // namespace lacon
