#include "lacon/operators/affe_char/affe_char.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/quantities.hpp"
#include "lacon/operators/meshing/skin.hpp"

namespace lacon {
namespace {

/// Names of the displacements, in the order of the quantity.
std::span<const std::string_view> displacements() {
  for (const catalog::QuantityRow& row : catalog::quantities())
    if (row.name == "DEPL_R") return row.components;
  return {};
}

const catalog::ElementRow* element_of(const Model& model, const Registry& registry, std::size_t cell) {
  return model.element[cell] < 0 ? nullptr
                                 : registry.find_element(model.elements[static_cast<std::size_t>(model.element[cell])]);
}

/// The degrees of freedom of each node: bit i for displacement i.
std::vector<unsigned> degrees_of_freedom(const Mesh& mesh, const Model& model, const Registry& registry) {
  const auto names = displacements();
  std::vector<unsigned> dofs(mesh.n_nodes(), 0);
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    const catalog::ElementRow* row = element_of(model, registry, cell);
    if (!row) continue;
    unsigned own = 0;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (std::find(row->dofs.begin(), row->dofs.end(), names[i]) != row->dofs.end()) own |= 1u << i;
    for (const std::int32_t node : mesh.cells[cell]) dofs[static_cast<std::size_t>(node)] |= own;
  }
  return dofs;
}

std::string names_of(unsigned dofs) {
  std::string text;
  for (std::size_t i = 0; i < displacements().size(); ++i)
    if (dofs & (1u << i)) text += (text.empty() ? "" : ", ") + std::string(displacements()[i]);
  return text;
}

std::int32_t node_of_name(const Mesh& mesh, const std::string& name, const std::string& keyword) {
  const std::optional<std::int32_t> node = number_of_name(name, 'N', mesh.n_nodes());
  if (!node)
    fail("CHARGE_1",
         {{"keyword", keyword}, {"name", name}, {"last", node_name(static_cast<std::int64_t>(mesh.n_nodes()) - 1)}});
  return *node;
}

/// The nodes that an occurrence names, with the keyword that names them.
struct NamedNodes {
  std::string source;
  std::vector<std::int32_t> nodes;
};

std::vector<NamedNodes> named_nodes(const Mesh& mesh, std::span<const unsigned> dofs, const Keywords& factor) {
  std::vector<NamedNodes> named;
  if (factor.has("TOUT")) {
    NamedNodes all{factor.path("TOUT"), {}};
    for (std::size_t node = 0; node < dofs.size(); ++node)
      if (dofs[node]) all.nodes.push_back(static_cast<std::int32_t>(node));
    named.push_back(std::move(all));
  }
  for (const std::string& group : factor.texts("GROUP_MA"))
    named.push_back({factor.path("GROUP_MA") + " '" + group + "'",
                     nodes_of_cells(mesh, cells_of_group(mesh, group, factor.path("GROUP_MA")))});
  for (const std::string& group : factor.texts("GROUP_NO")) {
    const auto members = nodes_of_group(mesh, group, factor.path("GROUP_NO"));
    named.push_back({factor.path("GROUP_NO") + " '" + group + "'", {members.begin(), members.end()}});
  }
  for (const std::string& name : factor.texts("NOEUD"))
    named.push_back({factor.path("NOEUD"), {node_of_name(mesh, name, factor.path("NOEUD"))}});
  return named;
}

void impose(Load& load, const Mesh& mesh, std::span<const unsigned> dofs, const std::vector<Keywords>& factors) {
  struct Given {
    double value;
    std::string source;
  };
  std::map<std::pair<std::int32_t, std::size_t>, Given> given;
  for (const Keywords& factor : factors)
    for (const NamedNodes& named : named_nodes(mesh, dofs, factor))
      for (const std::int32_t node : named.nodes) {
        const unsigned own = dofs[static_cast<std::size_t>(node)];
        if (own == 0) fail("CHARGE_2", {{"keyword", named.source}, {"node", node_name(node)}});
        for (std::size_t i = 0; i < displacements().size(); ++i) {
          const std::string component(displacements()[i]);
          if (!factor.has(component)) continue;
          if (!(own & (1u << i)))
            fail("CHARGE_3", {{"keyword", factor.path(component)},
                              {"node", node_name(node)},
                              {"component", component},
                              {"known", names_of(own)}});
          const double value = factor.real(component);
          const auto [at, first] = given.try_emplace({node, i}, Given{value, named.source});
          if (first)
            load.imposed.push_back({node, component, value});
          else if (at->second.value != value)
            fail("CHARGE_4", {{"component", component},
                              {"node", node_name(node)},
                              {"first", fmt::format("{:g}", at->second.value)},
                              {"first_source", at->second.source},
                              {"second", fmt::format("{:g}", value)},
                              {"second_source", named.source}});
        }
      }
}

/// Whether this element takes pressures: its row says so.
bool takes_pressure(const catalog::ElementRow* row, const Registry& registry) {
  return row && registry.has_kernel(*row, "CHAR_MECA_PRES");
}

void press(Load& load, const Mesh& mesh, const Model& model, const Registry& registry, const Keywords& keywords) {
  const SkinSides sides(mesh);
  std::map<std::int32_t, double> given;
  for (const Keywords& factor : keywords.factors("PRES_REP")) {
    const double value = factor.real("PRES");
    const auto press_cells = [&](std::span<const std::int32_t> cells, const std::string& source) {
      std::vector<std::int32_t> inward, alone;
      for (const std::int32_t cell : cells) {
        const auto c = static_cast<std::size_t>(cell);
        if (!takes_pressure(element_of(model, registry, c), registry))
          fail("CHARGE_6", {{"keyword", source}, {"cell", cell_name(cell)}, {"type", std::string(mesh.row(c).name)}});
        const auto [at, first] = given.try_emplace(cell, value);
        if (at->second != value)
          fail("CHARGE_5", {{"keyword", source},
                            {"cell", cell_name(cell)},
                            {"first", fmt::format("{:g}", at->second)},
                            {"second", fmt::format("{:g}", value)}});
        if (!first) continue;
        load.pressure.push_back({cell, value});
        const Side side = sides[cell];
        if (side == Side::inward) inward.push_back(cell);
        if (side == Side::alone) alone.push_back(cell);
      }
      if (!keywords.yes("VERI_NORM")) return;
      if (!inward.empty())
        fail("CHARGE_7", {{"keyword", source}, {"count", std::to_string(inward.size())}, {"cell", cell_name(inward.front())}});
      if (!alone.empty())
        inform("CHARGE_8", {{"keyword", source}, {"count", std::to_string(alone.size())}, {"cell", cell_name(alone.front())}});
    };
    if (factor.has("TOUT")) {
      std::vector<std::int32_t> cells;
      for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
        if (takes_pressure(element_of(model, registry, cell), registry)) cells.push_back(static_cast<std::int32_t>(cell));
      press_cells(cells, factor.path("TOUT"));
    }
    for (const std::string& group : factor.texts("GROUP_MA"))
      press_cells(cells_of_group(mesh, group, factor.path("GROUP_MA")), factor.path("GROUP_MA") + " '" + group + "'");
  }
}

}  // namespace

Load affe_char(const Mesh& mesh, const Model& model, const Registry& registry, const Keywords& keywords) {
  Load load;
  std::vector<Keywords> imposed = keywords.factors("MECA_IMPO");
  for (Keywords& factor : keywords.factors("DDL_IMPO")) imposed.push_back(std::move(factor));
  if (!imposed.empty()) impose(load, mesh, degrees_of_freedom(mesh, model, registry), imposed);
  if (keywords.has("PRES_REP")) press(load, mesh, model, registry, keywords);
  fmt::print("  {} imposed degrees of freedom, {} cells under pressure\n", load.imposed.size(), load.pressure.size());
  return load;
}

}  // namespace lacon
