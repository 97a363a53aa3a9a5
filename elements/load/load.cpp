// Loads on skin elements.
#include "lacon/elements/lanes.hpp"

namespace {

using lacon::clear_lanes;
using lacon::LaneErrors;
using lacon::Lanes;
using lacon::lanes;

// A tangent shorter than this share of the element is round-off.
constexpr double flat = 1e-13;

/// Dead pressure on an edge whose body is on its left, positive towards the body: f_a = -p int N_a n, with the outward normal
/// n = (t_y, -t_x) / |t| of the initial geometry. The length of t = x,xi is the Jacobian.
LACON_KERNEL void pressure_2d(const lacon_load_batch* batch) {
  const lacon_load_batch& b = *batch;
  const int nodes = b.n_nodes, dofs = 2 * nodes;
  if (b.dimension != 2) return lacon::refuse(b);
  for (std::int64_t block = 0; block < b.n_blocks; ++block) {
    LaneErrors errors;
    const double* x = b.coordinates + block * dofs * LACON_LANES;
    double* force = b.force ? b.force + block * dofs * LACON_LANES : nullptr;
    if (force) clear_lanes(force, 0, dofs);
    const Lanes pressure = lanes(b.value, block);
    Lanes extent = {};
    for (int i = 0; i < dofs; ++i) {
      const Lanes side = lanes(x, i) - lanes(x, i % 2);
      extent += side * side;
    }
    Lanes sum = pressure;
    for (int p = 0; p < b.n_points; ++p) {
      Lanes tx = {}, ty = {};
      for (int a = 1; a < nodes; ++a) {  // from the first node on: an edge far from the origin loses no digits
        tx += b.gradient[p * nodes + a] * (lanes(x, 2 * a) - lanes(x, 0));
        ty += b.gradient[p * nodes + a] * (lanes(x, 2 * a + 1) - lanes(x, 1));
      }
      const Lanes length2 = tx * tx + ty * ty;
      for (int l = 0; l < LACON_LANES; ++l) errors.set(l, !(length2[l] > flat * flat * extent[l]), LACON_BAD_JACOBIAN);
      sum += tx + ty;
      if (!force) continue;
      for (int a = 0; a < nodes; ++a) {
        const Lanes weight = -b.weight[p] * b.shape[p * nodes + a] * pressure;
        lanes(force, 2 * a) += weight * ty;
        lanes(force, 2 * a + 1) -= weight * tx;
      }
    }
    errors.check_finite(sum);
    errors.store(b.error, block);
  }
}

const lacon_kernel kernels[] = {
    {"pressure_2d", LACON_LOAD, nullptr, pressure_2d, nullptr, nullptr},
};
const lacon_plugin_table table = {LACON_ABI,
                                  sizeof(lacon_solid_batch),
                                  sizeof(lacon_load_batch),
                                  sizeof(lacon_contact_batch),
                                  "load",
                                  sizeof kernels / sizeof *kernels,
                                  kernels};

}  // namespace

extern "C" const lacon_plugin_table* lacon_plugin(void) { return &table; }
