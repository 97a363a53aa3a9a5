#pragma once
// Rigid motions, which take the least forces: what a coarser level must be able to do.
#include <petscksp.h>

#include <cstdint>
#include <span>
#include <vector>

#include "lacon/assembly/petsc/owned.hpp"

namespace lacon {

/// Own nodes of a process, as multigrids see them.
struct OwnNodes {
  std::vector<double> coordinates;
  std::vector<std::uint8_t> is_free;  ///< of each displacement: 0 where one is imposed
  std::vector<std::uint8_t> is_link;  ///< of blocks between own nodes, as they are stored: whether it is a body's stiffness
  double middle[3] = {0, 0, 0};       ///< of the nodes of all processes
};

/// What a rigid motion moves a displacement by: translations, then turns about `middle`. @param x where the node is
inline double moved_by(int motion, int dimension, int axis, const double* x, const double* middle) {
  if (motion < dimension) return axis == motion ? 1 : 0;
  const int turn = motion - dimension, from = dimension == 3 ? (turn + 1) % 3 : 0, to = dimension == 3 ? (turn + 2) % 3 : 1;
  return axis == to ? x[from] - middle[from] : axis == from ? middle[to] - x[to] : 0;
}

/// Rigid motions of all nodes, orthonormal; zero where a displacement is imposed. @param k of their displacements
std::vector<OwnedVec> rigid_motions(Mat k, int dimension, const OwnNodes& nodes);

void set_near_null_space(Mat matrix, std::span<const OwnedVec> motions);

}  // namespace lacon
