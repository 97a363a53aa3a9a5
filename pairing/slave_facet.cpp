#include "lacon/pairing/slave_facet.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

#include "lacon/pairing/detail.hpp"

namespace lacon::space {
namespace {

/// Whether the map of a facet of the second order is affine, but for what small deformations leave: opposite edges are
/// parallel, other nodes lie in the middle of corners.
bool is_nearly_affine(const Facet& f) {
  constexpr double small = 1e-3;
  const auto off = [&](Vec3 d) { return norm(d) > small * f.size; };
  const int n = f.n_vertices;
  if (n == 4 && off((f.nodes[0] - f.nodes[1]) + (f.nodes[2] - f.nodes[3]))) return false;
  for (int i = 0; i < n; ++i)
    if (off(f.nodes[n + i] - 0.5 * (f.nodes[i] + f.nodes[(i + 1) % n]))) return false;
  return f.type != CellType::QUAD9 || !off(f.nodes[8] - 0.5 * (f.nodes[0] + f.nodes[2]));
}

}  // namespace

void SlaveFacet::set(const Surface& surface, std::size_t cell, double size, const PairingTolerances& tolerances) {
  degenerate = true;
  constant = false;
  if (!detail::finite(surface, cell)) return;
  f = facet(surface, cell, tolerances.straight);
  n = f.normal;
  if (!(f.size > tolerances.degenerate * size)) return;
  take_normals(surface, cell);
  // A corner may have no normal (two nodes in one place, three corners on a line), the middle must.
  least_ = tolerances.degenerate * (smooth_ ? 1 : f.size * f.size);
  const std::optional<double> turn = largest_turn(tolerances);
  if (!turn) return;
  degenerate = false;
  turn_ = *turn;
  cut_ = suited_cut(turn_, tolerances);
  if (!surface.cuts.empty()) {
    cut_.refine(surface.cuts[cell]);
    surface.cuts[cell] = cut_;
  }
  nearly_flat = cut_.steps == 1;
  constant_ = nearly_flat && turn_ <= tolerances.flat;
}

void SlaveFacet::lay_out(bool in_triangles) {
  constant = constant_ && !in_triangles;
  // in the reference cell middle nodes move points at any bulge; lines of masters are straight there if its map is affine
  plane = !cut_.curved && !(in_triangles && cut_.affine);
  set_chart();
  set_pieces(cut_.steps);
  set_reach();
}

/// Nodal normals, where the surface has them (LISSAGE).
void SlaveFacet::take_normals(const Surface& surface, std::size_t cell) {
  smooth_ = !surface.normals.empty();
  if (!smooth_) return;
  Nodes normals;
  const auto nodes = surface.nodes[cell];
  for (std::size_t i = 0; i < nodes.size(); ++i)
    normals[i] = vector_at(surface.normals.data() + 3 * static_cast<std::size_t>(nodes[i]));
  nodal_ = interpolate(f.type, std::span<const Vec3>(normals).first(nodes.size()));
}

/// The largest distance of a unit normal from the mean one; nothing where the facet is folded.
std::optional<double> SlaveFacet::largest_turn(const PairingTolerances& tolerances) const {
  double turn = 0;
  const std::span<const Vec2> all_places = probes(f.family);
  const auto places = all_places.last(f.affine && !smooth_ ? 1 : all_places.size());
  for (const Vec2 p : places) {
    const Map3::Value v = f.x(p);
    const double jacobian = dot(cross(v.d1, v.d2), n), none = tolerances.degenerate * f.size * f.size;
    if (!(jacobian > (&p == &places.back() ? none : -none))) return std::nullopt;
    const Vec3 m = direction(p);
    if (!(dot(m, n) > tolerances.degenerate)) return std::nullopt;
    turn = std::max(turn, norm(m - n));
  }
  return turn;
}

void SlaveFacet::set_chart() {
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
}

SlaveCut SlaveFacet::suited_cut(double turn, const PairingTolerances& tolerances) const {
  SlaveCut cut{.curved = !f.straight, .affine = f.order > 1 && is_nearly_affine(f)};
  if (turn <= tolerances.nearly_flat && f.straight) return cut;
  // both are the same whichever node is the first
  double bulge = 0;
  for (int i = 0; i < f.n_vertices && !f.straight; ++i)
    bulge = std::max(bulge, norm(f.nodes[f.n_vertices + i] - 0.5 * (f.nodes[i] + f.nodes[(i + 1) % f.n_vertices])));
  const double steps = 8 * std::max(turn, 4 * bulge / diameter(f.nodes, f.n_vertices));
  const int most = f.family == Family::TRIA ? 6 : 4;
  const double of_family = f.family == Family::TRIA ? steps : steps / std::numbers::sqrt2;
  cut.steps = static_cast<std::uint8_t>(1 + std::clamp(static_cast<int>(std::ceil(of_family)), 1, most - 1));
  return cut;
}

void SlaveFacet::set_pieces(int steps) {
  if (constant) {
    pieces.resize(1);
    Piece& piece = pieces[0];
    piece.polygon.clear();
    for (int i = 0; i < f.n_vertices; ++i) piece.polygon.push_back({dot(f.nodes[i], e1), dot(f.nodes[i], e2)});
    piece.normal = n;
    piece.reach = Prism();  // the slave's own one is as good

  } else {
    pieces.clear();
    subdivide(plane ? steps : std::max(steps, 2));
  }
  chart_area = 0;
  for (const Piece& piece : pieces) chart_area += double_area(piece.polygon);
  chart_diameter = plane ? 2 * f.size : 3;
}

/// Triangles on a grid of k steps.
void SlaveFacet::subdivide(int k) {
  const auto vertex = [&](double a, double b) {
    const Vec2 xi = f.family == Family::TRIA ? Vec2{a / k, b / k} : Vec2{2 * a / k - 1, 2 * b / k - 1};
    return xi;
  };
  const auto add = [&](Vec2 a, Vec2 b, Vec2 c) {
    Piece piece;
    const std::array<Vec2, 3> xi{a, b, c};
    for (int i = 0; i < 3; ++i) {
      piece.xi[i] = xi[i];
      piece.x[i] = f.x(xi[i]).x;
      piece.n[i] = direction(xi[i]);
      piece.polygon.push_back(plane ? chart_(xi[i]).x : xi[i]);
      piece.normal = piece.normal + (1.0 / 3) * piece.n[i];
    }
    if (!(double_area(piece.polygon) > 0)) return;  // the facet has collapsed there
    set_reach(piece);
    pieces.push_back(std::move(piece));
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

/// What a piece sees is where affine functions are positive that the sides of its vertices' normals give (`side`). Along an
/// edge of a master they differ from the sides of interpolated normals that start at interpolated points by less than a third
/// of how far these normals turn over the piece.
void SlaveFacet::set_reach(Piece& piece) {
  double turn = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    turn = std::max(turn, norm(piece.n[(i + 1) % 3] - piece.n[i]));
    size = std::max(size, norm(piece.x[(i + 1) % 3] - piece.x[i]));
  }
  piece.reach = Prism(piece.x, (1 / norm(piece.normal)) * piece.normal);
  for (int i = 0; i < 3; ++i) {
    piece.reach.hold(piece.x[i]);
    piece.reach.lean(piece.n[i]);
  }
  piece.reach.widen(turn * size, turn * size);
}

void SlaveFacet::set_reach() {
  reach_ = Prism(std::span(f.nodes).first(static_cast<std::size_t>(f.n_vertices)), n);
  if (constant) {
    for (int k = 0; k < f.n_vertices; ++k) reach_.hold(f.nodes[k]);
    return;
  }
  for (const Vec3 x : hull(f.family, f.order, [&](Vec2 xi) { return f.x(xi).x; })) reach_.hold(x);
  reach_.widen(0, 0.25 * f.size);  // pieces go wrong along the border
  const int degree = smooth_ ? f.order : f.family == Family::TRIA ? std::max(1, 2 * f.order - 2) : 2 * f.order - 1;
  for (const Vec3 m : hull(f.family, degree, [&](Vec2 xi) { return unscaled_direction(xi); }))
    if (norm(m) > least_) reach_.lean(m);
}

void SlaveFacet::places(std::span<const Vec2> y, const PairingTolerances& tolerances, std::vector<Line>& lines,
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

}  // namespace lacon::space
