#pragma once
// Rigid motions of bodies that nothing resists: iterations would stall at them, or leave any multiple of one in a solution.
#include <cstdint>
#include <span>

#include "lacon/assembly/petsc/exchange.hpp"

namespace lacon {

/// Whether some rigid motion of bodies, on the geometry of the coordinates, meets no resistance of the matrix.
/// @param body of each block, from 0 on
bool has_free_motion(const BlockSystem& system, std::span<const std::int32_t> body);

}  // namespace lacon
