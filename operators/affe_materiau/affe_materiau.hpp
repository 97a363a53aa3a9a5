#pragma once
// AFFE_MATERIAU: a material for each cell, and where its temperature comes from.
#include "lacon/structures/base.hpp"

namespace lacon {

/// A later occurrence of AFFE wins over an earlier one. Throws MATERIAU_1 (mesh and model do not belong together), MATERIAU_2,
/// MESH_1, MESH_2, and BASE_4 where MATER is no material.
MaterialField affe_materiau(const Base& base, const Keywords& keywords);

}  // namespace lacon
