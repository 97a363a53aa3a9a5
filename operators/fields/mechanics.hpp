#pragma once
// Strains at integration points from displacements, and nodal forces from stresses.
#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "lacon/operators/fields/cell_points.hpp"
#include "lacon/structures/field.hpp"

namespace lacon {

enum class Strain {
  small,           ///< EPSI: (H + H^T) / 2 of the displacement gradient H
  green_lagrange,  ///< EPSG: (H + H^T + H^T H) / 2
  logarithmic      ///< EPSL: ln(F^T F) / 2, F = 1 + H
};

/// Strains at the integration points of the body cells that `wanted` marks, components EPXX EPYY EPZZ EPXY (EPXZ EPYZ). EPZZ is
/// 0 in plane strain, the hoop strain u_r / r in axisymmetry (Green-Lagrange: e + e^2 / 2), and 0 in plane stress, where the
/// material says it (ResultMaterials::set_strain_across). @param displacement nodal, DX DY (DZ)
Field strains(const Mesh& mesh, ModelPoints& points, const Field& displacement, const std::vector<char>& wanted, Strain measure,
              std::string name);

/// Gradient of the displacement at a point of a cell; in axisymmetry with u_r / r round the axis. @param u (n_nodes of the
/// mesh, dimension)
Eigen::Matrix3d displacement_gradient(const CellPoints& at, int point, std::span<const std::int32_t> nodes,
                                      std::span<const double> u, int dimension, bool axisymmetric);

/// Forces at nodes that the stresses do work with, the sum over cells of the integral of B^T sigma; components DX DY (DZ) on
/// the nodes of these cells. @param stress at integration points, Cauchy @param moved one entry a cell of the mesh, not 0 where
/// the stresses live on the current geometry (large strains) and not on the initial one @param current (n_nodes, 3) @param
/// thickness of each row of `stress`, by which its integral is multiplied
Field nodal_forces(const Mesh& mesh, ModelPoints& points, const Field& stress, const std::vector<char>& moved,
                   std::span<const double> current, std::span<const double> thickness, std::string name);

}  // namespace lacon
