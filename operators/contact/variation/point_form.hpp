#pragma once
// The quadratic form of what moves at a point (point_sums.hpp), and rows by the nodes.
#include "lacon/operators/contact/variation/lane_vectors.hpp"

namespace lacon::variations {

/// Derivatives of a quantity at a point by what moves there: D = dy - dx, A and nodal N of the nodes alone, a . dy_i, and by
/// the reference coordinates; in the plane the radius of the nodes, in a plane chart A . dm.
template <int D, bool smooth, bool plane>
struct Local {
  static constexpr int R = D - 1;
  static constexpr int apart = 0, area = D, slide = 2 * D, xi = slide + R, normal = xi + R, last = normal + (smooth ? D : 0),
                       size = last + (D == 2 || plane ? 1 : 0);

  struct Row {
    Lanes of[size] = {};

    LACON_INLINE Row& operator+=(const Row& b) {
      for (int i = 0; i < size; ++i) of[i] += b.of[i];
      return *this;
    }
    LACON_INLINE friend Row operator*(const Lanes& factor, Row row) {
      for (int i = 0; i < size; ++i) row.of[i] *= factor;
      return row;
    }
    /// Add v . d of a vector that moves with the nodes and, by its slopes, with the reference coordinates.
    LACON_INLINE void add(int first, const LaneVector<D>& v, const LaneVector<D>* slopes) {
      for (int d = 0; d < D; ++d) of[first + d] += v[d];
      for (int j = 0; j < R; ++j) of[xi + j] += dot(v, slopes[j]);
    }
  };

  /// A sum of products of such rows.
  struct Form {
    Lanes of[size][size] = {};

    LACON_INLINE void add(const Row& first, const Row& second) {
      for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j) of[i][j] += first.of[i] * second.of[j];
    }
    /// Add factor |d of that vector|^2.
    LACON_INLINE void add_square(int first, const Lanes& factor, const LaneVector<D>* slopes) {
      for (int d = 0; d < D; ++d) of[first + d][first + d] += factor;
      for (int j = 0; j < R; ++j) {
        for (int d = 0; d < D; ++d) of[first + d][xi + j] += 2 * factor * slopes[j][d];
        for (int k = 0; k < R; ++k) of[xi + j][xi + k] += factor * dot(slopes[j], slopes[k]);
      }
    }
    /// Of the product of two different quantities.
    LACON_INLINE Lanes both(int i, int j) const { return of[i][j] + of[j][i]; }
    template <int N>
    LACON_INLINE LaneVector<N> block(int row, int first) const {
      LaneVector<N> v;
      for (int d = 0; d < N; ++d) v[d] = row == first + d ? of[row][row] : both(row, first + d);
      return v;
    }
  };
};

/// A row by the nodes: what it takes of each of their values and slopes.
template <int D>
struct NodeRow {
  LaneVector<D> apart, tangent[D - 1], slide[D - 1], normal;
};

}  // namespace lacon::variations
