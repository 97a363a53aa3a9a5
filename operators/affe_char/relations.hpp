#pragma once
// Relations between displacements: LIAISON_DDL, LIAISON_UNIF, LIAISON_GROUP, LIAISON_SOLIDE, DNOR and DTAN of FACE_IMPO, and
// those of ties.hpp.
#include "lacon/operators/affe_char/places.hpp"

namespace lacon {

/// Every node that an occurrence names, each once, in the order in which they come.
std::vector<std::int32_t> distinct_nodes(const std::vector<NamedPlaces>& named);

/// Enter a relation: one term for each degree of freedom, without those of coefficient 0; where none is left and the value is
/// 0, there is no relation. Throws CHARGE_2, CHARGE_3 where a degree of freedom does not exist, CHARGE_25 where no term is left
/// to be a value.
void add_relation(Load& load, const LoadScene& scene, const std::string& source, std::vector<RelationTerm> terms,
                  LoadValue value);

/// Append the relations of every such keyword to the load. Throws what names of places and degrees of freedom throw, CHARGE_11
/// (lists of different lengths), CHARGE_12 (a group without normal), CHARGE_13 (nodes that do not pair), CHARGE_14 (a rigid
/// body in axisymmetry), CHARGE_15 (DTAN in 3D). CHARGE_16 alarms for normals that turn by more than 10 degrees at a node.
void add_relations(Load& load, const LoadScene& scene, const Keywords& keywords);

/// The relations that leave these points no other motions than those of a rigid body (small rotations): 2 n - 3 of n different
/// points in the plane, 3 n - 6 in space, 3 n - 5 on a line in space. Terms: number of a point, component, coefficient.
/// @param points (n, 3), the plane z = 0 for dimension 2
std::vector<std::vector<RelationTerm>> rigid_relations(std::span<const double> points, int dimension);

}  // namespace lacon
