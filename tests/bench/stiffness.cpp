// Stiffness, forces and stresses of solid elements by Google Benchmark: elements a second on one core, for each cell of 3D.
#include <benchmark/benchmark.h>

#include <random>

#include "lacon/elements/plugin.h"
#include "lacon/elements/reference.hpp"
#include "lacon/elements/registry.hpp"

namespace {

using namespace lacon;

constexpr int blocks = 32;  // as many as assembly hands to a kernel at once

void stiffness(benchmark::State& state, CellType type, const char* option) {
  static Registry registry;
  const catalog::ElementRow& row = *registry.find_element("3D", type);
  const lacon_kernel& kernel = registry.kernel(row, option, LACON_SOLID);
  const catalog::CellRow& cell = catalog::cell(type);
  const Tabulation table = tabulate(type, integration_rule(cell.family, row.points));
  const int n_dofs = 3 * cell.n_nodes, n_stress = static_cast<int>(row.stress.size());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shake(-0.02, 0.02);
  const auto numbers = [](int per_element) {
    return std::vector<double>(static_cast<std::size_t>(blocks) * per_element * LACON_LANES);
  };
  std::vector<double> coordinates = numbers(n_dofs), displacement = numbers(n_dofs), parameter = numbers(2),
                      matrix = numbers(n_dofs * (n_dofs + 1) / 2), force = numbers(n_dofs),
                      stress = numbers(row.points * n_stress);
  std::vector<std::int32_t> error(blocks * LACON_LANES);
  for (int b = 0; b < blocks; ++b)
    for (int lane = 0; lane < LACON_LANES; ++lane) {
      for (int i = 0; i < n_dofs; ++i) {
        const int at = (b * n_dofs + i) * LACON_LANES + lane;
        coordinates[at] = cell.nodes[i] + shake(random);
        displacement[at] = 0.01 * shake(random);
      }
      parameter[2 * b * LACON_LANES + lane] = 2000;
      parameter[(2 * b + 1) * LACON_LANES + lane] = 0.3;
    }
  lacon_solid_batch batch{};
  batch.struct_size = sizeof batch;
  batch.n_blocks = blocks;
  batch.n_nodes = cell.n_nodes;
  batch.dimension = 3;
  batch.n_points = table.n_points;
  batch.n_stress = n_stress;
  batch.n_parameters = 2;
  batch.shape = table.shape.data();
  batch.gradient = table.gradient.data();
  batch.weight = table.weight.data();
  batch.coordinates = coordinates.data();
  batch.displacement = displacement.data();
  batch.parameter = parameter.data();
  batch.matrix = matrix.data();
  batch.force = force.data();
  batch.stress = stress.data();
  batch.error = error.data();
  for (auto run : state) kernel.solid(&batch);
  for (const std::int32_t code : error)
    if (code != LACON_FINE) state.SkipWithError("the kernel refuses its elements");
  state.counters["elements"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * blocks * LACON_LANES, benchmark::Counter::kIsRate);
}

const bool registered = [] {
  for (const CellType type : {CellType::TETRA4, CellType::TETRA10, CellType::PENTA6, CellType::PENTA15, CellType::PYRAM5,
                              CellType::PYRAM13, CellType::HEXA8, CellType::HEXA20, CellType::HEXA27})
    for (const char* option : {"ELAS/PETIT", "ELAS/GREEN_LAGRANGE"})
      benchmark::RegisterBenchmark((std::string(catalog::cell(type).name) + " " + option).c_str(), stiffness, type, option);
  return true;
}();

}  // namespace

BENCHMARK_MAIN();
