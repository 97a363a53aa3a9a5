#pragma once
// What the Google Benchmarks of tests/bench share: a main() with the yardsticks of the machine, counters beside the time,
// meshes.
#include <benchmark/benchmark.h>

#include "lacon/structures/mesh.hpp"

namespace lacon::bench {

/// What one iteration of a benchmark does. Operations and bytes stay 0 where they mean nothing.
struct Work {
  double items = 0;  ///< elements, points, entries ...
  double flops = 0;  ///< that the result takes, whatever the program spends
  double bytes = 0;  ///< that must be read or written at least
};

/// Counters of a benchmark that is over: items a second, and where they are known GF/s with the part of dgemm, bytes a second
/// with the part of a copy of memory (dgemm and copy of this run: main() measures them first).
void report(benchmark::State& state, const Work& work);

/// The largest memory of this process since this was asked last.
double peak_megabytes();

/// The name that benchmarks of a cell of the catalogue have: "HEXA8".
std::string name_of(CellType type);

/// A box of n x n x layers cubes of side 1, each cut into cells of this kind; the facets at its top are the group TOP.
/// @param type of three dimensions
Mesh box(CellType type, int n, int layers);

}  // namespace lacon::bench
