#pragma once
// CREA_MAILLAGE: a mesh from another.
#include <string>
#include <vector>

#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// What becomes of groups of nodes that hold a whole slave skin: its new nodes are told of, enter them, or stay out.
enum class SkinGroups { tell, complete, keep };

/// What DECOUPE_LAC, or the command line of the tool, asks for.
struct LacCut {
  std::vector<std::string> groups;  ///< slave skins, one contact zone each
  std::string option = "PYRA";      ///< how hexahedra are cut: PYRA or HEXA
  SkinGroups node_groups = SkinGroups::tell;
  bool details = false;  ///< more about the cells' quality
  std::string keyword;   ///< that names the groups, for messages
};

/// The cut mesh; prints counts and the quality of the cells on stdout. Errors: operators/meshing/cut.hpp.
Mesh cut_and_tell(Mesh mesh, const LacCut& cut);

/// The mesh that the keywords DECOUPE_LAC, LINE_QUAD, QUAD_LINE, HEXA20_27 or RESTREINT ask for; prints a summary on stdout.
/// Errors: see operators/meshing/cut.hpp, order_change.hpp and restriction.hpp, and ORDER_2 where none of them is given.
/// @param label the variable that holds the mesh, for messages
Mesh crea_maillage(Mesh mesh, const Keywords& keywords, std::string_view label = {});

}  // namespace lacon
