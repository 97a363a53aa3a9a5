#include "lacon/operators/affe_char/places.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/quantities.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/named_nodes.hpp"

namespace lacon {

std::span<const std::string_view> unknowns() {
  for (const catalog::QuantityRow& row : catalog::quantities())
    if (row.name == "DEPL_R") return row.components;
  return {};
}

// ---------------------------------------------------------------------------------------------------- the scene

LoadScene make_scene(const Mesh& mesh, const Model& model, Registry& registry, const Base& base) {
  LoadScene scene{mesh, model, registry, base, std::vector<unsigned>(mesh.n_nodes(), 0), std::vector<char>(mesh.n_nodes(), 0)};
  const auto names = unknowns();
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    const catalog::ElementRow* row = scene.element(static_cast<std::int32_t>(cell));
    if (!row) continue;
    unsigned own = 0;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (std::find(row->dofs.begin(), row->dofs.end(), names[i]) != row->dofs.end()) own |= 1u << i;
    for (const std::int32_t node : mesh.cells[cell]) {
      scene.dofs[static_cast<std::size_t>(node)] |= own;
      if (row->role != catalog::Role::skin) scene.is_of_a_body[static_cast<std::size_t>(node)] = 1;
    }
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
  for (const std::int32_t node : nodes_by_name(mesh, factor, node_keyword))
    named.push_back({factor.path(node_keyword), {node}});
  if (suffix.empty())
    for (const std::vector<char> out = nodes_left_out(mesh, factor); NamedPlaces & places : named)
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

std::string show(const LoadScene& scene, const LoadValue& value) {
  return value.function.empty() ? fmt::format("{:g}", value.value) : scene.base.label(value.function);
}

void GivenTerms::add(std::int32_t number, const std::string& place, const std::string& component, const LoadValue& value,
                     const std::string& source) {
  const auto [at, first] = given_.try_emplace({number, component}, Given{terms_.size(), source});
  if (first) return terms_.push_back({number, component, value});
  LoadValue& held = terms_[at->second.term].value;
  if (held == value) return;
  const auto head = [](const std::string& path, const char* end) { return path.substr(0, path.find_first_of(end)); };
  const std::string& before = at->second.source;
  if (head(source, "[/") != head(before, "[/") || head(source, "/") == head(before, "/"))
    fail(conflict_, {{"component", component},
                     {"place", place},
                     {"first", show(scene_, held)},
                     {"first_source", before},
                     {"second", show(scene_, value)},
                     {"second_source", source}});
  if (replaced_++ == 0) first_replaced_ = part("one_of_another", {{"one", component}, {"other", place}}), last_source_ = source;
  held = value;
  at->second.source = source;
}

GivenTerms::~GivenTerms() {
  if (replaced_ > 0)
    inform("CHARGE_20", {{"count", std::to_string(replaced_)}, {"what", first_replaced_}, {"source", last_source_}});
}

}  // namespace lacon
