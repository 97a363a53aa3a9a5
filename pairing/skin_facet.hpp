#pragma once
// A facet of a skin in space, as pairing keeps it.
#include <array>
#include <span>
#include <tuple>
#include <vector>

#include "lacon/pairing/facet.hpp"
#include "lacon/pairing/surface.hpp"

namespace lacon::space {

using Nodes = std::array<Vec3, 9>;

/// The nodes of a cell, in coordinates that start at `origin`.
Nodes nodes_of(const Surface& surface, std::size_t cell, Vec3 origin);

/// The longest distance between two of the first nodes.
double diameter(const Nodes& nodes, int n_vertices);

/// What is kept of every master.
struct FacetKind {
  CellType type{};
  Family family{};
  int order = 1, n_vertices = 0;
  Vec3 normal{};         ///< mean, unit; 0 for a facet without area
  double size = 0;       ///< the longest distance from its first node
  bool straight = true;  ///< edges
  /// Of the edge from each vertex to the next: it is one line of the outline. Facets that share an edge say the same of it,
  /// whatever their other edges are.
  std::array<bool, 4> whole_edge = {true, true, true, true};
  bool plane = true;          ///< all nodes lie in one, and edges are straight, to round-off
  std::uint8_t mirrored = 0;  ///< Surface::mirrored
  bool affine = false;        ///< to round-off
  double distortion = 0;

  Map3 map(const Nodes& nodes) const {
    return interpolate(type, std::span<const Vec3>(nodes).first(static_cast<std::size_t>(catalog::cell(type).n_nodes)));
  }
};

/// A facet whose coordinates start at one of its own nodes.
struct Facet : FacetKind {
  Vec3 origin{};
  Nodes nodes;  ///< minus origin
  Map3 x;       ///< minus origin
};

/// @param straight largest bulge of a straight edge over its length
/// @param in_pieces cut the edges of a cell of the second order in pieces where they are straight, too: middle nodes then move
/// the outline at any bulge, and forces do not jump where an edge becomes straight
Facet facet(const Surface& surface, std::size_t cell, double straight, bool in_pieces = false);

/// An order of points: an edge is followed from its earlier end, whichever facet asks.
inline bool before(Vec3 a, Vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

/// Of the edges that end in a mirrored one, by which they are prolonged: images are taken that far outside of a cell. Where
/// slaves end at a plane of symmetry their normals lean over it by what facets leave, in gaps.
constexpr double hem = 0.0625;

/// The outline of a facet as a polygon: a curved edge in pieces, at places that depend on the edge alone, a straight one whole.
/// Mirrored edges lie a little outside of the cell: what normals meet there stands for the mirror image.
void outline(const FacetKind& f, const Nodes& nodes, std::vector<Vec3>& polygon);
/// The reference coordinates of its vertices.
void outline_places(const FacetKind& f, std::vector<Vec2>& places);

}  // namespace lacon::space
