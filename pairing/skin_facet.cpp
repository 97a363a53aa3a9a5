#include "lacon/pairing/skin_facet.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lacon::space {
namespace {

Vec3 point(const Surface& surface, std::int32_t node) {
  return vector_at(surface.coordinates.data() + 3 * static_cast<std::size_t>(node));
}

constexpr int edge_pieces = 4;  // of a curved edge
constexpr double round_off = 1e-12;

/// Whether the middle node m of an edge lies between its ends, and beside the line through them by no more than `bulge` of its
/// length.
bool is_straight(Vec3 a, Vec3 b, Vec3 m, double bulge) {
  if (before(b, a)) std::swap(a, b);
  const Vec3 d = b - a, to_middle = m - a;
  const double along = dot(d, to_middle), length2 = dot(d, d);
  if (length2 == 0 && dot(to_middle, to_middle) == 0) return true;  // collapsed
  return norm(cross(d, to_middle)) <= bulge * length2 && along > 0 && along < length2;
}

bool is_mirrored(const FacetKind& f, int edge) { return (f.mirrored >> (edge % f.n_vertices) & 1) != 0; }

/// The vertices of an outline: visit(edge, t), t from 0 to 1 between the ends of the edge, a little beyond where it is
/// prolonged and on mirrored edges between their prolonged ends. A curved edge is cut at the same places whether it is
/// prolonged or not: of two triangles that share it perhaps one alone has a mirrored edge.
template <class Visit>
void walk(const FacetKind& f, const Visit& visit) {
  for (int i = 0; i < f.n_vertices; ++i) {
    const bool whole = f.whole_edge[static_cast<std::size_t>(i)], outside = is_mirrored(f, i),
               from_behind = !outside && is_mirrored(f, i + f.n_vertices - 1), to_behind = !outside && is_mirrored(f, i + 1);
    if (from_behind) visit(i, -hem);
    if (!from_behind || !whole) visit(i, 0);
    for (int k = 1; k < edge_pieces && !whole; ++k) visit(i, static_cast<double>(k) / edge_pieces);
    if (to_behind && !whole) visit(i, 1);
  }
}

}  // namespace

Nodes nodes_of(const Surface& surface, std::size_t cell, Vec3 origin) {
  Nodes nodes;
  std::size_t i = 0;
  for (const std::int32_t node : surface.nodes[cell]) nodes[i++] = point(surface, node) - origin;
  return nodes;
}

double diameter(const Nodes& nodes, int n_vertices) {
  double longest = 0;
  for (int i = 0; i < n_vertices; ++i)
    for (int j = 0; j < i; ++j) longest = std::max(longest, norm(nodes[i] - nodes[j]));
  return longest;
}

Facet facet(const Surface& surface, std::size_t cell, double straight, bool in_pieces) {
  Facet f;
  f.type = surface.types[cell];
  const catalog::CellRow& row = catalog::cell(f.type);
  f.family = row.family;
  if (!surface.mirrored.empty()) f.mirrored = surface.mirrored[cell];
  f.order = row.order;
  f.n_vertices = row.n_vertices;
  f.origin = point(surface, surface.nodes[cell][0]);
  f.nodes = nodes_of(surface, cell, f.origin);
  for (int i = 0; i < row.n_nodes; ++i) f.size = std::max(f.size, norm(f.nodes[i]));
  f.x = f.map(f.nodes);
  Vec3 area{};  // of the outline
  const int nv = f.n_vertices;
  for (int i = 0; i < nv; ++i) {
    const Vec3 a = f.nodes[i], b = f.nodes[(i + 1) % nv];
    area = area + cross(a, b);
    if (f.order < 2) continue;
    const bool is_one_line = is_straight(a, b, f.nodes[nv + i], straight);
    f.straight = f.straight && is_one_line;
    f.plane = f.plane && is_straight(a, b, f.nodes[nv + i], round_off);
    f.whole_edge[static_cast<std::size_t>(i)] = is_one_line && !in_pieces;
  }
  const double length = norm(area);
  if (length > 0) f.normal = (1 / length) * area;
  for (int i = 0; i < row.n_nodes; ++i) f.plane = f.plane && std::abs(dot(f.nodes[i], f.normal)) <= round_off * f.size;
  f.affine = is_affine(f.x, f.normal);
  f.distortion = f.affine ? 0 : distortion(f.x, f.family, f.normal);
  return f;
}

void outline(const FacetKind& f, const Nodes& nodes, std::vector<Vec3>& polygon) {
  polygon.clear();
  const int n = f.n_vertices;
  const auto along = [&](int i, double t) {  // an edge, both of whose facets find the same bits
    const Vec3 a = nodes[i], b = nodes[(i + 1) % n];
    if (t == 0) return a;
    if (t == 1) return b;
    const bool forward = before(a, b);
    const Vec3 first = forward ? a : b, last = forward ? b : a;
    if (!forward) t = 1 - t;
    if (f.whole_edge[static_cast<std::size_t>(i)]) return (1 - t) * first + t * last;
    return ((1 - t) * (1 - 2 * t)) * first + (t * (2 * t - 1)) * last + (4 * t * (1 - t)) * nodes[n + i];
  };
  std::vector<Vec2> places;
  Map3 x;
  if (f.mirrored != 0) outline_places(f, places), x = f.map(nodes);
  walk(f, [&](int i, double t) {
    const int before_it = (i + n - 1) % n;
    if (!is_mirrored(f, i))
      polygon.push_back(along(i, t));
    else if (t == 0 && !is_mirrored(f, before_it))
      polygon.push_back(along(before_it, 1 + hem));
    else
      polygon.push_back(x(places[polygon.size()]).x);
  });
}

void outline_places(const FacetKind& f, std::vector<Vec2>& places) {
  places.clear();
  const std::span<const double> nodes = catalog::cell(f.type).nodes;
  const int n = f.n_vertices;
  const auto vertex = [&](int i) { return Vec2{nodes[2 * (i % n)], nodes[2 * (i % n) + 1]}; };
  const auto prolonged = [&](int i) {  // along the other edge of each mirrored one that ends there
    Vec2 at = vertex(i);
    if (is_mirrored(f, i)) at = at + hem * (vertex(i) - vertex(i + n - 1));
    if (is_mirrored(f, i + n - 1)) at = at + hem * (vertex(i) - vertex(i + 1));
    return at;
  };
  walk(f, [&](int i, double t) {
    const bool outside = is_mirrored(f, i);
    const Vec2 a = outside ? prolonged(i) : vertex(i), b = outside ? prolonged(i + 1) : vertex(i + 1);
    places.push_back(a + t * (b - a));
  });
}

}  // namespace lacon::space
