#include "lacon/elements/contact_system.hpp"

#include <algorithm>
#include <cassert>

namespace lacon {

int ContactCellDofs::displacement(int node, int component) const {
  const auto before = std::count_if(carriers.begin(), carriers.end(), [&](std::int8_t carrier) { return carrier < node; });
  return node * dimension + static_cast<int>(before) + component;
}

void contact_system(const ContactCellDofs& dofs, std::span<const double> coupling, std::span<const double> curvature,
                    double gap, bool active, double lambda, std::span<double> matrix, std::span<double> residual) {
  [[maybe_unused]] const int size = dofs.size();
  const int nodes = dofs.n_slave_nodes + dofs.n_master_nodes, carriers = static_cast<int>(dofs.carriers.size());
  assert(static_cast<int>(coupling.size()) >= nodes * dofs.dimension);
  assert(static_cast<int>(matrix.size()) >= size * (size + 1) / 2 && static_cast<int>(residual.size()) >= size);
  std::fill(matrix.begin(), matrix.end(), 0.0);
  std::fill(residual.begin(), residual.end(), 0.0);
  const auto entry = [&](int i, int j) -> double& {
    const auto [low, high] = std::minmax(i, j);
    return matrix[static_cast<std::size_t>(high * (high + 1) / 2 + low)];
  };
  const double share = 1.0 / carriers;
  for (int l = 0; l < carriers; ++l) {
    const int row = dofs.multiplier(l);
    residual[static_cast<std::size_t>(row)] = share * (active ? gap : lambda);
    if (!active) entry(row, row) = share;
  }
  if (!active) return;
  for (int node = 0; node < nodes; ++node)
    for (int i = 0; i < dofs.dimension; ++i) {
      const double c = coupling[static_cast<std::size_t>(node * dofs.dimension + i)];
      const int at = dofs.displacement(node, i);
      residual[static_cast<std::size_t>(at)] = lambda * c;
      for (int l = 0; l < carriers; ++l) entry(dofs.multiplier(l), at) = share * c;
    }
  if (curvature.empty()) return;
  const int n = nodes * dofs.dimension;
  assert(static_cast<int>(curvature.size()) >= n * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j)
      entry(dofs.displacement(i / dofs.dimension, i % dofs.dimension),
            dofs.displacement(j / dofs.dimension, j % dofs.dimension)) =
          lambda * curvature[static_cast<std::size_t>(i * n + j)];
}

}  // namespace lacon
