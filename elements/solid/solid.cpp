// Solid elements, small strains.
#include "lacon/elements/lanes.hpp"

namespace {

using lacon::clear_lanes;
using lacon::LaneErrors;
using lacon::Lanes;
using lacon::lanes;

constexpr int max_nodes = 9;

// A determinant below this share of the size of its terms is round-off.
constexpr double flat = 1e-13;

/// Plane strain, small strains, isotropic elasticity: sigma = lambda tr(eps) I + 2 mu eps, parameters E and nu.
/// Stress: SIXX SIYY SIZZ SIXY. Outputs of an element in error have no meaning.
LACON_KERNEL void plane_strain_small_elastic(const lacon_solid_batch* batch) {
  const lacon_solid_batch& b = *batch;
  const int nodes = b.n_nodes, dofs = 2 * nodes, entries = dofs * (dofs + 1) / 2;
  if (b.dimension != 2 || nodes > max_nodes || b.n_stress != 4 || b.n_parameters != 2) return lacon::refuse(b);
  for (std::int64_t block = 0; block < b.n_blocks; ++block) {
    LaneErrors errors;
    const Lanes young = lanes(b.parameter, 2 * block), nu = lanes(b.parameter, 2 * block + 1);
    for (int l = 0; l < LACON_LANES; ++l)
      errors.set(l, !(young[l] > 0 && std::isfinite(young[l]) && nu[l] > -1 && nu[l] < 0.5), LACON_BAD_PARAMETER);
    const Lanes mu = young / (2 * (1 + nu)), lambda = young * nu / ((1 + nu) * (1 - 2 * nu)), stiff = lambda + 2 * mu;
    const double* x = b.coordinates + block * dofs * LACON_LANES;
    const double* u = b.displacement + block * dofs * LACON_LANES;
    double* matrix = b.matrix ? b.matrix + block * entries * LACON_LANES : nullptr;
    double* force = b.force ? b.force + block * dofs * LACON_LANES : nullptr;
    if (matrix) clear_lanes(matrix, 0, entries);
    if (force) clear_lanes(force, 0, dofs);
    Lanes sum = {};
    for (int p = 0; p < b.n_points; ++p) {
      const double* d = b.gradient + p * dofs;  // by reference coordinates
      Lanes j00 = {}, j01 = {}, j10 = {}, j11 = {};
      for (int a = 1; a < nodes; ++a) {  // from the first node on: a cell far from the origin loses no digits
        const Lanes dx = lanes(x, 2 * a) - lanes(x, 0), dy = lanes(x, 2 * a + 1) - lanes(x, 1);
        j00 += d[2 * a] * dx;
        j01 += d[2 * a + 1] * dx;
        j10 += d[2 * a] * dy;
        j11 += d[2 * a + 1] * dy;
      }
      const Lanes determinant = j00 * j11 - j01 * j10;
      const Lanes size = j00 * j00 + j01 * j01 + j10 * j10 + j11 * j11;
      for (int l = 0; l < LACON_LANES; ++l) errors.set(l, !(determinant[l] > flat * size[l]), LACON_BAD_JACOBIAN);
      const Lanes inverse = 1 / determinant, dv = b.weight[p] * determinant;
      Lanes gx[max_nodes], gy[max_nodes];  // gradients in space
      Lanes exx = {}, eyy = {}, exy = {};  // exy twice the tensor's
      for (int a = 0; a < nodes; ++a) {
        gx[a] = (d[2 * a] * j11 - d[2 * a + 1] * j10) * inverse;
        gy[a] = (d[2 * a + 1] * j00 - d[2 * a] * j01) * inverse;
        exx += gx[a] * lanes(u, 2 * a);
        eyy += gy[a] * lanes(u, 2 * a + 1);
        exy += gy[a] * lanes(u, 2 * a) + gx[a] * lanes(u, 2 * a + 1);
      }
      const Lanes sxx = stiff * exx + lambda * eyy, syy = lambda * exx + stiff * eyy, szz = lambda * (exx + eyy),
                  sxy = mu * exy;
      sum += sxx + syy + sxy + dv;
      if (b.stress) {
        const std::int64_t at = (block * b.n_points + p) * b.n_stress;
        lanes(b.stress, at) = sxx;
        lanes(b.stress, at + 1) = syy;
        lanes(b.stress, at + 2) = szz;
        lanes(b.stress, at + 3) = sxy;
      }
      if (force)
        for (int a = 0; a < nodes; ++a) {
          lanes(force, 2 * a) += dv * (gx[a] * sxx + gy[a] * sxy);
          lanes(force, 2 * a + 1) += dv * (gx[a] * sxy + gy[a] * syy);
        }
      if (!matrix) continue;
      for (int a = 0; a < nodes; ++a) {
        double* row_x = matrix + a * (2 * a + 1) * LACON_LANES;  // row 2 a starts behind 2 a (2 a + 1) / 2 entries
        double* row_y = row_x + (2 * a + 1) * LACON_LANES;
        const Lanes ax = dv * gx[a], ay = dv * gy[a];
        for (int c = 0; c <= a; ++c) {
          lanes(row_x, 2 * c) += stiff * ax * gx[c] + mu * ay * gy[c];
          if (c < a) lanes(row_x, 2 * c + 1) += lambda * ax * gy[c] + mu * ay * gx[c];
          lanes(row_y, 2 * c) += lambda * ay * gx[c] + mu * ax * gy[c];
          lanes(row_y, 2 * c + 1) += stiff * ay * gy[c] + mu * ax * gx[c];
        }
      }
    }
    errors.check_finite(sum);
    errors.store(b.error, block);
  }
}

const char* const isotropic[] = {"ELAS/E", "ELAS/NU", nullptr};
const lacon_kernel kernels[] = {
    {"plane_strain_small_elastic", LACON_SOLID, plane_strain_small_elastic, nullptr, nullptr, isotropic},
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
