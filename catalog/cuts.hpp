#pragma once
// The cuts of DECOUPE_LAC: rows of cuts.toml (METHOD.md 1.4, 1.5), completed by the generator. Local numbers are 0-based.
//
// A row is written for one facet of the body cell, its canonical one; a Placement turns the body cell so that any other facet
// of the same type gets there. Sub-cells refer to nodes by number:
//   of the skin:  the skin cell's own nodes, then the new skin nodes;
//   of the body:  the nodes of the turned body cell, then the new skin nodes as seen from the turned facet, then the new body
//   nodes.
#include <span>
#include <string_view>

#include "lacon/catalog/cell_type.hpp"

namespace lacon::catalog {

struct SubCell {
  CellType type;
  std::span<const std::int8_t> nodes;
};

/// How a body cell is turned so that its facet `facet` lies where the row expects it.
struct Placement {
  int facet;                           ///< index into CellRow::facets
  std::span<const std::int8_t> nodes;  ///< node j of the turned cell is node nodes[j] of the body cell
};

struct CutRow {
  CellType skin;
  CellType body;
  std::string_view option;             ///< the DECOUPE_HEXA that asks for it; empty: any
  int kind;                            ///< of patch, row of contact.toml
  std::span<const std::int8_t> facet;  ///< vertices of the turned body cell under the skin's vertices
  std::span<const double> skin_nodes;  ///< new nodes: reference coordinates in the skin cell, (n, dimension of the skin)
  std::span<const double> body_nodes;  ///< new nodes: reference coordinates in the turned body cell, (n, dimension of the body)
  std::span<const SubCell> skin_cells;    ///< by rank; never empty
  std::span<const SubCell> body_cells;    ///< empty: the body cell stays as it is
  std::span<const std::int8_t> carriers;  ///< skin nodes (numbered as in skin_cells) that carry LAGS_C
  std::span<const Placement> placements;
  /// (skin vertices, new skin nodes): where the facet's first vertex is vertex s of the skin cell, new skin node j as seen from
  /// the facet is new skin node turned[s * n + j].
  std::span<const std::int8_t> turned;
};

std::span<const CutRow> cuts();

/// The cut of this pair under this DECOUPE_HEXA, or nullptr.
const CutRow* find_cut(CellType skin, CellType body, std::string_view option);

}  // namespace lacon::catalog
