#include "lacon/assembly/parts/partition.hpp"

#include <metis.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "lacon/assembly/counts.hpp"
#include "lacon/assembly/metis_status.hpp"

namespace lacon {
namespace {

/// The cells around each node, as places in `cells`.
Ragged<std::int32_t> cells_at_nodes(const Mesh& mesh, std::span<const std::int32_t> cells) {
  Ragged<std::int32_t> at;
  at.offset.assign(mesh.n_nodes() + 1, 0);
  for (const std::int32_t cell : cells)
    for (const std::int32_t node : mesh.cells[cell]) ++at.offset[node + 1];
  std::partial_sum(at.offset.begin(), at.offset.end(), at.offset.begin());
  at.values.resize(at.offset.back());
  std::vector<std::int64_t> next(at.offset.begin(), at.offset.end() - 1);
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (const std::int32_t node : mesh.cells[cells[i]]) at.values[next[node]++] = static_cast<std::int32_t>(i);
  return at;
}

/// A number of each cell's group, 0 to the number of groups: cells below one patch are one group, any other is its own.
std::vector<idx_t> groups_of(const Mesh& mesh, std::span<const std::int32_t> cells, const Ragged<std::int32_t>& at) {
  std::vector<std::int32_t> lowest(cells.size());
  std::iota(lowest.begin(), lowest.end(), 0);
  const auto root = [&](std::int32_t i) {
    while (lowest[i] != i) i = lowest[i] = lowest[lowest[i]];
    return i;
  };
  for (std::size_t p = 0; mesh.patches && p < mesh.patches->size(); ++p) {
    std::int32_t first = -1;
    for (const std::int32_t slave : mesh.patches->cells[p]) {
      const auto corners = mesh.cells[slave];
      for (const std::int32_t bearer : at[corners[0]]) {
        const auto nodes = mesh.cells[cells[bearer]];
        const auto has = [&](std::int32_t node) { return std::ranges::find(nodes, node) != nodes.end(); };
        if (!std::ranges::all_of(corners, has)) continue;
        if (first < 0) first = bearer;
        const std::int32_t a = root(first), b = root(bearer);
        lowest[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  std::vector<idx_t> group(cells.size());
  idx_t n_groups = 0;
  for (std::int32_t i = 0; i < std::ssize(lowest); ++i) group[i] = root(i) == i ? n_groups++ : group[root(i)];
  return group;
}

/// Groups beside each other, and by how many faces.
struct Graph {
  std::vector<idx_t> offset{0}, neighbour, faces;
};

Graph graph_of(const Mesh& mesh, std::span<const std::int32_t> cells, std::span<const idx_t> group, idx_t n_groups) {
  std::vector<idx_t> first{0}, nodes;
  for (const std::int32_t cell : cells) {
    nodes.insert(nodes.end(), mesh.cells[cell].begin(), mesh.cells[cell].end());
    first.push_back(narrow_count<idx_t>(std::ssize(nodes), "counted_corners"));
  }
  auto n_cells = static_cast<idx_t>(cells.size()), n_nodes = static_cast<idx_t>(mesh.n_nodes());
  idx_t common = mesh.dimension, base = 0, *offset = nullptr, *adjacent = nullptr;
  check_metis(METIS_MeshToDual(&n_cells, &n_nodes, first.data(), nodes.data(), &common, &base, &offset, &adjacent),
              "METIS_MeshToDual");
  std::vector<std::vector<idx_t>> members(static_cast<std::size_t>(n_groups));
  for (idx_t i = 0; i < n_cells; ++i) members[group[i]].push_back(i);
  Graph graph;
  for (idx_t g = 0; g < n_groups; ++g) {
    std::map<idx_t, idx_t> beside;
    for (const idx_t i : members[g])
      for (idx_t k = offset[i]; k < offset[i + 1]; ++k)
        if (const idx_t other = group[adjacent[k]]; other != g) ++beside[other];
    for (const auto& [other, count] : beside) {
      graph.neighbour.push_back(other);
      graph.faces.push_back(count);
    }
    graph.offset.push_back(static_cast<idx_t>(graph.neighbour.size()));
  }
  METIS_Free(offset);
  METIS_Free(adjacent);
  return graph;
}

}  // namespace

Partition partition(const Mesh& mesh, std::span<const std::int32_t> cells, std::span<const std::int32_t> weight, int n_parts) {
  Partition made{.n_parts = n_parts,
                 .of_cell = std::vector<std::int32_t>(cells.size(), 0),
                 .of_node = std::vector<std::int32_t>(mesh.n_nodes(), 0)};
  if (n_parts == 1 || cells.empty()) return made;
  const Ragged<std::int32_t> at = cells_at_nodes(mesh, cells);
  const std::vector<idx_t> group = groups_of(mesh, cells, at);
  idx_t n_groups = 1 + *std::ranges::max_element(group), constraints = 1, parts = n_parts, cut = 0;
  Graph graph = graph_of(mesh, cells, group, n_groups);
  std::vector<idx_t> weights(static_cast<std::size_t>(n_groups), 0), part(static_cast<std::size_t>(n_groups), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) weights[group[i]] += weight[i];
  if (n_groups <= parts) {
    std::iota(part.begin(), part.end(), 0);
  } else {
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;  // the same parts in every run
    check_metis(METIS_PartGraphRecursive(&n_groups, &constraints, graph.offset.data(), graph.neighbour.data(), weights.data(),
                                         nullptr, graph.faces.data(), &parts, nullptr, nullptr, options, &cut, part.data()),
                "METIS_PartGraphRecursive");
  }
  for (std::size_t i = 0; i < cells.size(); ++i) made.of_cell[i] = static_cast<std::int32_t>(part[group[i]]);

  std::vector<std::int32_t> count(static_cast<std::size_t>(n_parts));
  for (std::size_t node = 0; node < mesh.n_nodes(); ++node) {
    std::ranges::fill(count, 0);
    for (const std::int32_t i : at[node]) ++count[made.of_cell[i]];
    made.of_node[node] = static_cast<std::int32_t>(std::ranges::max_element(count) - count.begin());
  }
  return made;
}

}  // namespace lacon
