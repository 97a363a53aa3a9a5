// A plug-in outside the tree: plane stress, small strains, isotropic elasticity. It differs from the built-in plane strain in
// its law: sigma = E / (1 - nu^2) ((1 - nu) eps + nu tr(eps) I) in the plane, SIZZ = 0.
#include <lacon/elements/lanes.hpp>

namespace {

using lacon::Lanes;
using lacon::lanes;

LACON_KERNEL void plane_stress(const lacon_solid_batch* batch) {
  const lacon_solid_batch& b = *batch;
  const int nodes = b.n_nodes, dofs = 2 * nodes, entries = dofs * (dofs + 1) / 2;
  if (b.dimension != 2 || nodes > 9 || b.n_stress != 4 || b.n_parameters != 2) return lacon::refuse(b);
  for (std::int64_t block = 0; block < b.n_blocks; ++block) {
    lacon::LaneErrors errors;
    const Lanes young = lanes(b.parameter, 2 * block), nu = lanes(b.parameter, 2 * block + 1);
    for (int l = 0; l < LACON_LANES; ++l) errors.set(l, !(young[l] > 0 && nu[l] > -1 && nu[l] <= 0.5), LACON_BAD_PARAMETER);
    const Lanes stiff = young / (1 - nu * nu), lambda = nu * stiff, mu = young / (2 * (1 + nu));
    const double* x = b.coordinates + block * dofs * LACON_LANES;
    const double* u = b.displacement + block * dofs * LACON_LANES;
    double* matrix = b.matrix ? b.matrix + block * entries * LACON_LANES : nullptr;
    double* force = b.force ? b.force + block * dofs * LACON_LANES : nullptr;
    if (matrix) lacon::clear_lanes(matrix, 0, entries);
    if (force) lacon::clear_lanes(force, 0, dofs);
    Lanes sum = {};
    for (int p = 0; p < b.n_points; ++p) {
      const double* d = b.gradient + p * dofs;
      Lanes j[2][2] = {};
      for (int a = 1; a < nodes; ++a)
        for (int r = 0; r < 2; ++r)
          for (int s = 0; s < 2; ++s) j[r][s] += d[2 * a + s] * (lanes(x, 2 * a + r) - lanes(x, r));
      const Lanes determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0], dv = b.weight[p] * determinant;
      for (int l = 0; l < LACON_LANES; ++l) errors.set(l, !(determinant[l] > 0), LACON_BAD_JACOBIAN);
      Lanes g[9][2], slope[2][2] = {};  // gradients of shape functions and of the displacement
      for (int a = 0; a < nodes; ++a) {
        g[a][0] = (d[2 * a] * j[1][1] - d[2 * a + 1] * j[1][0]) / determinant;
        g[a][1] = (d[2 * a + 1] * j[0][0] - d[2 * a] * j[0][1]) / determinant;
        for (int r = 0; r < 2; ++r)
          for (int s = 0; s < 2; ++s) slope[r][s] += lanes(u, 2 * a + r) * g[a][s];
      }
      Lanes sigma[2][2];
      sigma[0][0] = stiff * slope[0][0] + lambda * slope[1][1];
      sigma[1][1] = lambda * slope[0][0] + stiff * slope[1][1];
      sigma[0][1] = sigma[1][0] = mu * (slope[0][1] + slope[1][0]);
      sum += sigma[0][0] + sigma[1][1] + sigma[0][1] + dv;
      if (b.stress) {
        const std::int64_t at = (block * b.n_points + p) * b.n_stress;
        lanes(b.stress, at) = sigma[0][0];
        lanes(b.stress, at + 1) = sigma[1][1];
        lanes(b.stress, at + 2) = Lanes{};
        lanes(b.stress, at + 3) = sigma[0][1];
      }
      for (int row = 0, entry = 0; row < dofs; ++row) {
        const int a = row / 2, r = row % 2;
        if (force) lanes(force, row) += dv * (g[a][0] * sigma[r][0] + g[a][1] * sigma[r][1]);
        for (int column = 0; matrix && column <= row; ++column, ++entry) {
          const int c = column / 2, s = column % 2;
          lanes(matrix, entry) += dv * (r == s ? stiff * g[a][r] * g[c][r] + mu * g[a][1 - r] * g[c][1 - r]
                                               : lambda * g[a][r] * g[c][s] + mu * g[a][s] * g[c][r]);
        }
      }
    }
    errors.check_finite(sum);
    errors.store(b.error, block);
  }
}

const char* const parameters[] = {"ELAS/E", "ELAS/NU", nullptr};
const lacon_kernel kernels[] = {{"elastic", LACON_SOLID, plane_stress, nullptr, nullptr, parameters}};
const lacon_plugin_table table = {
    LACON_ABI, sizeof(lacon_solid_batch), sizeof(lacon_load_batch), sizeof(lacon_contact_batch), "plane_stress", 1, kernels};

}  // namespace

extern "C" const lacon_plugin_table* lacon_plugin(void) { return &table; }
