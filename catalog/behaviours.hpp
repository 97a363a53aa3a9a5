#pragma once
// COMPORTEMENT: laws (RELATION) and measures of strain (DEFORMATION). Rows of behaviours.toml, and those that plug-ins bring
// (elements/registry.hpp).
#include <cstdint>
#include <span>
#include <string_view>

namespace lacon::catalog {

/// In plane stress, what the strain across the plate follows from.
enum class TransverseStrain : std::int8_t { unknown, elastic, isochoric };

struct RelationRow {
  std::string_view name;       ///< "VMIS_ISOT_LINE"
  std::string_view hardening;  ///< keyword of DEFI_MATERIAU whose tension curve kernels take, "ECRO_LINE"; empty: none
  TransverseStrain transverse_strain;
};

enum class StressGeometry : std::int8_t { initial, displaced };
enum class StrainMeasure : std::int8_t { small, green_lagrange };

struct DeformationRow {
  std::string_view name;  ///< "PETIT"
  StressGeometry stress_geometry;
  StrainMeasure strain;
};

/// The rows that were built in.
std::span<const RelationRow> relations();
std::span<const DeformationRow> deformations();

}  // namespace lacon::catalog
