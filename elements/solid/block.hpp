#pragma once
// What solid kernels take out of a batch: a block of elements, and its points with their gradients.
#include "lacon/elements/axis.hpp"
#include "stiffness.hpp"
#include "von_mises.hpp"

namespace lacon::solid {

/// A block of elements: what holds at all of its points.
template <Kind K, Measure M>
struct Block {
  static constexpr int D = dimension_of(K);
  static constexpr bool updated = moves(M), green = M == Measure::green;

  const double* place;   ///< coordinates where strains and integrals are taken
  Lanes lambda, mu, nu;  ///< plane stress: the lambda that makes SIZZ zero
  /// With ECRO_LINE/D_SIGM_EPSI behind E and NU: the slope of R(p), which follows E where that follows the temperature.
  bool own_hardening;
  Lanes hardening_slope;
  alignas(lane_alignment) Lanes side[max_nodes * D];  ///< from the first node on: a cell far from the origin loses no digits
  /// What strains come from: with Green-Lagrange the whole displacement, for they do not add up.
  alignas(lane_alignment) Lanes moved[max_nodes * D];
  alignas(lane_alignment) Lanes current[updated ? max_nodes * D : 1];

  LACON_INLINE void read(const lacon_solid_batch& b, std::int64_t block, LaneErrors& errors) {
    const int nodes = b.n_nodes, dofs = D * nodes;
    const Lanes young = lanes(b.parameter, b.n_parameters * block);
    nu = lanes(b.parameter, b.n_parameters * block + 1);
    errors.set(~((young > 0) & (young - young == 0) & (nu > -1) & (nu < 0.5)), LACON_BAD_PARAMETER);
    own_hardening = b.n_parameters > 2;
    if (own_hardening) {
      const Lanes tension = lanes(b.parameter, b.n_parameters * block + 2);
      errors.set(~(tension < young), LACON_BAD_PARAMETER);
      hardening_slope = young * tension / (young - tension);
    }
    mu = young / (2 * (1 + nu));
    lambda = K == Kind::plane_stress ? young * nu / ((1 + nu) * (1 - nu)) : young * nu / ((1 + nu) * (1 - 2 * nu));
    const double* x = b.coordinates + block * dofs * LACON_LANES;
    const double* u = b.displacement + block * dofs * LACON_LANES;
    const double* from = b.previous_displacement ? b.previous_displacement + block * dofs * LACON_LANES : nullptr;
    place = x;
    if constexpr (updated) {
      for (int i = 0; i < dofs; ++i) current[i] = lanes(x, i) + lanes(u, i);
      place = reinterpret_cast<const double*>(current);
    }
    for (int i = 0; i < dofs; ++i) {
      moved[i] = !green && from ? lanes(u, i) - lanes(from, i) : lanes(u, i);
      side[i] = lanes(place, i) - lanes(place, i % D);
    }
    if constexpr (K == Kind::axis)
      for (int l = 0; l < LACON_LANES; ++l)
        errors.set(l, lacon::reaches_over_axis(nodes, [&](int i) { return lanes(x, i)[l]; }), LACON_BAD_RADIUS);
  }
};

/// Behind E and NU plastic laws may take ECRO_LINE/D_SIGM_EPSI.
LACON_INLINE bool fits(int n_parameters, bool plastic) { return n_parameters == 2 || (plastic && n_parameters == 3); }

/// Of all elements of a block.
template <Kind K, Measure M>
LACON_INLINE Hardening hardening_of(const lacon_solid_batch& b, const Block<K, M>& block) {
  return {b.curve, b.n_curve, block.own_hardening ? reinterpret_cast<const double*>(&block.hardening_slope) : nullptr};
}

/// Gradient of a displacement (nodes, D) at a point, and its u_r / r.
template <Kind K>
LACON_INLINE void take_slope(const Point<K>& point, const Lanes* displacement, int nodes,
                             Lanes (&slope)[dimension_of(K)][dimension_of(K)], Lanes& hoop_slope) {
  constexpr int D = dimension_of(K);
  Lanes sum[D][D] = {}, hoop_sum = {};
  for (int a = 0; a < nodes; ++a) {
    for (int i = 0; i < D; ++i)
      for (int k = 0; k < D; ++k) sum[i][k] += displacement[a * D + i] * point.g[a][k];
    if constexpr (K == Kind::axis) hoop_sum += point.hoop[a] * displacement[2 * a];
  }
  for (int i = 0; i < D; ++i)
    for (int k = 0; k < D; ++k) slope[i][k] = sum[i][k];
  hoop_slope = hoop_sum;
}

/// Take the gradient of an increment of displacement from the geometry of u to the middle of the step, whose places are those
/// of u less half the increment.
template <Kind K>
LACON_INLINE void take_middle(Point<K>& point, LaneErrors& errors) {
  constexpr int D = dimension_of(K);
  // the inverse of 1 - slope / 2, as of a map from the middle of a cell whose nodes lie at these columns
  double gradient[(D + 1) * D] = {};
  Lanes columns[(D + 1) * D] = {};
  for (int k = 0; k < D; ++k) {
    gradient[(k + 1) * D + k] = 1;
    for (int i = 0; i < D; ++i) columns[(k + 1) * D + i] = (i == k ? 1.0 : 0.0) - 0.5 * point.slope[i][k];
  }
  const Map<D> map(gradient, columns, D + 1, errors);
  Lanes slope[D][D];
  for (int i = 0; i < D; ++i)
    for (int k = 0; k < D; ++k) {
      point.middle[i][k] = map.inverse[i][k];
      slope[i][k] = point.slope[i][0] * map.inverse[0][k];
      for (int m = 1; m < D; ++m) slope[i][k] += point.slope[i][m] * map.inverse[m][k];
    }
  for (int i = 0; i < D; ++i)
    for (int k = 0; k < D; ++k) point.slope[i][k] = slope[i][k];
  if constexpr (K == Kind::axis) {
    point.hoop_middle = 1 / (1 - 0.5 * point.hoop_slope);
    errors.set(~(point.hoop_middle > 0), LACON_BAD_RADIUS);
    point.hoop_slope *= point.hoop_middle;
  }
}

/// Measure and gradients at point p, and the gradient of the displacement.
template <Kind K, Measure M>
LACON_INLINE void take_gradients(const lacon_solid_batch& b, int p, const Block<K, M>& block, Point<K>& point,
                                 LaneErrors& errors) {
  constexpr bool axis = K == Kind::axis;
  constexpr int D = dimension_of(K);
  const int nodes = b.n_nodes;
  const double* d = b.gradient + p * nodes * D;
  const Map<D> map(d, block.side, nodes, errors);
  point.dv = b.weight[p] * map.determinant;
  [[maybe_unused]] Lanes per_radius = {};
  if constexpr (axis) {
    Lanes r = {};
    for (int a = 0; a < nodes; ++a) r += b.shape[p * nodes + a] * lanes(block.place, 2 * a);
    errors.set(~(r > 0), LACON_BAD_RADIUS);
    per_radius = 1 / r;
    point.dv *= r;
  }
  for (int a = 0; a < nodes; ++a) {
    for (int i = 0; i < D; ++i) {
      point.g[a][i] = d[a * D] * map.inverse[0][i];
      for (int r = 1; r < D; ++r) point.g[a][i] += d[a * D + r] * map.inverse[r][i];
    }
    if constexpr (axis) point.hoop[a] = b.shape[p * nodes + a] * per_radius;
  }
  take_slope(point, block.moved, nodes, point.slope, point.hoop_slope);
  if constexpr (M == Measure::centred) take_middle(point, errors);
}

}  // namespace lacon::solid
