#include "lacon/operators/meshing/open_facets.hpp"

#include <algorithm>

namespace lacon {
namespace {

/// The vertices of the facets of a kind of cell, four each: where there are fewer, `none`, a place behind the cell's vertices.
struct FacetTable {
  static constexpr std::int8_t none = 8;
  explicit FacetTable(const catalog::CellRow& row) : n_facets(row.facets.size()) {
    for (std::size_t f = 0; f < n_facets; ++f) {
      vertices[f].fill(none);
      std::copy_n(row.facets[f].nodes.begin(), catalog::cell(row.facets[f].type).n_vertices, vertices[f].begin());
    }
  }
  std::size_t n_facets;
  std::array<std::array<std::int8_t, 4>, 6> vertices;
};

/// Call use(cell, its facets, its vertices) for the cells of a dimension that count.
template <class Use>
void for_each_cell(const Mesh& mesh, int dimension, std::span<const char> counts, const Use& use) {
  for_each_run(mesh, [&](const catalog::CellRow& row, std::size_t first, std::size_t n_cells) {
    if (row.dimension != dimension) return;
    const FacetTable table(row);
    const auto n_nodes = static_cast<std::size_t>(row.n_nodes), n_vertices = static_cast<std::size_t>(row.n_vertices);
    const std::int32_t* nodes = mesh.cells[first].data();
    for (std::size_t c = first; c < first + n_cells; ++c, nodes += n_nodes)
      if (counts.empty() || counts[c]) use(c, table, std::span(nodes, n_vertices));
  });
}

/// A number of 64 bits that looks drawn by lot.
std::uint64_t scattered(std::uint64_t value) {
  value = (value + 1) * 0x9E3779B97F4A7C15u;
  return value ^ (value >> 29);
}

/// Nodes around which some facet has one cell alone. Each facet has a number of its vertices, whatever their order, and each
/// node keeps the sum of those around it, without carry: what two cells have falls out again.
std::vector<char> open_nodes(const Mesh& mesh, int dimension, std::span<const char> counts) {
  std::vector<std::uint64_t> sum(mesh.n_nodes());
  for_each_cell(mesh, dimension, counts, [&](std::size_t, const FacetTable& table, std::span<const std::int32_t> nodes) {
    std::array<std::uint64_t, 9> number{}, own{};
    for (std::size_t j = 0; j < nodes.size(); ++j) number[j] = scattered(static_cast<std::uint64_t>(nodes[j]));
    for (std::size_t f = 0; f < table.n_facets; ++f) {
      const auto [a, b, c, d] = table.vertices[f];
      const std::uint64_t facet = scattered(number[a] + number[b] + number[c] + number[d]);
      own[a] ^= facet;
      own[b] ^= facet;
      own[c] ^= facet;
      own[d] ^= facet;
    }
    for (std::size_t j = 0; j < nodes.size(); ++j) sum[static_cast<std::size_t>(nodes[j])] ^= own[j];
  });
  std::vector<char> open(mesh.n_nodes());
  std::ranges::transform(sum, open.begin(), [](std::uint64_t s) { return static_cast<char>(s != 0); });
  return open;
}

}  // namespace

std::array<std::int32_t, 4> distinct_vertices(std::span<const std::int32_t> vertices) {
  std::array<std::int32_t, 4> distinct;
  distinct.fill(-1);
  std::size_t n = 0;
  for (const std::int32_t vertex : vertices) {
    std::size_t at = n;
    while (at > 0 && distinct[at - 1] > vertex) --at;
    if (at > 0 && distinct[at - 1] == vertex) continue;
    for (std::size_t i = n++; i > at; --i) distinct[i] = distinct[i - 1];
    distinct[at] = vertex;
  }
  return distinct;
}

std::vector<OpenFacet> open_facets(const Mesh& mesh, int dimension, std::span<const char> counts) {
  const std::vector<char> open = open_nodes(mesh, dimension, counts);
  std::vector<OpenFacet> facets;
  for_each_cell(mesh, dimension, counts, [&](std::size_t cell, const FacetTable& table, std::span<const std::int32_t> nodes) {
    int n_open = 0;
    for (const std::int32_t node : nodes) n_open += open[static_cast<std::size_t>(node)];
    if (n_open < dimension) return;
    for (std::size_t f = 0; f < table.n_facets; ++f) {
      std::array<std::int32_t, 4> vertices;
      std::size_t n = 0;
      bool all_open = true;
      for (const std::int8_t v : table.vertices[f])
        if (v != FacetTable::none) {
          vertices[n++] = nodes[static_cast<std::size_t>(v)];
          all_open = all_open && open[static_cast<std::size_t>(vertices[n - 1])];
        }
      if (!all_open) continue;
      const OpenFacet facet{distinct_vertices(std::span(vertices).first(n)), static_cast<std::int32_t>(cell),
                            static_cast<std::int32_t>(f)};
      if (facet.vertices[static_cast<std::size_t>(dimension) - 1] >= 0) facets.push_back(facet);  // no facet drawn to less
    }
  });
  std::ranges::sort(facets, {}, [](const OpenFacet& f) { return std::pair(f.vertices, f.cell); });
  // the facets of several cells stand side by side now
  std::size_t kept = 0;
  for (std::size_t i = 0, end = 0; i < facets.size(); i = end) {
    while (end < facets.size() && facets[end].vertices == facets[i].vertices) ++end;
    if (end == i + 1) facets[kept++] = facets[i];
  }
  facets.resize(kept);
  return facets;
}

}  // namespace lacon
