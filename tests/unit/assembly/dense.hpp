#pragma once
#include <Eigen/Dense>
#include <random>

#include "lacon/assembly/symmetric_matrix.hpp"

namespace lacon::test {

inline Eigen::MatrixXd dense(const SymmetricMatrix& matrix) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(matrix.size(), matrix.size());
  for (std::int64_t row = 0; row < matrix.size(); ++row)
    for (std::int64_t k = matrix.rows()[row]; k < matrix.rows()[row + 1]; ++k) {
      full(row, matrix.columns()[k]) = matrix.values()[k];
      full(matrix.columns()[k], row) = matrix.values()[k];
    }
  return full;
}

/// Nodes in a row, two displacements each; cliques of neighbours.
struct Chain {
  explicit Chain(int n_nodes, int n_patches = 0, std::vector<std::uint8_t> free = {}) {
    if (free.empty()) free.assign(2 * n_nodes, 1);
    numbering = number_equations(n_nodes, 2, free, n_patches);
    for (std::int32_t i = 0; i + 1 < n_nodes; ++i) cliques.push_back(std::vector<std::int32_t>{i, i + 1});
  }
  Numbering numbering;
  Ragged<std::int32_t> cliques;
};

/// Lower triangle, row by row, of a random symmetric matrix.
inline std::vector<double> random_lower(std::size_t n, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> lower(n * (n + 1) / 2);
  for (double& v : lower) v = uniform(random);
  return lower;
}

/// Springs along the chain, held at both ends when `held`: positive definite, or with free motions.
/// @param stiffness of a spring  @param stride every how manieth clique has one
inline void add_springs(SymmetricMatrix& matrix, const Chain& chain, double stiffness = 1, std::size_t stride = 1) {
  std::vector<double> spring(10, 0.0);
  // two nodes, components x and y each: k (u_a - u_b)^2
  const auto at = [](int i, int j) { return i * (i + 1) / 2 + j; };
  for (int d = 0; d < 2; ++d) {
    spring[at(d, d)] = spring[at(2 + d, 2 + d)] = 2 * stiffness;
    spring[at(2 + d, d)] = -2 * stiffness;
  }
  for (std::size_t c = 0; c < chain.cliques.size(); c += stride) {
    std::vector<std::int64_t> equations;
    for (const std::int32_t node : chain.cliques[c])
      for (int d = 0; d < 2; ++d) equations.push_back(chain.numbering.of(node, d));
    matrix.add(equations, spring);
  }
}

}  // namespace lacon::test
