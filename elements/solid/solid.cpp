// Solid elements: a modelisation (Kind), a measure of strain (Measure) and a law, put together in one loop over elements.
#include <cmath>

#include "block.hpp"
#include "lacon/elements/lanes.hpp"
#include "stiffness.hpp"
#include "von_mises.hpp"

namespace {

using namespace lacon::solid;
using lacon::clear_lanes;
using lacon::lane_alignment;
using lacon::LaneErrors;
using lacon::Lanes;
using lacon::lanes;

/// Twice the strain, or its increment.
template <Kind K, Measure M>
LACON_INLINE void take_strain(const Point<K>& point, Lanes (&twice)[components_of(K)]) {
  constexpr bool green = M == Measure::green;
  constexpr int D = dimension_of(K);
  if constexpr (D == 2) twice[2] = Lanes{};
  for (int i = 0; i < D; ++i)
    for (int k = i; k < D; ++k) {
      Lanes& value = twice[at(i, k)];
      value = point.slope[i][k] + point.slope[k][i];
      if constexpr (green)
        for (int m = 0; m < D; ++m) value += point.slope[m][i] * point.slope[m][k];
    }
  if constexpr (K == Kind::axis) twice[2] = green ? point.hoop_slope * (2 + point.hoop_slope) : 2 * point.hoop_slope;
}

constexpr int n_variables_of(Law law) {
  return law == Law::kinematic ? n_kinematic_variables : law == Law::von_mises ? n_plastic_variables : 0;
}

/// The law: stress and tangent at a point. @param here its number among those of the batch
/// @param sum gets everything that must be finite
template <Kind K, Measure M, Law L>
LACON_INLINE void take_stress(const lacon_solid_batch& b, std::int64_t here, const Block<K, M>& block,
                              const Lanes (&twice)[components_of(K)], Point<K>& point, Lanes& sum, LaneErrors& errors) {
  constexpr int n_stress = components_of(K);
  Lanes thermal = {};  // twice the strain that is none of the stress's
  if (M == Measure::green && b.thermal_strain) thermal = 2 * lanes(b.thermal_strain, here);
  const Lanes pressure = block.lambda * (twice[0] + twice[1] + twice[2] - (K == Kind::plane_stress ? 2 : 3) * thermal) / 2;
  auto& s = point.stress;
  for (int i = 0; i < n_stress; ++i) s[i] = i < 3 ? pressure + block.mu * (twice[i] - thermal) : block.mu * twice[i];
  if (M != Measure::green && b.previous_stress)
    for (int i = 0; i < n_stress; ++i) s[i] += lanes(b.previous_stress, here * n_stress + i);
  if constexpr (K == Kind::plane_stress) s[2] = Lanes{};
  point.tangent = {block.lambda, block.mu};
  if constexpr (L == Law::von_mises) {
    Lanes strain = {}, flows = {};
    if (b.previous_variable) {
      strain = lanes(b.previous_variable, here * n_plastic_variables);
      flows = lanes(b.previous_variable, here * n_plastic_variables + 1);
    }
    return_to_criterion<K>(s, point.tangent, strain, flows, hardening_of(b, block), errors);
    if (b.variable) {
      lanes(b.variable, here * n_plastic_variables) = strain;
      lanes(b.variable, here * n_plastic_variables + 1) = flows;
    }
    sum += strain;
    if (b.elastic_matrix) point.tangent = {block.lambda, block.mu};
  }
  if constexpr (L == Law::kinematic) {
    constexpr int last = n_kinematic_variables - 1;
    const std::int64_t first = here * n_kinematic_variables;
    Lanes middle[n_stress] = {}, flowing = {};
    if (b.previous_variable) {
      for (int i = 0; i < n_stress; ++i) middle[i] = lanes(b.previous_variable, first + i);
      flowing = lanes(b.previous_variable, first + last);
    }
    Hardening hardening = hardening_of(b, block);
    hardening.size = 1;  // its first piece is the law
    return_to_moving_criterion<K>(s, point.tangent, middle, flowing, hardening, errors);
    if (b.variable) {
      for (int i = 0; i < last; ++i) lanes(b.variable, first + i) = i < n_stress ? middle[i] : Lanes{};
      lanes(b.variable, first + last) = flowing;
    }
    for (const Lanes& component : middle) sum += component;
    if (b.elastic_matrix) point.tangent = {block.lambda, block.mu};
  }
  sum += point.dv;
  for (const Lanes& component : s) sum += component;
}

/// What forces are made of: with Green-Lagrange the first Piola-Kirchhoff stress F S.
template <Kind K>
struct NominalStress {
  static constexpr int D = dimension_of(K);
  Lanes value[D][D], hoop;

  LACON_INLINE NominalStress(const Point<K>& point, bool green) {
    for (int i = 0; i < D; ++i)
      for (int k = 0; k < D; ++k) {
        value[i][k] = point.stress[at(i, k)];
        if (green)
          for (int m = 0; m < D; ++m) value[i][k] += point.slope[i][m] * point.stress[at(m, k)];
      }
    hoop = green ? (1 + point.hoop_slope) * point.stress[2] : point.stress[2];
  }
};

/// Green-Lagrange: whether the element is turned inside out, and Cauchy's stress F S F^T / det F. In plane stress det F has the
/// stretch across, which keeps SIZZ zero. @param thermal strain, equal in all directions
template <Kind K>
LACON_INLINE void take_cauchy_stress(const Point<K>& point, const NominalStress<K>& nominal,
                                     const Lanes (&twice)[components_of(K)], const Lanes& thermal, const Lanes& nu,
                                     double* stress, LaneErrors& errors) {
  constexpr int D = dimension_of(K);
  Lanes f[D][D], volume;
  for (int i = 0; i < D; ++i)
    for (int k = 0; k < D; ++k) f[i][k] = point.slope[i][k] + (i == k ? 1.0 : 0.0);
  if constexpr (D == 2)
    volume = (f[0][0] * f[1][1] - f[0][1] * f[1][0]) * (1 + point.hoop_slope);
  else
    volume = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) - f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0]) +
             f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
  for (int l = 0; l < LACON_LANES; ++l) {
    bool right_way = volume[l] > 0 && (K != Kind::axis || point.hoop_slope[l] > -1);
    if constexpr (K == Kind::plane_stress) {
      const double across = 1 + 2 * thermal[l] - nu[l] / (1 - nu[l]) * (twice[0][l] + twice[1][l] - 4 * thermal[l]);
      right_way = right_way && across > 0;
      volume[l] *= std::sqrt(across);
    }
    errors.set(l, !right_way, LACON_INSIDE_OUT);
  }
  if (!stress) return;
  for (int i = 0; i < D; ++i)
    for (int k = i; k < D; ++k) {
      Lanes cauchy = nominal.value[i][0] * f[k][0];
      for (int m = 1; m < D; ++m) cauchy += nominal.value[i][m] * f[k][m];
      lanes(stress, at(i, k)) = cauchy / volume;
    }
  if constexpr (D == 2) lanes(stress, 2) = nominal.hoop * (1 + point.hoop_slope) / volume;
}

template <Kind K>
LACON_INLINE void add_force(const Point<K>& point, const NominalStress<K>& nominal, int nodes, double* force) {
  constexpr int D = dimension_of(K);
  Lanes weighted[D][D];
  for (int i = 0; i < D; ++i)
    for (int k = 0; k < D; ++k) weighted[i][k] = point.dv * nominal.value[i][k];
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < D; ++i) {
      Lanes f = point.g[a][0] * weighted[i][0];
      for (int k = 1; k < D; ++k) f += point.g[a][k] * weighted[i][k];
      if (K == Kind::axis && i == 0) f += point.hoop[a] * (point.dv * nominal.hoop);
      lanes(force, a * D + i) += f;
    }
}

/// Isotropic elasticity sigma = lambda tr(eps) I + 2 mu eps with E and nu, and plasticity upon it. Outputs of an element in
/// error have no meaning. Stress: Cauchy's, SIXX SIYY SIZZ SIXY, in space SIXZ SIYZ too. In axisymmetry x is the radius r, ZZ
/// the hoop direction with the strain u_r / r, and integrals are those over one radian.
template <Kind K, Measure M, Law L>
LACON_INLINE void evaluate(const lacon_solid_batch& b) {
  constexpr bool green = M == Measure::green, updated = moves(M);
  constexpr bool same_moduli = M == Measure::small && L == Law::elastic;  // at all points
  constexpr int D = dimension_of(K), n_stress = components_of(K), n_variables = n_variables_of(L);
  const int nodes = b.n_nodes, dofs = D * nodes, entries = dofs * (dofs + 1) / 2;
  if (b.dimension != D || nodes > max_nodes || b.n_stress != n_stress || !fits(b.n_parameters, flows(L)) ||
      b.n_variables != n_variables || (flows(L) && b.n_curve < 1))
    return lacon::refuse(b);
  Block<K, M> block;
  alignas(lane_alignment) Point<K> points[same_moduli ? points_at_once : 1];
  for (std::int64_t index = 0; index < b.n_blocks; ++index) {
    LaneErrors errors;
    block.read(b, index, errors);
    double* matrix = b.matrix ? b.matrix + index * entries * LACON_LANES : nullptr;
    double* force = b.force ? b.force + index * dofs * LACON_LANES : nullptr;
    double* whole = updated && b.whole_matrix ? b.whole_matrix + index * dofs * dofs * LACON_LANES : nullptr;
    if (matrix && !same_moduli) clear_lanes(matrix, 0, entries);
    if (whole) clear_lanes(whole, 0, dofs * dofs);
    if (force) clear_lanes(force, 0, dofs);
    Lanes sum = {};
    for (int p = 0; p < b.n_points; ++p) {
      const std::int64_t here = index * b.n_points + p;
      const int kept = same_moduli ? p % points_at_once : 0;
      Point<K>& point = points[kept];
      Lanes twice[n_stress];  // the strain
      take_gradients<K, M>(b, p, block, point, errors);
      take_strain<K, M>(point, twice);
      take_stress<K, M, L>(b, here, block, twice, point, sum, errors);
      const NominalStress<K> nominal(point, green);
      double* const stress = b.stress ? b.stress + here * n_stress * LACON_LANES : nullptr;
      if constexpr (green)
        take_cauchy_stress<K>(point, nominal, twice, b.thermal_strain ? lanes(b.thermal_strain, here) : Lanes{}, block.nu,
                              stress, errors);
      else if (stress)
        for (int i = 0; i < n_stress; ++i) lanes(stress, i) = point.stress[i];
      if (force) add_force<K>(point, nominal, nodes, force);
      if (whole) add_updated_matrix<K, M, L, true>(point, nodes, whole);
      if (!matrix) continue;
      if constexpr (same_moduli) {
        if (kept + 1 == points_at_once || p + 1 == b.n_points)
          add_elastic_matrix<K>(points, kept + 1, block.lambda, block.mu, nodes, p < points_at_once, matrix);
        continue;
      }
      if (b.stressless_matrix)
        for (Lanes& component : point.stress) component = Lanes{};
      if (updated && !b.stressless_matrix)
        add_updated_matrix<K, M, L, false>(point, nodes, matrix);
      else
        add_matrix<K, M, L>(point, nodes, matrix);
    }
    errors.check_finite(sum);
    errors.store(b.error, index);
  }
}

const char* const isotropic[] = {"ELAS/E", "ELAS/NU", nullptr};
const char* const with_slope[] = {"ELAS/E", "ELAS/NU", "ECRO_LINE/D_SIGM_EPSI", nullptr};

constexpr lacon_kernel row(const char* name, void (*function)(const lacon_solid_batch*), Measure measure, Law law,
                           bool of_line) {
  const bool plastic = flows(law);
  return {.name = name,
          .kind = LACON_SOLID,
          .solid = function,
          .load = nullptr,
          .contact = nullptr,
          .parameters = of_line ? with_slope : isotropic,
          .variables = law == Law::kinematic ? kinematic_variables
                       : plastic             ? plastic_variables
                                             : nullptr,
          .nonlinear = plastic || measure != Measure::small,
          .has_memory = plastic || moves(measure),
          .takes_curve = plastic,
          .unknowns = nullptr,
          .unsymmetric = moves(measure),
          .takes_thermal_strain = measure == Measure::green};
}

// a function for each combination: a template cannot be compiled for several instruction sets
#define LACON_FUNCTION(kind, measure, law)                                     \
  LACON_KERNEL void kind##_##measure##_##law(const lacon_solid_batch* batch) { \
    evaluate<Kind::kind, Measure::measure, Law::law>(*batch);                  \
  }
#define LACON_ROW(kind, measure, law) \
  row(#kind "_" #measure "_" #law, kind##_##measure##_##law, Measure::measure, Law::law, Law::law == Law::kinematic),
// the same functions with the slope of ECRO_LINE
#define LACON_LINE_ROW(kind, measure) \
  row(#kind "_" #measure "_von_mises_line", kind##_##measure##_von_mises, Measure::measure, Law::von_mises, true),
#define LACON_LINE_ROWS(kind) LACON_LINE_ROW(kind, small) LACON_LINE_ROW(kind, updated) LACON_LINE_ROW(kind, centred)
#define LACON_OF_KIND(apply, kind)                                                                                    \
  apply(kind, small, elastic) apply(kind, updated, elastic) apply(kind, centred, elastic) apply(kind, green, elastic) \
      apply(kind, small, von_mises) apply(kind, updated, von_mises) apply(kind, centred, von_mises)
// in plane stress the middle would move across the plate too
#define LACON_KINEMATIC(apply, kind) \
  apply(kind, small, kinematic) apply(kind, updated, kinematic) apply(kind, centred, kinematic)
#define LACON_ALL(apply)               \
  LACON_OF_KIND(apply, plane_strain)   \
  LACON_OF_KIND(apply, plane_stress)   \
  LACON_OF_KIND(apply, axis)           \
  LACON_OF_KIND(apply, three_d)        \
  LACON_KINEMATIC(apply, plane_strain) \
  LACON_KINEMATIC(apply, axis)         \
  LACON_KINEMATIC(apply, three_d)

LACON_ALL(LACON_FUNCTION)
const lacon_kernel kernels[] = {LACON_ALL(LACON_ROW) LACON_LINE_ROWS(plane_strain) LACON_LINE_ROWS(plane_stress)
                                    LACON_LINE_ROWS(axis) LACON_LINE_ROWS(three_d)};
const lacon_plugin_table table = {LACON_ABI,
                                  sizeof(lacon_solid_batch),
                                  sizeof(lacon_load_batch),
                                  sizeof(lacon_contact_batch),
                                  "solid",
                                  sizeof kernels / sizeof *kernels,
                                  kernels};

}  // namespace

extern "C" const lacon_plugin_table* lacon_plugin(void) { return &table; }
