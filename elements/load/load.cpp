// Loads on skin elements.
#include "lacon/elements/lanes.hpp"

namespace {

using lacon::clear_lanes;
using lacon::LaneErrors;
using lacon::Lanes;
using lacon::lanes;

// A tangent shorter than this share of the element is round-off.
constexpr double flat = 1e-13;

// A node may be this far beyond the axis, as a share of its element's size.
constexpr double over_axis = 1e-10;

/// Dead pressure on a skin whose normal n leaves the body, positive towards the body: f_a = -p int N_a n, on the initial
/// geometry. The length of the normal is the Jacobian: (t_y, -t_x) of an edge (its body on the left), t x s of a face. In
/// axisymmetry the integral has the factor r: it is that over one radian.
template <int D, bool axis>
[[gnu::always_inline]] inline void pressure(const lacon_load_batch& b) {
  const int nodes = b.n_nodes, dofs = D * nodes;
  if (b.dimension != D) return lacon::refuse(b);
  for (std::int64_t block = 0; block < b.n_blocks; ++block) {
    LaneErrors errors;
    const double* x = b.coordinates + block * dofs * LACON_LANES;
    double* force = b.force ? b.force + block * dofs * LACON_LANES : nullptr;
    if (force) clear_lanes(force, 0, dofs);
    const Lanes value = lanes(b.value, block);
    Lanes extent = {};
    for (int i = 0; i < dofs; ++i) {
      const Lanes side = lanes(x, i) - lanes(x, i % D);
      extent += side * side;
    }
    if constexpr (axis)
      for (int l = 0; l < LACON_LANES; ++l)
        for (int a = 0; a < nodes; ++a) errors.set(l, lanes(x, 2 * a)[l] < -over_axis * std::sqrt(extent[l]), LACON_BAD_RADIUS);
    Lanes sum = value;
    for (int p = 0; p < b.n_points; ++p) {
      Lanes t[D - 1][D] = {};          // tangents
      for (int a = 1; a < nodes; ++a)  // from the first node on: an element far from the origin loses no digits
        for (int i = 0; i < D; ++i) {
          const Lanes side = lanes(x, D * a + i) - lanes(x, i);
          for (int r = 0; r < D - 1; ++r) t[r][i] += b.gradient[(p * nodes + a) * (D - 1) + r] * side;
        }
      Lanes n[D], length2 = {}, bound;
      if constexpr (D == 2) {
        n[0] = t[0][1];
        n[1] = -t[0][0];
        bound = extent;
      } else {
        for (int i = 0; i < 3; ++i) n[i] = t[0][(i + 1) % 3] * t[1][(i + 2) % 3] - t[0][(i + 2) % 3] * t[1][(i + 1) % 3];
        bound = (t[0][0] * t[0][0] + t[0][1] * t[0][1] + t[0][2] * t[0][2]) *
                (t[1][0] * t[1][0] + t[1][1] * t[1][1] + t[1][2] * t[1][2]);
      }
      for (int i = 0; i < D; ++i) {
        length2 += n[i] * n[i];
        sum += n[i];
      }
      for (int l = 0; l < LACON_LANES; ++l) errors.set(l, !(length2[l] > flat * flat * bound[l]), LACON_BAD_JACOBIAN);
      if (!force) continue;
      Lanes weight = -b.weight[p] * value;
      if constexpr (axis) {
        Lanes r = {};
        for (int a = 0; a < nodes; ++a) r += b.shape[p * nodes + a] * lanes(x, 2 * a);
        weight *= r;
      }
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < D; ++i) lanes(force, D * a + i) += b.shape[p * nodes + a] * weight * n[i];
    }
    errors.check_finite(sum);
    errors.store(b.error, block);
  }
}

LACON_KERNEL void pressure_2d(const lacon_load_batch* batch) { pressure<2, false>(*batch); }
LACON_KERNEL void pressure_axis(const lacon_load_batch* batch) { pressure<2, true>(*batch); }
LACON_KERNEL void pressure_3d(const lacon_load_batch* batch) { pressure<3, false>(*batch); }

const lacon_kernel kernels[] = {
    {"pressure_2d", LACON_LOAD, nullptr, pressure_2d, nullptr, nullptr},
    {"pressure_axis", LACON_LOAD, nullptr, pressure_axis, nullptr, nullptr},
    {"pressure_3d", LACON_LOAD, nullptr, pressure_3d, nullptr, nullptr},
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
