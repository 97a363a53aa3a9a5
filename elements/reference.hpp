#pragma once
// Shape functions and integration rules of the reference cells of catalog/cells.toml.
#include <span>
#include <vector>

#include "lacon/catalog/cells.hpp"

namespace lacon {

/// Shape functions at any number of points. What a point gets does not depend on the others, to the last bit.
/// @param xi (n_points, dimension) @param[out] values (n_points, n_nodes)
void shape_functions(CellType type, std::span<const double> xi, std::span<double> values);

/// Their derivatives. @param[out] gradients (n_points, n_nodes, dimension)
void shape_gradients(CellType type, std::span<const double> xi, std::span<double> gradients);

/// All their partial derivatives of an order at one point of a skin's reference cell. @param xi (dimension), at most 2
/// @param[out] derivatives (n_nodes, order + 1) on surfaces: column k by k times eta and the rest xi; (n_nodes) on lines
void shape_derivatives(CellType type, std::span<const double> xi, int order, std::span<double> derivatives);

/// Shape functions of a skin cell at LACON_LANES points, and all their derivatives up to an order.
/// @param xi (dimension, LACON_LANES) @param[out] derivatives (derivatives, n_nodes, LACON_LANES): from an order to the next,
/// of each as shape_derivatives() has them
void shape_lanes(CellType type, const double* xi, int order, double* derivatives);

/// An integration rule on a reference cell.
struct Rule {
  int dimension = 0;
  std::vector<double> points;   ///< (n, dimension)
  std::vector<double> weights;  ///< (n), summing up to the measure of the reference cell

  int size() const { return static_cast<int>(weights.size()); }
};

/// The rule with this number of points; throws std::logic_error where there is none.
const Rule& integration_rule(Family family, int n_points);

/// The Gauss rule on [-1, 1] exact to degree 2 n_points - 1.
const Rule& gauss_rule(int n_points);

/// Shape functions and gradients of a cell at the points of a rule.
struct Tabulation {
  int n_points = 0, n_nodes = 0, dimension = 0;
  std::vector<double> shape;     ///< (n_points, n_nodes)
  std::vector<double> gradient;  ///< (n_points, n_nodes, dimension)
  std::vector<double> weight;    ///< (n_points)
};

Tabulation tabulate(CellType type, const Rule& rule);

}  // namespace lacon
