#pragma once
// Finite elements: a modelisation on a cell. Rows of elements/*.toml, and those that plug-ins bring (elements/registry.hpp).
#include <span>
#include <string_view>

#include "lacon/catalog/cell_type.hpp"

namespace lacon::catalog {

enum class Role : std::int8_t { solid, skin };

struct KernelRow {
  std::string_view option;  ///< "ELAS/PETIT", "CHAR_MECA_PRES"
  std::string_view kernel;  ///< "plug-in/kernel"
};

struct ElementRow {
  std::string_view name;  ///< "D_PLAN/TRIA3"
  std::string_view modelisation;
  std::string_view phenomenon;
  CellType cell;
  Role role;
  int points;                                ///< integration points
  std::span<const std::string_view> dofs;    ///< of each node
  std::span<const std::string_view> stress;  ///< components at integration points
  std::span<const KernelRow> kernels;
};

/// The rows that were built in.
std::span<const ElementRow> elements();

}  // namespace lacon::catalog
