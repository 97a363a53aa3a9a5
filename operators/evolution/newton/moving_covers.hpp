#pragma once
// Ends of kept covers that move all the same, in a system whose matrix leaves that out.
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace lacon {

/// A term column row^T of the tangent, which is not symmetric.
struct MovingCover {
  std::vector<std::pair<std::int64_t, double>> column, row;  ///< equations and what they have there
  double step = 0;                                           ///< row times the imposed displacements
};

/// Solve (A + sum of column row^T) x = b by solutions of A: A keeps its symmetry, its factor and the pivots that tell what is
/// stable. Few terms take a solution each (Woodbury 1950); of many, GMRES finds by which amounts they move, to 1e-4, in a
/// solution for each of its iterations, and their pivots are not counted. Where there is no solution, or next to none, A alone
/// is solved.
/// @param[in,out] x solution of A x = b - sum of column step
/// @param size the largest entry of b: right sides are scaled to it, for they are judged by those before them
/// @param solve a right side of A, in place
/// @return negative eigenvalues that A has and the sum has not, where terms are few
std::int64_t follow_covers(std::span<const MovingCover> covers, double size,
                           const std::function<void(std::vector<double>&)>& solve, std::vector<double>& x);

}  // namespace lacon
