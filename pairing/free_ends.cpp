#include "lacon/pairing/free_ends.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

constexpr double free_turn = 0.5;   // cosine of the angle between two cells from which on their ends are free
constexpr double face_turn = 0.77;  // likewise, from which on they are two faces: of a chamfer, not of a round that is coarse

struct End {
  std::size_t cell;
  int number;
};

/// Of a skin: the cells at each edge, in the plane at each node, and the cosine of the angle between them; -1 where they are
/// not two.
template <class Visit>
void for_ends(const Surface& skin, const Visit& visit) {
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
  for (const auto& [nodes, around] : cells_at)
    visit(around, around.size() == 2 ? dot(normal(around[0].cell), normal(around[1].cell)) : -1);
}

}  // namespace

std::vector<std::uint8_t> free_ends(const Surface& skin) {
  std::vector<std::uint8_t> ends(skin.size(), 0);
  for_ends(skin, [&](const std::vector<End>& around, double cosine) {
    if (cosine < free_turn)
      for (const End& end : around) ends[end.cell] |= static_cast<std::uint8_t>(1U << end.number);
  });
  return ends;
}

std::vector<std::int32_t> faces(const Surface& skin) {
  std::vector<std::int32_t> first(skin.size());
  std::iota(first.begin(), first.end(), 0);
  const auto of = [&](std::size_t cell) {
    while (first[cell] != static_cast<std::int32_t>(cell)) {
      first[cell] = first[static_cast<std::size_t>(first[cell])];
      cell = static_cast<std::size_t>(first[cell]);
    }
    return static_cast<std::int32_t>(cell);
  };
  for_ends(skin, [&](const std::vector<End>& around, double cosine) {
    if (cosine < face_turn) return;
    const std::int32_t one = of(around[0].cell), other = of(around[1].cell);
    first[static_cast<std::size_t>(std::max(one, other))] = std::min(one, other);
  });
  for (std::size_t cell = 0; cell < skin.size(); ++cell) first[cell] = of(cell);
  return first;
}

}  // namespace lacon
