#pragma once
// The fields of contact at an instant: CONT_ELEM (METHOD.md 4), written from the state of contact and read again, and what
// nodes of the slave skins have of it.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/structures/field.hpp"

namespace lacon {

/// CONT, PRES, JEU, COEFSURF, PRESCOOR on every slave cell, equal in the cells of one patch.
Field contact_field(const Contact& contact, const ContactGeometry& geometry, const Patchwise& patches);

/// The pressure at each node of the slave skins, by number: the mean of PRESCOOR over the patches around it, weighted with
/// their measures, so that what a patch carries counts and not how little of it carries that.
std::vector<std::pair<std::int32_t, double>> nodal_pressures(const Mesh& mesh, const Contact& contact,
                                                             const ContactGeometry& geometry, const Patchwise& patches);

/// CONT_NOEU on the nodes of the slave skins. Means over the patches around a node, as nodal_pressures() takes them: PRES, and
/// JEU over those that have a master (stand-in -1 without any). CONT: 2 where one of them is active (contact slides), 0 where
/// none is, -1 where none has a master. RNX to RNZ are the nodal contact forces on the slave, RN their norm; R, RX to RZ,
/// forces with friction, are equal to them. VX to VZ: outward normal. Z in space alone. @param state linearised at `patches`
Field nodal_contact_field(const Mesh& mesh, const Contact& contact, const ContactState& state, const Patchwise& patches);

/// With which master cells pairing has paired each slave cell, in the order of the rows of CONT_ELEM.
struct PairedMasters {
  std::vector<std::int64_t> offset{0};  ///< (slave cells + 1)
  std::vector<std::int32_t> cell;       ///< of a slave cell ascending
  std::vector<double> share;  ///< part of the slave cell's patch that the couple covers: of the patch's together its coverage
};
PairedMasters paired_masters(const Mesh& mesh, const Contact& contact, const ContactGeometry& geometry);

/// What the patches carry in such a field of cells. @param label of the result that it is from
/// Throws EVOLUTION_11 where a slave cell is not in the field or lacks a component.
Patchwise patches_of(const Field& field, const Mesh& mesh, const Contact& contact, const std::string& label);

}  // namespace lacon
