#pragma once
// A master as one slave facet sees it.
#include <array>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "lacon/pairing/slave_facet.hpp"

namespace lacon::space {

/// Where a normal of the slave meets a master, and how far away.
class Target {
 public:
  /// @param nodes of the master, from the slave's origin
  Target(const FacetKind& f, const Nodes& nodes, const SlaveFacet& slave);

  /// The image of a point of the slave, given in the slave's chart and as a reference point; empty where there is none.
  std::optional<Vec2> image(Vec2 y, Vec2 xi, const PairingTolerances& tolerances) const;
  /// Images of many points. @param lines used again for every call
  void images(std::span<const Vec2> y, std::span<const SlaveFacet::Place> places, const PairingTolerances& tolerances,
              std::vector<Line>& lines, std::vector<Meeting>& images) const;
  /// The gap between a reference point of the slave and its image.
  double gap(Vec2 xi, Vec2 image) const { return dot(x_(image).x - slave_.f.x(xi).x, slave_.direction(xi)); }

 private:
  const SlaveFacet& slave_;
  Family family_;
  Map3 x_;
  Inverse along_;
  double size_ = 0;  ///< at least the distance between any two points of slave and master
};

/// A part of a slave cell that sees one master.
struct View {
  std::int32_t piece, master;
  Region region;
  double far = 0;  ///< the gap in its middle, where detail::may_be_through_bodies() says so
};

/// In an order that numbers of cells have no part in, as far as places decide.
inline bool sooner(const View* a, const View* b) {
  const Vec2 p = middle(a->region.polygon), q = middle(b->region.polygon);
  return std::tie(a->piece, p.x, p.y, a->master) < std::tie(b->piece, q.x, q.y, b->master);
}

/// A convex part of a master's outline; coordinates start at the slave's origin.
struct Part {
  int n = 0;
  std::array<Vec3, 4> p;
  std::array<std::int32_t, 4> place;                    ///< in the outline; -1: the middle of the facet
  std::array<std::int32_t, 4> line = {-1, -1, -1, -1};  ///< HalfPlane::line of each edge
};

/// Convex parts of a master's outline, as seen along the slave's mean normal. @param nodes of the master, from the slave's
/// origin
void cut_in_parts(const FacetKind& f, const Nodes& nodes, const SlaveFacet& slave, std::vector<Vec3>& polygon,
                  std::vector<Part>& parts);

/// Its area times its mean normal, twice.
inline Vec3 area_vector(const Part& part) {
  Vec3 sum{};
  for (int i = 2; i < part.n; ++i) sum = sum + cross(part.p[i - 1] - part.p[0], part.p[i] - part.p[0]);
  return sum;
}

/// What of a piece sees the front of a part, or its back.
void see(const SlaveFacet& slave, const Piece& piece, const Part& part, bool front, Region& seen, Polygon& scratch);

}  // namespace lacon::space
