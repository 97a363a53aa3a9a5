#pragma once
// Skin cells whose normals leave the body.
#include <string>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

struct OrientationReport {
  std::int64_t turned = 0;                 ///< skin cells that were turned
  std::vector<std::int32_t> without_body;  ///< left as they are
};

/// Turn the cells of a group so that their normals leave the body cell that has them as a facet (of a body cell of negative
/// volume the facets are seen from the other side). A skin cell without body cell stays as it is.
/// On a mesh that is cut for LAC a patch turns as a whole.
/// @param inside the cells that may be the body; empty: all
/// @param keyword path of the keyword that names the group
/// Throws ORIE_1 (a cell is no skin cell), ORIE_2 (two body cells: an internal facet), ORIE_3 (body cell without volume),
/// ORIE_5 (a part of a patch).
OrientationReport orient_skin(Mesh& mesh, const std::string& group, std::span<const std::int32_t> inside,
                              const std::string& keyword);

}  // namespace lacon
