#pragma once
// What solid kernels know of a cell: the map from the reference cell, gradients in space.
#include "lacon/elements/lanes.hpp"

namespace lacon::solid {

constexpr int max_nodes = 27;

// A determinant below this share of the size of its terms is round-off.
constexpr double flat = 1e-13;

enum class Kind { plane_strain, plane_stress, axis, three_d };

constexpr int dimension_of(Kind kind) { return kind == Kind::three_d ? 3 : 2; }
/// Components of a symmetric tensor: XX YY ZZ XY, in space XZ YZ too.
constexpr int components_of(Kind kind) { return kind == Kind::three_d ? 6 : 4; }
/// The place of component (i, k) among them.
constexpr int at(int i, int k) { return i == k ? i : i + k + 2; }

/// d x_i / d xi_r at a point, its determinant and inverse.
template <int D>
struct Map {
  Lanes inverse[D][D], determinant;  ///< inverse[r][i] = d xi_r / d x_i

  /// @param gradient (n_nodes, D), by reference coordinates @param side (n_nodes, D), from the first node on
  LACON_INLINE Map(const double* gradient, const Lanes* side, int nodes, LaneErrors& errors) {
    Lanes j[D][D] = {};
    for (int a = 1; a < nodes; ++a)
      for (int i = 0; i < D; ++i)
        for (int r = 0; r < D; ++r) j[i][r] += gradient[a * D + r] * side[a * D + i];
    Lanes size;
    if constexpr (D == 2) {
      determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
      size = j[0][0] * j[0][0] + j[0][1] * j[0][1] + j[1][0] * j[1][0] + j[1][1] * j[1][1];
      errors.set(~(determinant > flat * size), LACON_BAD_JACOBIAN);
      const Lanes scale = 1 / determinant;
      inverse[0][0] = j[1][1] * scale;
      inverse[0][1] = -j[0][1] * scale;
      inverse[1][0] = -j[1][0] * scale;
      inverse[1][1] = j[0][0] * scale;
    } else {
      for (int r = 0; r < 3; ++r)
        for (int i = 0; i < 3; ++i) {
          const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, i1 = (i + 1) % 3, i2 = (i + 2) % 3;
          inverse[r][i] = j[i1][r1] * j[i2][r2] - j[i1][r2] * j[i2][r1];
        }
      determinant = j[0][0] * inverse[0][0] + j[1][0] * inverse[0][1] + j[2][0] * inverse[0][2];
      size = (j[0][0] * j[0][0] + j[1][0] * j[1][0] + j[2][0] * j[2][0]) *
             (j[0][1] * j[0][1] + j[1][1] * j[1][1] + j[2][1] * j[2][1]) *
             (j[0][2] * j[0][2] + j[1][2] * j[1][2] + j[2][2] * j[2][2]);  // the square of Hadamard's bound
      errors.set(~((determinant > 0) & (determinant * determinant > flat * flat * size)), LACON_BAD_JACOBIAN);
      const Lanes scale = 1 / determinant;
      for (int r = 0; r < 3; ++r)
        for (int i = 0; i < 3; ++i) inverse[r][i] *= scale;
    }
  }
};

}  // namespace lacon::solid
