#pragma once
// Loops over elements: cells of one kind gathered into batches for their kernel, results handed back cell by cell.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacon/elements/reference.hpp"
#include "lacon/elements/registry.hpp"
#include "lacon/structures/concepts.hpp"

namespace lacon {

/// Cells that one kernel serves, with all that does not change from call to call.
struct ElementSet {
  const catalog::ElementRow* row = nullptr;
  const lacon_kernel* kernel = nullptr;
  Tabulation tabulation;
  std::vector<std::int32_t> cells;
  std::vector<double> parameters;  ///< (cells, n_parameters), solids only
  int n_parameters = 0;
  bool linear = true;  ///< the stiffness does not depend on the displacements

  int n_nodes() const { return tabulation.n_nodes; }
};

/// What a material says about a cell's parameter "ELAS/E"; throws ELEMENT_2, ELEMENT_3.
class MaterialTable {
 public:
  MaterialTable(const MaterialField& field, std::vector<Material> materials, std::vector<std::string> labels)
      : field_(&field), materials_(std::move(materials)), labels_(std::move(labels)) {}
  bool has(std::int32_t cell) const { return field_->material[cell] >= 0; }
  double parameter(std::int32_t cell, std::string_view path, std::string_view element) const;
  /// The parameter, or nothing where the cell's material lacks it.
  std::optional<double> find(std::int32_t cell, std::string_view path) const;

 private:
  const MaterialField* field_;
  std::vector<Material> materials_;
  std::vector<std::string> labels_;
};

/// Every solid element of the model, by kind; a set for each element row, cells in ascending order.
std::vector<ElementSet> solid_sets(const Mesh& mesh, const Model& model, Registry& registry, const MaterialTable& materials);

/// These cells by kind, with the load kernel of `option`. `position` receives for each set the indices into `cells`.
std::vector<ElementSet> load_sets(const Model& model, Registry& registry, std::string_view option,
                                  std::span<const std::int32_t> cells, std::vector<std::vector<std::int32_t>>& position);

/// What one solid element gives.
struct SolidValues {
  std::int32_t cell;
  std::span<const double> matrix;  ///< lower triangle, row by row; empty where it was not wanted
  std::span<const double> force;   ///< (n_nodes, dimension)
  std::span<const double> stress;  ///< (n_points, n_stress)
};

/// Call `use` for each element of a set. @param displacement (n_nodes, dimension) of the mesh
/// Throws ELEMENT_1 for elements that their kernel refuses.
void evaluate_solids(const ElementSet& set, const Mesh& mesh, int dimension, std::span<const double> displacement,
                     bool with_matrix, const std::function<void(const SolidValues&)>& use);

/// How many values a load kernel takes at each integration point.
int n_load_values(const lacon_kernel& kernel);

/// Coordinates of the integration points, (cells, n_points, 3). @param coordinates (n_nodes, 3)
std::vector<double> integration_points(const ElementSet& set, const Mesh& mesh, std::span<const double> coordinates);

/// What one element under a load gives.
struct LoadValues {
  std::int32_t cell;
  std::span<const double> force;  ///< (n_nodes, dimension)
  std::span<const double>
      matrix;  ///< symmetric part of its derivative, lower triangle row by row; empty where it was not wanted
};

/// Call `use` for each element of a set of load_sets(). @param coordinates (n_nodes, 3) of the mesh, initial or current
/// @param values (cells, n_points, n_load_values)
void evaluate_loads(const ElementSet& set, const Mesh& mesh, int dimension, std::span<const double> coordinates,
                    std::span<const double> values, bool with_matrix, const std::function<void(const LoadValues&)>& use);

}  // namespace lacon
