#pragma once
// The integration points of finite elements on a given geometry: where they are, what they measure, gradients there.
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "lacon/elements/reference.hpp"
#include "lacon/elements/registry.hpp"
#include "lacon/structures/concepts.hpp"
#include "lacon/structures/field.hpp"

namespace lacon {

/// The points of one cell's own integration rule (that of stiffness and stresses, in skins that of loads).
struct CellPoints {
  int n_points = 0, n_nodes = 0, dimension = 0;  ///< dimension: of the space
  std::vector<double> shape;                     ///< (n_points, n_nodes)
  std::vector<double> position;                  ///< (n_points, 3)
  std::vector<double> measure;   ///< (n_points): weight times Jacobian, in axisymmetry times the radius (one radian)
  std::vector<double> gradient;  ///< (n_points, n_nodes, dimension) in space; empty for skins
};

/// Integration points of the finite elements of a model. Refers to what it is made of. Each thread of a loop needs a copy.
class ModelPoints {
 public:
  /// Throws PLUGIN_4 for an element that no catalogue has.
  ModelPoints(const Mesh& mesh, const Model& model, const Registry& registry);

  /// The element of a cell, nullptr where it has none.
  const catalog::ElementRow* element(std::size_t cell) const;
  bool is_solid(std::size_t cell) const;
  bool is_axisymmetric(std::size_t cell) const;
  bool is_plane_stress(std::size_t cell) const;
  int n_points(std::size_t cell) const { return element(cell)->points; }

  /// @param coordinates (n_nodes of the mesh, 3). Valid until the next call. The cell must have an element. Throws FIELDS_4 for
  /// a body cell whose Jacobian is not positive there.
  const CellPoints& operator()(std::size_t cell, std::span<const double> coordinates);

 private:
  const Mesh& mesh_;
  const Model& model_;
  std::vector<const catalog::ElementRow*> rows_;  ///< of the model's elements
  std::map<const catalog::ElementRow*, Tabulation> tabulations_;
  CellPoints points_;
  std::vector<double> x_;  ///< (n_nodes, space) of the cell in hand
};

}  // namespace lacon
