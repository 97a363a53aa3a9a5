// Solid elements at large strain: a modelisation (Kind) and a measure with its laws, put together in one loop over elements.
// The law is evaluated element by element, on F = I + H of three dimensions; forces and matrices are sums over P and dP / dF.
#include <cmath>

#include "lacon/elements/lanes.hpp"
#include "lacon/elements/solid/block.hpp"
#include "measures.hpp"
#include "simo_miehe.hpp"

namespace {

using namespace lacon::solid;
using lacon::clear_lanes;
using lacon::lane_alignment;
using lacon::LaneErrors;
using lacon::Lanes;
using lacon::lanes;

const char* const simo_miehe_variables[] = {"EPSPEQ", "INDIPLAS", "EPSEXX", "EPSEYY", "EPSEZZ",
                                            "EPSEXY", "EPSEXZ",   "EPSEYZ", nullptr};
constexpr int n_elastic_variables = 6;  // of simo_miehe_variables, the last: (I - b) / 2

enum class Strain { logarithmic, green, simo_miehe };

/// Components of the deformation gradient that a kind has, (i, k) at i D + k, and that of the hoop behind them.
template <Kind K>
constexpr int n_slopes = dimension_of(K) * dimension_of(K) + (K == Kind::axis ? 1 : 0);
template <Kind K>
constexpr int in_space(int slope) {  ///< 3 i + k
  constexpr int D = dimension_of(K);
  return slope < D * D ? 3 * (slope / D) + slope % D : 8;
}

/// A point of all elements of a block: P and dP / dF, by the components that the kind has.
template <Kind K>
struct LargePoint {
  Lanes force[n_slopes<K>], tangent[n_slopes<K>][n_slopes<K>];
};

struct Moduli {
  Lanes lambda, mu;
};

struct Symmetric {
  int i, k;
};
constexpr Symmetric places[] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};  // XX YY ZZ XY XZ YZ

Matrix3 symmetric(const double* values, std::int64_t first, int n, int lane) {
  Matrix3 tensor = Matrix3::Zero();
  for (int i = 0; i < n; ++i)
    tensor(places[i].i, places[i].k) = tensor(places[i].k, places[i].i) = values[(first + i) * LACON_LANES + lane];
  return tensor;
}

template <Kind K>
Matrix3 slope_of(const Lanes (&slope)[dimension_of(K)][dimension_of(K)], const Lanes& hoop, int lane) {
  Matrix3 h = Matrix3::Zero();
  for (int i = 0; i < dimension_of(K); ++i)
    for (int k = 0; k < dimension_of(K); ++k) h(i, k) = slope[i][k][lane];
  if (K == Kind::axis) h(2, 2) = hoop[lane];
  return h;
}

/// The gradients of the displacement at a point, now and in the last state.
template <Kind K>
struct Slopes {
  Lanes now[dimension_of(K)][dimension_of(K)], before[dimension_of(K)][dimension_of(K)];
  Lanes hoop_now, hoop_before;

  Matrix3 at(int lane) const { return slope_of<K>(now, hoop_now, lane); }
  Matrix3 at_last(int lane) const { return slope_of<K>(before, hoop_before, lane); }
};

/// Where a point's answers go.
template <Kind K>
class Outputs {
 public:
  Outputs(const lacon_solid_batch& batch, std::int64_t here, LargePoint<K>& point, LaneErrors& errors)
      : batch_(batch), here_(here), point_(point), errors_(errors) {}

  bool wants_tangent() const { return batch_.matrix || batch_.whole_matrix; }
  void set(int lane, const Matrix3& nominal, const Matrix3& cauchy, const Matrix9& tangent, double volume, double radial) {
    for (int r = 0; r < n_slopes<K>; ++r) {
      point_.force[r][lane] = nominal(in_space<K>(r) / 3, in_space<K>(r) % 3);
      if (!wants_tangent()) continue;
      for (int c = 0; c < n_slopes<K>; ++c) point_.tangent[r][c][lane] = tangent(in_space<K>(r), in_space<K>(c));
    }
    if (batch_.stress)
      for (int i = 0; i < components_of(K); ++i)
        batch_.stress[(here_ * components_of(K) + i) * LACON_LANES + lane] = cauchy(places[i].i, places[i].k);
    errors_.set(lane, !(volume > 0 && radial > 0), LACON_INSIDE_OUT);
  }

 private:
  const lacon_solid_batch& batch_;
  std::int64_t here_;
  LargePoint<K>& point_;
  LaneErrors& errors_;
};

/// Of a lane at a point, 0 where there is none.
double thermal_at(const double* strain, std::int64_t here, int lane) { return strain ? strain[here * LACON_LANES + lane] : 0; }

/// A law of small strains, elasticity or plasticity upon it, in a measure that follows from C.
template <Kind K, class M, Law L>
void take_measured(const lacon_solid_batch& b, std::int64_t here, const Slopes<K>& slopes, const Moduli& moduli,
                   const Hardening& hardening, Outputs<K>& outputs, LaneErrors& errors) {
  constexpr int n = components_of(Kind::three_d), n_stress = components_of(K);
  Lanes stress[n] = {};
  for (int l = 0; l < LACON_LANES; ++l) {
    const Deformation<M> last(slopes.at_last(l));
    Matrix3 t = Matrix3::Zero();
    if (b.previous_stress) t = last.working(symmetric(b.previous_stress, here * n_stress, n_stress, l));
    const Matrix3 step =
        Deformation<M>(slopes.at(l)).strain() - last.strain() -
        (thermal_at(b.thermal_strain, here, l) - thermal_at(b.previous_thermal_strain, here, l)) * Matrix3::Identity();
    t += moduli.lambda[l] * step.trace() * Matrix3::Identity() + 2 * moduli.mu[l] * step;
    for (int i = 0; i < n; ++i) stress[i][l] = t(places[i].i, places[i].k);
  }
  Tangent<Kind::three_d> tangent{moduli.lambda, moduli.mu};
  if constexpr (L == Law::von_mises) {
    Lanes p = {}, flows = {};
    if (b.previous_variable) {
      p = lanes(b.previous_variable, here * n_plastic_variables);
      flows = lanes(b.previous_variable, here * n_plastic_variables + 1);
    }
    return_to_criterion<Kind::three_d>(stress, tangent, p, flows, hardening, errors);
    if (b.variable) {
      lanes(b.variable, here * n_plastic_variables) = p;
      lanes(b.variable, here * n_plastic_variables + 1) = flows;
    }
    if (b.elastic_matrix) tangent = {moduli.lambda, moduli.mu};
  }
  for (int l = 0; l < LACON_LANES; ++l) {
    const Deformation<M> now(slopes.at(l));
    Matrix3 t, direction;
    for (int i = 0; i < n; ++i) {
      t(places[i].i, places[i].k) = t(places[i].k, places[i].i) = stress[i][l];
      direction(places[i].i, places[i].k) = direction(places[i].k, places[i].i) = tangent.direction[i][l];
    }
    const Matrix3 nominal = now.gradient() * now.second_piola(t);
    Matrix9 moved = Matrix9::Zero();
    if (outputs.wants_tangent())
      moved = now.tangent(tangent.lambda[l], tangent.mu[l], tangent.rank[l], direction,
                          b.stressless_matrix ? Matrix3(Matrix3::Zero()) : t);
    outputs.set(l, nominal, nominal * now.gradient().transpose() / now.volume(), moved, now.volume(), now.gradient()(2, 2));
  }
}

template <Kind K, Law L>
void take_simo_miehe(const lacon_solid_batch& b, std::int64_t here, const Slopes<K>& slopes, const Moduli& moduli,
                     const Hardening& hardening, Outputs<K>& outputs, LaneErrors& errors) {
  constexpr int n = n_plastic_variables + n_elastic_variables;
  constexpr bool plastic = L == Law::von_mises;
  for (int l = 0; l < LACON_LANES; ++l) {
    const SimoMiehe law{.bulk = moduli.lambda[l] + 2 * moduli.mu[l] / 3,
                        .mu = moduli.mu[l],
                        .thermal = thermal_at(b.thermal_strain, here, l),
                        .plastic = plastic,
                        .elastic_matrix = b.elastic_matrix != 0,
                        .stressless_matrix = b.stressless_matrix != 0,
                        .hardening = hardening.of(l)};
    const bool starts = plastic && b.previous_variable;
    const double* const last = starts ? b.previous_variable + here * n * LACON_LANES + l : nullptr;
    const double p = last ? last[0] : 0;
    const bool flowed = last && last[LACON_LANES] != 0;
    const Matrix3 now = slopes.at(l), before = plastic ? slopes.at_last(l) : Matrix3(Matrix3::Zero());
    Matrix3 elastic = Matrix3::Zero();
    if (starts) elastic = -2 * symmetric(b.previous_variable, here * n + n_plastic_variables, n_elastic_variables, l);
    const SimoMiehe::Answer answer = law(now, before, elastic, p, flowed, outputs.wants_tangent());
    errors.set(l, answer.error != LACON_FINE, answer.error);
    if (plastic && b.variable) {
      double* const variable = b.variable + here * n * LACON_LANES + l;
      variable[0] = p + answer.dp;
      variable[LACON_LANES] = answer.dp > 0;
      for (int i = 0; i < n_elastic_variables; ++i)
        variable[(n_plastic_variables + i) * LACON_LANES] = -answer.elastic(places[i].i, places[i].k) / 2;
    }
    outputs.set(l, answer.nominal, answer.cauchy, answer.tangent, answer.volume, 1 + now(2, 2));
  }
}

/// The change of each slope with an unknown (a, i): shape gradients, and N / r of the hoop.
template <Kind K, class Use>
LACON_INLINE void each_slope(const Point<K>& point, int a, int i, const Use& use) {
  constexpr int D = dimension_of(K);
  for (int k = 0; k < D; ++k) use(i * D + k, point.g[a][k]);
  if (K == Kind::axis && i == 0) use(D * D, point.hoop[K == Kind::axis ? a : 0]);
}

template <Kind K>
LACON_INLINE void add_force(const Point<K>& point, const LargePoint<K>& answer, int nodes, double* force) {
  constexpr int D = dimension_of(K);
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < D; ++i) {
      Lanes sum = {};
      each_slope(point, a, i, [&](int r, const Lanes& g) LACON_INLINE_LAMBDA { sum += g * answer.force[r]; });
      lanes(force, a * D + i) += point.dv * sum;
    }
}

/// @tparam whole the derivative itself, (ndof, ndof); else the lower triangle of its symmetric part
template <Kind K, bool whole>
LACON_INLINE void add_matrix(const Point<K>& point, const LargePoint<K>& answer, int nodes, double* matrix) {
  constexpr int D = dimension_of(K), S = n_slopes<K>;
  Lanes tangent[S][S];
  for (int r = 0; r < S; ++r)
    for (int c = 0; c < S; ++c)
      tangent[r][c] = point.dv * (whole ? answer.tangent[r][c] : Lanes((answer.tangent[r][c] + answer.tangent[c][r]) / 2));
  for (int c = 0; c < nodes; ++c)
    for (int k = 0; k < D; ++k) {
      Lanes answers[S] = {};  // to a change of this unknown
      each_slope(point, c, k, [&](int s, const Lanes& g) LACON_INLINE_LAMBDA {
        for (int r = 0; r < S; ++r) answers[r] += tangent[r][s] * g;
      });
      const int column = D * c + k;
      for (int row = whole ? 0 : column; row < D * nodes; ++row) {
        Lanes& entry = lanes(matrix, whole ? row * D * nodes + column : row * (row + 1) / 2 + column);
        each_slope(point, row / D, row % D, [&](int r, const Lanes& g) LACON_INLINE_LAMBDA { entry += g * answers[r]; });
      }
    }
}

template <Kind K, Strain M, Law L>
LACON_INLINE void evaluate(const lacon_solid_batch& b) {
  constexpr bool plastic = L == Law::von_mises;
  constexpr int D = dimension_of(K), n_stress = components_of(K);
  constexpr int n_variables = !plastic ? 0 : n_plastic_variables + (M == Strain::simo_miehe ? n_elastic_variables : 0);
  const int nodes = b.n_nodes, dofs = D * nodes, entries = dofs * (dofs + 1) / 2;
  if (b.dimension != D || nodes > max_nodes || b.n_stress != n_stress || !fits(b.n_parameters, plastic) ||
      b.n_variables != n_variables || (plastic && b.n_curve < 1))
    return lacon::refuse(b);
  Block<K, Measure::green> block;
  alignas(lane_alignment) Lanes last[max_nodes * D];
  alignas(lane_alignment) Point<K> point;
  alignas(lane_alignment) LargePoint<K> answer;
  Slopes<K> slopes;
  for (std::int64_t index = 0; index < b.n_blocks; ++index) {
    LaneErrors errors;
    block.read(b, index, errors);
    for (int i = 0; i < dofs; ++i)
      last[i] = b.previous_displacement ? lanes(b.previous_displacement + index * dofs * LACON_LANES, i) : Lanes{};
    double* const matrix = b.matrix ? b.matrix + index * entries * LACON_LANES : nullptr;
    double* const force = b.force ? b.force + index * dofs * LACON_LANES : nullptr;
    double* const whole = b.whole_matrix ? b.whole_matrix + index * dofs * dofs * LACON_LANES : nullptr;
    if (matrix) clear_lanes(matrix, 0, entries);
    if (whole) clear_lanes(whole, 0, dofs * dofs);
    if (force) clear_lanes(force, 0, dofs);
    const Moduli moduli{block.lambda, block.mu};
    const Hardening hardening = hardening_of(b, block);
    Lanes sum = {};
    for (int p = 0; p < b.n_points; ++p) {
      const std::int64_t here = index * b.n_points + p;
      take_gradients(b, p, block, point, errors);
      take_slope(point, block.moved, nodes, slopes.now, slopes.hoop_now);
      take_slope(point, last, nodes, slopes.before, slopes.hoop_before);
      Outputs<K> outputs(b, here, answer, errors);
      if constexpr (M == Strain::simo_miehe)
        take_simo_miehe<K, L>(b, here, slopes, moduli, hardening, outputs, errors);
      else if constexpr (M == Strain::logarithmic)
        take_measured<K, LogarithmicMeasure, L>(b, here, slopes, moduli, hardening, outputs, errors);
      else
        take_measured<K, GreenMeasure, L>(b, here, slopes, moduli, hardening, outputs, errors);
      sum += point.dv;
      for (const Lanes& component : answer.force) sum += component;
      if (force) add_force(point, answer, nodes, force);
      if (matrix) add_matrix<K, false>(point, answer, nodes, matrix);
      if (whole) add_matrix<K, true>(point, answer, nodes, whole);
    }
    errors.check_finite(sum);
    errors.store(b.error, index);
  }
}

const char* const isotropic[] = {"ELAS/E", "ELAS/NU", nullptr};
const char* const with_slope[] = {"ELAS/E", "ELAS/NU", "ECRO_LINE/D_SIGM_EPSI", nullptr};

constexpr lacon_kernel row(const char* name, void (*function)(const lacon_solid_batch*), Strain strain, Law law,
                           bool of_line = false) {
  const bool plastic = law == Law::von_mises, simo_miehe = strain == Strain::simo_miehe;
  return {.name = name,
          .kind = LACON_SOLID,
          .solid = function,
          .load = nullptr,
          .contact = nullptr,
          .parameters = of_line ? with_slope : isotropic,
          .variables = !plastic     ? nullptr
                       : simo_miehe ? simo_miehe_variables
                                    : plastic_variables,
          .nonlinear = 1,
          .has_memory = plastic,
          .takes_curve = plastic,
          .unknowns = nullptr,
          .unsymmetric = plastic && simo_miehe,
          .takes_thermal_strain = 1};
}

// a function for each combination: a template cannot be compiled for several instruction sets
#define LACON_FUNCTION(kind, strain, law)                                     \
  LACON_KERNEL void kind##_##strain##_##law(const lacon_solid_batch* batch) { \
    evaluate<Kind::kind, Strain::strain, Law::law>(*batch);                   \
  }
#define LACON_ROW(kind, strain, law) row(#kind "_" #strain "_" #law, kind##_##strain##_##law, Strain::strain, Law::law),
// the same functions with the slope of ECRO_LINE
#define LACON_LINE_ROW(kind, strain) \
  row(#kind "_" #strain "_von_mises_line", kind##_##strain##_von_mises, Strain::strain, Law::von_mises, true),
#define LACON_LINE_ROWS(kind) LACON_LINE_ROW(kind, logarithmic) LACON_LINE_ROW(kind, green) LACON_LINE_ROW(kind, simo_miehe)
#define LACON_OF_KIND(apply, kind)                                                                    \
  apply(kind, logarithmic, elastic) apply(kind, logarithmic, von_mises) apply(kind, green, von_mises) \
      apply(kind, simo_miehe, elastic) apply(kind, simo_miehe, von_mises)
#define LACON_ALL(apply) LACON_OF_KIND(apply, plane_strain) LACON_OF_KIND(apply, axis) LACON_OF_KIND(apply, three_d)

LACON_ALL(LACON_FUNCTION)
const lacon_kernel kernels[] = {LACON_ALL(LACON_ROW) LACON_LINE_ROWS(plane_strain) LACON_LINE_ROWS(axis)
                                    LACON_LINE_ROWS(three_d)};
const lacon_plugin_table table = {LACON_ABI,
                                  sizeof(lacon_solid_batch),
                                  sizeof(lacon_load_batch),
                                  sizeof(lacon_contact_batch),
                                  "large_strain",
                                  sizeof kernels / sizeof *kernels,
                                  kernels};

}  // namespace

extern "C" const lacon_plugin_table* lacon_plugin(void) { return &table; }
