#pragma once
// The geometry of a facet as a polynomial of its reference coordinates, in space or projected to a plane.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lacon/catalog/cells.hpp"
#include "lacon/pairing/polygon.hpp"

namespace lacon::space {

/// sum of c[t] xi^i eta^j over the terms (i, j) of the kind of facet: TRIA3 takes the first three, QUAD4 four, TRIA6 six, QUAD8
/// and QUAD9 nine.
template <class Vec>
struct FacetMap {
  int n = 0;
  std::array<Vec, 9> c;  ///< the first n of them: of 1, xi, eta, xi eta, xi^2, eta^2, xi^2 eta, xi eta^2, xi^2 eta^2

  struct Value {
    Vec x, d1, d2;  ///< position, derivatives by xi and by eta
  };
  Value operator()(Vec2 p) const {
    Value v{c[0] + p.x * c[1] + p.y * c[2], c[1], c[2]};
    if (n > 3) {
      v.x = v.x + (p.x * p.y) * c[3];
      v.d1 = v.d1 + p.y * c[3];
      v.d2 = v.d2 + p.x * c[3];
    }
    if (n > 4) {
      v.x = v.x + (p.x * p.x) * c[4] + (p.y * p.y) * c[5];
      v.d1 = v.d1 + (2 * p.x) * c[4];
      v.d2 = v.d2 + (2 * p.y) * c[5];
    }
    if (n > 6) {
      const double xx = p.x * p.x, yy = p.y * p.y, xy = p.x * p.y;
      v.x = v.x + (xx * p.y) * c[6] + (p.x * yy) * c[7] + (xx * yy) * c[8];
      v.d1 = v.d1 + (2 * xy) * c[6] + yy * c[7] + (2 * p.x * yy) * c[8];
      v.d2 = v.d2 + xx * c[6] + (2 * xy) * c[7] + (2 * xx * p.y) * c[8];
    }
    return v;
  }
};
using Map3 = FacetMap<Vec3>;
using Map2 = FacetMap<Vec2>;

/// The map through values at the nodes of a facet. @param values (n_nodes) in the order of catalog/cells.toml
Map3 interpolate(CellType type, std::span<const Vec3> values);

/// Its components along two directions.
Map2 project(const Map3& map, Vec3 e1, Vec3 e2);

/// Whether a reference point lies within `margin` of the reference cell.
inline bool near_reference_cell(Family family, Vec2 p, double margin) {
  return family == Family::TRIA ? p.x >= -margin && p.y >= -margin && p.x + p.y <= 1 + margin
                                : std::max(std::abs(p.x), std::abs(p.y)) <= 1 + margin;
}

/// Where a map takes the value y: Newton's method from the middle of the reference cell, with shorter steps where the residual
/// would grow.
/// @param tolerance largest residual, a length. Empty where the method ends elsewhere, or further than `margin` from the
/// reference cell.
std::optional<Vec2> inverse(const Map2& map, Family family, Vec2 y, double tolerance, double margin);

/// A line in space.
struct Line {
  Vec3 x, n;  ///< a point, the unit direction
};

/// Where a line meets a facet.
struct Meeting {
  bool found;
  Vec2 xi;
  double jacobian;  ///< of the facet seen along the line
};

/// Where many lines meet a facet: Newton's method as in inverse(), without its shorter steps, for eight lines at a time. What a
/// line gets does not depend on the others. Not found is also what is not straightforward: inverse() may still find it.
/// @param[out] meetings (lines)
void meet(const Map3& map, Family family, std::span<const Line> lines, double tolerance, double margin,
          std::span<Meeting> meetings);

/// The inverse of a map of the plane: at once where it is affine, by Newton's method elsewhere.
class Inverse {
 public:
  Inverse() = default;
  Inverse(const Map2& map, Family family);

  /// As the function above.
  std::optional<Vec2> operator()(Vec2 y, double tolerance, double margin) const {
    if (!affine_) return inverse(map_, family_, y, tolerance, margin);
    const Vec2 xi = of_affine(y);
    if (!near_reference_cell(family_, xi, margin)) return std::nullopt;
    return xi;
  }
  bool affine() const { return affine_; }
  /// The same where the map is affine, however far outside the reference cell.
  Vec2 of_affine(Vec2 y) const {
    const Vec2 r = y - map_.c[0];
    return {dot(row1_, r), dot(row2_, r)};
  }
  /// The Jacobian at a reference point.
  double jacobian(Vec2 xi) const {
    if (affine_) return jacobian_;
    const Map2::Value v = map_(xi);
    return cross(v.d1, v.d2);
  }

 private:
  Map2 map_;
  Family family_{};
  bool affine_ = false;
  double jacobian_ = 0;
  Vec2 row1_{}, row2_{};  ///< of the inverse matrix
};

/// Whether a map is affine to round-off: neither Jacobian nor normal change by more. Never for a map without a Jacobian along
/// `normal`.
bool is_affine(const Map3& map, Vec3 normal);

/// One over the distance of the nearest singularity of the inverse map, for a facet that reaches from -1 to 1; 0 for an affine
/// facet, 1 for a folded one. With d = (max J - min J) / (max J + min J) of the Jacobian along `normal` over vertices, middles
/// of edges and the middle, it is d for a bilinear map, J = 1 + d s, whose inverse has a pole at 1 / d; a quadratic one, x = s
/// + d s^2 / 2, has a branch point where J = 0, and that place is (d + 1 / d) / 2 in x.
double distortion(const Map3& map, Family family, Vec3 normal);

/// Vectors whose convex hull holds every value of a polynomial on the reference cell: its Bernstein coefficients.
/// @param degree 1 or 2 in both coordinates together on triangles; 1, 2 or 3 in each of them on quadrangles
std::vector<Vec3> hull(Family family, int degree, const std::function<Vec3(Vec2)>& polynomial);

/// Reference points where a facet is examined: vertices, middles of edges, the middle.
std::span<const Vec2> probes(Family family);

}  // namespace lacon::space
