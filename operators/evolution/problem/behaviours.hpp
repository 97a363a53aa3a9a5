#pragma once
// COMPORTEMENT: which law and measure of strain cells have, and what the catalogue knows of them.
#include <optional>
#include <string_view>
#include <vector>

#include "lacon/assembly/element_sets.hpp"
#include "lacon/elements/registry.hpp"
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// A later occurrence wins over an earlier one; cells that none names are elastic with small strains.
Behaviours read_behaviours(const Mesh& mesh, const std::vector<Keywords>& occurrences);

/// The cells that an occurrence names, all where there is none: elasticity is then what was asked for.
std::vector<bool> named_cells(const Mesh& mesh, const std::vector<Keywords>& occurrences);

/// The rows behind "VMIS_ISOT_LINE/PETIT". Throws BEHAVIOUR_3 where neither the catalogue nor a plug-in has them.
struct BehaviourRows {
  const catalog::RelationRow& relation;
  const catalog::DeformationRow& deformation;
};
BehaviourRows behaviour_rows(const Registry& registry, std::string_view option);

/// Whether a law answers to a change of strain with isotropic elasticity, so that the stress that it starts from takes what the
/// change of a strain without stress does: what the rows of its relation and its deformation say. Throws BEHAVIOUR_9 where they
/// say so and the kernel does not take E and NU.
bool starts_elastically(const Registry& registry, const ElementSet& set);

}  // namespace lacon
