#include "lacon/operators/contact/mirrors.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "lacon/catalog/cells.hpp"
#include "lacon/pairing/skin_facet.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

constexpr double in_plane = 1e-9;                 // of the extent: mesh files have about ten digits
constexpr double parallel = 1e-9;                 // sine of an angle
constexpr double shallow = 0.1;                   // of an edge: depth of a cell that hardly leaves the plane of its edge
constexpr double still_aligned = space::hem / 2;  // of a cell: half of what outlines go on by
constexpr double still_flush = 1e-3;              // likewise, of faces that are free to slide past each other

struct BorderEdge {
  std::int32_t cell;
  int edge;
  std::vector<std::int32_t> nodes;
};

/// Edges of one cell alone.
std::vector<BorderEdge> border_of(const Surface& skin) {
  std::vector<BorderEdge> border;
  const std::vector<std::array<std::int32_t, 4>> neighbours = edge_neighbours(skin);
  for (std::size_t c = 0; c < skin.size(); ++c) {
    const catalog::CellRow& row = catalog::cell(skin.types[c]);
    const auto nodes = skin.nodes[c];
    const int n = row.n_vertices;
    for (int i = 0; i < n; ++i) {
      if (neighbours[c][static_cast<std::size_t>(i)] >= 0) continue;
      BorderEdge& edge = border.emplace_back(BorderEdge{static_cast<std::int32_t>(c), i, {nodes[i], nodes[(i + 1) % n]}});
      if (row.order > 1) edge.nodes.push_back(nodes[n + i]);
    }
  }
  return border;
}

Vec3 place_of(std::int32_t node, const Surface& skin) {
  return vector_at(skin.coordinates.data() + 3 * static_cast<std::size_t>(node));
}

/// How far a skin reaches along a direction.
double reach(const Surface& skin, Vec3 along) {
  double most = -INFINITY;
  for (std::size_t c = 0; c < skin.size(); ++c)
    for (const std::int32_t node : skin.nodes[c]) most = std::max(most, dot(along, place_of(node, skin)));
  return most;
}

double length_of(const BorderEdge& edge, const Surface& skin) {
  return norm(place_of(edge.nodes[1], skin) - place_of(edge.nodes[0], skin));
}

/// Whether both ends of an edge lie on others.
bool lies_on(const BorderEdge& edge, std::span<const BorderEdge> others, const Surface& skin) {
  constexpr double close = 1e-6;  // of its length
  const auto at = [&](std::int32_t node) { return place_of(node, skin); };
  const double length = length_of(edge, skin);
  const auto meets = [&](std::int32_t node) {
    return std::ranges::any_of(others, [&](const BorderEdge& other) {
      const Vec3 along = at(other.nodes[1]) - at(other.nodes[0]), to = at(node) - at(other.nodes[0]);
      const double part = std::clamp(dot(to, along) / dot(along, along), 0.0, 1.0);
      return norm(to - part * along) <= close * length;
    });
  };
  return meets(edge.nodes[0]) && meets(edge.nodes[1]);
}

/// In which directions nodes are held.
class Held {
 public:
  explicit Held(std::span<const HeldDirection> held) {
    for (const HeldDirection& one : held) of_[one.node].push_back(one.along);
  }
  bool along(Vec3 direction, std::int32_t node) const {
    const auto found = of_.find(node);
    return found != of_.end() &&
           std::ranges::any_of(found->second, [&](Vec3 one) { return norm(cross(one, direction)) <= parallel; });
  }
  /// The axes, and the other directions, in both senses, that all nodes of some edge are held in.
  std::vector<Vec3> normals(std::span<const BorderEdge> edges) const {
    std::vector<Vec3> found = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    for (const BorderEdge& edge : edges)
      if (const auto first = of_.find(edge.nodes[0]); first != of_.end())
        for (const Vec3 one : first->second)
          if (std::ranges::all_of(edge.nodes, [&](std::int32_t node) { return along(one, node); }) &&
              std::ranges::none_of(found, [&](Vec3 other) { return norm(cross(one, other)) <= parallel; }))
            found.insert(found.end(), {-1.0 * one, one});
    return found;
  }

 private:
  std::map<std::int32_t, std::vector<Vec3>> of_;
};

/// Edges of planes that are where the slave ends. @param tolerance of their cells
std::vector<std::uint8_t> aligned(std::span<const EndPlane> planes, std::vector<std::pair<std::int32_t, int>> EndPlane::*edges,
                                  double tolerance, const Surface& master, std::span<const double> coordinates) {
  std::vector<std::uint8_t> found;
  const auto at = [&](std::int32_t node) { return vector_at(coordinates.data() + 3 * static_cast<std::size_t>(node)); };
  for (const EndPlane& plane : planes)
    for (const auto& [cell, edge] : plane.*edges) {
      const auto nodes = master.nodes[static_cast<std::size_t>(cell)];
      const int n = catalog::cell(master.types[static_cast<std::size_t>(cell)]).n_vertices;
      double low = INFINITY, high = -INFINITY;  // of the cell, along the normal
      for (const std::int32_t node : nodes) {
        low = std::min(low, dot(plane.normal, at(node)));
        high = std::max(high, dot(plane.normal, at(node)));
      }
      const Vec3 middle = 0.5 * (at(nodes[edge]) + at(nodes[(edge + 1) % n]));
      const std::int32_t nearest =
          *std::ranges::min_element(plane.slave, {}, [&](std::int32_t node) { return norm(at(node) - middle); });
      if (!(std::abs(dot(plane.normal, at(nearest) - middle)) <= tolerance * (high - low))) continue;
      found.resize(master.size(), 0);
      found[static_cast<std::size_t>(cell)] |= static_cast<std::uint8_t>(1U << edge);
    }
  return found;
}

}  // namespace

std::vector<std::array<std::int32_t, 4>> edge_neighbours(const Surface& skin) {
  if (skin.dimension != 3) return {};
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::int32_t>> around;  // cells of each edge
  const auto for_edges = [&](const auto& visit) {
    for (std::size_t c = 0; c < skin.size(); ++c) {
      const auto nodes = skin.nodes[c];
      const auto n = static_cast<std::size_t>(catalog::cell(skin.types[c]).n_vertices);
      for (std::size_t i = 0; i < n; ++i)
        visit(static_cast<std::int32_t>(c), i, around[std::minmax(nodes[i], nodes[(i + 1) % n])]);
    }
  };
  for_edges([](std::int32_t cell, std::size_t, std::vector<std::int32_t>& cells) { cells.push_back(cell); });
  std::vector<std::array<std::int32_t, 4>> neighbours(skin.size(), {-1, -1, -1, -1});
  for_edges([&](std::int32_t cell, std::size_t i, const std::vector<std::int32_t>& cells) {
    for (const std::int32_t other : cells)
      if (other != cell) neighbours[static_cast<std::size_t>(cell)][i] = other;
  });
  return neighbours;
}

std::vector<EndPlane> end_planes(const Surface& slave, const Surface& master, std::span<const HeldDirection> held) {
  std::vector<EndPlane> planes;
  if (slave.dimension != 3) return planes;
  const std::vector<BorderEdge> of_slave = border_of(slave), of_master = border_of(master);
  const Held holds(held);
  for (const Vec3 normal : holds.normals(of_master)) {
    const double place = reach(master, normal);
    const double close = in_plane * std::max(std::abs(place), std::abs(reach(master, -1.0 * normal)));
    if (!(std::abs(place - reach(slave, normal)) <= close)) continue;
    EndPlane plane{.normal = normal, .slave = {}, .ends = {}, .flush = {}};
    const auto beside = [&](std::int32_t node) { return place - dot(normal, place_of(node, master)); };
    // a cell that lies in the plane does not end there
    const auto ends_there = [&](const BorderEdge& edge, const Surface& skin) {
      const auto cell = skin.nodes[static_cast<std::size_t>(edge.cell)];
      const double depth = beside(*std::ranges::max_element(cell, {}, beside));
      return depth > shallow * length_of(edge, skin) &&
             std::ranges::all_of(edge.nodes, [&](std::int32_t node) { return std::abs(beside(node)) <= close; });
    };
    std::vector<BorderEdge> at_slave;
    for (const BorderEdge& edge : of_slave)
      if (ends_there(edge, slave)) {
        plane.slave.insert(plane.slave.end(), edge.nodes.begin(), edge.nodes.end());
        at_slave.push_back(edge);
      }
    const auto is_held = [&](std::int32_t node) { return holds.along(normal, node); };
    const bool slave_is_held = std::ranges::all_of(plane.slave, is_held);
    for (const BorderEdge& edge : of_master) {
      if (!ends_there(edge, master)) continue;
      const bool held_there = slave_is_held && std::ranges::all_of(edge.nodes, is_held);
      (held_there || !lies_on(edge, at_slave, master) ? plane.ends : plane.flush).emplace_back(edge.cell, edge.edge);
    }
    if (!plane.slave.empty() && !(plane.ends.empty() && plane.flush.empty())) planes.push_back(std::move(plane));
  }
  return planes;
}

std::vector<std::uint8_t> mirrored_edges(std::span<const EndPlane> planes, const Surface& master,
                                         std::span<const double> coordinates) {
  return aligned(planes, &EndPlane::ends, still_aligned, master, coordinates);
}

std::vector<std::uint8_t> flush_edges(std::span<const EndPlane> planes, const Surface& master,
                                      std::span<const double> coordinates) {
  return aligned(planes, &EndPlane::flush, still_flush, master, coordinates);
}

}  // namespace lacon
