#pragma once
// SIMO_MIEHE: elasticity of the isochoric elastic left Cauchy-Green tensor b with tau = (K (J^2 - 1) / 2 - 3 K e (J + 1 / J) /
// 2) I
// + mu dev b, e the thermal strain, and plasticity with von Mises' criterion on Kirchhoff's stress tau (Simo and Hughes,
// Computational Inelasticity, 9.3: the return keeps the trace of b).
#include "lacon/elements/solid/von_mises.hpp"
#include "measures.hpp"

namespace lacon::solid {

struct SimoMiehe {
  double bulk, mu, thermal;
  bool plastic, elastic_matrix, stressless_matrix;
  Hardening hardening;

  struct Answer {
    Matrix3 nominal, cauchy;  ///< P and sigma
    Matrix3 elastic;          ///< b - I
    Matrix9 tangent;          ///< dP / dF
    double dp = 0, volume = 1;
    int error = LACON_FINE;
  };

  /// @param slope, previous_slope gradients of the displacement now and before  @param elastic b - I before  @param p plastic
  /// strain before  @param flowed whether the last step did
  Answer operator()(const Matrix3& slope, const Matrix3& previous_slope, const Matrix3& elastic, double p, bool flowed,
                    bool with_tangent) const {
    const Matrix3 unit = Matrix3::Identity(), f = unit + slope, back = f.inverse();
    // the step's gradient less I, exact for small steps, and made isochoric
    const Matrix3 step = (slope - previous_slope) * (unit + previous_slope).inverse();
    Answer answer;
    answer.volume = f.determinant();
    const double widening = determinant_less_one(step);  // a step that turns the element inside out has a force all the same
    const double shrink = widening > -1 ? std::expm1(-std::log1p(widening) / 3) : 1 / std::cbrt(1 + widening) - 1;
    const Matrix3 isochoric = step + shrink * (unit + step);
    const Matrix3 trial = isochoric + isochoric.transpose() + isochoric * isochoric.transpose() +
                          (unit + isochoric) * elastic * (unit + isochoric).transpose();  // b - I without further flow
    const double trace = 3 + trial.trace();
    const Matrix3 s_trial = mu * deviator(trial);
    const double q = std::sqrt(1.5) * s_trial.norm(), three_mu = mu * trace;
    double kept = 1, slope_of_yield = 0;
    const Hardening::Value yield = plastic ? hardening(p) : Hardening::Value{INFINITY, 0};
    const bool flows = q > (1 + on_criterion) * yield.stress,
               yields = flows || (flowed && q > (1 - still_on_criterion) * yield.stress && three_mu + yield.slope > 0);
    if (yields) slope_of_yield = yield.slope;
    if (flows) {
      const PlasticStep flow = radial_return(q, p, three_mu, hardening);
      answer.error = flow.error;
      answer.dp = flow.dp;
      slope_of_yield = flow.slope;
      kept = 1 - three_mu * flow.dp / q;
    }
    const Matrix3 s = kept * s_trial;
    answer.elastic = s / mu + (trace / 3 - 1) * unit;
    const double j = answer.volume, growth = determinant_less_one(slope);  // J - 1
    const Matrix3 tau = s + (bulk / 2 * (growth * (2 + growth) - 3 * thermal * (j + 1 / j))) * unit;
    answer.nominal = tau * back.transpose();
    answer.cauchy = tau / j;
    if (!with_tangent) return answer;
    Matrix9 spatial;  // dP F^T by dF F^-1
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) {
        Matrix3 rate = Matrix3::Zero();
        rate(k, l) = 1;
        const double growth_rate = rate.trace();
        const Matrix3 change = d_tau(rate, trial, s_trial, q, three_mu, kept, slope_of_yield, answer.dp, yields) +
                               growth_rate * bulk * (j * j - 1.5 * thermal * (j - 1 / j)) * unit -
                               (stressless_matrix ? Matrix3(Matrix3::Zero()) : Matrix3(tau * rate.transpose()));
        for (int i = 0; i < 3; ++i)
          for (int m = 0; m < 3; ++m) spatial(3 * i + m, 3 * k + l) = change(i, m);
      }
    Matrix9 pulled = Matrix9::Zero();  // I and F^-1, pair by pair
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a)
        for (int m = 0; m < 3; ++m) pulled(3 * i + a, 3 * i + m) = back(a, m);
    answer.tangent = pulled * spatial * pulled.transpose();
    return answer;
  }

 private:
  static Matrix3 deviator(const Matrix3& a) { return a - a.trace() / 3 * Matrix3::Identity(); }
  /// det(I + a) - 1 by the invariants of a, exact for small a.
  static double determinant_less_one(const Matrix3& a) {
    return a.trace() + (a.trace() * a.trace() - (a * a).trace()) / 2 + a.determinant();
  }

  /// Change of the deviatoric stress. @param rate dF F^-1
  Matrix3 d_tau(const Matrix3& rate, const Matrix3& trial, const Matrix3& s_trial, double q, double three_mu, double kept,
                double slope_of_yield, double dp, bool yields) const {
    const Matrix3 d = deviator(rate), d_symmetric = (d + d.transpose()) / 2;
    Matrix3 ds = 2 * three_mu / 3 * d_symmetric;  // without what turns and moves the stress
    double d_trace = 0;
    if (!stressless_matrix) {
      const Matrix3 moved = d * (Matrix3::Identity() + trial);
      ds = mu * deviator(moved + moved.transpose());
      d_trace = 2 * moved.trace();
    }
    if (!yields || elastic_matrix) return (elastic_matrix ? 1 : kept) * ds;
    const double dq = 1.5 / q * s_trial.cwiseProduct(ds).sum();
    const double ddp = (dq - mu * d_trace * dp) / (three_mu + slope_of_yield);
    return kept * ds + (slope_of_yield * ddp - kept * dq) / q * s_trial;
  }
};

}  // namespace lacon::solid
