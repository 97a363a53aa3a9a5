// Linear elasticity with voids (Cowin, Nunziato, 1983) in plane strain: beside the displacement a scalar phi, the change of the
// voids' volume fraction. Energy eps : C eps / 2 + B phi tr(eps) + XI phi^2 / 2 + ALPHA |grad phi|^2 / 2, hence
// sigma = C eps + B phi I, and ALPHA lap(phi) = XI phi + B tr(eps).
#include <lacon/elements/lanes.hpp>

namespace {

using lacon::Lanes;
using lacon::lanes;

enum Unknown { x_axis, y_axis, phi, n_unknowns };

LACON_KERNEL void voids(const lacon_solid_batch* batch) {
  const lacon_solid_batch& b = *batch;
  const int nodes = b.n_nodes, dofs = n_unknowns * nodes, entries = dofs * (dofs + 1) / 2;
  if (b.dimension != 2 || nodes > 9 || b.n_stress != 4 || b.n_parameters != 5 || b.n_unknowns != n_unknowns)
    return lacon::refuse(b);
  for (std::int64_t block = 0; block < b.n_blocks; ++block) {
    lacon::LaneErrors errors;
    const auto parameter = [&](int i) -> const Lanes& { return lanes(b.parameter, 5 * block + i); };
    const Lanes young = parameter(0), nu = parameter(1), coupling = parameter(2), xi = parameter(3), alpha = parameter(4);
    errors.set(~((young > 0) & (nu > -1) & (nu < 0.5) & (xi > 0) & (alpha > 0)), LACON_BAD_PARAMETER);
    const Lanes mu = young / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
    const double* x = b.coordinates + block * 2 * nodes * LACON_LANES;
    const double* u = b.displacement + block * dofs * LACON_LANES;
    double* matrix = b.matrix ? b.matrix + block * entries * LACON_LANES : nullptr;
    double* force = b.force ? b.force + block * dofs * LACON_LANES : nullptr;
    if (matrix) lacon::clear_lanes(matrix, 0, entries);
    if (force) lacon::clear_lanes(force, 0, dofs);
    Lanes sum = {};
    for (int p = 0; p < b.n_points; ++p) {
      const double *d = b.gradient + p * 2 * nodes, *n = b.shape + p * nodes;
      Lanes j[2][2] = {};
      for (int a = 1; a < nodes; ++a)
        for (int r = 0; r < 2; ++r)
          for (int s = 0; s < 2; ++s) j[r][s] += d[2 * a + s] * (lanes(x, 2 * a + r) - lanes(x, r));
      const Lanes determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0], dv = b.weight[p] * determinant;
      errors.set(~(determinant > 0), LACON_BAD_JACOBIAN);
      Lanes g[9][2], slope[n_unknowns][2] = {}, filled = {};  // gradients of shape functions and unknowns; phi
      for (int a = 0; a < nodes; ++a) {
        g[a][0] = (d[2 * a] * j[1][1] - d[2 * a + 1] * j[1][0]) / determinant;
        g[a][1] = (d[2 * a + 1] * j[0][0] - d[2 * a] * j[0][1]) / determinant;
        for (int r = 0; r < n_unknowns; ++r)
          for (int s = 0; s < 2; ++s) slope[r][s] += lanes(u, n_unknowns * a + r) * g[a][s];
        filled += n[a] * lanes(u, n_unknowns * a + phi);
      }
      const Lanes trace = slope[0][0] + slope[1][1], mean = lambda * trace + coupling * filled;
      const Lanes shear = mu * (slope[0][1] + slope[1][0]);
      const Lanes sigma[2][2] = {{mean + 2 * mu * slope[0][0], shear}, {shear, mean + 2 * mu * slope[1][1]}};
      const Lanes on_voids = coupling * trace + xi * filled;
      sum += sigma[0][0] + sigma[1][1] + shear + on_voids + slope[phi][0] + slope[phi][1] + dv;
      if (b.stress) {
        const std::int64_t at = (block * b.n_points + p) * b.n_stress;
        lanes(b.stress, at) = sigma[0][0];
        lanes(b.stress, at + 1) = sigma[1][1];
        lanes(b.stress, at + 2) = mean;
        lanes(b.stress, at + 3) = shear;
      }
      for (int row = 0, entry = 0; row < dofs; ++row) {
        const int a = row / n_unknowns, r = row % n_unknowns;
        if (force)
          lanes(force, row) += dv * (r == phi ? alpha * (g[a][0] * slope[phi][0] + g[a][1] * slope[phi][1]) + n[a] * on_voids
                                              : g[a][0] * sigma[r][0] + g[a][1] * sigma[r][1]);
        for (int column = 0; matrix && column <= row; ++column, ++entry) {
          const int c = column / n_unknowns, s = column % n_unknowns;
          const Lanes alike = g[a][0] * g[c][0] + g[a][1] * g[c][1];
          Lanes stiff;
          if (r == phi && s == phi)
            stiff = alpha * alike + xi * n[a] * n[c];
          else if (r == phi)
            stiff = coupling * n[a] * g[c][s];
          else if (s == phi)
            stiff = coupling * g[a][r] * n[c];
          else
            stiff = lambda * g[a][r] * g[c][s] + mu * g[a][s] * g[c][r] + (r == s ? mu * alike : Lanes{});
          lanes(matrix, entry) += dv * stiff;
        }
      }
    }
    errors.check_finite(sum);
    errors.store(b.error, block);
  }
}

const char* const parameters[] = {"ELAS/E", "ELAS/NU", "VOIDS/B", "VOIDS/XI", "VOIDS/ALPHA", nullptr};
const char* const unknowns[] = {"DX", "DY", "PHI", nullptr};
const lacon_kernel kernels[] = {
    {.name = "elastic", .kind = LACON_SOLID, .solid = voids, .parameters = parameters, .unknowns = unknowns}};
const lacon_plugin_table table = {
    LACON_ABI, sizeof(lacon_solid_batch), sizeof(lacon_load_batch), sizeof(lacon_contact_batch), "voids", 1, kernels};

}  // namespace

extern "C" const lacon_plugin_table* lacon_plugin(void) { return &table; }
