#pragma once
// The element matrix and vector of one contact cell (METHOD.md 3.5, 3.6, 5.6).
#include <cstdint>
#include <span>

namespace lacon {

/// The degrees of freedom of a contact cell: slave nodes one by one, each with its displacements and then its LAGS_C if it is a
/// carrier; then all other nodes with their displacements.
struct ContactCellDofs {
  int n_slave_nodes = 0, n_master_nodes = 0, dimension = 2;
  std::span<const std::int8_t>
      carriers;  ///< local slave nodes that carry LAGS_C, 0-based, no node twice (catalog/contact.toml)

  int size() const { return (n_slave_nodes + n_master_nodes) * dimension + static_cast<int>(carriers.size()); }
  /// The place of a displacement; nodes are counted from the slave's to the master's.
  int displacement(int node, int component) const;
  /// The place of the LAGS_C of carriers[carrier].
  int multiplier(int carrier) const { return displacement(carriers[static_cast<std::size_t>(carrier)], 0) + dimension; }
};

/// A contact cell's share of the tangent and of the residual F_int - F_ext + sum lambda C.
///
/// With n carriers, an active cell has n equal rows and columns `coupling` / n and residuals `gap` / n, and loads its
/// displacement rows with lambda times the whole coupling; an inactive one has 1 / n on the diagonal and lambda / n in the
/// residual of each carrier. Once the carriers share one equation, sums over the cells of a patch give the rows C_T du = -G_T
/// of METHOD.md (D).
/// @param coupling (nodes, dimension) C of the cell, slave nodes first  @param curvature (nodes dimension, the same): the
/// second derivative of G, which an active cell adds with the factor lambda; or empty  @param gap G of the cell
/// @param[out] matrix (size (size + 1) / 2): lower triangle, row by row  @param[out] residual (size)
void contact_system(const ContactCellDofs& dofs, std::span<const double> coupling, std::span<const double> curvature,
                    double gap, bool active, double lambda, std::span<double> matrix, std::span<double> residual);

}  // namespace lacon
