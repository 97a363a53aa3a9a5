#pragma once
// DEFI_CONTACT: zones of slave and master skins, and the slave elements that carry LAGS_C (METHOD.md 2).
#include "lacon/elements/registry.hpp"
#include "lacon/structures/base.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The contact without its model's id. Zones come in the order of the command; each takes the patches that DECOUPE_LAC made of
/// its slave group, and one slave element for each of their sub-cells, by patch kind and rank (catalog/contact.toml).
/// Skins of bodies that the model left without element get one (Contact::skins).
/// Throws what METHOD.md 2.2 lists (CONTACT4_1, 4_2, 4_4, 4_5, CONTACT2_16, 2_17, 2_18, CONTACT_94, 95, 96, CONTACT3_4,
/// MODELISA4_24), LAC_1 (FORMULATION), LAC_2 (ALGO_CONT), LAC_3 (slave and master share a cell), LAC_4 (a skin cell of no body
/// with a finite element), LAC_5 (patch of a kind without elements), MESH_1, MESH_2, FUNCTION_2. CONTACT2_20 informs of skin
/// cells without body, LAC_7 and LAC_8 of zones of which SANS_GROUP_NO leaves out nothing or all.
Contact defi_contact(const Mesh& mesh, const Model& of_bodies, const Registry& registry, const Base& base,
                     const Keywords& keywords);

}  // namespace lacon
