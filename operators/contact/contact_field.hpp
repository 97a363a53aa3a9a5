#pragma once
// The field CONT_ELEM of an instant (METHOD.md 4): written from the state of contact, and read again.
#include <string>

#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/structures/field.hpp"

namespace lacon {

/// CONT, PRES, JEU, COEFSURF, PRESCOOR on every slave cell, equal in the cells of one patch.
Field contact_field(const Contact& contact, const ContactGeometry& geometry, const Patchwise& patches);

/// What the patches carry in such a field. @param label of the result that it is from
/// Throws EVOLUTION_11 where a slave cell is not in the field or lacks a component.
Patchwise patches_of(const Field& field, const Mesh& mesh, const Contact& contact, const std::string& label);

}  // namespace lacon
