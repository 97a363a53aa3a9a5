#pragma once
// Cell types and their topology: rows of cells.toml. Local node numbers are 0-based.
#include <optional>
#include <span>
#include <string_view>

#include "lacon/catalog/cell_type.hpp"

namespace lacon::catalog {

/// The two vertices of an edge. In a quadratic cell the node in its middle is `n_vertices` + the edge's index.
struct EdgeRow {
  std::int8_t first;
  std::int8_t second;
};

/// A facet (cell of one dimension less) seen from outside: its normal leaves the cell.
struct FacetRow {
  CellType type;
  std::span<const std::int8_t> nodes;
};

struct CellRow {
  CellType type;
  std::string_view name;  ///< "HEXA8"
  Family family;
  int dimension;
  int n_nodes;
  int n_vertices;
  int order;                      ///< 1 linear, 2 quadratic
  std::span<const double> nodes;  ///< reference coordinates, (n_nodes, dimension)
  std::span<const EdgeRow> edges;
  std::span<const FacetRow> facets;               ///< with all nodes of the facet
  std::span<const std::int8_t> mirror;            ///< node order of the same cell turned inside out
  std::string_view med_name;                      ///< "HE8"
  std::span<const std::int8_t> med_permutation;   ///< node j here is node med_permutation[j] in MED
  int vtk_type;                                   ///< number in VTK files
  std::span<const std::int8_t> vtk_permutation;   ///< node j here is node vtk_permutation[j] in VTK
  int gmsh_type;                                  ///< number in gmsh's .msh files
  std::span<const std::int8_t> gmsh_permutation;  ///< node j here is node gmsh_permutation[j] in gmsh
  CellType linear;
  CellType quadratic;  ///< the first quadratic cell of the family (QUAD8, HEXA20); itself where there is none
};

/// All rows, in the order in which code_aster numbers cells; indexed by CellType.
std::span<const CellRow> cells();

inline const CellRow& cell(CellType type) { return cells()[static_cast<std::size_t>(type)]; }

/// The cell of this name ("TRIA6"), or nothing.
std::optional<CellType> find_cell(std::string_view name);

}  // namespace lacon::catalog
