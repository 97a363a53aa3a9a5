#pragma once
#include <Eigen/Dense>
#include <random>
#include <span>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon::test {

inline Eigen::MatrixXd dense(const SparseMatrix& matrix) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(matrix.size(), matrix.size());
  for (std::int64_t row = 0; row < matrix.size(); ++row)
    for (std::int64_t k = matrix.rows()[row]; k < matrix.rows()[row + 1]; ++k) {
      full(row, matrix.columns()[k]) = matrix.values()[k];
      if (matrix.is_symmetric()) full(matrix.columns()[k], row) = matrix.values()[k];
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

inline std::vector<double> random_values(std::size_t n, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> values(n);
  for (double& v : values) v = uniform(random);
  return values;
}

/// Lower triangle, row by row, of a random symmetric matrix.
inline std::vector<double> random_lower(std::size_t n, std::mt19937& random) { return random_values(n * (n + 1) / 2, random); }

/// A regular system of a chain with multipliers that has entries wherever there may be some: random and unsymmetric, on a
/// diagonal of nodes that outweighs them.
inline void fill_unsymmetric(SparseMatrix& matrix, const Chain& chain, std::span<const Coupling> couplings,
                             std::mt19937& random) {
  matrix.set_zero();
  const auto add = [&](std::span<const std::int32_t> vertices) {
    std::vector<std::int64_t> equations;
    for (const std::int32_t v : vertices)
      for (std::int64_t e = chain.numbering.first[v]; e < chain.numbering.first[v + 1]; ++e) equations.push_back(e);
    matrix.add_unsymmetric(equations, random_values(equations.size() * equations.size(), random));
  };
  for (std::size_t c = 0; c < chain.cliques.size(); ++c) add(chain.cliques[c]);
  for (const Coupling& c : couplings) add(std::vector<std::int32_t>{c.a, c.b});
  for (std::int64_t e = 0; e < chain.numbering.first[chain.numbering.n_nodes]; ++e) matrix.add_diagonal(e, 8);
}

/// Springs along the chain, held at both ends when `held`: positive definite, or with free motions.
/// @param stiffness of a spring  @param stride every how manieth clique has one
inline void add_springs(SparseMatrix& matrix, const Chain& chain, double stiffness = 1, std::size_t stride = 1) {
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
