#pragma once
// Loops over elements: cells of one kind gathered into batches for their kernel, results handed back cell by cell.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacon/elements/material.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/elements/registry.hpp"
#include "lacon/structures/concepts.hpp"

namespace lacon {

/// Cells that one kernel serves, with all that does not change from call to call.
struct ElementSet {
  const catalog::ElementRow* row = nullptr;
  const lacon_kernel* kernel = nullptr;
  std::string option;  ///< of the kernel: "ELAS/PETIT", "CHAR_MECA_PRES"
  Tabulation tabulation;
  std::vector<std::int32_t> cells;              ///< ascending
  std::vector<std::int32_t> numbers;            ///< of them, where the mesh is a part of another one; empty: the same
  std::vector<double> parameters;               ///< (cells, n_parameters), solids only
  int n_parameters = 0, n_point_variables = 0;  ///< n_point_variables: internal variables of a point
  bool linear = true;                           ///< the stiffness does not depend on the displacements
  std::vector<double> curve;  ///< (points, 3), lacon_solid_batch::curve; of all cells, empty where the kernel takes none
  int n_components = 0;       ///< width of arrays (n_nodes of the mesh, n_components): what node_unknowns() lists
  std::vector<int> columns;   ///< of such arrays: where they hold each of the kernel's unknowns

  int dimension() const { return catalog::dimension_of(row->geometry); }  ///< of the space
  int n_unknowns() const { return static_cast<int>(columns.size()); }     ///< of a node
  int n_nodes() const { return tabulation.n_nodes; }
  std::int32_t number(std::size_t i) const { return numbers.empty() ? cells[i] : numbers[i]; }  ///< of one of `cells`
  std::size_t n_stress() const { return static_cast<std::size_t>(tabulation.n_points) * row->stress.size(); }    ///< of a cell
  std::size_t n_variables() const { return static_cast<std::size_t>(tabulation.n_points * n_point_variables); }  ///< of a cell
};

/// The unknowns of the model's nodes, of which a node may have some alone: the displacements, and behind them the others in the
/// order in which elements bring them. Nodal arrays hold them node by node. Throws PLUGIN_4.
std::vector<std::string> node_unknowns(const Model& model, const Registry& registry);

/// No cells yet, for those of a solid element under an option of it. @param unknowns of node_unknowns()
ElementSet solid_set(const catalog::ElementRow& row, Registry& registry, const std::string& option,
                     std::span<const std::string> unknowns);

/// Set the internal variable by which a law says that it flows (INDIPLAS) to zero. @param variable (cells, n_variables)
void stop_flow(const ElementSet& set, std::span<double> variable);
/// Whether internal variables are others than before: the law flows. @param now, before (cells, n_variables)
bool has_flowed(const ElementSet& set, std::span<const double> now, std::span<const double> before);

/// The behaviour of cells: options of solid rows, "ELAS/PETIT", and for each cell of the mesh its index among them.
struct Behaviours {
  std::vector<std::string> options;
  std::vector<std::int32_t> of_cell;
};

/// Every solid element of the model, by kind; a set for each element row and behaviour, and material where the law takes a
/// curve; cells in ascending order. Throws ELEMENT_2, ELEMENT_3, BEHAVIOUR_1 (no such behaviour of the element).
std::vector<ElementSet> solid_sets(const Mesh& mesh, const Model& model, Registry& registry, const MaterialTable& materials,
                                   const Behaviours& behaviours);

/// These cells by kind, with the load kernel of `option`. `position` receives for each set the indices into `cells`.
std::vector<ElementSet> load_sets(const Model& model, Registry& registry, std::string_view option,
                                  std::span<const std::int32_t> cells, std::vector<std::vector<std::int32_t>>& position);

/// What one element gives for sums over elements.
struct ElementValues {
  std::int32_t cell;
  std::span<const std::int64_t> dofs;  ///< (n_nodes, n_unknowns): node * n_components + column
  std::span<const double> force;       ///< (n_nodes, n_unknowns)
  std::span<const double> matrix;      ///< row by row, empty where it was not wanted
  bool symmetric = true;               ///< the matrix is a lower triangle, otherwise it is square
};

/// The tangent is the symmetric part of the force's derivative, the whole one the derivative where the kernel has one that is
/// not symmetric. The tangent without the terms of the present stress has no instability but that of the law.
enum class SolidMatrix { none, tangent, stressless, elastic, whole };

/// What solid elements are evaluated at. Displacements, with the other unknowns behind them, are those of the mesh, (n_nodes,
/// n_components). The last state in equilibrium may be left empty, which is the natural state; its stresses and variables are
/// those of the set.
struct SolidInput {
  std::span<const double> displacement;
  std::span<const double> previous_displacement;
  std::span<const double> previous_stress;                 ///< (cells, n_points, n_stress)
  std::span<const double> previous_variable;               ///< (cells, n_points, n_variables)
  std::span<const double> thermal, previous_thermal = {};  ///< (cells, n_points): strains, for kernels that take them
  std::span<const double> parameters = {};  ///< (cells, n_parameters), in the place of those of the set; empty: those
};

/// Where values at the integration points of the set's cells go; empty: not wanted.
struct SolidOutput {
  std::span<double> stress;    ///< (cells, n_points, n_stress)
  std::span<double> variable;  ///< (cells, n_points, n_variables): internal variables
};

/// Evaluate the elements of a set, in n_threads() threads, and call `use` for each of them: in their order and one at a time,
/// so that sums have the same bits for any number of threads. @return the first cell that the displacement turns inside out, if
/// there is one  Throws ELEMENT_1 for elements that their kernel refuses.
std::optional<std::int32_t> evaluate_solids(const ElementSet& set, const Mesh& mesh, const SolidInput& input,
                                            SolidMatrix matrix, const SolidOutput& output,
                                            const std::function<void(const ElementValues&)>& use);

/// How many values a load kernel takes at each integration point.
int n_load_values(const lacon_kernel& kernel);

/// Coordinates of the integration points, (cells, n_points, 3). @param coordinates (n_nodes, 3)
std::vector<double> integration_points(const ElementSet& set, const Mesh& mesh, std::span<const double> coordinates);

/// Call `use` for each element of a set of load_sets(), as evaluate_solids() does; the matrix is the symmetric part of
/// the force's derivative. @param coordinates (n_nodes, 3) of the mesh, initial or current
/// @param values (cells, n_points, n_load_values)
void evaluate_loads(const ElementSet& set, const Mesh& mesh, std::span<const double> coordinates,
                    std::span<const double> values, bool with_matrix, const std::function<void(const ElementValues&)>& use);

}  // namespace lacon
