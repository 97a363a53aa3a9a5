#include "lacon/operators/crea_maillage/order_change.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/operators/meshing/conformity.hpp"

namespace lacon {
namespace {

std::vector<char> marked(const Mesh& mesh, std::span<const std::int32_t> cells) {
  std::vector<char> mark(mesh.n_cells(), 0);
  for (const std::int32_t c : cells) mark[static_cast<std::size_t>(c)] = 1;
  return mark;
}

std::pair<std::int32_t, std::int32_t> edge_of(std::span<const std::int32_t> nodes, const catalog::EdgeRow& edge) {
  return std::minmax({nodes[static_cast<std::size_t>(edge.first)], nodes[static_cast<std::size_t>(edge.second)]});
}

}  // namespace

std::int64_t make_quadratic(Mesh& mesh, std::span<const std::int32_t> cells) {
  const std::vector<char> chosen = marked(mesh, cells);
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middle;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const catalog::CellRow& row = mesh.row(c);
    if (row.order != 2) continue;
    for (std::size_t e = 0; e < row.edges.size(); ++e)
      middle[edge_of(mesh.cells[c], row.edges[e])] = mesh.cells[c][static_cast<std::size_t>(row.n_vertices) + e];
  }

  std::int64_t changed = 0;
  Ragged<std::int32_t> connectivity;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const catalog::CellRow& row = mesh.row(c);
    std::vector<std::int32_t> nodes(mesh.cells[c].begin(), mesh.cells[c].end());
    if (chosen[c] && row.order == 1 && row.quadratic != row.type) {
      for (const catalog::EdgeRow& edge : row.edges) {
        const auto key = edge_of(mesh.cells[c], edge);
        const auto [at, fresh] = middle.emplace(key, static_cast<std::int32_t>(mesh.n_nodes()));
        if (fresh) {
          const auto a = static_cast<std::size_t>(key.first), b = static_cast<std::size_t>(key.second);
          for (std::size_t k = 0; k < 3; ++k)
            mesh.coordinates.push_back((mesh.coordinates[3 * a + k] + mesh.coordinates[3 * b + k]) / 2);
        }
        nodes.push_back(at->second);
      }
      mesh.types[c] = row.quadratic;
      ++changed;
    }
    connectivity.push_back(nodes);
  }
  mesh.cells = std::move(connectivity);
  return changed;
}

namespace {

/// The cell of the same family with the most nodes: HEXA27 for a HEXA20.
const catalog::CellRow& complete_cell(const catalog::CellRow& row) {
  const catalog::CellRow* most = &row;
  for (const catalog::CellRow& other : catalog::cells())
    if (other.linear == row.linear && other.n_nodes > most->n_nodes) most = &other;
  return *most;
}

/// The vertices of the face whose middle is the node `local` of a complete cell, sorted; nothing for the centre of a solid.
std::vector<std::int32_t> face_of(const catalog::CellRow& row, std::span<const std::int32_t> nodes, int local) {
  std::vector<std::int32_t> vertices;
  for (const catalog::FacetRow& facet : row.facets)
    if (facet.nodes.back() == local)
      for (int v = 0; v < catalog::cell(facet.type).n_vertices; ++v) vertices.push_back(nodes[facet.nodes[v]]);
  if (vertices.empty() && row.dimension == 2) vertices.assign(nodes.begin(), nodes.begin() + row.n_vertices);
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

}  // namespace

std::int64_t make_complete(Mesh& mesh, std::span<const std::int32_t> cells) {
  const std::vector<char> chosen = marked(mesh, cells);
  std::map<std::vector<std::int32_t>, std::int32_t> middle;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const catalog::CellRow& row = mesh.row(c);
    const catalog::CellRow& quadratic = catalog::cell(catalog::cell(row.linear).quadratic);
    for (int local = quadratic.n_nodes; local < row.n_nodes; ++local)
      if (const auto face = face_of(row, mesh.cells[c], local); !face.empty()) middle[face] = mesh.cells[c][local];
  }

  std::int64_t changed = 0;
  Ragged<std::int32_t> connectivity;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const catalog::CellRow &row = mesh.row(c), &complete = complete_cell(row);
    std::vector<std::int32_t> nodes(mesh.cells[c].begin(), mesh.cells[c].end());
    if (chosen[c] && row.order == 2 && complete.type != row.type) {
      std::vector<double> shape(row.n_nodes);
      for (int local = row.n_nodes; local < complete.n_nodes; ++local) {
        const auto face = face_of(complete, nodes, local);
        const auto known = face.empty() ? middle.end() : middle.find(face);
        if (known != middle.end()) {
          nodes.push_back(known->second);
          continue;
        }
        const auto fresh = static_cast<std::int32_t>(mesh.n_nodes());
        shape_functions(row.type, complete.nodes.subspan(local * complete.dimension, complete.dimension), shape);
        for (std::size_t k = 0; k < 3; ++k) {
          double x = 0;
          for (int n = 0; n < row.n_nodes; ++n) x += shape[n] * mesh.coordinates[3 * static_cast<std::size_t>(nodes[n]) + k];
          mesh.coordinates.push_back(x);
        }
        if (!face.empty()) middle[face] = fresh;
        nodes.push_back(fresh);
      }
      mesh.types[c] = complete.type;
      ++changed;
    }
    connectivity.push_back(nodes);
  }
  mesh.cells = std::move(connectivity);
  return changed;
}

std::int64_t make_linear(Mesh& mesh, std::span<const std::int32_t> cells) {
  const std::vector<char> chosen = marked(mesh, cells);
  std::vector<char> dropped(mesh.n_nodes(), 0);
  std::int64_t changed = 0;
  Ragged<std::int32_t> connectivity;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const catalog::CellRow& row = mesh.row(c);
    std::span<const std::int32_t> nodes = std::as_const(mesh.cells)[c];
    if (chosen[c] && row.order == 2) {
      const auto n = static_cast<std::size_t>(row.n_vertices);
      for (const std::int32_t node : nodes.subspan(n)) dropped[static_cast<std::size_t>(node)] = 1;
      nodes = nodes.first(n);
      mesh.types[c] = row.linear;
      ++changed;
    }
    connectivity.push_back(nodes);
  }
  for (const std::int32_t node : connectivity.values) dropped[static_cast<std::size_t>(node)] = 0;

  // numbers without the dropped nodes
  std::vector<std::int32_t> number(mesh.n_nodes(), -1);
  std::int32_t next = 0;
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n) {
    if (dropped[n]) continue;
    for (std::size_t k = 0; k < 3; ++k) mesh.coordinates[3 * static_cast<std::size_t>(next) + k] = mesh.coordinates[3 * n + k];
    number[n] = next++;
  }
  mesh.coordinates.resize(3 * static_cast<std::size_t>(next));
  for (std::int32_t& node : connectivity.values) node = number[static_cast<std::size_t>(node)];
  mesh.cells = std::move(connectivity);
  for (Group& group : mesh.node_groups) {
    const auto lost = std::erase_if(group.members, [&](std::int32_t n) { return number[static_cast<std::size_t>(n)] < 0; });
    for (std::int32_t& n : group.members) n = number[static_cast<std::size_t>(n)];
    if (lost > 0 && !group.members.empty()) inform("ORDRE_1", {{"group", group.name}, {"count", std::to_string(lost)}});
    if (lost > 0 && group.members.empty()) inform("ORDRE_2", {{"group", group.name}});
  }
  std::erase_if(mesh.node_groups, [](const Group& group) { return group.members.empty(); });
  return changed;
}

void tell_what_hangs(const Mesh& mesh) {
  const Misfit found = mixed_orders(mesh, mesh.dimension - 1);  // lines in space carry neither volume nor skin
  const auto named = [&](std::int32_t cell) {
    return std::string(mesh.row(static_cast<std::size_t>(cell)).name) + " " + cell_name(cell);
  };
  if (found.count > 0)
    inform("ORDRE_3", {{"count", std::to_string(found.count)}, {"with", named(found.cell)}, {"without", named(found.other)}});
}

}  // namespace lacon
