#pragma once
// DEFI_CONTACT: zones of slave and master skins, and the slave elements that carry LAGS_C (METHOD.md 2).
#include <string_view>

#include "lacon/elements/registry.hpp"
#include "lacon/structures/concepts.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The contact without its model's id. Zones come in the order of the command; each takes the patches that DECOUPE_LAC made of
/// its slave group, and one slave element for each of their sub-cells, by patch kind and rank (catalog/contact.toml).
/// @param mesh_label the mesh's name in messages
/// Throws what METHOD.md 2.2 lists (CONTACT4_1, 4_2, 4_4, 4_5, CONTACT2_16, 2_17, 2_18, CONTACT_94, 95, 96, CONTACT3_4,
/// MODELISA4_24), LAC_1 (FORMULATION), LAC_2 (ALGO_CONT), LAC_3 (slave and master share a cell), LAC_4 (a skin cell without
/// finite element), LAC_5 (patch of a kind without elements), MESH_1, MESH_2. CONTACT2_20 informs of skin cells without body.
Contact defi_contact(const Mesh& mesh, std::string_view mesh_label, const Model& model, const Registry& registry,
                     const Keywords& keywords);

}  // namespace lacon
