#pragma once
// What the cells of a result are made of at an instant: moduli and strains without stress, and energies that follow from them.
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lacon/operators/fields/cell_points.hpp"
#include "lacon/operators/fields/initial_strains.hpp"
#include "lacon/operators/fields/thermal.hpp"

namespace lacon {

/// Refers to what it is made of.
class ResultMaterials {
 public:
  /// @param points of the result's model
  ResultMaterials(const Base& base, const Result& result, const Mesh& mesh, ModelPoints& points);

  /// Strains that make no stress, thermal and initial ones (PRE_EPSI), of each row of a field at integration points.
  std::vector<Eigen::Matrix3d> free_strains(const Field& field);
  /// Set EPZZ in plane stress to that of an isotropic elastic body, without stress across. Throws ELEMENT_3 without NU.
  void set_strain_across(Field& strain);
  /// E and NU of each cell of a field at integration points, (cells, 2), at its instant and temperature. Throws ELEMENT_3.
  std::vector<double> moduli(const Field& field);

 private:
  /// "E" or "NU" of a cell, the number at the reference temperature. Throws ELEMENT_3.
  double elastic(std::int32_t cell, const char* name) const;
  /// Put into moduli (cells, 2) of a field those of cells whose material has functions.
  void follow_temperature(const Field& field, std::vector<double>& moduli);
  /// Call use(cells, their places in the field's support, n_points) for cells that matter, of as many points.
  template <class Matters, class Use>
  static void each_size(const Field& field, const Matters& matters, const Use& use);
  const InitialStrains& initial_strains(std::int64_t order);

  const Base& base_;
  const Result& result_;
  const Mesh& mesh_;
  ModelPoints& points_;
  MaterialField field_;
  std::unique_ptr<MaterialTable> table_;
  std::unique_ptr<ThermalMaterials> thermal_;
  std::optional<std::pair<std::int64_t, InitialStrains>> initial_;  ///< of a stage, by its first order
};

/// Elastic energy for each unit of volume out of stresses at integration points, sigma : C^-1 : sigma / 2: TOTALE.
Field energy_of_stress(const Field& stress, std::string name, ResultMaterials& materials);
/// The same out of strains, less those without stress: e : C : e / 2.
Field energy_of_strain(const Field& strain, std::string name, ResultMaterials& materials);
/// Work done from one state to the next for each unit of volume, the mean of both stresses times the change of strain, added to
/// `before`. Where `before` is null the state before is the natural one.
struct StateOfPoints {
  const Field &stress, &strain;
};
Field energy_of_path(const StateOfPoints& now, const StateOfPoints* last, const Field* before, std::string name);
/// The integral of a field at integration points over each of its cells (ELEM).
Field cell_integrals(const Mesh& mesh, ModelPoints& points, const Field& density, std::string name);

}  // namespace lacon
