#include "lacon/operators/contact/mirrors.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "lacon/catalog/cells.hpp"

namespace lacon {
namespace {

constexpr double in_plane = 1e-9;  // of the extent: mesh files have about ten digits

struct BorderEdge {
  std::int32_t cell;
  int edge;
  std::vector<std::int32_t> nodes;
};

/// Edges of one cell alone.
std::vector<BorderEdge> border_of(const Surface& skin) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> cells_at;
  std::vector<BorderEdge> edges, border;
  const auto ends = [](const BorderEdge& edge) { return std::minmax(edge.nodes[0], edge.nodes[1]); };
  for (std::size_t c = 0; c < skin.size(); ++c) {
    const catalog::CellRow& row = catalog::cell(skin.types[c]);
    const auto nodes = skin.nodes[c];
    const int n = row.n_vertices;
    for (int i = 0; i < n; ++i) {
      BorderEdge& edge = edges.emplace_back(BorderEdge{static_cast<std::int32_t>(c), i, {nodes[i], nodes[(i + 1) % n]}});
      if (row.order > 1) edge.nodes.push_back(nodes[n + i]);
      ++cells_at[ends(edge)];
    }
  }
  for (BorderEdge& edge : edges)
    if (cells_at[ends(edge)] == 1) border.push_back(std::move(edge));
  return border;
}

double coordinate(std::span<const double> coordinates, std::int32_t node, int axis) {
  return coordinates[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(axis)];
}

/// How far a skin reaches along an axis, in the sense of `sign`.
double reach(const Surface& skin, int axis, int sign) {
  double most = -INFINITY;
  for (std::size_t c = 0; c < skin.size(); ++c)
    for (const std::int32_t node : skin.nodes[c]) most = std::max(most, sign * coordinate(skin.coordinates, node, axis));
  return most;
}

}  // namespace

std::vector<MirrorPlane> mirror_planes(const Surface& slave, const Surface& master, std::span<const std::uint8_t> free) {
  std::vector<MirrorPlane> planes;
  if (slave.dimension != 3) return planes;
  const std::vector<BorderEdge> of_slave = border_of(slave), of_master = border_of(master);
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {-1, 1}) {
      const double place = reach(master, axis, sign), other = reach(slave, axis, sign);
      const double close = in_plane * std::max(std::abs(reach(master, axis, 1)), std::abs(reach(master, axis, -1)));
      if (!(std::abs(place - other) <= close)) continue;
      MirrorPlane plane{.axis = axis, .close = close, .nodes = {}, .ends = {}};
      const auto ends_there = [&](const BorderEdge& edge) {
        return std::ranges::all_of(edge.nodes, [&](std::int32_t node) {
          return std::abs(sign * coordinate(master.coordinates, node, axis) - place) <= close &&
                 free[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(axis)] == 0;
        });
      };
      bool slave_ends = false;
      for (const BorderEdge& edge : of_slave)
        if (ends_there(edge)) {
          slave_ends = true;
          plane.nodes.insert(plane.nodes.end(), edge.nodes.begin(), edge.nodes.end());
        }
      for (const BorderEdge& edge : of_master)
        if (ends_there(edge)) {
          plane.ends.emplace_back(edge.cell, edge.edge);
          plane.nodes.insert(plane.nodes.end(), edge.nodes.begin(), edge.nodes.end());
        }
      if (slave_ends && !plane.ends.empty()) planes.push_back(std::move(plane));
    }
  return planes;
}

std::vector<std::uint8_t> mirrored_edges(std::span<const MirrorPlane> planes, std::span<const double> coordinates,
                                         std::size_t n_cells) {
  std::vector<std::uint8_t> mirrored;
  for (const MirrorPlane& plane : planes) {
    const double place = coordinate(coordinates, plane.nodes[0], plane.axis);
    const bool stays = std::ranges::all_of(plane.nodes, [&](std::int32_t node) {
      return std::abs(coordinate(coordinates, node, plane.axis) - place) <= plane.close;
    });
    if (!stays) continue;
    mirrored.resize(n_cells, 0);
    for (const auto& [cell, edge] : plane.ends)
      mirrored[static_cast<std::size_t>(cell)] |= static_cast<std::uint8_t>(1U << edge);
  }
  return mirrored;
}

}  // namespace lacon
