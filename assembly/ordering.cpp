#include "lacon/assembly/ordering.hpp"

#include <metis.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

#include "lacon/assembly/counts.hpp"

namespace lacon {

std::vector<std::int32_t> elimination_order(const VertexGraph& of) {
  const Numbering& numbering = of.numbering;
  const Ragged<std::int32_t>& graph = of.neighbours;
  const std::int64_t n_vertices = numbering.n_vertices();

  // vertices that have equations, numbered without gaps: METIS must not see the others
  std::vector<idx_t> compact(n_vertices, -1);
  std::vector<std::int32_t> vertices;
  for (std::int32_t v = 0; v < n_vertices; ++v)
    if (numbering.first[v + 1] > numbering.first[v]) {
      compact[v] = static_cast<idx_t>(vertices.size());
      vertices.push_back(v);
    }
  idx_t n = static_cast<idx_t>(vertices.size());
  std::vector<idx_t> offset{0}, adjacent;
  for (const std::int32_t v : vertices) {
    for (const std::int32_t w : graph[v])
      if (compact[w] >= 0) adjacent.push_back(compact[w]);
    offset.push_back(narrow_count<idx_t>(std::ssize(adjacent), "counted_neighbours"));
  }
  std::vector<idx_t> place(n), inverse(n);
  std::iota(place.begin(), place.end(), 0);
  if (!adjacent.empty()) {
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;  // the same bits in every run
    if (const int status = METIS_NodeND(&n, offset.data(), adjacent.data(), nullptr, options, inverse.data(), place.data());
        status != METIS_OK)
      throw std::runtime_error("METIS_NodeND returned " + std::to_string(status));
  }

  // (place, 1 behind it for a moved multiplier) sorts the vertices
  std::vector<std::pair<idx_t, bool>> key(n);
  for (idx_t i = 0; i < n; ++i) {
    key[i] = {place[i], false};
    if (vertices[i] < numbering.n_nodes) continue;
    for (idx_t k = offset[i]; k < offset[i + 1]; ++k)
      if (place[adjacent[k]] > key[i].first) key[i] = {place[adjacent[k]], true};
  }
  std::vector<idx_t> sorted(n);
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&](idx_t a, idx_t b) { return key[a] < key[b]; });

  std::vector<std::int32_t> order(numbering.n_equations());
  std::int32_t next = 0;
  for (const idx_t i : sorted)
    for (std::int64_t e = numbering.first[vertices[i]]; e < numbering.first[vertices[i] + 1]; ++e) order[e] = next++;
  return order;
}

}  // namespace lacon
