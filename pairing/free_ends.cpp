#include "lacon/pairing/free_ends.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

constexpr double goes_on = 0.5;  // cosine of the angle between two cells that are one face

}  // namespace

std::vector<std::uint8_t> free_ends(const Surface& skin) {
  struct End {
    std::size_t cell;
    int number;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<End>> cells_at;  // by nodes: of an edge, or twice that of an end
  for (std::size_t cell = 0; cell < skin.size(); ++cell) {
    const auto nodes = skin.nodes[cell];
    const int n = skin.dimension == 2 ? 2 : catalog::cell(skin.types[cell]).n_vertices;
    for (int i = 0; i < n; ++i) {
      const std::int32_t first = nodes[i], second = skin.dimension == 2 ? first : nodes[(i + 1) % n];
      cells_at[std::minmax(first, second)].push_back({cell, i});
    }
  }
  const auto normal = [&](std::size_t cell) { return normal_of(skin.types[cell], skin.nodes[cell], skin.coordinates); };
  std::vector<std::uint8_t> ends(skin.size(), 0);
  for (const auto& [nodes, around] : cells_at)
    if (around.size() != 2 || dot(normal(around[0].cell), normal(around[1].cell)) < goes_on)
      for (const End& end : around) ends[end.cell] |= static_cast<std::uint8_t>(1U << end.number);
  return ends;
}

}  // namespace lacon
