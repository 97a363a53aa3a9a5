#pragma once
// Displacements and other unknowns of nodes out of a field, and where nodes are then.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lacon/structures/concepts.hpp"
#include "lacon/structures/field.hpp"
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

/// These components of a field of nodes as (n_nodes of the mesh, components), 0 where it has none.
std::vector<double> nodal_values(const Mesh& mesh, const Field& field, std::span<const std::string> components);

/// DX, DY, DZ of a field of nodes as (n_nodes of the mesh, dimension), 0 where it has none.
std::vector<double> nodal_displacements(const Mesh& mesh, const Field& field, int dimension);

/// A unit vector along which the displacement of a node is given.
struct HeldDirection {
  std::int32_t node;
  Vec3 along;
};

/// What some loads impose, along an axis or by a relation between displacements of one node.
std::vector<HeldDirection> held_directions(const Mesh& mesh, std::span<const Load> loads);

/// Coordinates of the mesh and displacements, added up: (n_nodes, 3).
/// @param values (n_nodes, n): the first `dimension` of the n values of a node are its displacements
/// @param coordinates to be overwritten, so that a caller may keep its memory
void displace(const Mesh& mesh, std::span<const double> values, int dimension, std::vector<double>& coordinates);

/// The longest side of the box around all nodes, where they are without displacements.
double extent(const Mesh& mesh);

/// Coordinates displaced by a field of nodes, (n_nodes, 3).
std::vector<double> displaced(const Mesh& mesh, const Field& field);

}  // namespace lacon
