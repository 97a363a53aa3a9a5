// Laws of behaviour for plane strain, small strains. sigma = (1 - d) C eps with C by Lame's constants. Elasticity: d = 0.
// Damage: d = kappa / (YC + kappa), kappa the largest energy density eps : C eps / 2 that there was. Hooke: elasticity by E and
// NU, which adds to the stress that it starts from.
#include <lacon/elements/lanes.hpp>

namespace {

using lacon::Lanes;
using lacon::lanes;

enum Variable { kappa, damage_share, n_variables };

enum class Law { lame, damage, hooke };

template <Law law>
[[gnu::always_inline]] inline void evaluate(const lacon_solid_batch& b) {
  const int nodes = b.n_nodes, dofs = 2 * nodes, entries = dofs * (dofs + 1) / 2;
  constexpr bool weakens = law == Law::damage;
  constexpr int n_parameters = weakens ? 3 : 2;
  if (b.dimension != 2 || nodes > 9 || b.n_stress != 4 || b.n_parameters != n_parameters ||
      b.n_variables != (weakens ? n_variables : 0))
    return lacon::refuse(b);
  for (std::int64_t block = 0; block < b.n_blocks; ++block) {
    lacon::LaneErrors errors;
    const auto parameter = [&](int i) -> const Lanes& { return lanes(b.parameter, n_parameters * block + i); };
    Lanes lambda = parameter(0), mu = parameter(1);
    if (law == Law::hooke) {
      const Lanes nu = parameter(0), young = parameter(1);
      lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
      mu = young / (2 * (1 + nu));
    }
    errors.set(~((lambda >= 0) & (mu > 0)), LACON_BAD_PARAMETER);
    const double* x = b.coordinates + block * dofs * LACON_LANES;
    const double* u = b.displacement + block * dofs * LACON_LANES;
    double* matrix = b.matrix ? b.matrix + block * entries * LACON_LANES : nullptr;
    double* force = b.force ? b.force + block * dofs * LACON_LANES : nullptr;
    if (matrix) lacon::clear_lanes(matrix, 0, entries);
    if (force) lacon::clear_lanes(force, 0, dofs);
    Lanes sum = {};
    for (int p = 0; p < b.n_points; ++p) {
      const std::int64_t point = block * b.n_points + p;
      const double* d = b.gradient + p * dofs;
      Lanes j[2][2] = {};
      for (int a = 1; a < nodes; ++a)
        for (int r = 0; r < 2; ++r)
          for (int s = 0; s < 2; ++s) j[r][s] += d[2 * a + s] * (lanes(x, 2 * a + r) - lanes(x, r));
      const Lanes determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0], dv = b.weight[p] * determinant;
      errors.set(~(determinant > 0), LACON_BAD_JACOBIAN);
      Lanes g[9][2], e[2][2] = {};
      for (int a = 0; a < nodes; ++a) {
        g[a][0] = (d[2 * a] * j[1][1] - d[2 * a + 1] * j[1][0]) / determinant;
        g[a][1] = (d[2 * a + 1] * j[0][0] - d[2 * a] * j[0][1]) / determinant;
        for (int r = 0; r < 2; ++r)
          for (int s = 0; s < 2; ++s) e[r][s] += lanes(u, 2 * a + r) * g[a][s];
      }
      const Lanes trace = e[0][0] + e[1][1], shear = mu * (e[0][1] + e[1][0]);
      Lanes full[2][2] = {{lambda * trace + 2 * mu * e[0][0], shear}, {shear, lambda * trace + 2 * mu * e[1][1]}};
      Lanes across = {};  // of the stress that it starts from
      if (law == Law::hooke && b.previous_stress) {
        const auto start = [&](int i) -> const Lanes& { return lanes(b.previous_stress, point * 4 + i); };
        full[0][0] += start(0), full[1][1] += start(1), across = start(2);
        full[0][1] += start(3), full[1][0] += start(3);
      }
      Lanes kept = Lanes{} + 1.0, slope = {};  // 1 - d, and minus its derivative by kappa where that grows
      if (weakens) {
        const Lanes yc = parameter(2);
        const Lanes energy = (full[0][0] * e[0][0] + full[1][1] * e[1][1] + shear * (e[0][1] + e[1][0])) / 2;
        const Lanes before = b.previous_variable ? lanes(b.previous_variable, point * n_variables + kappa) : Lanes{};
        const Lanes largest = energy > before ? energy : before;
        kept = yc / (yc + largest);
        slope = energy > before ? kept * kept / yc : Lanes{};
        if (b.variable) {
          lanes(b.variable, point * n_variables + kappa) = largest;
          lanes(b.variable, point * n_variables + damage_share) = 1 - kept;
        }
      }
      sum += full[0][0] + full[1][1] + shear + dv + kept;
      if (b.stress) {
        lanes(b.stress, point * 4) = kept * full[0][0];
        lanes(b.stress, point * 4 + 1) = kept * full[1][1];
        lanes(b.stress, point * 4 + 2) = kept * lambda * trace + across;
        lanes(b.stress, point * 4 + 3) = kept * full[0][1];
      }
      Lanes pull[9][2];  // C eps g
      for (int a = 0; a < nodes; ++a)
        for (int r = 0; r < 2; ++r) pull[a][r] = g[a][0] * full[r][0] + g[a][1] * full[r][1];
      for (int row = 0, entry = 0; row < dofs; ++row) {
        const int a = row / 2, r = row % 2;
        if (force) lanes(force, row) += dv * kept * pull[a][r];
        for (int column = 0; matrix && column <= row; ++column, ++entry) {
          const int c = column / 2, s = column % 2;
          Lanes stiff = lambda * g[a][r] * g[c][s] + mu * g[a][s] * g[c][r];
          if (r == s) stiff += mu * (g[a][0] * g[c][0] + g[a][1] * g[c][1]);
          lanes(matrix, entry) += dv * (kept * stiff - (b.elastic_matrix ? Lanes{} : slope * pull[a][r] * pull[c][s]));
        }
      }
    }
    errors.check_finite(sum);
    errors.store(b.error, block);
  }
}

LACON_KERNEL void lame(const lacon_solid_batch* batch) { evaluate<Law::lame>(*batch); }
LACON_KERNEL void damage(const lacon_solid_batch* batch) { evaluate<Law::damage>(*batch); }
LACON_KERNEL void hooke(const lacon_solid_batch* batch) { evaluate<Law::hooke>(*batch); }

const char* const constants[] = {"LAME/LAMBDA", "LAME/MU", nullptr};
const char* const constants_and_energy[] = {"LAME/LAMBDA", "LAME/MU", "DAMAGE/YC", nullptr};
const char* const moduli[] = {"ELAS/NU", "ELAS/E", nullptr};
const char* const variables[] = {"KAPPA", "ENDO", nullptr};

const lacon_kernel kernels[] = {
    {.name = "lame", .kind = LACON_SOLID, .solid = lame, .parameters = constants},
    {.name = "hooke", .kind = LACON_SOLID, .solid = hooke, .parameters = moduli},
    {.name = "damage",
     .kind = LACON_SOLID,
     .solid = damage,
     .parameters = constants_and_energy,
     .variables = variables,
     .nonlinear = 1,
     .has_memory = 1},
};
const lacon_plugin_table table = {
    LACON_ABI, sizeof(lacon_solid_batch), sizeof(lacon_load_batch), sizeof(lacon_contact_batch), "laws", 3, kernels};

}  // namespace

extern "C" const lacon_plugin_table* lacon_plugin(void) { return &table; }
