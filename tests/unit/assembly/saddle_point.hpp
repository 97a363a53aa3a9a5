#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "dense.hpp"

namespace lacon::test {

/// A chain held at its first node, with multipliers that tie the x displacements of node pairs.
struct SaddlePoint {
  SaddlePoint() : chain(30, 2, held()), matrix(chain.numbering, chain.cliques, couplings()) { fill(matrix); }
  void fill(SparseMatrix& to) const {
    add_springs(to, chain);
    for (const Coupling& c : couplings()) {
      const std::vector<std::int64_t> equations{chain.numbering.of_patch(c.a - 30), chain.numbering.of(c.b, 0)};
      to.add(equations, std::vector<double>{0, c.b % 2 ? 1.0 : -0.5, 0});
    }
  }
  static std::vector<std::uint8_t> held() {
    std::vector<std::uint8_t> free(60, 1);
    free[0] = free[1] = 0;
    return free;
  }
  static std::vector<Coupling> couplings() { return {{30, 5}, {30, 16}, {31, 9}, {31, 20}}; }
  Chain chain;
  SparseMatrix matrix;
};

inline std::span<double> entries(Eigen::VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

}  // namespace lacon::test
