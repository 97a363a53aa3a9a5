#pragma once
// How good a factor is that is not exact, by what its solutions leave of their right sides. Equations are measured multiplied
// by the scale of their rows.
#include <optional>
#include <span>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// @param scale of the equations, (n)
double scaled_norm(std::span<const double> scale, std::span<const double> residual);
/// The largest entry of a residual over what its row sums up; of rows that sum up next to nothing, over a millionth of what
/// the largest one does.
double residual_share(const SparseMatrix& matrix, std::span<const double> scale, std::span<const double> residual,
                      std::span<const double> x, std::span<const double> right_side);

/// Powers of what substitutions leave of a vector bring out what they leave most of: where its share is well below 1, no pivot
/// on the way from the factor to the matrix changes its sign. The matrix and the scale must outlive this.
class FactorProof {
 public:
  FactorProof(const SparseMatrix& matrix, std::span<const double> scale);

  /// The right side whose solution is looked at next, (n); none behind the last one.
  std::optional<std::vector<double>> next() const;
  /// @param x the factor's solution for it  @return whether the factor may still be good
  bool look(std::span<const double> x);
  /// The largest share that was left so far.
  double error() const { return error_; }

 private:
  const SparseMatrix& matrix_;
  std::span<const double> scale_;
  std::vector<double> left_;
  double size_, error_ = 0;
  int looks_ = 0;
};

}  // namespace lacon
