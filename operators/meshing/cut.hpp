#pragma once
// DECOUPE_LAC: the slave skins and the body cells under them are cut into macro-elements (METHOD.md 1.2 to 1.8).
#include <string>
#include <vector>

#include "lacon/operators/meshing/quality.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

struct CutZone {
  std::string group;
  std::int64_t patches = 0;
  std::int64_t turned = 0;                           ///< slave cells that looked into the body
  std::vector<std::int32_t> skin_nodes, body_nodes;  ///< the new ones, of the cut mesh
  std::vector<std::int32_t> bodies;                  ///< body cells under the skin, of the mesh before the cut; sorted
  std::vector<std::int32_t> old_skin_nodes,
      old_body_nodes;  ///< of the slave cells and of `bodies`, where there are node groups
};

struct CutReport {
  std::vector<CutZone> zones;
  std::int64_t new_nodes = 0;
  std::int64_t new_cells = 0;
  Quality before;  ///< of the body cells of all zones, by their numbers in the mesh before the cut
  Quality after;   ///< of what they have become, by their numbers in the cut mesh
};

/// Cut the skins `groups`, one contact zone each, in this order. Sub-cells take the place of the cell they come from, in the
/// list of cells and in every group; new nodes are appended and belong to no group; inward slave cells are turned first.
/// @param mesh is changed in place: moved into the call, no array of a cut that stays is copied
/// @param option DECOUPE_HEXA: "PYRA" or "HEXA" @param keyword path of the keyword that names the groups
/// @return the cut mesh, with its patches
/// Throws MESH1_2 (skin cell without body cell), CREALAC_1 (unsupported pair), MESH1_12 (mesh already cut), MESH_1, MESH_2
/// (unknown, empty group), DECOUPE_1 (repeated group), DECOUPE_2 (cell in two places), DECOUPE_3 (two body cells), DECOUPE_4
/// (not a skin cell), DECOUPE_5 (two slave cells on one facet), DECOUPE_6 (body cell or sub-cell of negative or mixed
/// Jacobian).
Mesh cut_lac(Mesh mesh, std::span<const std::string> groups, std::string_view option, std::string_view keyword,
             CutReport& report);

/// The new nodes enter the groups of nodes that they belong to: a group that holds every node of a slave skin gets the skin's
/// new nodes, and where it also holds every node of the body cells under the skin, those inside too. Informs DECOUPE_8 of each.
/// @param cut the mesh that cut_lac() made, with its report
void complete_node_groups(const CutReport& report, Mesh& cut);

/// Informs DECOUPE_11 of the groups that would get new nodes, where there are any: what is summed over such a group misses
/// them.
void tell_node_groups(const CutReport& report, const Mesh& cut);

}  // namespace lacon
