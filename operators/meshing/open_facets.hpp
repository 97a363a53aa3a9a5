#pragma once
// Facets of body cells that no second cell has.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

struct OpenFacet {
  std::array<std::int32_t, 4> vertices;  ///< ascending, each once; -1 behind the last
  std::int32_t cell;
  std::int32_t facet;  ///< index into CellRow::facets

  std::size_t n_vertices() const { return vertices[2] < 0 ? 2 : vertices[3] < 0 ? 3 : 4; }
};

/// The distinct vertices of a facet, as OpenFacet has them. @param nodes of the facet, vertices first
std::array<std::int32_t, 4> distinct_vertices(std::span<const std::int32_t> vertices);

/// The facets of cells of this dimension that exactly one cell that counts has, ascending by vertices. Linear in the number of
/// cells. @param counts by cell; empty: all of them
std::vector<OpenFacet> open_facets(const Mesh& mesh, int dimension, std::span<const char> counts = {});

}  // namespace lacon
