#include "lacon/pairing/free_ends.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "lacon/pairing/normals.hpp"
#include "lacon/pairing/pairing.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

struct End {
  std::size_t cell;
  int number;
};

/// What two cells do at an edge, in the plane at a node, that they share.
struct Fold {
  double cosine = -1;  ///< of the angle between them; -1 where they are not two
  bool convex = true;  ///< they turn away from what is in front of them
};

/// The cells at each edge of a skin, in the plane at each node, and their fold.
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
  // curved cells that go on smoothly do so there, whatever their chords do
  const auto normal = [&](const End& end) {
    const CellType type = skin.types[end.cell];
    const catalog::CellRow& row = catalog::cell(type);
    std::vector<double> points;
    for (const std::int32_t node : skin.nodes[end.cell]) {
      const auto place = skin.coordinates.subspan(3 * static_cast<std::size_t>(node), 3);
      points.insert(points.end(), place.begin(), place.end());
    }
    std::array<double, 2> at{};  // in reference coordinates: the end, in space the middle of the edge
    for (int d = 0; d < row.dimension; ++d) {
      const auto of = [&](int vertex) { return row.nodes[static_cast<std::size_t>(vertex * row.dimension + d)]; };
      at[static_cast<std::size_t>(d)] =
          skin.dimension == 2 ? of(end.number) : 0.5 * (of(end.number) + of((end.number + 1) % row.n_vertices));
    }
    const Vec3 found = cell_normal(type, points, std::span(at).first(static_cast<std::size_t>(row.dimension)));
    return norm(found) > 0 ? found / norm(found) : Vec3{};
  };
  const auto at = [&](std::int32_t node) { return vector_at(skin.coordinates.data() + 3 * std::ptrdiff_t{node}); };
  const auto middle = [&](std::size_t cell) { return middle_of(skin.nodes[cell], skin.coordinates); };
  const auto fold = [&](const std::pair<std::int32_t, std::int32_t>& nodes, const End& one, const End& other) {
    const Vec3 n = normal(one), m = normal(other), place = 0.5 * (at(nodes.first) + at(nodes.second));
    return Fold{dot(n, m), dot(n, middle(other.cell) - place) + dot(m, middle(one.cell) - place) < 0};
  };
  for (const auto& [nodes, around] : cells_at) visit(around, around.size() == 2 ? fold(nodes, around[0], around[1]) : Fold());
}

}  // namespace

std::vector<std::uint8_t> free_ends(const Surface& skin) {
  std::vector<std::uint8_t> ends(skin.size(), 0);
  for_ends(skin, [&](const std::vector<End>& around, const Fold& fold) {
    if (fold.cosine < wall_cosine)
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
  for_ends(skin, [&](const std::vector<End>& around, const Fold& fold) {
    if (fold.convex && fold.cosine < wall_cosine) return;
    const std::int32_t one = of(around[0].cell), other = of(around[1].cell);
    first[static_cast<std::size_t>(std::max(one, other))] = std::min(one, other);
  });
  for (std::size_t cell = 0; cell < skin.size(); ++cell) first[cell] = of(cell);
  return first;
}

}  // namespace lacon
