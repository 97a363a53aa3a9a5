#pragma once
// Strains that have flowed (EPSP), under each measure of strain.
#include <optional>
#include <string>
#include <vector>

#include "lacon/catalog/behaviours.hpp"
#include "lacon/operators/fields/cell_points.hpp"
#include "lacon/operators/fields/result_materials.hpp"

namespace lacon {

/// How the plastic strain of a cell follows from its state, on the initial axes.
enum class PlasticMeasure {
  small,        ///< PETIT: e - C^-1 : sigma
  none,         ///< nothing flows
  green,        ///< GROT_GDEP: the same of Green and Lagrange's strain and the second Piola-Kirchhoff stress
  logarithmic,  ///< GDEF_LOG: the same of ln(F^T F) / 2 and the stress that works on it
  stretches     ///< SIMO_MIEHE: ln(F^T b^-1 F) / 2 without its trace, b being the elastic stretches of V3 to V8
};

/// That of a law under a measure of strain; nothing where it does not say what has flowed.
std::optional<PlasticMeasure> plastic_measure(const catalog::RelationRow& relation, const catalog::DeformationRow& deformation);

/// The fields of a state at integration points, but for displacements at nodes.
struct FlownState {
  const Field &strain, &stress;  ///< EPSI and SIEF, on the same cells
  const Field& displacement;
  const Field* variables;  ///< VARI, for PlasticMeasure::stretches
};

/// What stresses leave of strains, less those without stress. @param measure one entry a cell of the mesh
Field plastic_strain(const Mesh& mesh, ModelPoints& points, const FlownState& state, const std::vector<PlasticMeasure>& measure,
                     std::string name, ResultMaterials& materials);

}  // namespace lacon
