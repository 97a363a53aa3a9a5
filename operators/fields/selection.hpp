#pragma once
// Which part of a result a command means: TOUT_ORDRE, NUME_ORDRE, INST, LIST_INST; GROUP_MA.
#include <cstdint>
#include <vector>

#include "lacon/structures/base.hpp"

namespace lacon {

/// True where the keywords name instants; otherwise all are meant.
bool names_instants(const Keywords& keywords);

/// The orders of the result that NUME_ORDRE, INST or LIST_INST (with PRECISION and CRITERE) name; all of them without these.
/// Instants of LIST_INST that the result does not have are told (FIELDS_5), unless it has none of them. Throws FIELDS_1 for an
/// order, FIELDS_2 for an instant that the result does not have, FIELDS_3 for an instant that is several.
std::vector<std::int64_t> selected_orders(const Base& base, const Result& result, const Keywords& keywords);

/// The index of a new result: the same calculation, only these of its orders, no fields yet.
Result part_of(const Result& result, const std::vector<std::int64_t>& orders);

/// One entry a cell of the mesh: not 0 where GROUP_MA means it, or everywhere without GROUP_MA. Throws MESH_1, MESH_2.
std::vector<char> selected_cells(const Mesh& mesh, const Keywords& keywords);

/// The cells of GROUP_MA, by number; throws CALCPRES_1 for one that is no skin cell.
std::vector<std::int32_t> selected_skin(const Mesh& mesh, const Keywords& keywords);

/// One entry a node of the mesh: 1 where a cell that `cells` marks has it.
std::vector<char> nodes_of_marked_cells(const Mesh& mesh, const std::vector<char>& cells);

/// One entry a node (of a field of nodes) or cell of the mesh: not 0 where TOUT, GROUP_MA (with its nodes) or GROUP_NO means
/// it; everywhere without these. Throws MESH_1, MESH_2, CREACHAMP_7 for nodes of a field of cells. @param name of the field or
/// its type
std::vector<char> selected_places(const Mesh& mesh, const Keywords& keywords, Location location, const std::string& name);

}  // namespace lacon
