// Bodies that have gone through each other since they were at rest, and are so far behind each other that pairing sees nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/operators/contact/facing.hpp"
#include "lacon/pairing/box_tree.hpp"
#include "lacon/structures/vector.hpp"

// The middle of a slave cell and the corners of masters go straight ways, all at once. Where that middle passes a master from
// its front to its back and stays behind it, or leaves the body where it looks the other way, it has gone through. Motions of
// both bodies together do not change that; a middle that slides over a hill enters and leaves it on one side.

namespace lacon {
namespace {

constexpr double in_front = -0.05;    // of the patch: what lies no deeper touches, as its way begins or ends
constexpr double deep_behind = 1;     // likewise: less is what coarse patches overlap by
constexpr double on_the_edge = 1e-6;  // of barycentric coordinates and of the way
constexpr int halvings = 50;

/// A master, or a part of it with as few corners as the mesh has dimensions, on its way.
struct MovingFacet {
  std::array<Vec3, 3> before, after;
  int n_corners = 0;
  double sense = 1;  ///< of its normal by its corners against that out of the body

  Vec3 corner(int i, double t) const { return (1 - t) * before[i] + t * after[i]; }
  Vec3 normal(double t) const {
    const Vec3 a = corner(0, t), u = corner(1, t) - a;
    const Vec3 n = n_corners == 2 ? Vec3{u.y, -u.x, 0} : cross(u, corner(2, t) - a);
    return sense * n / norm(n);
  }
  double height(Vec3 place, double t) const { return dot(normal(t), place - corner(0, t)); }
  bool holds(Vec3 place, double t) const {
    const Vec3 a = corner(0, t), u = corner(1, t) - a, w = place - a;
    if (n_corners == 2) {
      const double at = dot(w, u) / dot(u, u);
      return at >= -on_the_edge && at <= 1 + on_the_edge;
    }
    const Vec3 v = corner(2, t) - a, n = cross(u, v);
    const double r = dot(cross(w, v), n) / dot(n, n), s = dot(cross(u, w), n) / dot(n, n);
    return r >= -on_the_edge && s >= -on_the_edge && r + s <= 1 + on_the_edge;
  }
};

/// The parts of a cell.
std::vector<MovingFacet> facets_of(const Mesh& mesh, std::int32_t cell, std::span<const double> rest,
                                   std::span<const double> now) {
  const auto nodes = mesh.cells[cell];
  const int n = mesh.row(cell).n_vertices;
  std::vector<MovingFacet> parts;
  for (int last = mesh.dimension - 1; last < n; ++last) {
    MovingFacet& part = parts.emplace_back();
    part.n_corners = mesh.dimension;
    const std::array<int, 3> corners = mesh.dimension == 2 ? std::array{0, last, 0} : std::array{0, last - 1, last};
    for (int i = 0; i < part.n_corners; ++i) {
      const std::size_t at = 3 * static_cast<std::size_t>(nodes[static_cast<std::size_t>(corners[i])]);
      part.before[i] = vector_at(&rest[at]);
      part.after[i] = vector_at(&now[at]);
    }
    if (dot(part.normal(0), facing(mesh, cell, rest).normal) < 0) part.sense = -1;
  }
  return parts;
}

/// Where a middle passes a facet.
struct Passage {
  double at;  ///< of the way, 0 to 1
  bool enters;
  Vec3 normal;
  double depth;  ///< behind the facet when the way ends
};

std::optional<Passage> passage(const MovingFacet& facet, Vec3 from, Vec3 to, double size) {
  const double first = facet.height(from, 0), end = facet.height(to, 1);
  const bool enters = first >= in_front * size && end < 0;
  if (!enters && !(first < 0 && end >= in_front * size)) return std::nullopt;
  const auto place = [&](double t) { return (1 - t) * from + t * to; };
  double low = 0, high = 1;
  for (int i = 0; i < halvings && first * end < 0; ++i) {
    const double middle = 0.5 * (low + high);
    ((facet.height(place(middle), middle) < 0) == (end < 0) ? high : low) = middle;
  }
  const double at = first * end < 0 || enters ? low : high;  // what touches all the time passes as its way begins, or ends
  if (!facet.holds(place(at), at)) return std::nullopt;
  return Passage{.at = at, .enters = enters, .normal = facet.normal(at), .depth = -end};
}

/// How deep a middle lies behind what it has gone through.
std::optional<double> depth_behind(std::vector<Passage>& passages, double size) {
  std::ranges::stable_sort(passages, {}, &Passage::at);
  const auto same = [](const Passage& a, const Passage& b) {  // of two facets with a common edge
    return a.enters == b.enters && b.at - a.at <= on_the_edge;
  };
  passages.erase(std::unique(passages.begin(), passages.end(), same), passages.end());
  std::vector<const Passage*> inside;  // what it has entered and not left yet
  for (const Passage& passage : passages) {
    if (passage.enters) {
      inside.push_back(&passage);
    } else if (!inside.empty()) {
      if (dot(inside.back()->normal, passage.normal) < 0) return inside.back()->depth;
      inside.pop_back();
    }
  }
  if (inside.empty() || inside.front()->depth < deep_behind * size) return std::nullopt;
  return inside.front()->depth;
}

}  // namespace

std::optional<GoneThrough> ContactGeometry::gone_through(std::size_t zone_number) const {
  const Zone& zone = zones_[zone_number];
  const auto middles = [&](std::int32_t slave) {
    const std::int32_t cell = contact_.slaves[slave].cell;
    return std::array{facing(mesh_, cell, rest_).place, facing(mesh_, cell, coordinates_).place};
  };
  const auto farthest_motion = [&](std::span<const std::int32_t> cells, const auto& cell_of) {
    double most = 0;
    for (const std::int32_t cell : cells)
      for (const std::int32_t node : mesh_.cells[cell_of(cell)]) {
        const std::size_t at = 3 * static_cast<std::size_t>(node);
        most = std::max(most, norm(vector_at(&coordinates_[at]) - vector_at(&rest_[at])));
      }
    return most;
  };
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::int32_t slave : zone.slaves) smallest = std::min(smallest, size_[contact_.slaves[slave].patch]);
  const auto itself = [](std::int32_t cell) { return cell; };
  const auto of_slave = [&](std::int32_t slave) { return contact_.slaves[slave].cell; };
  if (farthest_motion(zone.slaves, of_slave) + farthest_motion(zone.masters, itself) < smallest) return std::nullopt;

  std::vector<MovingFacet> facets;
  std::vector<Box<3>> boxes;
  for (const std::int32_t master : zone.masters)
    for (const MovingFacet& facet : facets_of(mesh_, master, rest_, coordinates_)) {
      facets.push_back(facet);
      boxes.push_back(Box<3>::empty());
      for (int i = 0; i < facet.n_corners; ++i)
        for (const Vec3& corner : {facet.before[i], facet.after[i]})
          boxes.back().add(std::array{corner.x, corner.y, corner.z}.data());
    }
  const BoxTree<3> tree(std::move(boxes));
  std::optional<GoneThrough> deepest;
  for (const std::int32_t slave : zone.slaves) {
    const auto [from, to] = middles(slave);
    const double size = size_[contact_.slaves[slave].patch];
    Box<3> way = Box<3>::empty();
    for (const Vec3& end : {from, to}) way.add(std::array{end.x, end.y, end.z}.data());
    for (int d = 0; d < 3; ++d) way.low[d] -= -in_front * size, way.high[d] += -in_front * size;
    std::vector<Passage> passages;
    tree.visit(
        [&](const Box<3>& box) {
          for (int d = 0; d < 3; ++d)
            if (box.low[d] > way.high[d] || box.high[d] < way.low[d]) return false;
          return true;
        },
        [&](std::int32_t facet) {
          if (const auto found = passage(facets[facet], from, to, size)) passages.push_back(*found);
        });
    const auto depth = depth_behind(passages, size);
    if (depth && (!deepest || *depth / size > deepest->sizes)) deepest = {contact_.slaves[slave].cell, *depth / size};
  }
  return deepest;
}

}  // namespace lacon
