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

/// Rigid motions of all nodes, orthonormal; zero where a displacement is imposed. @param k of their displacements
std::vector<OwnedVec> rigid_motions(Mat k, int dimension, const OwnNodes& nodes);

void set_near_null_space(Mat matrix, std::span<const OwnedVec> motions);

}  // namespace lacon
