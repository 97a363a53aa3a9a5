#pragma once
// A mesh: nodes, cells of mixed types, groups, and the macro-elements (patches) of its slave skins.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/catalog/cells.hpp"

namespace lacon {

/// Rows of different lengths, one behind the other: row i is values[offset[i]] to values[offset[i + 1]].
template <class T>
struct Ragged {
  std::vector<std::int64_t> offset{0};
  std::vector<T> values;

  std::size_t size() const { return offset.size() - 1; }
  std::span<const T> operator[](std::size_t i) const { return {values.data() + offset[i], values.data() + offset[i + 1]}; }
  std::span<T> operator[](std::size_t i) { return {values.data() + offset[i], values.data() + offset[i + 1]}; }
  template <class Row>
  void push_back(const Row& row) {
    values.insert(values.end(), std::begin(row), std::end(row));
    offset.push_back(static_cast<std::int64_t>(values.size()));
  }
};

/// Capacity of the arrays of a mesh that is read: what a cut adds goes there in place, and memory that nothing touches costs
/// nothing.
constexpr std::size_t with_room(std::size_t size) { return size + size / 4; }

/// A named set of nodes or cells, in the order of the file it came from. A node group and a cell group may share a name.
struct Group {
  std::string name;
  std::vector<std::int32_t> members;
};

/// The macro-elements of the slave skins (METHOD.md 1.8), made by CREA_MAILLAGE(DECOUPE_LAC).
struct Patches {
  std::vector<std::string> zone_group;       ///< GROUP_MA_ESCL of each zone, in the order given
  std::vector<std::int64_t> zone_offset{0};  ///< patches of zone k: zone_offset[k] to zone_offset[k + 1]
  std::vector<std::int32_t> kind;            ///< row of catalog/contact.toml
  std::vector<std::int32_t> parent;          ///< skin cell it came from, in the mesh before the cut
  Ragged<std::int32_t> cells;                ///< sub-cells by rank
  Ragged<std::int32_t> carriers;             ///< nodes that carry LAGS_C, the one that is read first

  std::size_t size() const { return kind.size(); }
};

/// Numbers are 0-based; what a user sees is node_name() and cell_name().
struct Mesh {
  std::string name;                 ///< in the file it was read from
  int dimension = 3;                ///< of the space: 2 or 3
  std::vector<double> coordinates;  ///< (n_nodes, 3); z = 0 in 2D
  std::vector<CellType> types;      ///< of each cell
  Ragged<std::int32_t> cells;       ///< nodes of each cell, in the order of catalog/cells.toml
  std::vector<Group> cell_groups;
  std::vector<Group> node_groups;
  std::optional<Patches> patches;
  std::vector<double> first_place;  ///< sums of coordinates before a field moved the nodes (DEFORME); empty: they are there

  std::size_t n_nodes() const { return coordinates.size() / 3; }
  std::size_t n_cells() const { return types.size(); }
  std::span<const double, 3> point(std::size_t node) const {
    return std::span<const double, 3>(coordinates.data() + 3 * node, 3);
  }
  const catalog::CellRow& row(std::size_t cell) const { return catalog::cell(types[cell]); }

  void add_cell(CellType type, std::span<const std::int32_t> nodes);

  /// The group of this name, or nullptr.
  const Group* find_cell_group(std::string_view group_name) const;
  const Group* find_node_group(std::string_view group_name) const;
};

/// Cells of consecutive numbers and one type are a run. @param visit(row of the type, first cell, how many)
template <class Visit>
void for_each_run(const Mesh& mesh, const Visit& visit) {
  for (std::size_t first = 0, end = 0; first < mesh.n_cells(); first = end) {
    while (end < mesh.n_cells() && mesh.types[end] == mesh.types[first]) ++end;
    visit(mesh.row(first), first, end - first);
  }
}

/// 2 for a mesh without 3D cells that lies in the plane z = 0, otherwise 3.
int least_dimension(const Mesh& mesh);

std::string node_name(std::int64_t node);  ///< "N1" for node 0
std::string cell_name(std::int64_t cell);  ///< "M1" for cell 0
/// The number behind the name of one of `count` nodes (letter N) or cells (M), 0-based; nothing for any other text.
std::optional<std::int32_t> number_of_name(std::string_view name, char letter, std::size_t count);

/// The members of a group; throws MESH_1 (unknown group, with the nearest known one) or MESH_2 (empty group).
/// `keyword` is the path of the keyword that names the group.
std::span<const std::int32_t> cells_of_group(const Mesh& mesh, std::string_view group, std::string_view keyword);
std::span<const std::int32_t> nodes_of_group(const Mesh& mesh, std::string_view group, std::string_view keyword);

/// The nodes of these cells, sorted, each once.
std::vector<std::int32_t> nodes_of_cells(const Mesh& mesh, std::span<const std::int32_t> cells);

/// The one of `names` that is nearest to `name`, for "did you mean"; empty where none is near.
std::string nearest_name(std::string_view name, std::span<const std::string> names);

}  // namespace lacon
