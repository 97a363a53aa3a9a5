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
  bool starts_elastically;  ///< a change of strain changes the stress by Hooke's law first, whatever follows
};

enum class StressGeometry : std::int8_t { initial, displaced };
enum class StrainMeasure : std::int8_t { small, green_lagrange };

/// How what has flowed (EPSP) follows from a state, on the initial axes.
enum class PlasticStrain : std::int8_t {
  unknown,
  none,            ///< nothing flows
  small,           ///< e - C^-1 : sigma
  green_lagrange,  ///< the same of Green and Lagrange's strain and the second Piola-Kirchhoff stress
  logarithmic,     ///< the same of ln(F^T F) / 2 and the stress that works on it
  stretches        ///< ln(F^T b^-1 F) / 2 without its trace, b being the elastic stretches, (I - b) / 2 in V3 to V8
};

struct DeformationRow {
  std::string_view name;  ///< "PETIT"
  StressGeometry stress_geometry;
  StrainMeasure strain;
  PlasticStrain plastic_strain;
  bool adds_stress;   ///< a law answers to the increment of strain alone, beside the stress before
  bool turns_stress;  ///< the stress before is turned with the body
};

/// The rows that were built in.
std::span<const RelationRow> relations();
std::span<const DeformationRow> deformations();

}  // namespace lacon::catalog
