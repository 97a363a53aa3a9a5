// The yardsticks of the end-to-end bench, as JSON: dgemm, a copy of memory, and the factorisation by MUMPS of the matrix of a
// cube of HEXA8 (107 811 displacements for 32 cells an edge) in double precision, with the kernel and the threads that an
// operator takes. usage: bench_machine [cells an edge]
#include <fmt/format.h>

#include <cstdlib>

#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/operators/program/blas.hpp"
#include "yardsticks.hpp"

using namespace lacon;

int main(int argc, char** argv) {
  set_up_blas(argv);
  const int n = argc > 1 ? std::atoi(argv[1]) : 32;
  const double dgemm = bench::dgemm_gflops(), copy = bench::copy_gbytes();
  const Numbering numbering = bench::cube_numbering(n);
  const SparseMatrix matrix = bench::cube_matrix(numbering, n);
  MumpsEngine engine({.single_precision = MumpsOptions::Use::never});
  const double analysis = bench::seconds([&] { engine.analyse(matrix); });
  Factorisation found;
  const double factorisation = bench::seconds([&] { found = engine.factorise(matrix); });
  std::vector<double> side(matrix.size(), 1.0);
  const double substitution = bench::seconds([&] { engine.substitute(side); });
  fmt::print(
      R"({{"equations": {}, "dgemm_gflops": {:.2f}, "copy_gbytes": {:.2f}, "analysis_seconds": {:.3f}, "factorisation_seconds": {:.3f}, "factorisation_gflops": {:.2f}, "factor_entries": {}, "substitution_seconds": {:.4f}}})"
      "\n",
      matrix.size(), dgemm, copy, analysis, factorisation, 1e-9 * found.flops / factorisation, found.entries, substitution);
}
