#pragma once
// Equation numbers: unknowns of nodes that are not imposed, and one multiplier a patch.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lacon {

/// Unknowns hang on vertices: vertex v < n_nodes is node v with its displacements and whatever else its elements know, vertex
/// n_nodes + p is the multiplier of patch p, and behind the patches there may be multipliers of relations. All LAGS_C carriers
/// of a patch are that one equation (METHOD.md 3.6).
struct Numbering {
  std::int64_t n_nodes = 0;
  int n_components = 0;                ///< unknowns of a node, displacements first
  std::vector<std::int64_t> first;     ///< equations of vertex v: first[v] to first[v + 1], (n_vertices + 1)
  std::vector<std::int64_t> equation;  ///< (n_nodes, n_components): equation of an unknown, -1 where it is imposed or absent

  std::int64_t n_vertices() const { return static_cast<std::int64_t>(first.size()) - 1; }
  std::int64_t n_equations() const { return first.back(); }
  std::int64_t of_patch(std::int64_t patch) const { return first[n_nodes + patch]; }
  std::int64_t of(std::int64_t node, int component) const { return equation[node * n_components + component]; }
};

/// @param free (n_nodes, n_components): 1 where there is an unknown, 0 where it is imposed or does not exist
/// Throws SOLVER_16.
Numbering number_equations(std::int64_t n_nodes, int n_components, std::span<const std::uint8_t> free, std::int64_t n_patches);

}  // namespace lacon
