#pragma once
// Kinds of macro-elements and the contact elements on their sub-cells: rows of contact.toml (METHOD.md 2.3).
#include <span>
#include <string_view>

#include "lacon/catalog/cell_type.hpp"

namespace lacon::catalog {

/// A kind of macro-element (patch): what its sub-cells are, by rank.
struct PatchRow {
  int kind;
  std::span<const CellType> cells;
};

/// The element on the sub-cell of rank `rank` (0-based) of a patch of this kind.
struct SlaveRow {
  int kind;
  int rank;
  std::string_view element;  ///< "LACS22D"
  CellType cell;
  std::span<const std::int8_t> carriers;  ///< local nodes that carry LAGS_C, 0-based
};

std::span<const PatchRow> patches();
std::span<const SlaveRow> slaves();

/// The row of a kind, or nullptr.
const PatchRow* find_patch(int kind);
/// The row of a sub-cell, or nullptr.
const SlaveRow* find_slave(int kind, int rank);

}  // namespace lacon::catalog
