#pragma once
// Plasticity with von Mises' criterion and isotropic hardening R(p), given as a curve of straight pieces, or linear kinematic
// hardening (Prager): the return to the criterion and the consistent tangent. Simo and Hughes, Computational Inelasticity, 3.3
// (solids) and 3.4 (plane stress).
#include <algorithm>
#include <cmath>

#include "geometry.hpp"

namespace lacon::solid {

// Von Mises stresses this far above the yield stress, as a share of it, are on the criterion: a step of no length does not
// flow.
constexpr double on_criterion = 1e-12;
// This far below it they still are where the last step flowed. There a step of no length is taken for the start of more flow,
// with the tangent of the continuum, which predicts what comes next.
constexpr double still_on_criterion = 1e-9;

inline const char* const plastic_variables[] = {"EPSPEQ", "INDIPLAS", nullptr};  // cumulated plastic strain; 1 where it grows
constexpr int n_plastic_variables = 2;
// the stress in the middle of the criterion, a deviator, of which the plane has four components; 1 where the law flows
inline const char* const kinematic_variables[] = {"XCINXX", "XCINYY", "XCINZZ",   "XCINXY",
                                                  "XCINXZ", "XCINYZ", "INDIPLAS", nullptr};
constexpr int n_kinematic_variables = 7;

/// How a stress answers to a change of strain: lambda tr(de) I + 2 mu de - rank (direction : de) direction.
template <Kind K>
struct Tangent {
  Lanes lambda, mu;
  Lanes rank{}, direction[components_of(K)]{};
};

/// The yield stress at a plastic strain.
struct Hardening {
  const double* curve;  ///< lacon_solid_batch::curve
  int size;
  const double* slopes = nullptr;  ///< of each lane, in the place of those of the curve; null: the curve's

  Hardening of(int lane) const { return {curve, size, slopes ? slopes + lane : nullptr}; }

  struct Value {
    double stress, slope;
  };
  double strain(int piece) const { return curve[3 * piece]; }
  Value on(int piece, double p) const {
    const double slope = slopes ? *slopes : curve[3 * piece + 2];
    return {p > strain(piece) ? curve[3 * piece + 1] + slope * (p - strain(piece)) : curve[3 * piece + 1], slope};
  }
  int piece_of(double p) const {
    int piece = 0;
    while (piece + 1 < size && p >= strain(piece + 1)) ++piece;
    return piece;
  }
  Value operator()(double p) const { return on(piece_of(p), p); }
};

struct PlasticStep {
  double dp = 0, slope = 0;
  int error = LACON_FINE;
};

/// The increment dp with q - 3 mu dp = R(p + dp). @param q von Mises stress of the trial, above R(p)
inline PlasticStep radial_return(double q, double p, double three_mu, const Hardening& hardening) {
  for (int piece = hardening.piece_of(p);; ++piece) {
    const auto [stress, slope] = hardening.on(piece, p);
    if (std::isnan(slope)) return {.error = LACON_BEYOND_CURVE};
    if (!(three_mu + slope > 0)) return {.error = LACON_BAD_PARAMETER};
    // of the piece's line, which may start behind p
    const double line = stress + slope * std::min(0.0, p - hardening.strain(piece));
    const double dp = (q - line) / (three_mu + slope);
    if (piece + 1 < hardening.size && p + dp > hardening.strain(piece + 1)) continue;
    if (!(line + slope * dp > 0)) return {.error = LACON_BAD_PARAMETER};  // softened to nothing
    return {dp, slope};
  }
}

/// The von Mises stress that a plane trial stress keeps after the plastic flow gamma = 3 dp / (2 q), squared over 3/2:
/// sum / (1 + by_sum gamma)^2 + rest / (1 + by_rest gamma)^2.
struct PlaneTrial {
  double sum, rest;        ///< (SIXX + SIYY)^2 / 6; (SIXX - SIYY)^2 / 2 + 2 SIXY^2
  double by_sum, by_rest;  ///< E / (3 (1 - nu)); 2 mu

  double square(double gamma) const {
    const double a = 1 + by_sum * gamma, b = 1 + by_rest * gamma;
    return sum / (a * a) + rest / (b * b);
  }
  double slope(double gamma) const {
    const double a = 1 + by_sum * gamma, b = 1 + by_rest * gamma;
    return -2 * (by_sum * sum / (a * a * a) + by_rest * rest / (b * b * b));
  }
};

/// The increment dp with q(gamma) = R(p + dp), gamma = 3 dp / (2 R(p + dp)): Newton's method between two bounds.
inline PlasticStep plane_return(const PlaneTrial& trial, double p, const Hardening& hardening) {
  constexpr int most = 200;  // bisection alone needs fewer
  constexpr double round_off = 1e-14;
  double low = 0, high = INFINITY, dp = 0;
  for (int i = 0; i < most; ++i) {
    const auto [stress, slope] = hardening(p + dp);
    if (std::isnan(slope)) return {.error = LACON_BEYOND_CURVE};
    if (!(stress > 0)) return {.error = LACON_BAD_PARAMETER};
    const double gamma = 1.5 * dp / stress, q = std::sqrt(1.5 * trial.square(gamma)), excess = q - stress;
    (excess > 0 ? low : high) = dp;
    const double rate = 0.75 / q * trial.slope(gamma) * 1.5 * (stress - slope * dp) / (stress * stress) - slope;
    double next = dp - excess / rate;
    if (!(next > low && next < high))
      next = std::isinf(high) ? 2 * low + (q - stress) / std::min(trial.by_sum, trial.by_rest) : (low + high) / 2;
    const bool done = std::abs(next - dp) <= round_off * (p + next) || excess == 0;
    dp = excess == 0 ? dp : next;
    if (done) break;
  }
  return {dp, hardening(p + dp).slope};
}

/// Bring a trial stress back to the criterion.
/// @param stress in: elastic trial, out: the law's answer  @param tangent in: elastic, out: consistent
/// @param p cumulated plastic strain, in and out  @param flows in: 1 where the last step flowed, out: 1 where p has grown
template <Kind K>
LACON_INLINE void return_to_criterion(Lanes (&stress)[components_of(K)], Tangent<K>& tangent, Lanes& p, Lanes& flows,
                                      const Hardening& hardening, LaneErrors& errors) {
  constexpr int n = components_of(K);
  Lanes deviator[n], square = {};
  const Lanes mean = (stress[0] + stress[1] + stress[2]) / 3;
  for (int i = 0; i < n; ++i) {
    deviator[i] = i < 3 ? stress[i] - mean : stress[i];
    square += (i < 3 ? 1 : 2) * deviator[i] * deviator[i];
  }
  Lanes dp = {}, slope = {}, q = {}, yields = {};
  bool any = false;
  for (int l = 0; l < LACON_LANES; ++l) {
    q[l] = std::sqrt(1.5 * square[l]);
    const Hardening own = hardening.of(l);
    const auto [yield, present_slope] = own(p[l]);
    const bool flowed = flows[l] != 0;
    flows[l] = q[l] > (1 + on_criterion) * yield;
    if (flows[l] == 0) {
      if (!flowed || !(q[l] > (1 - still_on_criterion) * yield) || !(3 * tangent.mu[l] + present_slope > 0)) continue;
      slope[l] = present_slope;
      yields[l] = 1;
      any = true;
      continue;
    }
    PlasticStep step;
    if constexpr (K == Kind::plane_stress) {
      const double sum = stress[0][l] + stress[1][l], difference = stress[0][l] - stress[1][l];
      // E / (1 - nu) = 2 (lambda + mu) with the lambda of plane stress
      const PlaneTrial trial{sum * sum / 6, difference * difference / 2 + 2 * stress[3][l] * stress[3][l],
                             2 * (tangent.lambda[l] + tangent.mu[l]) / 3, 2 * tangent.mu[l]};
      step = plane_return(trial, p[l], own);
    } else {
      step = radial_return(q[l], p[l], 3 * tangent.mu[l], own);
    }
    errors.set(l, step.error != LACON_FINE, step.error);
    dp[l] = step.dp;
    slope[l] = step.slope;
    yields[l] = 1;
    any = true;
  }
  if (!any) return;
  const Lanes three_mu = 3 * tangent.mu;
  if constexpr (K == Kind::plane_stress) {
    Lanes gamma = {};
    for (int l = 0; l < LACON_LANES; ++l)
      if (yields[l] != 0) gamma[l] = 1.5 * dp[l] / hardening.of(l)(p[l] + dp[l]).stress;
    const Lanes sum_stiffness = 2 * (tangent.lambda + tangent.mu);
    const Lanes by_sum = 1 / (1 + sum_stiffness / 3 * gamma), by_rest = 1 / (1 + 2 * tangent.mu * gamma);
    const Lanes half_sum = (stress[0] + stress[1]) / 2 * by_sum, half_difference = (stress[0] - stress[1]) / 2 * by_rest;
    stress[0] = half_sum + half_difference;
    stress[1] = half_sum - half_difference;
    stress[3] = stress[3] * by_rest;
    // moduli of the algorithm: Xi = (C^-1 + gamma P)^-1, then the flow direction n = P sigma taken out
    const Lanes xi_sum = sum_stiffness * by_sum, xi_rest = 2 * tangent.mu * by_rest;
    const Lanes n_sum = half_sum / 3, n_difference = half_difference, n_shear = stress[3];
    tangent.mu = xi_rest / 2;
    tangent.lambda = (xi_sum - xi_rest) / 2;
    tangent.direction[0] = xi_sum * n_sum + xi_rest * n_difference;
    tangent.direction[1] = xi_sum * n_sum - xi_rest * n_difference;
    tangent.direction[3] = xi_rest * n_shear;
    const Lanes through = 2 * (xi_sum * n_sum * n_sum + xi_rest * (n_difference * n_difference + n_shear * n_shear));
    const Lanes whole = 2 * (3 * n_sum * n_sum + n_difference * n_difference + n_shear * n_shear);  // n : P^-1 : n
    const Lanes beta = 2.0 / 3 * slope * whole / (1 - 2.0 / 3 * slope * gamma);
    for (int l = 0; l < LACON_LANES; ++l) tangent.rank[l] = yields[l] != 0 ? 1 / (through[l] + beta[l]) : 0.0;
  } else {
    Lanes kept = {}, lost = {};
    for (int l = 0; l < LACON_LANES; ++l) {
      kept[l] = yields[l] != 0 ? 1 - three_mu[l] * dp[l] / q[l] : 1.0;
      // 2 mu times the share of a change along the deviator that flows; per square of the trial's deviator
      lost[l] = yields[l] != 0 ? (three_mu[l] / (three_mu[l] + slope[l]) - 1 + kept[l]) / square[l] : 0.0;
    }
    const Lanes bulk = tangent.lambda + 2 * tangent.mu / 3;
    tangent.rank = 2 * tangent.mu * lost;
    tangent.mu *= kept;
    tangent.lambda = bulk - 2 * tangent.mu / 3;
    for (int i = 0; i < n; ++i) {
      tangent.direction[i] = deviator[i];
      stress[i] = (i < 3 ? mean : Lanes{}) + kept * deviator[i];
    }
  }
  p += dp;
}

/// The same with a criterion of constant size whose middle moves by 2/3 h times the plastic strain, h being the slope of the
/// curve's first piece. @param middle in and out  @param mu shear modulus of the trial
template <Kind K>
LACON_INLINE void return_to_moving_criterion(Lanes (&stress)[components_of(K)], Tangent<K>& tangent,
                                             Lanes (&middle)[components_of(K)], Lanes& flows, const Hardening& hardening,
                                             LaneErrors& errors) {
  constexpr int n = components_of(K);
  // seen from the middle the stress comes back along its deviator to the size that isotropic hardening would reach in this one
  // step, by 3 mu dp; the middle goes the rest of the way, h dp
  Lanes share;
  for (int l = 0; l < LACON_LANES; ++l) share[l] = hardening.of(l).on(0, 0).slope / (3 * tangent.mu[l]);
  Lanes relative[n], trial[n], dp = {};
  for (int i = 0; i < n; ++i) relative[i] = trial[i] = stress[i] - middle[i];
  return_to_criterion<K>(relative, tangent, dp, flows, hardening, errors);
  for (int i = 0; i < n; ++i) {
    const Lanes back = trial[i] - relative[i];
    stress[i] -= back;
    middle[i] += share * back;
  }
}

}  // namespace lacon::solid
