#pragma once
#include <algorithm>
#include <vector>

#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon::test {

/// n^3 points in a cube, one displacement each, with springs between neighbours; one side is held, or none.
struct Lattice {
  explicit Lattice(int n, double contrast = 1, bool is_held = true)
      : numbering(number_equations(n * n * n, 1, held(n, is_held), 0)), matrix(numbering, springs(n), {}) {
    const Ragged<std::int32_t> all = springs(n);
    for (std::size_t s = 0; s < all.size(); ++s) {
      const double k = all[s][0] >= n * n * n / 2 ? contrast : 1;
      matrix.add(std::vector<std::int64_t>{numbering.of(all[s][0], 0), numbering.of(all[s][1], 0)},
                 std::vector<double>{k, -k, k});
    }
  }
  static std::vector<std::uint8_t> held(int n, bool is_held) {
    std::vector<std::uint8_t> free(n * n * n, 1);
    if (is_held) std::fill(free.begin(), free.begin() + n * n, 0);
    return free;
  }
  static Ragged<std::int32_t> springs(int n) {
    Ragged<std::int32_t> all;
    const int strides[] = {1, n, n * n};
    for (int i = 0; i < n * n * n; ++i)
      for (const int stride : strides)
        if (i / stride % n + 1 < n) all.push_back(std::vector<std::int32_t>{i, i + stride});
    return all;
  }
  Numbering numbering;
  SparseMatrix matrix;
};

/// Points of a free lattice (n even) in pairs that resist each other alone, and a tenth of that between all neighbours: there
/// is no diagonal, so that no order gives a pivot unless one is looked for. Eigenvalues are within 0.6 of 1 and of -1, as many
/// of each.
inline void make_pairs(Lattice& lattice, int n) {
  lattice.matrix.set_zero();
  const Ragged<std::int32_t> all = Lattice::springs(n);
  for (std::size_t s = 0; s < all.size(); ++s) {
    const bool is_pair = all[s][1] == all[s][0] + 1 && all[s][0] % 2 == 0;
    lattice.matrix.add(std::vector<std::int64_t>{lattice.numbering.of(all[s][0], 0), lattice.numbering.of(all[s][1], 0)},
                       std::vector<double>{0, is_pair ? 1 : 0.1, 0});
  }
}

}  // namespace lacon::test
