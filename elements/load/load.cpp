// Loads on elements: pressures on skins, forces on bodies, skins and edges.
#include <algorithm>
#include <cmath>

#include "lacon/elements/axis.hpp"
#include "lacon/elements/lanes.hpp"

namespace {

// what returns lanes here is inlined into kernels: no call passes them
#pragma GCC diagnostic ignored "-Wpsabi"

using lacon::clear_lanes;
using lacon::LaneErrors;
using lacon::Lanes;
using lacon::lanes;

// A Jacobian below this share of what the element's size allows is round-off.
constexpr double flat = 1e-13;

LACON_INLINE void take_root(Lanes& x) {
  for (int l = 0; l < LACON_LANES; ++l) x[l] = std::sqrt(x[l]);
}

/// An element of R reference dimensions in a space of D.
template <int D, int R, bool axis>
struct Geometry {
  const lacon_load_batch& b;
  const double* x;     // of the block
  Lanes extent = {};   // square of the element's size
  Lanes t[R][D] = {};  // tangents at a point
  Lanes r = {};        // radius at a point, 1 away from axisymmetry

  LACON_INLINE Geometry(const lacon_load_batch& batch, std::int64_t block, LaneErrors& errors)
      : b(batch), x(batch.coordinates + block * D * batch.n_nodes * LACON_LANES) {
    for (int i = 0; i < D * b.n_nodes; ++i) {
      const Lanes side = lanes(x, i) - lanes(x, i % D);
      extent += side * side;
    }
    if constexpr (axis)  // whether these are coordinates of the mesh or displaced ones is not said
      for (int l = 0; l < LACON_LANES; ++l)
        errors.set(l, lacon::displaced_reaches_over_axis(b.n_nodes, [&](int i) { return lanes(x, i)[l]; }), LACON_BAD_RADIUS);
  }

  LACON_INLINE double shape(int p, int a) const { return b.shape[p * b.n_nodes + a]; }
  LACON_INLINE double gradient(int p, int a, int k) const { return b.gradient[(p * b.n_nodes + a) * R + k]; }

  LACON_INLINE void go_to(int p) {
    for (int k = 0; k < R; ++k)
      for (int i = 0; i < D; ++i) {
        t[k][i] = Lanes{};
        for (int a = 1; a < b.n_nodes; ++a)  // from the first node on: an element far from the origin loses no digits
          t[k][i] += gradient(p, a, k) * (lanes(x, D * a + i) - lanes(x, i));
      }
    r = Lanes{} + 1.0;
    if constexpr (axis) {
      r = Lanes{};
      for (int a = 0; a < b.n_nodes; ++a) r += shape(p, a) * lanes(x, 2 * a);
      r = r < 0 ? Lanes{} : r;
    }
  }
  LACON_INLINE Lanes length2(int k) const {
    Lanes sum = {};
    for (int i = 0; i < D; ++i) sum += t[k][i] * t[k][i];
    return sum;
  }
  /// The normal of a skin, as long as the Jacobian: (t_y, -t_x) of an edge (its body on the left), t x s of a face.
  LACON_INLINE void normal(Lanes (&n)[D]) const {
    if constexpr (D == 2) {
      n[0] = t[0][1];
      n[1] = -t[0][0];
    } else {
      for (int i = 0; i < 3; ++i) n[i] = t[0][(i + 1) % 3] * t[1][(i + 2) % 3] - t[0][(i + 2) % 3] * t[1][(i + 1) % 3];
    }
  }
  /// Length, area or volume for one of the reference cell.
  LACON_INLINE Lanes jacobian(LaneErrors& errors) const {
    Lanes j, bound = extent;
    if constexpr (R == D) {
      if constexpr (D == 2) {
        j = t[0][0] * t[1][1] - t[0][1] * t[1][0];
        bound = length2(0) * length2(1);
      } else {
        j = Lanes{};
        for (int i = 0; i < 3; ++i)
          j += t[0][i] * (t[1][(i + 1) % 3] * t[2][(i + 2) % 3] - t[1][(i + 2) % 3] * t[2][(i + 1) % 3]);
        bound = length2(0) * length2(1) * length2(2);
      }
    } else if constexpr (R == 1) {
      j = length2(0);
      take_root(j);
    } else {
      Lanes n[D], sum = {};
      normal(n);
      for (int i = 0; i < D; ++i) sum += n[i] * n[i];
      j = sum;
      take_root(j);
      bound = length2(0) * length2(1);
    }
    take_root(bound);
    errors.set(~(j > flat * bound), LACON_BAD_JACOBIAN);
    return j;
  }
};

/// Pressure p on a skin whose normal n leaves the body, positive towards the body, and in the plane a shear c along its tangent
/// t: f_a = int N_a (-p n + c t). In axisymmetry the integral has the factor r: it is that over one radian.
template <int D, bool axis>
LACON_INLINE void pressure(const lacon_load_batch& b) {
  constexpr int n_values = D == 2 ? 2 : 1;
  const int nodes = b.n_nodes, dofs = D * nodes, n_lower = dofs * (dofs + 1) / 2;
  if (b.dimension != D || b.reference_dimension != D - 1 || b.n_values != n_values) return lacon::refuse(b);
  for (std::int64_t block = 0; block < b.n_blocks; ++block) {
    LaneErrors errors;
    double* force = b.force ? b.force + block * dofs * LACON_LANES : nullptr;
    double* matrix = b.matrix ? b.matrix + block * n_lower * LACON_LANES : nullptr;
    if (force) clear_lanes(force, 0, dofs);
    if (matrix) clear_lanes(matrix, 0, n_lower);
    Geometry<D, D - 1, axis> g(b, block, errors);
    Lanes sum = {};
    for (int p = 0; p < b.n_points; ++p) {
      g.go_to(p);
      sum += g.jacobian(errors);
      const double* const value = b.value + (block * b.n_points + p) * n_values * LACON_LANES;
      for (int v = 0; v < n_values; ++v) sum += lanes(value, v);
      Lanes n[D], density[D];
      g.normal(n);
      for (int i = 0; i < D; ++i) {
        density[i] = -b.weight[p] * lanes(value, 0) * n[i];
        if constexpr (D == 2) density[i] += b.weight[p] * lanes(value, 1) * g.t[0][i];
      }
      if (force)
        for (int a = 0; a < nodes; ++a)
          for (int i = 0; i < D; ++i) lanes(force, D * a + i) += g.shape(p, a) * g.r * density[i];
      if (!matrix) continue;
      // the derivative of f_a,i by x_c,j is N_a times what this adds
      const Lanes weight = b.weight[p] * g.r;
      const auto add = [&](Lanes& sum_of, double factor, int i, int c, int j) LACON_INLINE_LAMBDA {
        if constexpr (D == 2) {
          const Lanes density_by_tangent = i == j ? lanes(value, 1) : i == 0 ? -lanes(value, 0) : lanes(value, 0);
          sum_of += factor * g.gradient(p, c, 0) * weight * density_by_tangent;
          if constexpr (axis)
            if (j == 0) sum_of += factor * g.shape(p, c) * density[i];
        } else if (i != j) {
          const int k = 3 - i - j;
          const double sign = (i + 1) % 3 == j ? -factor : factor;
          sum_of += sign * weight * lanes(value, 0) * (g.gradient(p, c, 0) * g.t[1][k] - g.gradient(p, c, 1) * g.t[0][k]);
        }
      };
      std::int64_t at = 0;
      for (int row = 0; row < dofs; ++row)
        for (int column = 0; column <= row; ++column, ++at) {
          const int a = row / D, i = row % D, c = column / D, j = column % D;
          add(lanes(matrix, at), 0.5 * g.shape(p, a), i, c, j);
          add(lanes(matrix, at), 0.5 * g.shape(p, c), j, a, i);
        }
    }
    errors.check_finite(sum);
    errors.store(b.error, block);
  }
}

/// A force for each unit of length, area or volume: f_a = int N_a f; in axisymmetry that over one radian.
template <int D, int R, bool axis>
LACON_INLINE void force(const lacon_load_batch& b) {
  const int nodes = b.n_nodes, dofs = D * nodes;
  if (b.dimension != D || b.reference_dimension != R || b.n_values != D) return lacon::refuse(b);
  for (std::int64_t block = 0; block < b.n_blocks; ++block) {
    LaneErrors errors;
    double* force = b.force ? b.force + block * dofs * LACON_LANES : nullptr;
    if (force) clear_lanes(force, 0, dofs);
    if (b.matrix) clear_lanes(b.matrix + block * (dofs * (dofs + 1) / 2) * LACON_LANES, 0, dofs * (dofs + 1) / 2);
    Geometry<D, R, axis> g(b, block, errors);
    Lanes sum = {};
    for (int p = 0; p < b.n_points; ++p) {
      g.go_to(p);
      const Lanes weight = b.weight[p] * g.jacobian(errors) * g.r;
      sum += weight;
      const double* const value = b.value + (block * b.n_points + p) * D * LACON_LANES;
      for (int i = 0; i < D; ++i) {
        sum += lanes(value, i);
        if (!force) continue;
        for (int a = 0; a < nodes; ++a) lanes(force, D * a + i) += g.shape(p, a) * weight * lanes(value, i);
      }
    }
    errors.check_finite(sum);
    errors.store(b.error, block);
  }
}

LACON_KERNEL void pressure_2d(const lacon_load_batch* batch) { pressure<2, false>(*batch); }
LACON_KERNEL void pressure_axis(const lacon_load_batch* batch) { pressure<2, true>(*batch); }
LACON_KERNEL void pressure_3d(const lacon_load_batch* batch) { pressure<3, false>(*batch); }
LACON_KERNEL void line_2d(const lacon_load_batch* batch) { force<2, 1, false>(*batch); }
LACON_KERNEL void line_axis(const lacon_load_batch* batch) { force<2, 1, true>(*batch); }
LACON_KERNEL void face_3d(const lacon_load_batch* batch) { force<3, 2, false>(*batch); }
LACON_KERNEL void volume_2d(const lacon_load_batch* batch) { force<2, 2, false>(*batch); }
LACON_KERNEL void volume_axis(const lacon_load_batch* batch) { force<2, 2, true>(*batch); }
LACON_KERNEL void volume_3d(const lacon_load_batch* batch) { force<3, 3, false>(*batch); }

const char* const pressures_2d[] = {"PRES", "CISA_2D", nullptr};
const char* const pressures_3d[] = {"PRES", nullptr};
const char* const forces_2d[] = {"FX", "FY", nullptr};
const char* const forces_3d[] = {"FX", "FY", "FZ", nullptr};

constexpr lacon_kernel load_kernel(const char* name, void (*load)(const lacon_load_batch*), const char* const* values) {
  lacon_kernel kernel{};
  kernel.name = name;
  kernel.kind = LACON_LOAD;
  kernel.load = load;
  kernel.parameters = values;
  return kernel;
}

const lacon_kernel kernels[] = {
    load_kernel("pressure_2d", pressure_2d, pressures_2d), load_kernel("pressure_axis", pressure_axis, pressures_2d),
    load_kernel("pressure_3d", pressure_3d, pressures_3d), load_kernel("line_2d", line_2d, forces_2d),
    load_kernel("line_axis", line_axis, forces_2d),        load_kernel("face_3d", face_3d, forces_3d),
    load_kernel("volume_2d", volume_2d, forces_2d),        load_kernel("volume_axis", volume_axis, forces_2d),
    load_kernel("volume_3d", volume_3d, forces_3d),
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
