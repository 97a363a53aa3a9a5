#pragma once
// MASS_INER: mass, centre of gravity and moments of inertia of bodies, as rows of a table.
#include "lacon/structures/base.hpp"

namespace lacon {

/// A row for each occurrence and group: of plane bodies for each unit of thickness, of axisymmetric ones the whole of the body.
/// Throws FIELDS_8 (no model or no materials), MESH_1, POSTELEM_5 (a place without body cells or mass), ELEMENT_3 (a material
/// without RHO).
Table inertia(const Order& order, const Base& base);

}  // namespace lacon
