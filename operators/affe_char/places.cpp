#include "lacon/operators/affe_char/places.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/quantities.hpp"
#include "lacon/operators/program/study_function.hpp"
#include "lacon/structures/names.hpp"

namespace lacon {

std::span<const std::string_view> unknowns() {
  for (const catalog::QuantityRow& row : catalog::quantities())
    if (row.name == "DEPL_R") return row.components;
  return {};
}

// ---------------------------------------------------------------------------------------------------- the scene

LoadScene make_scene(const Mesh& mesh, const Model& model, Registry& registry, const Base& base) {
  LoadScene scene{mesh, model, registry, base, std::vector<unsigned>(mesh.n_nodes(), 0)};
  const auto names = unknowns();
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    const catalog::ElementRow* row = scene.element(static_cast<std::int32_t>(cell));
    if (!row) continue;
    unsigned own = 0;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (std::find(row->dofs.begin(), row->dofs.end(), names[i]) != row->dofs.end()) own |= 1u << i;
    for (const std::int32_t node : mesh.cells[cell]) scene.dofs[static_cast<std::size_t>(node)] |= own;
  }
  return scene;
}

const catalog::ElementRow* LoadScene::element(std::int32_t cell) const {
  const std::int32_t number = model.element[static_cast<std::size_t>(cell)];
  return number < 0 ? nullptr : registry.find_element(model.elements[static_cast<std::size_t>(number)]);
}

void LoadScene::check_dof(std::int32_t node, std::string_view component, const std::string& source) const {
  const unsigned own = dofs[static_cast<std::size_t>(node)];
  if (own == 0) fail("CHARGE_2", {{"keyword", source}, {"node", node_name(node)}});
  const auto names = unknowns();
  const auto at = std::find(names.begin(), names.end(), component);
  if (at == names.end() || !(own & (1u << (at - names.begin()))))
    fail("CHARGE_3",
         {{"keyword", source}, {"node", node_name(node)}, {"component", std::string(component)}, {"known", names_of(own)}});
}

std::string LoadScene::names_of(unsigned own) const {
  std::string text;
  for (std::size_t i = 0; i < unknowns().size(); ++i)
    if (own & (1u << i)) text += (text.empty() ? "" : ", ") + std::string(unknowns()[i]);
  return text;
}

// ---------------------------------------------------------------------------------------------------- places

namespace {

/// The nodes that a keyword gives by name: N1, N2, ... Throws CHARGE_1.
std::vector<std::int32_t> nodes_by_name(const LoadScene& scene, const Keywords& factor, const std::string& keyword) {
  std::vector<std::int32_t> nodes;
  for (const std::string& name : factor.texts(keyword)) {
    const std::optional<std::int32_t> node = find_by_name(scene.mesh, name, Entity::node);
    if (!node)
      fail("CHARGE_1", {{"keyword", factor.path(keyword)},
                        {"name", name},
                        {"last", node_name(static_cast<std::int64_t>(scene.mesh.n_nodes()) - 1)}});
    nodes.push_back(*node);
  }
  return nodes;
}

}  // namespace

std::vector<char> nodes_left_out(const LoadScene& scene, const Keywords& factor) {
  std::vector<char> out(scene.mesh.n_nodes(), 0);
  const auto leave_out = [&](const auto& nodes) {
    for (const std::int32_t node : nodes) out[static_cast<std::size_t>(node)] = 1;
  };
  for (const std::string& group : factor.texts("SANS_GROUP_MA"))
    leave_out(nodes_of_cells(scene.mesh, cells_of_group(scene.mesh, group, factor.path("SANS_GROUP_MA"))));
  for (const std::string& group : factor.texts("SANS_GROUP_NO"))
    leave_out(nodes_of_group(scene.mesh, group, factor.path("SANS_GROUP_NO")));
  leave_out(nodes_by_name(scene, factor, "SANS_NOEUD"));
  return out;
}

std::vector<NamedPlaces> named_nodes(const LoadScene& scene, const Keywords& factor, const std::string& suffix) {
  const Mesh& mesh = scene.mesh;
  std::vector<NamedPlaces> named;
  if (factor.has("TOUT")) {
    NamedPlaces all{factor.path("TOUT"), {}};
    for (std::size_t node = 0; node < scene.dofs.size(); ++node)
      if (scene.dofs[node]) all.members.push_back(static_cast<std::int32_t>(node));
    named.push_back(std::move(all));
  }
  const std::string group_ma = "GROUP_MA" + suffix, group_no = "GROUP_NO" + suffix, node_keyword = "NOEUD" + suffix;
  for (const std::string& group : factor.texts(group_ma))
    named.push_back(
        {factor.path(group_ma) + " '" + group + "'", nodes_of_cells(mesh, cells_of_group(mesh, group, factor.path(group_ma)))});
  for (const std::string& group : factor.texts(group_no)) {
    const auto members = nodes_of_group(mesh, group, factor.path(group_no));
    named.push_back({factor.path(group_no) + " '" + group + "'", {members.begin(), members.end()}});
  }
  for (const std::int32_t node : nodes_by_name(scene, factor, node_keyword))
    named.push_back({factor.path(node_keyword), {node}});
  if (suffix.empty())
    for (const std::vector<char> out = nodes_left_out(scene, factor); NamedPlaces & places : named)
      std::erase_if(places.members, [&](std::int32_t node) { return out[static_cast<std::size_t>(node)] != 0; });
  return named;
}

std::vector<NamedPlaces> named_cells(const LoadScene& scene, const Keywords& factor,
                                     const std::function<bool(std::int32_t)>& fits) {
  std::vector<NamedPlaces> named;
  if (factor.has("TOUT") || !factor.has("GROUP_MA")) {
    NamedPlaces all{factor.path("TOUT"), {}};
    for (std::size_t cell = 0; cell < scene.mesh.n_cells(); ++cell)
      if (fits(static_cast<std::int32_t>(cell))) all.members.push_back(static_cast<std::int32_t>(cell));
    named.push_back(std::move(all));
  }
  for (const std::string& group : factor.texts("GROUP_MA")) {
    const auto members = cells_of_group(scene.mesh, group, factor.path("GROUP_MA"));
    named.push_back({factor.path("GROUP_MA") + " '" + group + "'", {members.begin(), members.end()}});
  }
  return named;
}

// ---------------------------------------------------------------------------------------------------- values

LoadValue value_of(const LoadScene& scene, const Keywords& factor, std::string_view keyword) {
  if (!factor.is_concept(keyword)) return {factor.real(keyword), ""};
  const StudyFunction function(scene.base, factor.concept_id(keyword));
  constexpr std::string_view known[] = {"X", "Y", "Z", "INST"};
  function.check_parameters(known, factor.path(keyword));
  return {0.0, function.id()};
}

std::string show(const LoadScene& scene, const LoadValue& value) {
  return value.function.empty() ? fmt::format("{:g}", value.value) : scene.base.label(value.function);
}

bool GivenTerms::add(std::int32_t number, const std::string& place, const std::string& component, const LoadValue& value,
                     const std::string& source) {
  const auto [at, first] = given_.try_emplace({number, component}, Given{value, source});
  if (!first && at->second.value != value)
    fail(conflict_, {{"component", component},
                     {"place", place},
                     {"first", show(scene_, at->second.value)},
                     {"first_source", at->second.source},
                     {"second", show(scene_, value)},
                     {"second_source", source}});
  if (first) terms_.push_back({number, component, value});
  return first;
}

}  // namespace lacon
