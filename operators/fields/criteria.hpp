#pragma once
// Invariants of stresses and strains: the fields SIEQ_* and EPEQ_* of CALC_CHAMP.
#include <string>

#include "lacon/structures/field.hpp"

namespace lacon {

/// SIEQ of a field of stresses (components SIXX ...), where that field lives: VMIS (von Mises), TRESCA (largest difference of
/// principal stresses), PRIN_1 <= PRIN_2 <= PRIN_3, VMIS_SG (VMIS with the sign of the trace), VECT_n_X, Y, Z (unit vector of
/// PRIN_n, its component of largest magnitude positive), TRSIG (trace), TRIAX (TRSIG / 3 / VMIS, 0 without deviator).
/// A row without stresses has none of these.
Field equivalent_stress(const Field& stress, std::string name);

/// EPEQ of a field of strains (components EPXX ...): INVA_2 = sqrt(2/3 e : e) of the deviator e, PRIN_n, INVA_2SG, VECT_n_*.
Field equivalent_strain(const Field& strain, std::string name);

}  // namespace lacon
