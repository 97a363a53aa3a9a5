#pragma once
// What an element's matrix is made of: a point with its gradients, stress and tangent, and the sums over its nodes.
#include "geometry.hpp"
#include "von_mises.hpp"

namespace lacon::solid {

/// DEFORMATION: small strains (PETIT); small increments of strain on the geometry of u (PETIT_REAC), or on the one in the
/// middle of the step (PETIT_REAC_MILIEU), with forces on that of u; Green-Lagrange strains and second Piola-Kirchhoff stresses
/// on the initial geometry (GREEN_LAGRANGE).
enum class Measure { small, updated, centred, green };
enum class Law { elastic, von_mises, kinematic };
constexpr bool flows(Law law) { return law != Law::elastic; }

/// Whether strains are increments, and forces those on the geometry of u.
constexpr bool moves(Measure measure) { return measure == Measure::updated || measure == Measure::centred; }

/// Where row n of a matrix starts, in numbers: behind n (n + 1) / 2 entries.
constexpr int start_of_row(int n) { return n * (n + 1) / 2 * LACON_LANES; }

/// What the loop over nodes needs at a point.
template <Kind K>
struct Point {
  static constexpr int D = dimension_of(K), n = components_of(K);
  Lanes dv;
  Lanes g[max_nodes][D];                        ///< gradients of the shape functions
  Lanes hoop[K == Kind::axis ? max_nodes : 1];  ///< N / r
  Lanes slope[D][D];                            ///< gradient of the displacement that strains are made of
  Lanes hoop_slope;                             ///< u_r / r
  Lanes middle[D][D];                           ///< centred: derivative of the geometry of u by that of the middle
  Lanes hoop_middle;                            ///< likewise r of u over r of the middle
  Lanes stress[n];                              ///< in equilibrium: Cauchy's; with Green-Lagrange the second Piola-Kirchhoff
  Tangent<K> tangent;

  static constexpr int n_slopes = K == Kind::axis ? 3 : D;
  /// Gradient of shape function a, and behind it in axisymmetry its N / r.
  LACON_INLINE const Lanes& slope_of(int a, int i) const { return i < D ? g[a][i] : hoop[K == Kind::axis ? a : 0]; }
};

// Points whose gradients are kept for add_elastic_matrix: those of QUAD9 and HEXA8 at once, a third of HEXA27's, in the fast
// cache.
constexpr int points_at_once = 9;

/// The matrix of small strains where all points have the same moduli. Of nodes a, c the sum over points M = dv G_a (x) G_c of
/// slopes G is enough: the entries are lambda M_ik + mu M_ki + mu tr(M) delta_ik, with terms of u_r / r in axisymmetry. M stays
/// in registers while the points pass, so that each entry is written once.
/// @param first whether what `matrix` held before is overwritten, not added to
template <Kind K>
LACON_INLINE void add_elastic_matrix(const Point<K>* points, int n_points, const Lanes& lambda, const Lanes& mu, int nodes,
                                     bool first, double* matrix) {
  constexpr bool axis = K == Kind::axis;
  constexpr int D = dimension_of(K), S = Point<K>::n_slopes;
  alignas(lane_alignment) Lanes weighted[points_at_once][S];
  for (int a = 0; a < nodes; ++a) {
    for (int p = 0; p < n_points; ++p)
      for (int i = 0; i < S; ++i) weighted[p][i] = points[p].dv * points[p].slope_of(a, i);
    double* row[D];
    for (int i = 0; i < D; ++i) row[i] = matrix + start_of_row(D * a + i);
    for (int c = 0; c <= a; ++c) {
      Lanes m[S][S] = {};
      for (int p = 0; p < n_points; ++p)
        for (int i = 0; i < S; ++i)
          for (int k = 0; k < S; ++k) m[i][k] += weighted[p][i] * points[p].slope_of(c, k);
      Lanes shear = m[0][0];
      for (int k = 1; k < D; ++k) shear += m[k][k];
      shear *= mu;
      for (int i = 0; i < D; ++i)
        for (int k = 0; k < D; ++k) {
          if (c == a && k > i) continue;
          Lanes traces = m[i][k];
          if (axis && i == 0) traces += m[S - 1][k];
          if (axis && k == 0) traces += m[i][S - 1];
          if (axis && i == 0 && k == 0) traces += m[S - 1][S - 1];
          Lanes entry = lambda * traces + mu * m[k][i];
          if (i == k) entry += shear;
          if (axis && i == 0 && k == 0) entry += 2 * mu * m[S - 1][S - 1];
          Lanes& sum = lanes(row[i], D * c + k);
          sum = first ? entry : sum + entry;
        }
    }
  }
}

/// The matrix of small strains and of Green-Lagrange strains. The change of strain by node a and direction i is the symmetric
/// part of F_i (x) g_a, where F_i is row i of the deformation gradient (small strains: of the unit matrix).
template <Kind K, Measure M, Law L>
LACON_INLINE void add_matrix(const Point<K>& point, int nodes, double* matrix) {
  constexpr bool axis = K == Kind::axis, green = M == Measure::green, rank_one = flows(L);
  constexpr int D = dimension_of(K);
  const Lanes dl = point.dv * point.tangent.lambda, dm = point.dv * point.tangent.mu;
  Lanes pushed[green ? max_nodes : 1][D];  // F g
  Lanes left[D][D];                        // F F^T
  const Lanes stretch = 1 + point.hoop_slope;
  if constexpr (green) {
    Lanes f[D][D];
    for (int i = 0; i < D; ++i)
      for (int k = 0; k < D; ++k) f[i][k] = point.slope[i][k] + (i == k ? 1.0 : 0.0);
    for (int i = 0; i < D; ++i)
      for (int k = 0; k < D; ++k) {
        left[i][k] = f[i][0] * f[k][0];
        for (int m = 1; m < D; ++m) left[i][k] += f[i][m] * f[k][m];
      }
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < D; ++i) {
        pushed[a][i] = f[i][0] * point.g[a][0];
        for (int m = 1; m < D; ++m) pushed[a][i] += f[i][m] * point.g[a][m];
      }
  }
  const Lanes(*const strain)[D] = green ? pushed : point.g;
  [[maybe_unused]] Lanes with_ring[axis ? max_nodes : 1];
  if constexpr (axis)
    for (int a = 0; a < nodes; ++a) with_ring[a] = strain[a][0] + (green ? stretch * point.hoop[a] : point.hoop[a]);
  const auto trace = [&](int a, int i) LACON_INLINE_LAMBDA -> const Lanes& {  // of the change of strain
    return axis && i == 0 ? with_ring[axis ? a : 0] : strain[a][i];
  };
  Lanes along[rank_one ? max_nodes : 1][D];  // the change of strain along the tangent's direction
  if constexpr (rank_one)
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < D; ++i) {
        along[a][i] = point.tangent.direction[at(i, 0)] * point.g[a][0];
        for (int k = 1; k < D; ++k) along[a][i] += point.tangent.direction[at(i, k)] * point.g[a][k];
        if (axis && i == 0) along[a][i] += point.tangent.direction[2] * point.hoop[a];
      }
  for (int a = 0; a < nodes; ++a) {
    Lanes la[D], ma[D], drawn[D];  // of the divergence, of the gradient, of the stress
    for (int i = 0; i < D; ++i) {
      la[i] = dl * trace(a, i);
      ma[i] = dm * strain[a][i];
    }
    Lanes ga[D];
    for (int k = 0; k < D; ++k) ga[k] = dm * point.g[a][k];
    if constexpr (green)
      for (int k = 0; k < D; ++k) {
        drawn[k] = point.stress[at(k, 0)] * point.g[a][0];
        for (int m = 1; m < D; ++m) drawn[k] += point.stress[at(k, m)] * point.g[a][m];
        drawn[k] *= point.dv;
      }
    double* row[D];
    for (int i = 0; i < D; ++i) row[i] = matrix + start_of_row(D * a + i);
    for (int c = 0; c <= a; ++c) {
      Lanes both = ga[0] * point.g[c][0];
      for (int k = 1; k < D; ++k) both += ga[k] * point.g[c][k];
      [[maybe_unused]] Lanes geometric = {};
      if constexpr (green)
        for (int k = 0; k < D; ++k) geometric += drawn[k] * point.g[c][k];
      for (int i = 0; i < D; ++i)
        for (int k = 0; k < D; ++k) {
          if (c == a && k > i) continue;
          Lanes entry = la[i] * trace(c, k) + ma[k] * strain[c][i];
          if constexpr (green) {
            entry += left[i][k] * both;
            if (i == k) entry += geometric;
          } else if (i == k) {
            entry += both;
          }
          if (axis && i == 0 && k == 0) {
            const Lanes ring = point.hoop[a] * point.hoop[c];
            if constexpr (green)
              entry += (2 * dm * stretch * stretch + point.dv * point.stress[2]) * ring;
            else
              entry += 2 * dm * point.hoop[a] * point.hoop[c];
          }
          if constexpr (rank_one) entry -= point.dv * point.tangent.rank * along[a][i] * along[c][k];
          lanes(row[i], D * c + k) += entry;
        }
    }
  }
}

/// The matrix of PETIT_REAC, and of the same centred: the derivative of the force on the geometry of u, which moves with u. It
/// is symmetric only up to terms of the size of the stress.
/// @tparam whole the derivative itself, (ndof, ndof); else the lower triangle of its symmetric part
template <Kind K, Measure M, Law L, bool whole>
LACON_INLINE void add_updated_matrix(const Point<K>& point, int nodes, double* matrix) {
  constexpr bool axis = K == Kind::axis, centred = M == Measure::centred;
  constexpr int D = dimension_of(K);
  constexpr double share = centred ? 0.5 : 1.0;  // of the step, that the geometry of strains moves by
  const Tangent<K>& tangent = point.tangent;
  const Lanes(&g)[max_nodes][D] = point.g;
  // the strain of the step changes by sym(A dh), dh the change of displacement's gradient on the geometry of strains
  Lanes shrink[D][D];
  for (int i = 0; i < D; ++i)
    for (int k = 0; k < D; ++k) shrink[i][k] = (i == k ? 1.0 : 0.0) - share * point.slope[i][k];
  const Lanes hoop_shrink = 1 - share * point.hoop_slope;
  Lanes own[centred ? max_nodes : 1][D], own_hoop[centred && axis ? max_nodes : 1];  // gradients on that geometry
  if constexpr (centred)
    for (int a = 0; a < nodes; ++a) {
      for (int i = 0; i < D; ++i) {
        own[a][i] = g[a][0] * point.middle[0][i];
        for (int k = 1; k < D; ++k) own[a][i] += g[a][k] * point.middle[k][i];
      }
      if constexpr (axis) own_hoop[a] = point.hoop[a] * point.hoop_middle;
    }
  const Lanes(*const strain)[D] = centred ? own : g;
  const Lanes* const ring = centred && axis ? own_hoop : point.hoop;
  Lanes mixed[max_nodes][D], drawn[max_nodes][D];        // A^T g, sigma g
  Lanes mixed_strain[max_nodes][D];                      // A^T g of strains
  Lanes along[max_nodes][D], mixed_along[max_nodes][D];  // direction g, A^T direction g of strains
  for (int a = 0; a < nodes; ++a) {
    Lanes along_strain[D];
    for (int i = 0; i < D; ++i) {
      mixed[a][i] = mixed_strain[a][i] = drawn[a][i] = along[a][i] = along_strain[i] = Lanes{};
      for (int k = 0; k < D; ++k) {
        mixed[a][i] += shrink[k][i] * g[a][k];
        mixed_strain[a][i] += shrink[k][i] * strain[a][k];
        drawn[a][i] += point.stress[at(i, k)] * g[a][k];
        if (flows(L)) along[a][i] += tangent.direction[at(i, k)] * g[a][k];
        if (flows(L)) along_strain[i] += tangent.direction[at(i, k)] * strain[a][k];
      }
    }
    for (int i = 0; i < D; ++i) {
      mixed_along[a][i] = Lanes{};
      for (int k = 0; k < D; ++k) mixed_along[a][i] += shrink[k][i] * along_strain[k];
    }
    if (axis && flows(L)) {
      mixed_along[a][0] += tangent.direction[2] * hoop_shrink * ring[a];
      along[a][0] += tangent.direction[2] * point.hoop[a];
    }
  }
  Lanes trace[max_nodes][D], mixed_trace[max_nodes][D], whole_drawn[max_nodes][D];  // with the hoop direction
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < D; ++i) {
      trace[a][i] = g[a][i];
      mixed_trace[a][i] = mixed_strain[a][i];
      whole_drawn[a][i] = drawn[a][i];
      if (axis && i == 0) {
        trace[a][0] += point.hoop[a];
        mixed_trace[a][0] += hoop_shrink * ring[a];
        whole_drawn[a][0] += point.stress[2] * point.hoop[a];
      }
    }
  // entry += d force (a, i) / d u (c, j) over dv
  const auto add_derivative = [&](int a, int i, int c, int j, const Lanes& both, Lanes& entry) LACON_INLINE_LAMBDA {
    entry += tangent.lambda * trace[a][i] * mixed_trace[c][j] +
             tangent.mu * (shrink[i][j] * both + strain[c][i] * mixed[a][j]) + whole_drawn[a][i] * trace[c][j] -
             g[a][j] * drawn[c][i];
    if (axis && i == 0 && j == 0)
      entry += (2 * tangent.mu * hoop_shrink * ring[c] - point.stress[2] * point.hoop[c]) * point.hoop[a];
    if (flows(L)) entry -= tangent.rank * along[a][i] * mixed_along[c][j];
  };
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < D; ++i) {
      double* row = matrix + (whole ? (D * a + i) * D * nodes * LACON_LANES : start_of_row(D * a + i));
      for (int c = 0; c < (whole ? nodes : a + 1); ++c) {
        Lanes both = g[a][0] * strain[c][0], turned = g[c][0] * strain[a][0];
        for (int k = 1; k < D; ++k) both += g[a][k] * strain[c][k], turned += g[c][k] * strain[a][k];
        for (int j = 0; j < D && (whole || c < a || j <= i); ++j) {
          Lanes entry = {};
          add_derivative(a, i, c, j, both, entry);
          if (!whole) add_derivative(c, j, a, i, turned, entry);
          lanes(row, D * c + j) += (whole ? point.dv : point.dv / 2) * entry;
        }
      }
    }
}

}  // namespace lacon::solid
