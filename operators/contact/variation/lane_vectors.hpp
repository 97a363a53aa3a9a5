#pragma once
// Vectors of the plane and of space at LACON_LANES points at a time, for the kernels of derivatives: all of it is inlined.
#include <cmath>

#include "lacon/elements/lanes.hpp"
#include "lacon/elements/reference.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed between inlined functions alone

namespace lacon::variations {

template <int D>
struct LaneVector {
  Lanes of[D] = {};

  LACON_INLINE Lanes& operator[](int i) { return of[i]; }
  LACON_INLINE const Lanes& operator[](int i) const { return of[i]; }
  LACON_INLINE LaneVector& operator+=(const LaneVector& b) {
    for (int i = 0; i < D; ++i) of[i] += b.of[i];
    return *this;
  }
};

template <int D>
LACON_INLINE LaneVector<D> operator+(LaneVector<D> a, const LaneVector<D>& b) {
  return a += b;
}
template <int D>
LACON_INLINE LaneVector<D> operator-(LaneVector<D> a, const LaneVector<D>& b) {
  for (int i = 0; i < D; ++i) a[i] -= b[i];
  return a;
}
template <int D>
LACON_INLINE LaneVector<D> operator*(const Lanes& factor, LaneVector<D> a) {
  for (int i = 0; i < D; ++i) a[i] *= factor;
  return a;
}
template <int D>
LACON_INLINE Lanes dot(const LaneVector<D>& a, const LaneVector<D>& b) {
  Lanes sum = a[0] * b[0];
  for (int i = 1; i < D; ++i) sum += a[i] * b[i];
  return sum;
}
LACON_INLINE LaneVector<3> cross(const LaneVector<3>& a, const LaneVector<3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
LACON_INLINE Lanes root(const Lanes& x) {
  Lanes roots;
  for (int l = 0; l < LACON_LANES; ++l) roots[l] = std::sqrt(x[l]);
  return roots;
}
template <int D>
LACON_INLINE Lanes length(const LaneVector<D>& a) {
  return root(dot(a, a));
}
/// The same vector everywhere.
template <int D>
LACON_INLINE LaneVector<D> everywhere(const double* x) {
  LaneVector<D> vector;
  for (int i = 0; i < D; ++i) vector[i] += x[i];
  return vector;
}
/// The vector at a right angle to the tangent that points out of the body.
LACON_INLINE LaneVector<2> out_of(const LaneVector<2>& t) { return {{t[1], -t[0]}}; }

/// What factor . N is to each tangent t, N the area normal.
template <int D>
LACON_INLINE void of_tangents(const LaneVector<D>* t, const LaneVector<D>& factor, LaneVector<D>* out) {
  if constexpr (D == 2) {
    out[0] = {{-factor[1], factor[0]}};
  } else {
    out[0] = cross(t[1], factor);
    out[1] = cross(factor, t[0]);
  }
}

/// Shape functions of a skin cell, (derivative, node): the value, first, second and third derivatives.
template <int D>
struct LaneShapes {
  static constexpr int R = D - 1, max_nodes = 9;
  static constexpr int first = 1, second = 1 + R, third = D == 2 ? 3 : 6, end = D == 2 ? 4 : 10;
  int n;
  alignas(lane_alignment) double of[end * max_nodes * LACON_LANES];

  /// @param xi (R, LACON_LANES)
  LACON_INLINE LaneShapes(CellType type, const double* xi, int order) : n(catalog::cell(type).n_nodes) {
    shape_lanes(type, xi, order, of);
  }
  LACON_INLINE Lanes value(int node) const { return lanes(of, node); }
  LACON_INLINE Lanes slope(int node, int i) const { return lanes(of, (first + i) * n + node); }
  LACON_INLINE Lanes bend(int node, int i, int j) const { return lanes(of, (second + i + j) * n + node); }
};

/// What nodal vectors interpolate to, with derivatives by the reference coordinates.
template <int D>
struct LaneInterpolated {
  using Shapes = LaneShapes<D>;
  static constexpr int R = D - 1;
  LaneVector<D> all[Shapes::end];

  /// @param order of derivatives; 0: nothing at all  @param nodes (n, D)
  LACON_INLINE LaneInterpolated(const Shapes& shapes, int order, const double* nodes) {
    const int derivatives = order == 0 ? 0 : order == 1 ? Shapes::second : order == 2 ? Shapes::third : Shapes::end;
    for (int k = 0; k < derivatives; ++k) {
      LaneVector<D> sum;
      for (int a = 0; a < shapes.n; ++a) {
        const Lanes& value = lanes(shapes.of, k * shapes.n + a);
        for (int d = 0; d < D; ++d) sum[d] += value * nodes[a * D + d];
      }
      all[k] = sum;
    }
  }
  LACON_INLINE const LaneVector<D>& x() const { return all[0]; }
  LACON_INLINE const LaneVector<D>* slopes() const { return all + Shapes::first; }
  LACON_INLINE const LaneVector<D>& d(int i) const { return all[Shapes::first + i]; }
  LACON_INLINE const LaneVector<D>& dd(int i, int j) const { return all[Shapes::second + i + j]; }
  LACON_INLINE const LaneVector<D>& ddd(int by_eta) const { return all[Shapes::third + by_eta]; }
};

/// The area normal of a skin, with derivatives by the reference coordinates where only these move.
template <int D>
struct LaneNormal {
  static constexpr int R = D - 1;
  LaneVector<D> n, d[R];

  LACON_INLINE explicit LaneNormal(const LaneInterpolated<D>& skin) {
    if constexpr (D == 2) {
      n = out_of(skin.d(0));
      d[0] = out_of(skin.dd(0, 0));
    } else {
      n = cross(skin.d(0), skin.d(1));
      for (int i = 0; i < R; ++i) d[i] = cross(skin.dd(0, i), skin.d(1)) + cross(skin.d(0), skin.dd(1, i));
    }
  }
  /// The second derivative by the reference coordinates i and j.
  LACON_INLINE static LaneVector<D> second(const LaneInterpolated<D>& skin, int i, int j) {
    if constexpr (D == 2)
      return out_of(skin.ddd(0));
    else
      return cross(skin.dd(0, i), skin.dd(1, j)) + cross(skin.dd(0, j), skin.dd(1, i)) + cross(skin.ddd(i + j), skin.d(1)) +
             cross(skin.d(0), skin.ddd(i + j + 1));
  }
};

}  // namespace lacon::variations
