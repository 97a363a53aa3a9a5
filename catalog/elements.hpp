#pragma once
// Finite elements: a modelisation on a cell. Rows of elements/*.toml, and those that plug-ins bring (elements/registry.hpp).
#include <span>
#include <string_view>

#include "lacon/catalog/cell_type.hpp"

namespace lacon::catalog {

enum class Role : std::int8_t { solid, skin, discrete };

/// What the coordinates mean: a plane x y; half a plane through the axis of revolution y, x being the radius; space.
enum class Geometry : std::int8_t { plane, axis, space };
constexpr int dimension_of(Geometry geometry) { return geometry == Geometry::space ? 3 : 2; }

/// Of a solid in the plane: no strain across it, or no stress. `full` elsewhere.
enum class StressState : std::int8_t { full, plane_strain, plane_stress };

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
  Geometry geometry;
  StressState stress_state;
  int points;                                ///< integration points
  std::span<const std::string_view> dofs;    ///< of each node: the displacements of its geometry, then others
  std::span<const std::string_view> stress;  ///< components at integration points
  std::span<const KernelRow> kernels;
};

/// The rows that were built in.
std::span<const ElementRow> elements();

}  // namespace lacon::catalog
