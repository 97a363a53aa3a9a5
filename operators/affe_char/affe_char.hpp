#pragma once
// AFFE_CHAR_CINE, AFFE_CHAR_MECA and their forms with functions (_F): what acts on a model, and what is imposed on it.
#include "lacon/elements/registry.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

/// The load without its kind and its model's id. Each component of a node or a cell is given once, in the order of the
/// occurrences; functions stay functions, and are evaluated when the load is applied.
/// Throws MESH_1, MESH_2, CHARGE_1 (no such node), CHARGE_2 (node without finite element), CHARGE_3 (no such degree of freedom
/// there), CHARGE_4 and CHARGE_5 (two values for one component), CHARGE_6 (cell that cannot carry the load), CHARGE_7 (skin
/// that looks into its body, VERI_NORM='OUI'), CHARGE_9 (component that the element does not know), CHARGE_10 (direction of
/// gravity), CHARGE_11 to CHARGE_15 (relations), FUNCTION_2 (function of another parameter than X, Y, Z, INST). CHARGE_8 alarms
/// for a skin under pressure without body, CHARGE_27 for one inside a body, CHARGE_26 for nodes that are not merged with the
/// body where they lie.
Load affe_char(const Mesh& mesh, const Model& model, Registry& registry, const Base& base, const Keywords& keywords);

}  // namespace lacon
