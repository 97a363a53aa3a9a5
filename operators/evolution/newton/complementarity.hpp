#pragma once
// Small linear complementarity problems.
#include <Eigen/Core>
#include <optional>

namespace lacon {

/// z >= 0 with w = q + H z >= 0 and z w = 0. Block principal pivoting: all pairs that are wrong change while they become fewer;
/// when they do not, the last of them alone does, until they are fewer than ever before. For a P-matrix, which that of a stable
/// equilibrium is, this ends (Murty, Linear Algebra and its Applications 1974; Judice and Pires, Computers and Operations
/// Research 1994).
/// @param matrix H, in units that make its diagonal about 1  @param digits relative error of H and q: by so much z and w may
/// miss zero
/// @return nothing where H is no P-matrix, or has a motion that nothing resists
std::optional<Eigen::VectorXd> solve_complementarity(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& q, double digits);

}  // namespace lacon
