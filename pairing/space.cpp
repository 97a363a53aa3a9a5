// Pairing in space.
#include <algorithm>
#include <atomic>
#include <deque>
#include <limits>
#include <memory>
#include <numbers>
#include <tuple>
#include <utility>

#include "lacon/elements/reference.hpp"
#include "lacon/pairing/box_tree.hpp"
#include "lacon/pairing/detail.hpp"
#include "lacon/pairing/facet.hpp"
#include "lacon/structures/parallel.hpp"

// The normal of the slave at xi passes a directed edge (a, b) of a master on the side that the sign of
//     s(xi) = ((b - a) x n(xi)) . (x_e(xi) - a)
// tells; it crosses a convex master that faces the slave where s >= 0 for all its edges. So a slave is cut into convex pieces
// of a *chart*, s is an affine function on each piece, and a master keeps what half-planes leave of it. Two masters that share
// an edge have the same s but for the sign, to the last bit. Nothing is projected onto an extrapolated slave.
//
// The chart of a facet with straight edges is its mean plane. If it is flat and has one normal, s is affine there: one
// piece, and exact polygons. Otherwise s is interpolated on a grid of triangles. A facet with curved edges has its reference
// cell as chart.

namespace lacon {
namespace {

using namespace space;

constexpr int edge_pieces = 4;  // of a curved edge of a master

Vec3 point(const Surface& surface, std::int32_t node) {
  const double* c = surface.coordinates.data() + 3 * static_cast<std::size_t>(node);
  return {c[0], c[1], c[2]};
}

double extent(const Surface& surface) {
  Box<3> box = Box<3>::empty();
  for (std::size_t cell = 0; cell < surface.size(); ++cell)
    if (detail::finite(surface, cell))
      for (const std::int32_t node : surface.nodes[cell])
        box.add(surface.coordinates.data() + 3 * static_cast<std::size_t>(node));
  if (!(box.low[0] <= box.high[0])) return 0;
  return norm(Vec3{box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]});
}

using Nodes = std::array<Vec3, 9>;

/// The nodes of a cell, in coordinates that start at `origin`.
Nodes nodes_of(const Surface& surface, std::size_t cell, Vec3 origin) {
  Nodes nodes;
  std::size_t i = 0;
  for (const std::int32_t node : surface.nodes[cell]) nodes[i++] = point(surface, node) - origin;
  return nodes;
}

/// The longest distance between two of the first nodes.
double diameter(const Nodes& nodes, int n_vertices) {
  double longest = 0;
  for (int i = 0; i < n_vertices; ++i)
    for (int j = 0; j < i; ++j) longest = std::max(longest, norm(nodes[i] - nodes[j]));
  return longest;
}

/// What is kept of every master.
struct FacetKind {
  CellType type{};
  Family family{};
  int order = 1, n_vertices = 0;
  Vec3 normal{};         ///< mean, unit; 0 for a facet without area
  double size = 0;       ///< the longest distance from its first node
  bool straight = true;  ///< edges
  bool affine = false;   ///< to round-off
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

Facet facet(const Surface& surface, std::size_t cell, double straight) {
  Facet f;
  f.type = surface.types[cell];
  const catalog::CellRow& row = catalog::cell(f.type);
  f.family = row.family;
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
    const Vec3 d = b - a, m = f.nodes[nv + i] - a;
    const double along = dot(d, m), length2 = dot(d, d);
    const bool collapsed = length2 == 0 && dot(m, m) == 0;
    if (!collapsed && !(norm(cross(d, m)) <= straight * length2 && along > 0 && along < length2)) f.straight = false;
  }
  const double length = norm(area);
  if (length > 0) f.normal = (1 / length) * area;
  f.affine = is_affine(f.x, f.normal);
  f.distortion = f.affine ? 0 : distortion(f.x, f.family, f.normal);
  return f;
}

/// A convex part of a master's outline; coordinates start at the slave's origin.
struct Part {
  int n = 0;
  std::array<Vec3, 4> p;
};

bool before(Vec3 a, Vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

/// The outline of a facet as a polygon: `edge_pieces` pieces for a curved edge, at places that depend on the edge alone.
void outline(const FacetKind& f, const Nodes& nodes, std::vector<Vec3>& polygon) {
  polygon.clear();
  for (int i = 0; i < f.n_vertices; ++i) {
    const Vec3 a = nodes[i], b = nodes[(i + 1) % f.n_vertices];
    polygon.push_back(a);
    if (f.straight) continue;
    const Vec3 m = nodes[f.n_vertices + i];
    const bool forward = before(a, b);
    const Vec3 first = forward ? a : b, last = forward ? b : a;
    for (int k = 1; k < edge_pieces; ++k) {
      const double t = static_cast<double>(forward ? k : edge_pieces - k) / edge_pieces;
      polygon.push_back(((1 - t) * (1 - 2 * t)) * first + (t * (2 * t - 1)) * last + (4 * t * (1 - t)) * m);
    }
  }
}

struct Piece {
  Polygon polygon;           ///< in the chart
  std::array<Vec3, 3> x, n;  ///< at its vertices, where the normal is not constant
  Vec3 normal{};             ///< mean
};

class SlaveFacet {
 public:
  Facet f;
  bool degenerate = false;
  bool constant = true, nearly_flat = true, plane = true;  ///< one normal, nearly one, straight edges
  Vec3 n{}, e1{}, e2{};
  std::vector<Piece> pieces;
  double chart_area = 0;      ///< twice the area
  double chart_diameter = 0;  ///< at least the largest distance in a piece

  void set(const Surface& surface, std::size_t cell, double size, const PairingTolerances& tolerances) {
    degenerate = true;
    constant = false;
    if (!detail::finite(surface, cell)) return;
    f = facet(surface, cell, tolerances.straight);
    n = f.normal;
    if (!(f.size > tolerances.degenerate * size)) return;
    smooth_ = !surface.normals.empty();
    if (smooth_) {
      std::array<Vec3, 9> normals;
      const auto nodes = surface.nodes[cell];
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double* c = surface.normals.data() + 3 * static_cast<std::size_t>(nodes[i]);
        normals[i] = {c[0], c[1], c[2]};
      }
      nodal_ = interpolate(f.type, std::span<const Vec3>(normals).first(nodes.size()));
    }
    // A corner may have no normal (two nodes in one place, three corners on a line), the middle must.
    least_ = tolerances.degenerate * (smooth_ ? 1 : f.size * f.size);
    double turn = 0;
    const std::span<const Vec2> all_places = probes(f.family);
    const auto places = all_places.last(f.affine && !smooth_ ? 1 : all_places.size());
    for (const Vec2 p : places) {
      const Map3::Value v = f.x(p);
      const double jacobian = dot(cross(v.d1, v.d2), n), none = tolerances.degenerate * f.size * f.size;
      if (!(jacobian > (&p == &places.back() ? none : -none))) return;
      const Vec3 m = direction(p);
      if (!(dot(m, n) > tolerances.degenerate)) return;
      turn = std::max(turn, norm(m - n));
    }
    degenerate = false;
    constant = turn <= tolerances.flat && f.straight;
    nearly_flat = turn <= tolerances.nearly_flat && f.straight;
    plane = f.straight;
    // axes that follow an edge: turning the whole mesh turns them too
    Vec3 edge{};
    for (int i = 0; i < f.n_vertices; ++i) {
      const Vec3 d = f.nodes[(i + 1) % f.n_vertices] - f.nodes[i];
      if (dot(d, d) > dot(edge, edge)) edge = d;
    }
    const Vec3 t = edge - dot(edge, n) * n;
    e1 = (1 / norm(t)) * t;
    e2 = cross(n, e1);
    chart_ = project(f.x, e1, e2);
    if (plane) from_chart_ = Inverse(chart_, f.family);
    if (constant) {
      pieces.resize(1);
      Piece& piece = pieces[0];
      piece.polygon.clear();
      for (int i = 0; i < f.n_vertices; ++i) piece.polygon.push_back({dot(f.nodes[i], e1), dot(f.nodes[i], e2)});
      piece.normal = n;
    } else {
      pieces.clear();
      // both are the same whichever node is the first
      double bulge = 0;
      for (int i = 0; i < f.n_vertices && !plane; ++i)
        bulge = std::max(bulge, norm(f.nodes[f.n_vertices + i] - 0.5 * (f.nodes[i] + f.nodes[(i + 1) % f.n_vertices])));
      const double steps = 8 * std::max(turn, 4 * bulge / diameter(f.nodes, f.n_vertices));
      subdivide(nearly_flat                ? 1
                : f.family == Family::TRIA ? std::clamp(1 + static_cast<int>(std::ceil(steps)), 2, 6)
                                           : std::clamp(1 + static_cast<int>(std::ceil(steps / std::numbers::sqrt2)), 2, 4));
    }
    chart_area = 0;
    for (const Piece& piece : pieces) chart_area += double_area(piece.polygon);
    chart_diameter = plane ? 2 * f.size : 3;
    build_walls();
  }

  /// The unit normal at a reference point; the mean one where there is none.
  Vec3 direction(Vec2 xi) const {
    if (constant) return n;
    const Vec3 m = unscaled_direction(xi);
    const double length = norm(m);
    return length > least_ ? (1 / length) * m : n;
  }

  struct Place {
    bool found = false;
    Vec2 xi{};
    double scale = 1;  ///< area of the reference cell by area of the chart
  };

  /// The reference point of a point of the chart.
  Place place(Vec2 y, const PairingTolerances& tolerances) const {
    if (!plane) return {true, y, 1};
    const std::optional<Vec2> xi = from_chart_(y, tolerances.ray * f.size, tolerances.margin);
    if (!xi) return {};
    return {true, *xi, 1 / from_chart_.jacobian(*xi)};
  }

  /// The mean normal at a point of the mean plane.
  Line normal_at(Vec2 y) const { return {y.x * e1 + y.y * e2, n}; }

  /// Reference points of many points of the chart. @param lines, meetings used again for every call
  void places(std::span<const Vec2> y, const PairingTolerances& tolerances, std::vector<Line>& lines,
              std::vector<Meeting>& meetings, std::vector<Place>& places) const {
    places.resize(y.size());
    if (!plane) {
      for (std::size_t i = 0; i < y.size(); ++i) places[i] = place(y[i], tolerances);
    } else if (from_chart_.affine()) {
      const double scale = 1 / from_chart_.jacobian({});
      for (std::size_t i = 0; i < y.size(); ++i) {
        const Vec2 xi = from_chart_.of_affine(y[i]);
        places[i] = {near_reference_cell(f.family, xi, tolerances.margin), xi, scale};
      }
    } else {
      lines.clear();
      for (const Vec2 p : y) lines.push_back(normal_at(p));
      meetings.resize(y.size());
      meet(f.x, f.family, lines, tolerances.ray * f.size, tolerances.margin, meetings);
      for (std::size_t i = 0; i < y.size(); ++i)
        places[i] = meetings[i].found ? Place{true, meetings[i].xi, 1 / meetings[i].jacobian} : place(y[i], tolerances);
    }
  }

  /// The side of an edge of a master on which a normal passes, on a piece.
  HalfPlane side(const Piece& piece, Vec3 a, Vec3 b) const {
    if (before(b, a)) return side(piece, b, a).opposite();
    if (constant) {
      const Vec2 first{dot(a, e1), dot(a, e2)}, last{dot(b, e1), dot(b, e2)};
      const Vec2 d = last - first;
      return {first, {d.y, -d.x}, 0};
    }
    std::array<double, 3> s;
    for (int k = 0; k < 3; ++k) s[k] = dot(cross(b - a, piece.n[k]), piece.x[k] - a);
    const Vec2 u = piece.polygon[1] - piece.polygon[0], v = piece.polygon[2] - piece.polygon[0];
    const double ds = s[1] - s[0], dt = s[2] - s[0], det = cross(u, v);
    return {piece.polygon[0], {(ds * v.y - dt * u.y) / det, (dt * u.x - ds * v.x) / det}, s[0]};
  }

  /// False only where no normal of the slave meets the box. A point q = x(xi) + t m(xi) has the height t = (q - x) . n over x
  /// if m is scaled to m . n = 1; then m leans by at most `lean_` and q lies at most lean_ |t| beyond the walls around the
  /// slave.
  bool touches(const Box<3>& box) const {
    const Vec3 centre =
        Vec3{0.5 * (box.low[0] + box.high[0]), 0.5 * (box.low[1] + box.high[1]), 0.5 * (box.low[2] + box.high[2])} - f.origin;
    const Vec3 half{0.5 * (box.high[0] - box.low[0]), 0.5 * (box.high[1] - box.low[1]), 0.5 * (box.high[2] - box.low[2])};
    const auto reach = [&](Vec3 d) { return half.x * std::abs(d.x) + half.y * std::abs(d.y) + half.z * std::abs(d.z); };
    const double leaning = lean_ > 0 ? lean_ * (std::abs(dot(centre, n)) + reach(n) + height_) : 0;
    const FourWalls beyond = walls_.x * centre.x + walls_.y * centre.y + walls_.z * centre.z -
                             (walls_.ax * half.x + walls_.ay * half.y + walls_.az * half.z) - walls_.offset;
    return !(std::max(std::max(beyond[0], beyond[1]), std::max(beyond[2], beyond[3])) > leaning);
  }

 private:
  Vec3 unscaled_direction(Vec2 xi) const {
    if (smooth_) return nodal_(xi).x;
    const Map3::Value v = f.x(xi);
    return cross(v.d1, v.d2);
  }

  void build_walls() {
    walls_ = Walls{};
    const auto push = [&](Vec3 x) {  // the walls outward, behind x
      for (int i = 0; i < f.n_vertices; ++i)
        walls_.offset[i] = std::max(walls_.offset[i], walls_.x[i] * x.x + walls_.y[i] * x.y + walls_.z[i] * x.z);
    };
    for (int i = 0; i < f.n_vertices; ++i) {
      const Vec3 out = cross(f.nodes[(i + 1) % f.n_vertices] - f.nodes[i], n);
      const double length = norm(out), scale = length > 0 ? 1 / length : 0;
      walls_.x[i] = scale * out.x, walls_.y[i] = scale * out.y, walls_.z[i] = scale * out.z;
      walls_.ax[i] = std::abs(walls_.x[i]), walls_.ay[i] = std::abs(walls_.y[i]), walls_.az[i] = std::abs(walls_.z[i]);
    }
    lean_ = height_ = 0;
    if (constant) {
      for (int k = 0; k < f.n_vertices; ++k) push(f.nodes[k]);
      return;
    }
    for (const Vec3 x : hull(f.family, f.order, [&](Vec2 xi) { return f.x(xi).x; })) {
      push(x);
      height_ = std::max(height_, std::abs(dot(n, x)));
    }
    height_ += 0.25 * f.size;
    const int degree = smooth_ ? f.order : f.family == Family::TRIA ? std::max(1, 2 * f.order - 2) : 2 * f.order - 1;
    for (const Vec3 m : hull(f.family, degree, [&](Vec2 xi) { return unscaled_direction(xi); })) {
      const double up = dot(m, n);
      if (norm(m) <= least_) continue;
      lean_ = up > 0 ? std::max(lean_, norm(m - up * n) / up) : std::numeric_limits<double>::infinity();
      if (!(up > 0)) break;
    }
  }

  void subdivide(int k) {
    const auto vertex = [&](double a, double b) {
      const Vec2 xi = f.family == Family::TRIA ? Vec2{a / k, b / k} : Vec2{2 * a / k - 1, 2 * b / k - 1};
      return xi;
    };
    const auto add = [&](Vec2 a, Vec2 b, Vec2 c) {
      Piece piece;
      const std::array<Vec2, 3> xi{a, b, c};
      for (int i = 0; i < 3; ++i) {
        piece.x[i] = f.x(xi[i]).x;
        piece.n[i] = direction(xi[i]);
        piece.polygon.push_back(plane ? chart_(xi[i]).x : xi[i]);
        piece.normal = piece.normal + (1.0 / 3) * piece.n[i];
      }
      if (double_area(piece.polygon) > 0) pieces.push_back(std::move(piece));  // not where the facet has collapsed
    };
    if (f.family == Family::TRIA) {
      for (int j = 0; j < k; ++j)
        for (int i = 0; i < k - j; ++i) {
          add(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
          if (i + j + 1 < k) add(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
        }
      return;
    }
    // around the middle of each square: the same pieces whichever node is the first
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < k; ++i) {
        const std::array<Vec2, 4> corner{vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)};
        for (int c = 0; c < 4; ++c) add(corner[c], corner[(c + 1) % 4], vertex(i + 0.5, j + 0.5));
      }
  }

  bool smooth_ = false;
  double least_ = 0;  ///< length of `unscaled_direction` below which there is none
  Map3 nodal_;
  Map2 chart_;
  Inverse from_chart_;
  /// A number of each wall, in vector registers.
  using FourWalls = double __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double))));
  /// Planes behind which the slave lies; out . x is nowhere larger than `offset` on it. A triangle's fourth one is everywhere.
  struct Walls {
    FourWalls x, y, z;     ///< out: unit, at a right angle to n
    FourWalls ax, ay, az;  ///< |out|
    FourWalls offset;
  } walls_;
  double lean_ = 0;    ///< tangent of the largest angle between a normal and n, or infinity
  double height_ = 0;  ///< largest |n . x|, and an allowance for what pieces get wrong along the border
};

/// A master as one slave facet sees it: where a normal of the slave meets it, and how far away.
class Target {
 public:
  /// @param nodes of the master, from the slave's origin
  Target(const FacetKind& f, const Nodes& nodes, const SlaveFacet& slave) : slave_(slave), family_(f.family), x_(f.map(nodes)) {
    size_ = f.size + norm(x_.c[0]) + slave.f.size;
    if (slave.constant) along_ = Inverse(project(x_, slave.e1, slave.e2), family_);
  }

  /// The image of a point of the slave, given in the slave's chart and as a reference point; empty where there is none.
  std::optional<Vec2> image(Vec2 y, Vec2 xi, const PairingTolerances& tolerances) const {
    if (slave_.constant) return along_(y, tolerances.ray * size_, tolerances.margin);
    const Vec3 x = slave_.f.x(xi).x, n = slave_.direction(xi);
    const Vec3 axis = std::abs(n.x) <= std::abs(n.y) && std::abs(n.x) <= std::abs(n.z) ? Vec3{1, 0, 0}
                      : std::abs(n.y) <= std::abs(n.z)                                 ? Vec3{0, 1, 0}
                                                                                       : Vec3{0, 0, 1};
    const Vec3 t = cross(n, axis), e1 = (1 / norm(t)) * t, e2 = cross(n, e1);
    return inverse(project(x_, e1, e2), family_, {dot(x, e1), dot(x, e2)}, tolerances.ray * size_, tolerances.margin);
  }
  /// Images of many points. @param lines used again for every call
  void images(std::span<const Vec2> y, std::span<const SlaveFacet::Place> places, const PairingTolerances& tolerances,
              std::vector<Line>& lines, std::vector<Meeting>& images) const {
    images.resize(y.size());
    if (slave_.constant && along_.affine()) {
      for (std::size_t i = 0; i < y.size(); ++i) {
        const Vec2 xi = along_.of_affine(y[i]);
        images[i] = {places[i].found && near_reference_cell(family_, xi, tolerances.margin), xi, 0};
      }
      return;
    }
    lines.clear();
    for (std::size_t i = 0; i < y.size(); ++i)
      if (slave_.constant)
        lines.push_back(slave_.normal_at(y[i]));
      else
        lines.push_back({slave_.f.x(places[i].xi).x, slave_.direction(places[i].xi)});
    meet(x_, family_, lines, tolerances.ray * size_, tolerances.margin, images);
    for (std::size_t i = 0; i < y.size(); ++i) {
      images[i].found = images[i].found && places[i].found;
      if (images[i].found || !places[i].found) continue;
      if (const std::optional<Vec2> found = image(y[i], places[i].xi, tolerances)) images[i] = {true, *found, 0};
    }
  }
  /// The gap between a reference point of the slave and its image.
  double gap(Vec2 xi, Vec2 image) const { return dot(x_(image).x - slave_.f.x(xi).x, slave_.direction(xi)); }

 private:
  const SlaveFacet& slave_;
  Family family_;
  Map3 x_;
  Inverse along_;
  double size_ = 0;  ///< at least the distance between any two points of slave and master
};

/// Convex parts of a master's outline, as seen along the slave's mean normal. @param nodes of the master, from the slave's
/// origin
void cut_in_parts(const FacetKind& f, const Nodes& nodes, const SlaveFacet& slave, std::vector<Vec3>& polygon,
                  std::vector<Part>& parts) {
  parts.clear();
  outline(f, nodes, polygon);
  const std::size_t n = polygon.size();
  if (n == 3) {
    parts.push_back({3, {polygon[0], polygon[1], polygon[2]}});
  } else if (n == 4) {
    // a corner that turns the other way is where a diagonal must start
    std::array<double, 4> corner;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      corner[i] = dot(cross(polygon[i] - polygon[(i + 3) % 4], polygon[(i + 1) % 4] - polygon[i]), slave.n);
      sum += corner[i];
    }
    std::size_t reflex = 0;
    for (std::size_t i = 1; i < 4; ++i)
      if (corner[i] * sum < corner[reflex] * sum) reflex = i;
    if (slave.constant && corner[reflex] * sum >= 0)
      parts.push_back({4, {polygon[0], polygon[1], polygon[2], polygon[3]}});
    else
      for (const std::size_t k : {std::size_t{1}, std::size_t{2}})
        parts.push_back({3, {polygon[reflex], polygon[(reflex + k) % 4], polygon[(reflex + k + 1) % 4]}});
  } else {
    const Vec3 centre = f.map(nodes)(probes(f.family).back()).x;
    for (std::size_t i = 0; i < n; ++i) parts.push_back({3, {centre, polygon[i], polygon[(i + 1) % n]}});
  }
}

Vec3 area_vector(const Part& part) {
  Vec3 sum{};
  for (int i = 2; i < part.n; ++i) sum = sum + cross(part.p[i - 1] - part.p[0], part.p[i] - part.p[0]);
  return sum;
}

/// What of a piece sees the front of a part, or its back.
void see(const SlaveFacet& slave, const Piece& piece, const Part& part, bool front, Region& seen, Polygon& scratch) {
  seen.polygon = piece.polygon;
  seen.halves.clear();
  for (int i = 0; i < part.n && !seen.polygon.empty(); ++i) {
    const HalfPlane half = slave.side(piece, part.p[i], part.p[(i + 1) % part.n]);
    seen.halves.push_back(front ? half : half.opposite());
    clip(seen.polygon, seen.halves.back(), scratch);
    seen.polygon.swap(scratch);
  }
}

/// A part of a slave cell that sees one master.
struct View {
  std::int32_t piece, master;
  Region region;
};

bool sooner(const View* a, const View* b) {
  const Vec2 p = middle(a->region.polygon), q = middle(b->region.polygon);
  return std::tie(a->piece, p.x, p.y, a->master) < std::tie(b->piece, q.x, q.y, b->master);
}

/// Whether polygons of a couple are exact, or nearly so.
bool exact_polygons(const SlaveFacet& slave, const FacetKind& master) { return slave.nearly_flat && master.straight; }

constexpr int largest_degree = 61;  ///< of a rule of 32 points each way, on squares and on triangles

/// The degree to which a couple is integrated. The integrand is analytic in the plane; the nearest singularity of an inverse
/// map lies at about 1 / distortion, so that a rule of degree p leaves rho^-p with rho as below (METHOD.md 5.4 has measured
/// figures). Where polygons are themselves approximate a higher degree than 8 serves nothing.
int integration_degree(const SlaveFacet& slave, const FacetKind& master) {
  const double d = std::min(0.999, std::max(slave.f.distortion, master.distortion));
  const int polynomial = 2 * std::max(slave.f.order, master.order);
  if (d <= 1e-12) return std::max(4, polynomial);
  const double rho = 1 / d + std::sqrt(1 / (d * d) - 1);
  const int degree = polynomial + static_cast<int>(std::ceil(12 * std::numbers::ln10 / std::log(rho)));
  return std::clamp(degree, 4, exact_polygons(slave, master) ? largest_degree : 8);
}

/// Rules by degree: found once, and then without the lock of integration_rule().
class KnownRules {
 public:
  template <class Points>
  const Rule& get(Family family, int degree, const Points& points) {
    if (degree < 0 || degree >= size) return integration_rule(family, points());
    std::atomic<const Rule*>& rule = rules_[static_cast<std::size_t>(degree)];
    if (!rule) rule = &integration_rule(family, points());
    return *rule;
  }

 private:
  static constexpr int size = largest_degree + 1;
  std::array<std::atomic<const Rule*>, size> rules_{};
};

const Rule& triangle_rule(int degree) {
  static KnownRules rules;
  return rules.get(Family::TRIA, degree, [&] {
    const int m = degree / 2 + 1;
    return degree <= 4 ? 6 : degree <= 6 ? 12 : degree <= 8 ? 16 : m * m;
  });
}

/// The rule of the square that is exact for polynomials of this degree on any convex quadrangle: seen from the square they have
/// the degree in each coordinate, and the Jacobian adds one. That of a parallelogram is constant: there the total degree
/// counts.
const Rule& square_rule(int degree, bool parallelogram) {
  static KnownRules any, parallelograms;
  if (parallelogram && degree <= 5) return parallelograms.get(Family::QUAD, degree, [] { return 7; });
  return any.get(Family::QUAD, degree, [&] {
    const int m = (degree + 3) / 2;
    return m * m;
  });
}

/// Points of the chart, with their weights there.
struct ChartPoints {
  std::vector<Vec2> y;
  std::vector<double> weight;
  Polygon corners;  ///< used again for every polygon

  void add(Vec2 at, double of_it) {
    y.push_back(at);
    weight.push_back(of_it);
  }
};

/// Integration points of a convex polygon: as a quadrangle where it has four corners, which takes fewer points for the same
/// degree, else on a fan of triangles. Where the degree is not enough (polygons that are approximate) the smaller triangles are
/// the more accurate ones.
///
/// Where edges of slave and master coincide to round-off, vertices come and go: C must not jump by the error of quadrature
/// there, Newton's method would never end. So vertices that cut off next to nothing are no corners, and have small triangles of
/// their own; a fan has them by itself.
void place_points(const Polygon& polygon, int degree, bool enough, ChartPoints& points) {
  constexpr double round_off = 1e-13, no_area = 1e-15, small = 1e-6;  // the last two: of the area
  points.y.clear();
  points.weight.clear();
  const Rule& triangle = triangle_rule(degree);
  const auto on_triangle = [&](Vec2 a, Vec2 b, Vec2 c, double least) {
    const Vec2 u = b - a, v = c - a;
    const double area = cross(u, v);
    if (!(area > least)) return;
    for (int g = 0; g < triangle.size(); ++g)
      points.add(a + triangle.points[2 * g] * u + triangle.points[2 * g + 1] * v, triangle.weights[g] * area);
  };
  Polygon& corners = points.corners;
  if (enough && polygon.size() >= 4) {
    const double whole = double_area(polygon);
    corners = polygon;
    for (std::size_t i = 0; i < corners.size() && corners.size() > 3;) {
      const Vec2 a = corners[(i + corners.size() - 1) % corners.size()], b = corners[i], c = corners[(i + 1) % corners.size()];
      if (cross(b - a, c - a) <= small * whole) {
        on_triangle(a, b, c, no_area * whole);
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    if (corners.size() == 4) {
      const Vec2 a = corners[0], b = corners[1], c = corners[2], d = corners[3];
      const Vec2 middle = 0.25 * ((a + c) + (b + d)), s = 0.25 * ((b - a) + (c - d)), t = 0.25 * ((d - a) + (c - b)),
                 st = 0.25 * ((c - d) - (b - a));
      const auto size = [](Vec2 v) { return std::abs(v.x) + std::abs(v.y); };
      const double area = cross(s, t), by_s = cross(s, st), by_t = cross(st, t);
      const Rule& rule = square_rule(degree, size(st) <= round_off * (size(s) + size(t)));
      for (int g = 0; g < rule.size(); ++g) {
        const double x = rule.points[2 * g], y = rule.points[2 * g + 1];
        points.add(middle + x * s + y * t + (x * y) * st, rule.weights[g] * (area + x * by_s + y * by_t));
      }
      return;
    }
    points.y.clear();
    points.weight.clear();
  }
  for (std::size_t i = 2; i < polygon.size(); ++i) on_triangle(polygon[0], polygon[i - 1], polygon[i], 0);
}

/// The master skin, examined once for all slave cells.
struct Masters {
  const Surface &slave, &master;
  PairingOptions options;
  double slave_extent = 0, smallest_cosine = -1;
  std::vector<FacetKind> facets;
  std::vector<std::int32_t> usable;  ///< cells that are not degenerate, and what the tree has as items
  BoxTree<3> tree;

  Masters(const Surface& slave_skin, const Surface& master_skin, const PairingOptions& pairing_options,
          std::vector<RejectedCouple>& rejected)
      : slave(slave_skin),
        master(master_skin),
        options(pairing_options),
        slave_extent(extent(slave_skin)),
        smallest_cosine(detail::smallest_cosine(pairing_options)),
        facets(master.size()),
        tree(examine(rejected)) {}

 private:
  std::vector<Box<3>> examine(std::vector<RejectedCouple>& rejected) {
    const PairingTolerances& tolerances = options.tolerances;
    const double size = extent(master);
    std::vector<Box<3>> boxes(master.size());
    std::vector<std::uint8_t> degenerate(master.size());
    parallel_for(master.size(), block, [&](const LoopBlock& cells) {
      std::vector<Vec3> polygon;
      for (std::size_t cell = cells.first; cell < cells.last; ++cell) {
        const Facet f = detail::finite(master, cell) ? facet(master, cell, tolerances.straight) : Facet{};
        facets[cell] = f;
        const Map3::Value at = f.x({0, 0});
        degenerate[cell] = !(f.size > tolerances.degenerate * size) || !(norm(f.normal) > 0) ||
                           !(std::abs(dot(cross(at.d1, at.d2), f.normal)) > tolerances.degenerate * f.size * f.size);
        if (degenerate[cell]) continue;
        Box<3>& box = boxes[cell] = Box<3>::empty();
        outline(f, f.nodes, polygon);
        polygon.push_back(f.x(probes(f.family).back()).x);
        for (const Vec3 p : polygon) {
          const Vec3 x = p + f.origin;
          box.add(std::array{x.x, x.y, x.z}.data());
        }
        for (int d = 0; d < 3; ++d) {
          box.low[d] -= tolerances.box * size;
          box.high[d] += tolerances.box * size;
        }
      }
    });
    for (std::size_t cell = 0; cell < master.size(); ++cell) {
      if (degenerate[cell]) {
        rejected.push_back({-1, static_cast<std::int32_t>(cell), Rejection::degenerate_master});
        continue;
      }
      boxes[usable.size()] = boxes[cell];
      usable.push_back(static_cast<std::int32_t>(cell));
    }
    boxes.resize(usable.size());
    return boxes;
  }

  static constexpr std::size_t block = 512;  // facets that a thread examines at a time
};

class PairerInSpace final : public detail::CellPairer {
 public:
  explicit PairerInSpace(std::shared_ptr<const Masters> masters) : masters_(std::move(masters)) {}

  void pair(std::size_t cell, Pairing& pairing) override {
    const Surface& slave = masters_->slave;
    const std::vector<FacetKind>& masters = masters_->facets;
    const PairingOptions& options = masters_->options;
    const PairingTolerances& tolerances = options.tolerances;
    ContactCells& cells = pairing.cells;
    const auto slave_index = static_cast<std::int32_t>(cell);
    e.set(slave, cell, masters_->slave_extent, tolerances);
    if (e.degenerate) {
      pairing.rejected.push_back({slave_index, -1, Rejection::degenerate_slave});
      return;
    }
    const auto reject = [&](std::int32_t m, Rejection reason) { pairing.rejected.push_back({slave_index, m, reason}); };
    const double sliver = tolerances.sliver * e.chart_area;
    views.clear();
    n_stored = 0;
    // The gap in the middle of a view, or infinity where there is no image.
    const auto nodes_of_master = [&](std::int32_t m) {
      return nodes_of(masters_->master, static_cast<std::size_t>(m), e.f.origin);
    };
    const auto distance = [&](const View& view, Vec2 y) {
      const SlaveFacet::Place place = e.place(y, tolerances);
      const Target target(masters[view.master], nodes_of_master(view.master), e);
      const std::optional<Vec2> image = place.found ? target.image(y, place.xi, tolerances) : std::nullopt;
      return image ? std::abs(target.gap(place.xi, *image)) : std::numeric_limits<double>::infinity();
    };
    const auto couple = [&](std::int32_t m) {
      cut_in_parts(masters[m], nodes_of_master(m), e, polygon, parts);
      bool couples = false, away = false, thin = false;
      for (const Part& part : parts) {
        const Vec3 area = area_vector(part);
        for (std::size_t p = 0; p < e.pieces.size(); ++p) {
          const Piece& piece = e.pieces[p];
          const bool faces = dot(area, piece.normal) < 0;
          if (faces || !e.constant) {
            see(e, piece, part, true, seen, scratch);
            const double seen_area = double_area(seen.polygon);
            if (seen_area > sliver) {
              couples = true;
              if (-dot(area, piece.normal) < masters_->smallest_cosine * norm(area) * norm(piece.normal))
                reject(m, Rejection::too_steep);
              else {
                views.push_back(new_view(static_cast<std::int32_t>(p), m));
                std::swap(views.back()->region, seen);
              }
              continue;
            }
            thin = thin || !seen.polygon.empty();
          }
          if (faces || away || couples) continue;
          see(e, piece, part, false, seen, scratch);
          away = double_area(seen.polygon) > sliver;
        }
      }
      if (!couples && away) reject(m, Rejection::facing_away);
      if (!couples && !away && thin) reject(m, Rejection::sliver);
    };
    if (options.brute_force) {
      for (const std::int32_t m : masters_->usable) couple(m);
    } else {
      masters_->tree.visit([&](const Box<3>& box) { return e.touches(box); },
                           [&](std::int32_t i) { couple(masters_->usable[i]); });
    }
    if (options.distance_limit > 0)
      std::erase_if(views, [&](const View* view) {
        const double size = std::max(diameter(e.f.nodes, e.f.n_vertices),
                                     diameter(nodes_of_master(view->master), masters[view->master].n_vertices));
        const double gap = distance(*view, middle(view->region.polygon));
        const bool far = std::isfinite(gap) && gap > options.distance_limit * size;
        if (far) reject(view->master, Rejection::too_far);
        return far;
      });
    std::sort(views.begin(), views.end(), sooner);

    // Where several masters cover a part of the slave, the nearest along the normal keeps it.
    kept.clear();
    const double overlap = tolerances.overlap * e.chart_area;
    const double strip = 0.25 * overlap / e.chart_diameter;  // a common strip of this width is less than `overlap`
    bool any_hidden = false;
    for (View* const first : views) {
      todo.assign(1, first);
      while (!todo.empty()) {
        View* const view = todo.back();
        todo.pop_back();
        bool whole = true;
        for (std::size_t k = 0; k < kept.size() && whole; ++k) {
          View* const old = kept[k];
          if (old->piece != view->piece || separated(old->region, view->region, strip)) continue;
          const Region both = intersection(old->region, view->region);
          if (double_area(both.polygon) <= overlap) continue;
          const Vec2 y = middle(both.polygon);
          const double old_distance = distance(*old, y), new_distance = distance(*view, y);
          const bool old_wins = old_distance < new_distance || (old_distance == new_distance && old->master < view->master);
          const View &winner = old_wins ? *old : *view, &loser = old_wins ? *view : *old;
          reject(loser.master, Rejection::hidden);
          any_hidden = true;
          rest.clear();
          subtract(loser.region, winner.region, sliver, rest);
          if (old_wins) {
            for (Region& part : rest) {
              todo.push_back(new_view(loser.piece, loser.master));
              std::swap(todo.back()->region, part);
            }
            whole = false;
          } else {
            kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(k));
            for (Region& part : rest) {
              View* const left = new_view(loser.piece, loser.master);
              std::swap(left->region, part);
              kept.insert(kept.begin() + static_cast<std::ptrdiff_t>(k++), left);
            }
            --k;  // wraps at 0, and the loop steps back to it
          }
        }
        if (whole) kept.push_back(view);
      }
    }
    if (any_hidden) std::sort(kept.begin(), kept.end(), sooner);

    for (const View* const kept_view : kept) {
      const View& view = *kept_view;
      const FacetKind& f = masters[view.master];
      const Target target(f, nodes_of_master(view.master), e);
      place_points(view.region.polygon, options.degree > 0 ? options.degree : integration_degree(e, f), exact_polygons(e, f),
                   points);
      const std::size_t before_points = cells.weight.size(), before_vertices = cells.vertex.size();
      cells.slave_point.resize(2 * (before_points + points.weight.size()));
      cells.master_point.resize(2 * (before_points + points.weight.size()));
      cells.weight.resize(before_points + points.weight.size());
      const std::size_t n_points = points.weight.size();
      points.y.insert(points.y.end(), view.region.polygon.begin(), view.region.polygon.end());  // vertices behind them
      e.places(points.y, tolerances, lines, meetings, places);
      target.images(std::span(points.y).first(n_points), places, tolerances, lines, images);
      bool complete = std::all_of(places.begin(), places.end(), [](const SlaveFacet::Place& place) { return place.found; });
      std::size_t at = 2 * before_points;
      for (std::size_t i = 0; i < n_points; ++i, at += 2) {
        const Vec2 xi = places[i].xi, eta = images[i].xi;
        complete = complete && images[i].found;
        cells.slave_point[at] = xi.x, cells.slave_point[at + 1] = xi.y;
        cells.master_point[at] = eta.x, cells.master_point[at + 1] = eta.y;
        cells.weight[at / 2] = points.weight[i] * places[i].scale;
      }
      for (const SlaveFacet::Place& place : std::span(places).subspan(n_points)) {
        cells.vertex.push_back(place.xi.x);
        cells.vertex.push_back(place.xi.y);
      }
      if (!complete) {
        cells.slave_point.resize(2 * before_points);
        cells.master_point.resize(2 * before_points);
        cells.weight.resize(before_points);
        cells.vertex.resize(before_vertices);
        reject(view.master, Rejection::no_image);
        continue;
      }
      cells.slave.push_back(slave_index);
      cells.master.push_back(view.master);
      cells.offset.push_back(static_cast<std::int64_t>(cells.weight.size()));
      cells.vertex_offset.push_back(static_cast<std::int64_t>(cells.vertex.size() / 2));
    }
  }

 private:
  View* new_view(std::int32_t piece, std::int32_t m) {
    if (n_stored == store.size()) store.emplace_back();
    View& view = store[n_stored++];
    view.piece = piece;
    view.master = m;
    return &view;
  }

  std::shared_ptr<const Masters> masters_;
  // used again for every slave cell
  SlaveFacet e;
  std::vector<Vec3> polygon;
  std::vector<Part> parts;
  std::deque<View> store;
  std::size_t n_stored = 0;
  std::vector<View*> views, kept, todo;
  std::vector<Region> rest;
  Region seen;
  Polygon scratch;
  ChartPoints points;
  std::vector<Line> lines;
  std::vector<Meeting> meetings, images;
  std::vector<SlaveFacet::Place> places;
};

}  // namespace

detail::MakeCellPairer detail::pair_in_space(const Surface& slave, const Surface& master, const PairingOptions& options,
                                             std::vector<RejectedCouple>& rejected) {
  return [masters = std::make_shared<const Masters>(slave, master, options, rejected)] {
    return std::make_unique<PairerInSpace>(masters);
  };
}

}  // namespace lacon
