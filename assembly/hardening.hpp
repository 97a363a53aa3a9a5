#pragma once
// Isotropic hardening of plasticity: what a material says, as the curve that kernels take.
#include <string_view>
#include <vector>

#include "lacon/assembly/element_sets.hpp"

namespace lacon {

/// The hardening curve of a cell's material under RELATION, (points, 3): plastic strain from 0 on, yield stress, slope behind
/// it (lacon_solid_batch::curve). Throws ELEMENT_3 (a parameter is missing), BEHAVIOUR_2 (it makes no sense).
std::vector<double> hardening_curve(const MaterialTable& materials, std::int32_t cell, std::string_view relation,
                                    std::string_view element);

}  // namespace lacon
