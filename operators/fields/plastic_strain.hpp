#pragma once
// Strains that have flowed (EPSP), under each measure of strain.
#include <string>
#include <vector>

#include "lacon/catalog/behaviours.hpp"
#include "lacon/operators/fields/cell_points.hpp"
#include "lacon/operators/fields/result_materials.hpp"

namespace lacon {

/// That of a law under a measure of strain; `unknown` where it does not say what has flowed.
catalog::PlasticStrain plastic_measure(const catalog::RelationRow& relation, const catalog::DeformationRow& deformation);

/// The fields of a state at integration points, but for displacements at nodes.
struct FlownState {
  const Field &strain, &stress;  ///< EPSI and SIEF, on the same cells
  const Field& displacement;
  const Field* variables;  ///< VARI, for PlasticStrain::stretches
};

/// What stresses leave of strains, less those without stress. @param measure one entry a cell of the mesh
Field plastic_strain(const Mesh& mesh, ModelPoints& points, const FlownState& state,
                     const std::vector<catalog::PlasticStrain>& measure, std::string name, ResultMaterials& materials);

}  // namespace lacon
