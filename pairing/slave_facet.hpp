#pragma once
// A slave cell in space, ready to be cut: its chart, the convex pieces of it, and the normals over them.
//
// The chart of a facet with straight edges is its mean plane. If it is flat and has one normal, the side on which a normal
// passes an edge of a master is an affine function there: one piece, and exact polygons. Otherwise it is interpolated on a grid
// of triangles. A facet with curved edges has its reference cell as chart.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "lacon/pairing/box_tree.hpp"
#include "lacon/pairing/pairing.hpp"
#include "lacon/pairing/prism.hpp"
#include "lacon/pairing/skin_facet.hpp"

namespace lacon::space {

struct Piece {
  Polygon polygon;           ///< in the chart
  std::array<Vec3, 3> x, n;  ///< at its vertices, where the normal is not constant
  std::array<Vec2, 3> xi;    ///< likewise
  Vec3 normal{};             ///< mean
  Prism reach;               ///< of its normals; coordinates start at the slave's origin
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

  /// Examine a slave cell; `degenerate` says whether it cannot be paired. Only then can it be laid out.
  /// @param size the extent of its skin
  void set(const Surface& surface, std::size_t cell, double size, const PairingTolerances& tolerances);
  /// Its chart, and the pieces of it. @param in_triangles one flat piece will not do, as for a facet that is nearly flat
  void lay_out(bool in_triangles);
  /// To round-off: one normal, a plane, lines of masters that are straight in the chart of triangles too.
  bool whole() const { return constant_ && turn_ <= round_off && f.plane && (f.order == 1 || f.affine); }

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
              std::vector<Meeting>& meetings, std::vector<Place>& places) const;

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

  /// False only where no normal of the slave meets the box.
  bool touches(const Box<3>& box) const {
    const Vec3 low{box.low[0], box.low[1], box.low[2]}, high{box.high[0], box.high[1], box.high[2]};
    const Vec3 centre = 0.5 * (low + high) - f.origin, half = 0.5 * (high - low);
    return reach_.touches(centre, half) &&
           std::any_of(pieces.begin(), pieces.end(), [&](const Piece& piece) { return piece.reach.touches(centre, half); });
  }

 private:
  Vec3 unscaled_direction(Vec2 xi) const {
    if (smooth_) return nodal_(xi).x;
    const Map3::Value v = f.x(xi);
    return cross(v.d1, v.d2);
  }

  void take_normals(const Surface& surface, std::size_t cell);
  std::optional<double> largest_turn(const PairingTolerances& tolerances) const;
  void set_chart();
  /// What its shape asks for. @param turn as of largest_turn()
  SlaveCut suited_cut(double turn, const PairingTolerances& tolerances) const;
  void set_pieces(int steps);
  void subdivide(int k);
  void set_reach();
  static void set_reach(Piece& piece);

  static constexpr double round_off = 1e-12;

  bool smooth_ = false, constant_ = false;
  double turn_ = 0;  ///< of largest_turn()
  SlaveCut cut_;
  double least_ = 0;  ///< length of `unscaled_direction` below which there is none
  Map3 nodal_;
  Map2 chart_;
  Inverse from_chart_;
  Prism reach_;  ///< of all of it
};

}  // namespace lacon::space
