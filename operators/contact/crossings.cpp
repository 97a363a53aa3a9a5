// Bodies that have gone through each other since they were at rest, and are so far behind each other that pairing sees nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/operators/contact/facing.hpp"
#include "lacon/pairing/box_tree.hpp"
#include "lacon/structures/vector.hpp"

// The middle of a slave cell and the corners of masters go straight ways, all at once. A middle has gone through where it
// passes a master from its front to its back and ends deep behind it: deeper than coarse patches, facets of curved cells and
// offsets let bodies overlap. That is where the nearest master has it behind its face, where it has left the body on the far
// side, through a master that looks the other way, or where it came from afar, was inside and has passed no other master.
// Bodies that slide along, off or onto each other, however far, do none of it.

namespace lacon {
namespace {

constexpr double touching = 0.05;     // of the patch: what lies no deeper is in front as its way begins
constexpr double on_the_edge = 1e-6;  // of barycentric coordinates
constexpr double other_way = -0.5;    // cosine between normals of near and far side
constexpr double within = 0.2;        // of the way between them, or of the patch: how far inside a middle lies
constexpr int halvings = 50;

/// A master, or a part of it with as few corners as the mesh has dimensions, on its way.
struct MovingFacet {
  std::array<Vec3, 3> before, after;
  int n_corners = 0;
  double sense = 1;   ///< of its normal by its corners against that out of the body
  double extent = 0;  ///< of its cell

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
  /// To the nearest point of it.
  double distance(Vec3 place, double t) const {
    if (holds(place, t)) return std::abs(height(place, t));
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < n_corners; ++i) {
      const Vec3 a = corner(i, t), u = corner((i + 1) % n_corners, t) - a;
      const double along = std::clamp(dot(place - a, u) / dot(u, u), 0.0, 1.0);
      least = std::min(least, norm(place - a - along * u));
    }
    return least;
  }
};

/// The parts of a cell, of the corners and middles of its sides; those of no area are passed by nothing. @param shift  what
/// masters have moved by in the mean
std::vector<MovingFacet> facets_of(const Mesh& mesh, std::int32_t cell, std::span<const double> rest,
                                   std::span<const double> now, Vec3 shift) {
  const auto nodes = mesh.cells[cell];
  const catalog::CellRow& row = mesh.row(cell);
  const int n = row.n_vertices;
  std::vector<int> around;  // the places of its nodes in their order
  for (int i = 0; i < n; ++i) {
    around.push_back(i);
    if (row.order > 1 && (mesh.dimension == 3 || i == 0)) around.push_back(n + i);
  }
  const Vec3 outward = facing(mesh, cell, rest).normal;
  const double extent = mesh.dimension == 2 ? cell_extent(mesh, cell) : std::sqrt(cell_extent(mesh, cell));
  std::vector<MovingFacet> parts;
  for (std::size_t last = static_cast<std::size_t>(mesh.dimension) - 1; last < around.size(); ++last) {
    MovingFacet& part = parts.emplace_back();
    part.n_corners = mesh.dimension;
    part.extent = extent;
    const std::array<int, 3> corners = mesh.dimension == 2 ? std::array{around[last - 1], around[last], 0}
                                                           : std::array{around[0], around[last - 1], around[last]};
    for (int i = 0; i < part.n_corners; ++i) {
      const std::size_t at = 3 * static_cast<std::size_t>(nodes[static_cast<std::size_t>(corners[i])]);
      part.before[i] = vector_at(&rest[at]);
      part.after[i] = vector_at(&now[at]) - shift;
    }
    if (dot(part.normal(0), outward) < 0) part.sense = -1;
  }
  return parts;
}

/// Where a middle passes a facet.
struct Passage {
  double at;  ///< of the way, 0 to 1
  bool enters, comes_from_afar;
  Vec3 normal;
  double depth;  ///< behind the facet when the way ends
  double extent;
};

struct Way {
  Vec3 from, to;
  double size;  ///< of the patch
  Vec3 place(double t) const { return (1 - t) * from + t * to; }
};

std::optional<Passage> passage(const MovingFacet& facet, const Way& way) {
  const double first = facet.height(way.from, 0), end = facet.height(way.to, 1);
  const bool enters = first >= -touching * way.size && end < 0;
  if (!enters && !(first < 0 && end >= 0)) return std::nullopt;
  double low = 0, high = 1;
  for (int i = 0; i < halvings && first * end < 0; ++i) {
    const double middle = 0.5 * (low + high);
    ((facet.height(way.place(middle), middle) < 0) == (end < 0) ? high : low) = middle;
  }
  if (!facet.holds(way.place(low), low)) return std::nullopt;
  return Passage{.at = low,
                 .enters = enters,
                 .comes_from_afar = first > touching * way.size,
                 .normal = facet.normal(low),
                 .depth = -end,
                 .extent = facet.extent};
}

/// The masters of a zone on their way.
class Masters {
 public:
  explicit Masters(std::vector<MovingFacet> facets) : facets_(std::move(facets)), tree_(boxes(facets_)) {}

  /// How deep a middle lies behind a master that it has gone through. @param least  what bodies may overlap by beside that of
  /// their cells
  std::optional<double> depth_behind(const Way& way, double least) const {
    Box<3> box = Box<3>::empty();
    for (const Vec3& end : {way.from, way.to}) box.add(std::array{end.x, end.y, end.z}.data());
    for (int d = 0; d < 3; ++d) box.low[d] -= touching * way.size, box.high[d] += touching * way.size;
    std::vector<Passage> entered, left;
    tree_.visit(
        [&](const Box<3>& other) {
          for (int d = 0; d < 3; ++d)
            if (other.low[d] > box.high[d] || other.high[d] < box.low[d]) return false;
          return true;
        },
        [&](std::int32_t facet) {
          if (const auto found = passage(facets_[facet], way)) (found->enters ? entered : left).push_back(*found);
        });
    for (const Passage& entry : entered) {
      const double deep = least + std::max(way.size, entry.extent);
      if (entry.depth < deep) continue;
      if (inside(way.to, 1, deep)) return entry.depth;
      const double shortly_after = entry.at + (1 - entry.at) * std::min(1.0, way.size / entry.depth);
      if (entry.comes_from_afar && std::ranges::none_of(left, [&](const Passage& exit) { return exit.at > entry.at; }) &&
          inside(way.place(shortly_after), shortly_after, within * way.size))
        return entry.depth;
      for (const Passage& exit : left)
        if (exit.at > entry.at && dot(entry.normal, exit.normal) < other_way) {
          const double middle = 0.5 * (entry.at + exit.at);
          if (inside(way.place(middle), middle, within * norm(way.place(exit.at) - way.place(entry.at)))) return entry.depth;
        }
    }
    return std::nullopt;
  }

 private:
  static std::vector<Box<3>> boxes(const std::vector<MovingFacet>& facets) {
    std::vector<Box<3>> all;
    for (const MovingFacet& facet : facets) {
      Box<3>& box = all.emplace_back(Box<3>::empty());
      for (int i = 0; i < facet.n_corners; ++i)
        for (const Vec3& corner : {facet.before[i], facet.after[i]}) box.add(std::array{corner.x, corner.y, corner.z}.data());
    }
    return all;
  }
  /// Whether the nearest master has a place behind its face, at least so deep.
  bool inside(Vec3 place, double t, double deep) const {
    const MovingFacet* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const MovingFacet& facet : facets_)
      if (const double distance = facet.distance(place, t); distance < least) least = distance, nearest = &facet;
    return nearest && least >= deep && nearest->holds(place, t) && nearest->height(place, t) < 0;
  }

  std::vector<MovingFacet> facets_;
  BoxTree<3> tree_;
};

}  // namespace

std::optional<GoneThrough> ContactGeometry::gone_through(std::size_t zone_number) const {
  const Zone& zone = zones_[zone_number];
  const auto moved = [&](std::int32_t node) {
    const std::size_t at = 3 * static_cast<std::size_t>(node);
    return vector_at(&coordinates_[at]) - vector_at(&rest_[at]);
  };
  Vec3 shift{};
  double count = 0;
  for (const std::int32_t master : zone.masters)
    for (const std::int32_t node : mesh_.cells[master]) shift = shift + moved(node), count += 1;
  shift = shift / std::max(1.0, count);
  double most_master = 0, most_slave = 0, smallest = std::numeric_limits<double>::infinity(), offset = 0;
  for (const std::int32_t master : zone.masters)
    for (const std::int32_t node : mesh_.cells[master]) most_master = std::max(most_master, norm(moved(node) - shift));
  for (const std::int32_t slave : zone.slaves) {
    smallest = std::min(smallest, size_[contact_.slaves[slave].patch]);
    for (const std::int32_t node : mesh_.cells[contact_.slaves[slave].cell])
      most_slave = std::max(most_slave, norm(moved(node) - shift));
  }
  if (most_slave + most_master < smallest) return std::nullopt;
  if (has_offset(zone_number))
    for (const double value : offsets_[zone_number]) offset = std::max(offset, std::abs(value));

  std::vector<MovingFacet> facets;
  for (const std::int32_t master : zone.masters)
    for (const MovingFacet& facet : facets_of(mesh_, master, rest_, coordinates_, shift)) facets.push_back(facet);
  const Masters masters(std::move(facets));
  for (const std::int32_t slave : zone.slaves) {
    const std::int32_t cell = contact_.slaves[slave].cell;
    const Way way{.from = facing(mesh_, cell, rest_).place,
                  .to = facing(mesh_, cell, coordinates_).place - shift,
                  .size = size_[contact_.slaves[slave].patch]};
    if (const auto depth = masters.depth_behind(way, offset)) return GoneThrough{cell, *depth / way.size};
  }
  return std::nullopt;
}

}  // namespace lacon
