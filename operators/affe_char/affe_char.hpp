#pragma once
// AFFE_CHAR_CINE and AFFE_CHAR_MECA: imposed displacements and pressures.
#include "lacon/elements/registry.hpp"
#include "lacon/structures/concepts.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The load without its kind and its model's id. Imposed degrees of freedom come in the order of the occurrences, each once; a
/// pressure is given for each skin cell once. Throws MESH_1, MESH_2, CHARGE_1 (no such node), CHARGE_2 (node without finite
/// element), CHARGE_3 (no such degree of freedom there), CHARGE_4 and CHARGE_5 (two values for one degree of freedom, one
/// cell), CHARGE_6 (cell that cannot carry a pressure), CHARGE_7 (skin that looks into its body, VERI_NORM='OUI'). CHARGE_8
/// alarms for a loaded skin without body.
Load affe_char(const Mesh& mesh, const Model& model, const Registry& registry, const Keywords& keywords);

}  // namespace lacon
