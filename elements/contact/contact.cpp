// Contact cells of the LAC method: integrated gap, measures and the conservative contact matrix.
#include <cmath>
#include <cstdint>

#include "lacon/elements/axis.hpp"
#include "lacon/elements/lanes.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed between inlined functions alone

namespace {

constexpr int max_nodes = 9;

/// The components of a vector of the plane or of space as one value in a register; in space the fourth is 0.
template <int D>
struct VectorOf;
template <>
struct VectorOf<2> {
  using type = double __attribute__((vector_size(2 * sizeof(double))));
};
template <>
struct VectorOf<3> {
  using type = double __attribute__((vector_size(4 * sizeof(double))));
};
template <int D>
using Vector = typename VectorOf<D>::type;

// A Jacobian below this share of the size of its terms is round-off.
constexpr double flat = 1e-13;

template <int D>
LACON_INLINE double dot(const Vector<D>& a, const Vector<D>& b) {
  const Vector<D> products = a * b;
  double sum = products[0];
  for (int i = 1; i < D; ++i) sum += products[i];
  return sum;
}

LACON_INLINE Vector<3> cross(const Vector<3>& a, const Vector<3>& b) {
  using Places = std::int64_t __attribute__((vector_size(4 * sizeof(std::int64_t))));
  const Places next = {1, 2, 0, 3};
  return __builtin_shuffle(a * __builtin_shuffle(b, next) - __builtin_shuffle(a, next) * b, next);
}

template <int D>
LACON_INLINE Vector<D> load(const double* x) {
  if constexpr (D == 2)
    return Vector<2>{x[0], x[1]};
  else
    return Vector<3>{x[0], x[1], x[2], 0.0};
}

/// The nodes of a cell.
template <int D>
struct Nodes {
  int n;
  Vector<D> x[max_nodes];

  /// @param nodes (n, D)
  LACON_INLINE Nodes(int count, const double* nodes) : n(count) {
    for (int a = 0; a < n; ++a) x[a] = load<D>(nodes + a * D);
  }
  /// Sum of shape_a x_a.
  LACON_INLINE Vector<D> at(const double* shape) const {
    Vector<D> value{};
    for (int a = 0; a < n; ++a) value += shape[a] * x[a];
    return value;
  }
};

/// The edges from the first node of a cell to the others.
template <int D>
struct Edges : Nodes<D> {
  LACON_INLINE Edges(int count, const double* nodes) : Nodes<D>(count, nodes) {
    for (int a = count - 1; a >= 0; --a) this->x[a] -= this->x[0];
  }
  /// The tangent along reference coordinate `axis`: a cell far from the origin loses no digits.
  LACON_INLINE Vector<D> tangent(const double* gradient, int axis) const {
    Vector<D> value{};
    for (int a = 1; a < this->n; ++a) value += gradient[a * (D - 1) + axis] * this->x[a];
    return value;
  }
};

/// The outward normal of a slave skin at a point, its length being the Jacobian; `scale2` gets the square of the size of its
/// terms.
template <int D>
LACON_INLINE Vector<D> area_normal(const double* gradient, const Edges<D>& edges, double& scale2) {
  const Vector<D> t = edges.tangent(gradient, 0);
  if constexpr (D == 2) {
    double scale = 0;
    for (int a = 1; a < edges.n; ++a) scale += std::abs(gradient[a]) * (std::abs(edges.x[a][0]) + std::abs(edges.x[a][1]));
    scale2 = scale * scale;
    return Vector<D>{t[1], -t[0]};
  } else {
    const Vector<D> s = edges.tangent(gradient, 1);
    scale2 = dot<D>(t, t) * dot<D>(s, s);
    return cross(t, s);
  }
}

/// METHOD.md 3.4 and 5.4 (b): at each point the gap g = (x_m - x).n_e; with the measure J of TYPE_JACOBIEN (of the initial
/// geometry or of the current one, in both) G = sum w J g and C = sum w J (-phi_i n_e on the slave, +phi_j n_e on the master).
/// In axisymmetry (METHOD.md 3.9) J has the factor r, the slave's radius in the same geometry: integrals over one radian.
/// @tparam S, M nodes of the slave and of the master where they are known in advance, or 0
template <int D, bool axis, int S, int M>
LACON_INLINE void lac_of(const lacon_contact_batch& b) {
  const int slaves = S > 0 ? S : b.n_slave_nodes, masters = M > 0 ? M : b.n_master_nodes, dofs = (slaves + masters) * D;
  for (std::int64_t cell = 0; cell < b.n_cells; ++cell) {
    if (b.dimension != D || slaves > max_nodes || masters > max_nodes) {
      b.error[cell] = LACON_BAD_BATCH;
      continue;
    }
    const double* const initial_nodes = b.slave_initial + cell * slaves * D;
    const double* const current_nodes = b.slave + cell * slaves * D;
    const Nodes<D> initial(slaves, initial_nodes), current(slaves, current_nodes),
        master(masters, b.master + cell * masters * D);
    const Edges<D> initial_edges(slaves, initial_nodes), current_edges(slaves, current_nodes);
    const Nodes<D> normals(b.slave_normal ? slaves : 0, b.slave_normal + cell * slaves * D);
    Vector<D> on_slave[max_nodes], on_master[max_nodes];  // C
    for (int a = 0; a < slaves; ++a) on_slave[a] = Vector<D>{};
    for (int a = 0; a < masters; ++a) on_master[a] = Vector<D>{};
    double gap = 0, measure = 0, current_measure = 0;
    bool bad = false, over = false;
    if constexpr (axis)
      over = lacon::reaches_over_axis(slaves, [&](int i) { return initial_nodes[i]; }) ||
             lacon::displaced_reaches_over_axis(slaves, [&](int i) { return current_nodes[i]; });
    for (std::int64_t p = b.offset[cell]; p < b.offset[cell + 1]; ++p) {
      const double* shape = b.slave_shape + p * slaves;
      const double* master_shape = b.master_shape + p * masters;
      const double* gradient = b.slave_gradient + p * slaves * (D - 1);
      double scale2, scale02;
      Vector<D> n = area_normal<D>(gradient, current_edges, scale2);
      const Vector<D> n0 = area_normal<D>(gradient, initial_edges, scale02);
      double jacobian = std::sqrt(dot<D>(n, n)), jacobian0 = std::sqrt(dot<D>(n0, n0));
      bad |= !(jacobian * jacobian > flat * flat * scale2) || !(jacobian0 * jacobian0 > flat * flat * scale02);
      double length = jacobian;
      if (normals.n > 0) {
        n = normals.at(shape);
        length = std::sqrt(dot<D>(n, n));
        bad |= !(length > flat);  // nodal normals that cancel
      }
      n = (1 / length) * n;
      const Vector<D> x = current.at(shape), across = master.at(master_shape) - x;
      if constexpr (axis) {
        // beyond the axis, where an iterate may be on its way, nothing is measured
        jacobian *= std::fmax(x[0], 0);
        jacobian0 *= std::fmax(initial.at(shape)[0], 0);
      }
      const double g = dot<D>(across, n), w = b.weight[p] * (b.current_jacobian ? jacobian : jacobian0);
      if (b.point_gap) b.point_gap[p] = g;
      gap += w * g;
      measure += w;
      current_measure += b.weight[p] * jacobian;
      const Vector<D> wn = w * n;
      for (int a = 0; a < slaves; ++a) on_slave[a] -= shape[a] * wn;
      for (int a = 0; a < masters; ++a) on_master[a] += master_shape[a] * wn;
    }
    if (b.coupling) {
      double* coupling = b.coupling + cell * dofs;
      for (int a = 0; a < slaves; ++a)
        for (int i = 0; i < D; ++i) *coupling++ = on_slave[a][i];
      for (int a = 0; a < masters; ++a)
        for (int i = 0; i < D; ++i) *coupling++ = on_master[a][i];
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
LACON_INLINE void lac(const lacon_contact_batch& batch) {
  const auto nodes = [&](int slaves, int masters) { return batch.n_slave_nodes == slaves && batch.n_master_nodes == masters; };
  if (D == 3 && nodes(4, 4)) return lac_of<D, axis, 4, 4>(batch);
  if (D == 3 && nodes(3, 3)) return lac_of<D, axis, 3, 3>(batch);
  if (D == 3 && nodes(3, 4)) return lac_of<D, axis, 3, 4>(batch);
  if (D == 3 && nodes(4, 3)) return lac_of<D, axis, 4, 3>(batch);
  lac_of<D, axis, 0, 0>(batch);
}

LACON_KERNEL void lac_2d(const lacon_contact_batch* batch) { lac<2>(*batch); }
LACON_KERNEL void lac_axis(const lacon_contact_batch* batch) { lac<2, true>(*batch); }
LACON_KERNEL void lac_3d(const lacon_contact_batch* batch) { lac<3>(*batch); }

const lacon_kernel kernels[] = {
    {"lac_2d", LACON_CONTACT, nullptr, nullptr, lac_2d, nullptr},
    {"lac_axis", LACON_CONTACT, nullptr, nullptr, lac_axis, nullptr},
    {"lac_3d", LACON_CONTACT, nullptr, nullptr, lac_3d, nullptr},
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
