#pragma once
#include <cstdint>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon::test {

/// Numbers of a block of n^3 HEXA8 with edges of 1, x first.
struct HexaBlock {
  std::int32_t n;

  std::int32_t node(std::int32_t x, std::int32_t y, std::int32_t z) const { return (z * (n + 1) + y) * (n + 1) + x; }
  std::int32_t cell(std::int32_t x, std::int32_t y, std::int32_t z) const { return (z * n + y) * n + x; }
  /// Its nodes and cells, into an empty mesh.
  void add_to(Mesh& mesh) const {
    for (std::int32_t i = 0; i < (n + 1) * (n + 1) * (n + 1); ++i)
      for (const std::int32_t at : {i % (n + 1), i / (n + 1) % (n + 1), i / (n + 1) / (n + 1)}) mesh.coordinates.push_back(at);
    for (std::int32_t z = 0; z < n; ++z)
      for (std::int32_t y = 0; y < n; ++y)
        for (std::int32_t x = 0; x < n; ++x) {
          std::vector<std::int32_t> nodes;
          for (const std::int32_t up : {z, z + 1})
            nodes.insert(nodes.end(), {node(x, y, up), node(x + 1, y, up), node(x + 1, y + 1, up), node(x, y + 1, up)});
          mesh.add_cell(CellType::HEXA8, nodes);
        }
  }
};

}  // namespace lacon::test
