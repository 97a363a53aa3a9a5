// Solid elements, small strains.
#include "lacon/elements/lanes.hpp"

namespace {

using lacon::clear_lanes;
using lacon::LaneErrors;
using lacon::Lanes;
using lacon::lanes;

constexpr int max_nodes = 27;

// A determinant below this share of the size of its terms is round-off.
constexpr double flat = 1e-13;

// A node may be this far beyond the axis, as a share of its cell's size.
constexpr double over_axis = 1e-10;

enum class Kind { plane_strain, plane_stress, axis, solid };

/// d x_i / d xi_r at a point, its determinant and inverse.
template <int D>
struct Map {
  Lanes inverse[D][D], determinant;  ///< inverse[r][i] = d xi_r / d x_i

  /// @param gradient (n_nodes, D), by reference coordinates @param side (n_nodes, D), from the first node on
  [[gnu::always_inline]] Map(const double* gradient, const Lanes* side, int nodes, LaneErrors& errors) {
    Lanes j[D][D] = {};
    for (int a = 1; a < nodes; ++a)
      for (int i = 0; i < D; ++i)
        for (int r = 0; r < D; ++r) j[i][r] += gradient[a * D + r] * side[a * D + i];
    Lanes size;
    if constexpr (D == 2) {
      determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
      size = j[0][0] * j[0][0] + j[0][1] * j[0][1] + j[1][0] * j[1][0] + j[1][1] * j[1][1];
      for (int l = 0; l < LACON_LANES; ++l) errors.set(l, !(determinant[l] > flat * size[l]), LACON_BAD_JACOBIAN);
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
      for (int l = 0; l < LACON_LANES; ++l)
        errors.set(l, !(determinant[l] > 0 && determinant[l] * determinant[l] > flat * flat * size[l]), LACON_BAD_JACOBIAN);
      const Lanes scale = 1 / determinant;
      for (int r = 0; r < 3; ++r)
        for (int i = 0; i < 3; ++i) inverse[r][i] *= scale;
    }
  }
};

/// Small strains, isotropic elasticity: sigma = lambda tr(eps) I + 2 mu eps, parameters E and nu. Outputs of an element in
/// error have no meaning. Stress: SIXX SIYY SIZZ SIXY, in space SIXZ SIYZ too. Plane stress is the law with the lambda that
/// makes SIZZ zero; in axisymmetry x is the radius r, ZZ the hoop direction with the strain u_r / r, and integrals are those
/// over one radian.
template <Kind K>
[[gnu::always_inline]] inline void small_elastic(const lacon_solid_batch& b) {
  constexpr bool axis = K == Kind::axis;
  constexpr int D = K == Kind::solid ? 3 : 2, n_stress = K == Kind::solid ? 6 : 4;
  const int nodes = b.n_nodes, dofs = D * nodes, entries = dofs * (dofs + 1) / 2;
  if (b.dimension != D || nodes > max_nodes || b.n_stress != n_stress || b.n_parameters != 2) return lacon::refuse(b);
  Lanes side[max_nodes * D];         // from the first node on: a cell far from the origin loses no digits
  Lanes g[max_nodes][D];             // gradients in space
  Lanes hoop[axis ? max_nodes : 1];  // N / r
  for (std::int64_t block = 0; block < b.n_blocks; ++block) {
    LaneErrors errors;
    const Lanes young = lanes(b.parameter, 2 * block), nu = lanes(b.parameter, 2 * block + 1);
    for (int l = 0; l < LACON_LANES; ++l)
      errors.set(l, !(young[l] > 0 && std::isfinite(young[l]) && nu[l] > -1 && nu[l] < 0.5), LACON_BAD_PARAMETER);
    const Lanes mu = young / (2 * (1 + nu));
    const Lanes lambda = K == Kind::plane_stress ? young * nu / ((1 + nu) * (1 - nu)) : young * nu / ((1 + nu) * (1 - 2 * nu));
    const double* x = b.coordinates + block * dofs * LACON_LANES;
    const double* u = b.displacement + block * dofs * LACON_LANES;
    double* matrix = b.matrix ? b.matrix + block * entries * LACON_LANES : nullptr;
    double* force = b.force ? b.force + block * dofs * LACON_LANES : nullptr;
    if (matrix) clear_lanes(matrix, 0, entries);
    if (force) clear_lanes(force, 0, dofs);
    for (int i = 0; i < dofs; ++i) side[i] = lanes(x, i) - lanes(x, i % D);
    if constexpr (axis)
      for (int l = 0; l < LACON_LANES; ++l) {
        double size = 0;
        for (int i = 0; i < dofs; ++i) size = std::fmax(size, std::abs(side[i][l]));
        for (int a = 0; a < nodes; ++a) errors.set(l, lanes(x, 2 * a)[l] < -over_axis * size, LACON_BAD_RADIUS);
      }
    Lanes sum = {};
    for (int p = 0; p < b.n_points; ++p) {
      const double* d = b.gradient + p * dofs;
      const Map<D> map(d, side, nodes, errors);
      Lanes dv = b.weight[p] * map.determinant;
      [[maybe_unused]] Lanes per_radius = {};
      if constexpr (axis) {
        Lanes r = {};
        for (int a = 0; a < nodes; ++a) r += b.shape[p * nodes + a] * lanes(x, 2 * a);
        for (int l = 0; l < LACON_LANES; ++l) errors.set(l, !(r[l] > 0), LACON_BAD_RADIUS);
        per_radius = 1 / r;
        dv *= r;
      }
      Lanes e[D][D] = {}, hoop_strain = {};  // e: gradient of the displacement
      for (int a = 0; a < nodes; ++a) {
        for (int i = 0; i < D; ++i) {
          g[a][i] = d[a * D] * map.inverse[0][i];
          for (int r = 1; r < D; ++r) g[a][i] += d[a * D + r] * map.inverse[r][i];
        }
        for (int i = 0; i < D; ++i)
          for (int k = 0; k < D; ++k) e[i][k] += lanes(u, a * D + i) * g[a][k];
        if constexpr (axis) {
          hoop[a] = b.shape[p * nodes + a] * per_radius;
          hoop_strain += hoop[a] * lanes(u, 2 * a);
        }
      }
      Lanes trace = e[0][0] + e[1][1] + hoop_strain;
      if constexpr (D == 3) trace += e[2][2];
      Lanes s[D][D];
      for (int i = 0; i < D; ++i)
        for (int k = 0; k < D; ++k) s[i][k] = mu * (e[i][k] + e[k][i]);
      for (int i = 0; i < D; ++i) s[i][i] += lambda * trace;
      Lanes out[n_stress] = {s[0][0], s[1][1]};
      out[3] = s[0][1];
      if constexpr (D == 3) {
        out[2] = s[2][2];
        out[4] = s[0][2];
        out[5] = s[1][2];
      } else if constexpr (K != Kind::plane_stress) {
        out[2] = lambda * trace + 2 * mu * hoop_strain;
      }
      sum += dv;
      for (const Lanes& component : out) sum += component;
      if (b.stress)
        for (int i = 0; i < n_stress; ++i) lanes(b.stress, (block * b.n_points + p) * n_stress + i) = out[i];
      if (force)
        for (int a = 0; a < nodes; ++a)
          for (int i = 0; i < D; ++i) {
            Lanes f = g[a][0] * s[i][0];
            for (int k = 1; k < D; ++k) f += g[a][k] * s[i][k];
            if (axis && i == 0) f += hoop[a] * out[2];
            lanes(force, a * D + i) += dv * f;
          }
      if (!matrix) continue;
      const Lanes dl = dv * lambda, dm = dv * mu;
      for (int a = 0; a < nodes; ++a) {
        Lanes la[D], ma[D];  // of the divergence, of the gradient
        for (int i = 0; i < D; ++i) {
          la[i] = dl * (axis && i == 0 ? g[a][0] + hoop[a] : g[a][i]);
          ma[i] = dm * g[a][i];
        }
        double* row[D];  // row n starts behind n (n + 1) / 2 entries
        for (int i = 0; i < D; ++i) row[i] = matrix + (D * a + i) * (D * a + i + 1) / 2 * LACON_LANES;
        for (int c = 0; c <= a; ++c) {
          Lanes both = ma[0] * g[c][0];
          for (int k = 1; k < D; ++k) both += ma[k] * g[c][k];
          for (int i = 0; i < D; ++i)
            for (int k = 0; k < D; ++k) {
              if (c == a && k > i) continue;
              Lanes entry = la[i] * (axis && k == 0 ? g[c][0] + hoop[c] : g[c][k]) + ma[k] * g[c][i];
              if (i == k) entry += both;
              if (axis && i == 0 && k == 0) entry += 2 * dm * hoop[a] * hoop[c];
              lanes(row[i], D * c + k) += entry;
            }
        }
      }
    }
    errors.check_finite(sum);
    errors.store(b.error, block);
  }
}

LACON_KERNEL void plane_strain_small_elastic(const lacon_solid_batch* batch) { small_elastic<Kind::plane_strain>(*batch); }
LACON_KERNEL void plane_stress_small_elastic(const lacon_solid_batch* batch) { small_elastic<Kind::plane_stress>(*batch); }
LACON_KERNEL void axis_small_elastic(const lacon_solid_batch* batch) { small_elastic<Kind::axis>(*batch); }
LACON_KERNEL void three_d_small_elastic(const lacon_solid_batch* batch) { small_elastic<Kind::solid>(*batch); }

const char* const isotropic[] = {"ELAS/E", "ELAS/NU", nullptr};
const lacon_kernel kernels[] = {
    {"plane_strain_small_elastic", LACON_SOLID, plane_strain_small_elastic, nullptr, nullptr, isotropic},
    {"plane_stress_small_elastic", LACON_SOLID, plane_stress_small_elastic, nullptr, nullptr, isotropic},
    {"axis_small_elastic", LACON_SOLID, axis_small_elastic, nullptr, nullptr, isotropic},
    {"three_d_small_elastic", LACON_SOLID, three_d_small_elastic, nullptr, nullptr, isotropic},
};
const lacon_plugin_table table = {LACON_ABI,
                                  sizeof(lacon_solid_batch),
                                  sizeof(lacon_load_batch),
                                  sizeof(lacon_contact_batch),
                                  "solid",
                                  sizeof kernels / sizeof *kernels,
                                  kernels};

}  // namespace

extern "C" const lacon_plugin_table* lacon_plugin(void) { return &table; }
