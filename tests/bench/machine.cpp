// The yardsticks of the end-to-end bench, as JSON: dgemm, a copy of memory, and the factorisation by MUMPS of the matrix of a
// cube of HEXA8 (107 811 displacements for 32 cells an edge) with one thread of this process. usage: bench_machine [cells an
// edge]
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "lacon/assembly/direct_solver.hpp"

extern "C" void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
                       const double*, const int*, const double*, double*, const int*);

namespace {

template <class Work>
double seconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double dgemm_gflops() {
  const int n = 1500;
  const std::vector<double> a(n * n, 1.0), b(n * n, 2.0);
  std::vector<double> c(n * n, 0.0);
  const double one = 1, zero = 0;
  const auto multiply = [&] { dgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &zero, c.data(), &n); };
  multiply();
  return 2e-9 * n * n * n / seconds(multiply);
}

double copy_gbytes() {
  const std::vector<double> from(40'000'000, 1.0);
  std::vector<double> to(from.size());
  const auto copy = [&] { std::memcpy(to.data(), from.data(), from.size() * sizeof(double)); };
  copy();
  return 2e-9 * static_cast<double>(from.size() * sizeof(double)) / seconds(copy);  // read and written
}

/// Three displacements a node, all nodes of a cell coupled: the pattern of elasticity, positive definite values.
lacon::SymmetricMatrix cube(const lacon::Numbering& numbering, int n) {
  lacon::Ragged<std::int32_t> cells;
  const auto node = [n](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        std::vector<std::int32_t> nodes;
        for (int corner = 0; corner < 8; ++corner)
          nodes.push_back(node(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2)));
        cells.push_back(nodes);
      }
  lacon::SymmetricMatrix matrix(numbering, cells, {});
  std::vector<double> lower;
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j <= i; ++j) lower.push_back(i == j ? 8.0 : i % 3 == j % 3 ? -1.0 : 0.01);
  std::vector<std::int64_t> equations;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    equations.clear();
    for (const std::int32_t vertex : cells[c])
      for (int d = 0; d < 3; ++d) equations.push_back(numbering.of(vertex, d));
    matrix.add(equations, lower);
  }
  return matrix;
}

}  // namespace

int main(int argc, char** argv) {
  const int n = argc > 1 ? std::atoi(argv[1]) : 32;
  const std::int64_t n_nodes = static_cast<std::int64_t>(n + 1) * (n + 1) * (n + 1);
  const lacon::Numbering numbering = lacon::number_equations(n_nodes, 3, std::vector<std::uint8_t>(3 * n_nodes, 1), 0);
  const lacon::SymmetricMatrix matrix = cube(numbering, n);
  lacon::DirectSolver solver;
  const double analysis = seconds([&] { solver.analyse(matrix); });
  lacon::Factorisation found;
  const double factorisation = seconds([&] { found = solver.factorise(); });
  std::vector<double> side(matrix.size(), 1.0);
  const double substitution = seconds([&] { solver.substitute(side); });
  fmt::print(
      R"({{"equations": {}, "dgemm_gflops": {:.2f}, "copy_gbytes": {:.2f}, "analysis_seconds": {:.3f}, "factorisation_seconds": {:.3f}, "factorisation_gflops": {:.2f}, "factor_entries": {}, "substitution_seconds": {:.4f}}})"
      "\n",
      matrix.size(), dgemm_gflops(), copy_gbytes(), analysis, factorisation, 1e-9 * found.flops / factorisation, found.entries,
      substitution);
}
