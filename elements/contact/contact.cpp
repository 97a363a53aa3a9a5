// Contact cells of the LAC method: integrated gap, measures and the conservative contact matrix.
#include <array>
#include <cmath>
#include <cstdint>

#include "lacon/elements/plugin.h"

namespace {

template <int D>
using Vector = std::array<double, D>;

// A Jacobian below this share of the size of its terms is round-off.
constexpr double flat = 1e-13;

template <int D>
double dot(const Vector<D>& a, const Vector<D>& b) {
  double sum = 0;
  for (int i = 0; i < D; ++i) sum += a[i] * b[i];
  return sum;
}

/// Sum of shape_a nodes_a. @param nodes (n, D)
template <int D>
inline Vector<D> interpolate(const double* shape, const double* nodes, int n) {
  Vector<D> value{};
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < D; ++i) value[i] += shape[a] * nodes[a * D + i];
  return value;
}

/// The tangent along reference coordinate `axis`, from the first node on: a cell far from the origin loses no digits.
template <int D>
inline Vector<D> tangent(const double* gradient, int axis, const double* nodes, int n) {
  Vector<D> value{};
  for (int a = 1; a < n; ++a)
    for (int i = 0; i < D; ++i) value[i] += gradient[a * (D - 1) + axis] * (nodes[a * D + i] - nodes[i]);
  return value;
}

/// The outward normal of a slave skin at a point, its length being the Jacobian; `scale` gets the size of its terms.
template <int D>
inline Vector<D> area_normal(const double* gradient, const double* nodes, int n, double& scale) {
  const Vector<D> t = tangent<D>(gradient, 0, nodes, n);
  if constexpr (D == 2) {
    scale = 0;
    for (int a = 1; a < n; ++a)
      scale += std::abs(gradient[a]) * (std::abs(nodes[2 * a] - nodes[0]) + std::abs(nodes[2 * a + 1] - nodes[1]));
    return {t[1], -t[0]};
  } else {
    const Vector<D> s = tangent<D>(gradient, 1, nodes, n);
    scale = std::sqrt(dot<D>(t, t) * dot<D>(s, s));
    return {t[1] * s[2] - t[2] * s[1], t[2] * s[0] - t[0] * s[2], t[0] * s[1] - t[1] * s[0]};
  }
}

/// Whether a node of an edge has a negative radius by more than round-off. @param nodes (n, 2)
bool reaches_over_axis(const double* nodes, int n) {
  double size = 0, least = nodes[0];
  for (int i = 0; i < 2 * n; ++i) size = std::fmax(size, std::abs(nodes[i] - nodes[i % 2]));
  for (int a = 1; a < n; ++a) least = std::fmin(least, nodes[2 * a]);
  return least < -1e-10 * size;
}

/// METHOD.md 3.4 and 5.4 (b): at each point the gap g = (x_m - x).n_e; with the measure J of TYPE_JACOBIEN (of the initial
/// geometry or of the current one, in both) G = sum w J g and C = sum w J (-phi_i n_e on the slave, +phi_j n_e on the master).
/// In axisymmetry (METHOD.md 3.9) J has the factor r, the slave's radius in the same geometry: integrals over one radian.
/// @tparam S, M nodes of the slave and of the master where they are known in advance, or 0
template <int D, bool axis, int S, int M>
void lac_of(const lacon_contact_batch& b) {
  const int slaves = S > 0 ? S : b.n_slave_nodes, masters = M > 0 ? M : b.n_master_nodes, dofs = (slaves + masters) * D;
  for (std::int64_t cell = 0; cell < b.n_cells; ++cell) {
    if (b.dimension != D) {
      b.error[cell] = LACON_BAD_BATCH;
      continue;
    }
    const double* initial = b.slave_initial + cell * slaves * D;
    const double* current = b.slave + cell * slaves * D;
    const double* master = b.master + cell * masters * D;
    const double* normals = b.slave_normal ? b.slave_normal + cell * slaves * D : nullptr;
    double* coupling = b.coupling ? b.coupling + cell * dofs : nullptr;
    for (int i = 0; coupling && i < dofs; ++i) coupling[i] = 0;
    double gap = 0, measure = 0, current_measure = 0;
    bool bad = false, over = false;
    if constexpr (axis) over = reaches_over_axis(initial, slaves) || reaches_over_axis(current, slaves);
    for (std::int64_t p = b.offset[cell]; p < b.offset[cell + 1]; ++p) {
      const double* shape = b.slave_shape + p * slaves;
      const double* master_shape = b.master_shape + p * masters;
      const double* gradient = b.slave_gradient + p * slaves * (D - 1);
      double scale, scale0;
      Vector<D> n = area_normal<D>(gradient, current, slaves, scale);
      const Vector<D> n0 = area_normal<D>(gradient, initial, slaves, scale0);
      double jacobian = std::sqrt(dot<D>(n, n)), jacobian0 = std::sqrt(dot<D>(n0, n0));
      bad |= !(jacobian > flat * scale) || !(jacobian0 > flat * scale0);
      double length = jacobian;
      if (normals) {
        n = interpolate<D>(shape, normals, slaves);
        length = std::sqrt(dot<D>(n, n));
        bad |= !(length > flat);  // nodal normals that cancel
      }
      for (double& component : n) component /= length;
      const Vector<D> x = interpolate<D>(shape, current, slaves), image = interpolate<D>(master_shape, master, masters);
      if constexpr (axis) {
        // beyond the axis, where an iterate may be on its way, nothing is measured
        jacobian *= std::fmax(x[0], 0);
        jacobian0 *= std::fmax(interpolate<D>(shape, initial, slaves)[0], 0);
      }
      Vector<D> across;
      for (int i = 0; i < D; ++i) across[i] = image[i] - x[i];
      const double g = dot<D>(across, n), w = b.weight[p] * (b.current_jacobian ? jacobian : jacobian0);
      if (b.point_gap) b.point_gap[p] = g;
      gap += w * g;
      measure += w;
      current_measure += b.weight[p] * jacobian;
      if (!coupling) continue;
      for (int i = 0; i < D; ++i) {
        const double wn = w * n[i];
        for (int a = 0; a < slaves; ++a) coupling[a * D + i] -= wn * shape[a];
        for (int a = 0; a < masters; ++a) coupling[(slaves + a) * D + i] += wn * master_shape[a];
      }
    }
    if (b.gap) b.gap[cell] = gap;
    if (b.measure) b.measure[cell] = measure;
    if (b.current_measure) b.current_measure[cell] = current_measure;
    const bool finite = std::isfinite(gap) && std::isfinite(measure) && std::isfinite(current_measure);
    b.error[cell] = over ? LACON_BAD_RADIUS : bad ? LACON_BAD_JACOBIAN : finite ? LACON_FINE : LACON_NOT_FINITE;
  }
}

/// Loops over nodes of a known number are unrolled: skins of linear cells, the most frequent ones in space.
template <int D, bool axis = false>
void lac(const lacon_contact_batch* batch) {
  const auto nodes = [&](int slaves, int masters) {
    return batch->n_slave_nodes == slaves && batch->n_master_nodes == masters;
  };
  if (D == 3 && nodes(4, 4)) return lac_of<D, axis, 4, 4>(*batch);
  if (D == 3 && nodes(3, 3)) return lac_of<D, axis, 3, 3>(*batch);
  if (D == 3 && nodes(3, 4)) return lac_of<D, axis, 3, 4>(*batch);
  if (D == 3 && nodes(4, 3)) return lac_of<D, axis, 4, 3>(*batch);
  lac_of<D, axis, 0, 0>(*batch);
}

const lacon_kernel kernels[] = {
    {"lac_2d", LACON_CONTACT, nullptr, nullptr, lac<2>, nullptr},
    {"lac_axis", LACON_CONTACT, nullptr, nullptr, lac<2, true>, nullptr},
    {"lac_3d", LACON_CONTACT, nullptr, nullptr, lac<3>, nullptr},
};
const lacon_plugin_table table = {LACON_ABI,
                                  sizeof(lacon_solid_batch),
                                  sizeof(lacon_load_batch),
                                  sizeof(lacon_contact_batch),
                                  "contact",
                                  sizeof kernels / sizeof *kernels,
                                  kernels};

}  // namespace

extern "C" const lacon_plugin_table* lacon_plugin(void) { return &table; }
