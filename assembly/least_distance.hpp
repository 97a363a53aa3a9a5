#pragma once
// The point nearest to another one in a polyhedron of few dimensions and many sides.
#include <Eigen/Dense>
#include <optional>

namespace lacon {

struct LeastDistance {
  Eigen::VectorXd point;   ///< (n)
  Eigen::VectorXd forces;  ///< (n_rows), 0 or positive where a side holds the point: point = aim + rows^T forces
};

/// @param rows, bounds (n_rows, n), (n_rows): the points x with rows x >= bounds  @param aim (n)
/// @return nothing where there is no such point
/// Source: C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), chapter 23, algorithms NNLS and LDP.
std::optional<LeastDistance> least_distance(const Eigen::MatrixXd& rows, const Eigen::VectorXd& bounds,
                                            const Eigen::VectorXd& aim);

}  // namespace lacon
