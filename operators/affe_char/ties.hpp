#pragma once
// Relations in axes of their own and from mesh to mesh: LIAISON_OBLIQUE, LIAISON_MAIL and LIAISON_RBE3.
#include "lacon/operators/affe_char/places.hpp"

namespace lacon {

/// LIAISON_OBLIQUE: displacements along the axes of ANGL_NAUT. Throws MODIREPERE_5, and what names of places throw.
void hold_oblique(Load& load, const LoadScene& scene, const Keywords& factor);

/// LIAISON_MAIL: nodes move as the points of body cells at their places do. Throws CHARGE_21 (a node that no cell is near to),
/// CHARGE_22 (no body cell among the masters), and what names of places throw; CHARGE_23 alarms for nodes outside.
void tie_to_cells(Load& load, const LoadScene& scene, const Keywords& factor);

/// LIAISON_RBE3: a node moves as the rigid body does that follows others best, by weighted least squares. Throws CHARGE_11
/// (counts), CHARGE_24 (what the others do not say), and what names of places throw.
void follow_on_average(Load& load, const LoadScene& scene, const Keywords& factor);

}  // namespace lacon
