#pragma once
// The points of one LIGN_COUPE, and how values there follow from those at nodes.
#include <array>
#include <cstdint>
#include <vector>

#include "lacon/operators/fields/cell_locator.hpp"
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

struct LinePoint {
  double along = 0;  ///< curved abscissa
  std::array<double, 3> position{};
  std::vector<std::int32_t> nodes;
  std::vector<double> weights;  ///< of these nodes
};

/// The points that an occurrence of LIGN_COUPE names.
///   SEGMENT   NB_POINTS at equal distances from COOR_ORIG to COOR_EXTR
///   ARC       NB_POINTS at equal angles from COOR_ORIG, turned about CENTRE by ANGLE degrees in all, in space about
///             the axis DNOR; the abscissa is the arc's length
///   GROUP_NO  the nodes of a group, in its order; the abscissa is the length of the straight pieces between points
///   GROUP_MA  the nodes of a chain of line cells, along it, in the direction of its first cell; a closed chain ends at
///             the node where it begins
/// Throws LIGNCOUPE_1 for a point that is in no cell and near none, LIGNCOUPE_3 for coordinates that are not as many as the
/// space has, LIGNCOUPE_4 for a group that is no chain, LIGNCOUPE_8 for an arc without radius or axis; says LIGNCOUPE_2 where
/// points lie outside by less than the locator's limit.
std::vector<LinePoint> line_points(const Mesh& mesh, const CellLocator& locator, const Keywords& line);

std::vector<std::array<double, 3>> positions(const std::vector<LinePoint>& points);
/// The same where the nodes have these coordinates, (n_nodes, 3).
std::vector<std::array<double, 3>> positions_now(const std::vector<LinePoint>& points, const std::vector<double>& coordinates);

/// POST_10 where the way from point to point goes back on itself by more than 154 degrees, as places.turns_back has it.
void tell_of_turns(const std::vector<LinePoint>& points, const Keywords& line);

}  // namespace lacon
