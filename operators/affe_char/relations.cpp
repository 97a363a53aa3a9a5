#include "lacon/operators/affe_char/relations.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/affe_char/component_names.hpp"
#include "lacon/operators/affe_char/ties.hpp"
#include "lacon/operators/meshing/named_nodes.hpp"
#include "lacon/operators/program/study_function.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

std::vector<std::int32_t> distinct_nodes(const std::vector<NamedPlaces>& named) {
  std::vector<std::int32_t> nodes;
  std::set<std::int32_t> seen;
  for (const NamedPlaces& places : named)
    for (const std::int32_t node : places.members)
      if (seen.insert(node).second) nodes.push_back(node);
  return nodes;
}

namespace {

constexpr double round_off = 1e-12;  // of coefficients that cancel each other

/// One term for each degree of freedom, in the order of their first ones; those whose coefficients cancel are left out.
std::vector<RelationTerm> sums_by_dof(std::span<const RelationTerm> terms) {
  std::vector<RelationTerm> sums;
  std::vector<double> sizes;
  std::map<std::pair<std::int32_t, std::string>, std::size_t> places;
  for (const RelationTerm& term : terms) {
    const auto [place, is_new] = places.try_emplace({term.node, term.component}, sums.size());
    if (is_new) {
      sums.push_back(term);
      sizes.push_back(std::abs(term.coefficient));
      continue;
    }
    sums[place->second].coefficient += term.coefficient;
    sizes[place->second] += std::abs(term.coefficient);
  }
  std::vector<RelationTerm> kept;
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (std::abs(sums[i].coefficient) > round_off * sizes[i]) kept.push_back(std::move(sums[i]));
  return kept;
}

}  // namespace

void add_relation(Load& load, const LoadScene& scene, const std::string& source, std::vector<RelationTerm> terms,
                  LoadValue value) {
  for (const RelationTerm& term : terms) scene.check_dof(term.node, term.component, source);
  terms = sums_by_dof(terms);
  if (!terms.empty())
    load.relations.push_back({source, std::move(terms), std::move(value)});
  else if (value != LoadValue{})
    fail("CHARGE_25",
         {{"keyword", source},
          {"value", value.function.empty() ? fmt::format("{:.15g}", value.value)
                                           : part("value_of_function", {{"label", scene.base.label(value.function)}})}});
}

namespace {

[[noreturn]] void wrong_count(const Keywords& factor, std::string_view keyword, std::size_t found, std::size_t expected) {
  fail("CHARGE_11",
       {{"keyword", factor.path(keyword)}, {"found", std::to_string(found)}, {"expected", std::to_string(expected)}});
}

// ------------------------------------------------------------------------------------ LIAISON_DDL, LIAISON_UNIF, LIAISON_GROUP

/// sum of COEF_MULT[i] * DDL[i] of node i = COEF_IMPO
void link_dofs(Load& load, const LoadScene& scene, const Keywords& factor) {
  std::vector<std::int32_t> nodes;  // a node may come twice, with two components
  for (const NamedPlaces& named : named_nodes(scene, factor))
    nodes.insert(nodes.end(), named.members.begin(), named.members.end());
  const std::vector<std::string> components = factor.texts("DDL");
  const std::vector<double> coefficients = factor.reals("COEF_MULT");
  if (components.size() != nodes.size()) wrong_count(factor, "DDL", components.size(), nodes.size());
  if (coefficients.size() != nodes.size()) wrong_count(factor, "COEF_MULT", coefficients.size(), nodes.size());
  std::vector<RelationTerm> terms;
  for (std::size_t i = 0; i < nodes.size(); ++i) terms.push_back({nodes[i], components[i], coefficients[i]});
  add_relation(load, scene, factor.path("DDL"), std::move(terms), value_of(scene.base, factor, "COEF_IMPO"));
}

/// Every node has the first one's displacement.
void make_uniform(Load& load, const LoadScene& scene, const Keywords& factor) {
  const std::vector<std::int32_t> nodes = distinct_nodes(named_nodes(scene, factor));
  for (const std::string& component : factor.texts("DDL"))
    for (std::size_t i = 1; i < nodes.size(); ++i)
      add_relation(load, scene, factor.path("DDL"), {{nodes[0], component, 1.0}, {nodes[i], component, -1.0}}, {});
}

/// GROUP_NO_1 and the like (side 0), or GROUP_NO_2 (side 1).
std::string of_side(const char* keyword, int side) { return fmt::format("{}_{}", keyword, side + 1); }

/// The node of `others` that is nearest to a place.
std::int32_t nearest_of(const std::vector<std::int32_t>& others, const Mesh& mesh, const std::array<double, 3>& place) {
  std::int32_t nearest = -1;
  double least = INFINITY;
  for (const std::int32_t other : others) {
    const auto to = mesh.point(static_cast<std::size_t>(other));
    const double distance = std::hypot(place[0] - to[0], place[1] - to[1], place[2] - to[2]);
    if (!(distance < least)) continue;
    least = distance;
    nearest = other;
  }
  return nearest;
}

/// The sum over DDL_1 at a node and that over DDL_2 at the other one.
std::vector<RelationTerm> terms_of_pair(const Keywords& factor, const std::array<std::int32_t, 2>& nodes) {
  std::vector<RelationTerm> terms;
  for (int side = 0; side < 2; ++side) {
    const std::string keyword = of_side("COEF_MULT", side);
    const std::vector<std::string> components = factor.texts(of_side("DDL", side));
    const std::vector<double> coefficients = factor.reals(keyword);
    if (coefficients.size() != components.size()) wrong_count(factor, keyword, coefficients.size(), components.size());
    for (std::size_t i = 0; i < components.size(); ++i) terms.push_back({nodes[side], components[i], coefficients[i]});
  }
  return terms;
}

/// For each node of the first group and the nearest one of the second, behind TRAN: the sum over DDL_1 and that over DDL_2 are
/// COEF_IMPO together.
void link_groups(Load& load, const LoadScene& scene, const Keywords& factor) {
  std::array<std::vector<std::int32_t>, 2> sides;
  const std::vector<char> out = nodes_left_out(scene.mesh, factor);
  for (int side = 0; side < 2; ++side) {
    sides[side] = distinct_nodes(named_nodes(scene, factor, side ? "_2" : "_1"));
    std::erase_if(sides[side], [&](std::int32_t node) { return out[static_cast<std::size_t>(node)] != 0; });
  }
  const auto refuse_pairs = [&](const std::string& reason) {
    fail("CHARGE_13", {{"keyword", factor.path("DDL_1")}, {"reason", reason}});
  };
  if (sides[0].size() != sides[1].size())
    refuse_pairs(
        part("unequal_sides", {{"first", std::to_string(sides[0].size())}, {"second", std::to_string(sides[1].size())}}));
  std::vector<double> shift = factor.reals("TRAN");
  shift.resize(3, 0.0);
  std::set<std::int32_t> taken;
  for (const std::int32_t node : sides[0]) {
    const auto at = scene.mesh.point(static_cast<std::size_t>(node));
    const std::int32_t nearest = nearest_of(sides[1], scene.mesh, {at[0] + shift[0], at[1] + shift[1], at[2] + shift[2]});
    if (!taken.insert(nearest).second) refuse_pairs(part("nearest_to_two", {{"node", node_name(nearest)}}));
    add_relation(load, scene, factor.path("DDL_1"), terms_of_pair(factor, {node, nearest}),
                 value_of(scene.base, factor, "COEF_IMPO"));
  }
}

// ---------------------------------------------------------------------------------------------------- LIAISON_SOLIDE

void make_rigid(Load& load, const LoadScene& scene, const Keywords& factor) {
  const std::vector<NamedPlaces> named = named_nodes(scene, factor);
  const std::vector<std::int32_t> nodes = distinct_nodes(named);
  for (const std::string& element : scene.model.elements)
    if (const catalog::ElementRow* row = scene.registry.find_element(element); row && row->geometry == catalog::Geometry::axis)
      fail("CHARGE_14", {{"keyword", named.front().source}});
  std::vector<double> points;
  for (const std::int32_t node : nodes) {
    const auto at = scene.mesh.point(static_cast<std::size_t>(node));
    points.insert(points.end(), at.begin(), at.end());
  }
  for (std::vector<RelationTerm>& terms : rigid_relations(points, scene.mesh.dimension)) {
    for (RelationTerm& term : terms) term.node = nodes[static_cast<std::size_t>(term.node)];
    add_relation(load, scene, named.front().source, std::move(terms), {});
  }
}

// ---------------------------------------------------------------------------------------------------- FACE_IMPO

/// Unit normals at the nodes of an occurrence's skin cells: (node, normal).
std::vector<std::pair<std::int32_t, Vec3>> normals_of(const LoadScene& scene, const Keywords& factor) {
  std::vector<std::int32_t> cells;
  for (const std::string& group : factor.texts("GROUP_MA"))
    for (const std::int32_t cell : cells_of_group(scene.mesh, group, factor.path("GROUP_MA"))) {
      if (catalog::cell(scene.mesh.types[static_cast<std::size_t>(cell)]).dimension != scene.mesh.dimension - 1)
        fail("CHARGE_12", {{"keyword", factor.path("GROUP_MA") + " '" + group + "'"},
                           {"reason", part("cell_no_skin", {{"cell", cell_name(cell)}})}});
      cells.push_back(cell);
    }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  const Surface surface = surface_of(scene.mesh, cells, scene.mesh.coordinates);
  const std::vector<double> normals = nodal_normals(surface);
  std::vector<std::pair<std::int32_t, Vec3>> found;
  const std::vector<char> out = nodes_left_out(scene.mesh, factor);
  for (const std::int32_t node : nodes_of_cells(scene.mesh, cells)) {
    if (out[static_cast<std::size_t>(node)]) continue;
    const Vec3 n = vector_at(normals.data() + 3 * static_cast<std::size_t>(node));
    if (norm(n) == 0)
      fail("CHARGE_12",
           {{"keyword", factor.path("GROUP_MA")}, {"reason", part("normals_cancel", {{"node", node_name(node)}})}});
    found.emplace_back(node, n);
  }
  // a normal that stands for cells of different directions holds none of them
  if (const TurnedNormals turned = turned_normals(surface, normals, 10 * std::acos(-1.0) / 180); turned.count)
    inform("CHARGE_16",
           {{"keyword", factor.path("GROUP_MA")}, {"count", std::to_string(turned.count)}, {"node", node_name(turned.first)}});
  return found;
}

/// DNOR: u . n, DTAN (in the plane): u . t, with t = n turned by +90 degrees.
void hold_normal(Load& load, const LoadScene& scene, const Keywords& factor) {
  if (!factor.has("DNOR") && !factor.has("DTAN")) return;
  const auto normals = normals_of(scene, factor);
  for (const char* const keyword : {"DNOR", "DTAN"}) {
    if (!factor.has(keyword)) continue;
    const bool tangent = std::string_view(keyword) == "DTAN";
    if (tangent && scene.mesh.dimension != 2) fail("CHARGE_15", {{"keyword", factor.path(keyword)}});
    for (const auto& [node, n] : normals) {
      const Vec3 direction = tangent ? Vec3{-n.y, n.x, 0} : n;
      std::vector<RelationTerm> terms;
      for (int d = 0; d < scene.mesh.dimension; ++d) terms.push_back({node, translation[d], component(direction, d)});
      add_relation(load, scene, factor.path(keyword), std::move(terms), value_of(scene.base, factor, keyword));
    }
  }
}

}  // namespace

void add_relations(Load& load, const LoadScene& scene, const Keywords& keywords) {
  for (const Keywords& factor : keywords.factors("FACE_IMPO")) hold_normal(load, scene, factor);
  for (const Keywords& factor : keywords.factors("LIAISON_DDL")) link_dofs(load, scene, factor);
  for (const Keywords& factor : keywords.factors("LIAISON_UNIF")) make_uniform(load, scene, factor);
  for (const Keywords& factor : keywords.factors("LIAISON_GROUP")) link_groups(load, scene, factor);
  for (const Keywords& factor : keywords.factors("LIAISON_SOLIDE")) make_rigid(load, scene, factor);
  for (const Keywords& factor : keywords.factors("LIAISON_OBLIQUE")) hold_oblique(load, scene, factor);
  for (const Keywords& factor : keywords.factors("LIAISON_MAIL")) tie_to_cells(load, scene, factor);
  for (const Keywords& factor : keywords.factors("LIAISON_RBE3")) follow_on_average(load, scene, factor);
}

}  // namespace lacon
