// Stiffness, forces and stresses of solid elements by Google Benchmark: elements a second on one core, for each kind of cell.
#include <random>

#include "bench.hpp"
#include "lacon/elements/plugin.h"
#include "lacon/elements/reference.hpp"
#include "lacon/elements/registry.hpp"

namespace {

using namespace lacon;

constexpr int blocks = 32;  // as many as assembly hands to a kernel at once

void stiffness(benchmark::State& state, const char* modelisation, CellType type, const char* option) {
  static Registry registry;
  const catalog::ElementRow& row = *registry.find_element(modelisation, type);
  const lacon_kernel& kernel = registry.kernel(row, option, LACON_SOLID);
  const catalog::CellRow& cell = catalog::cell(type);
  const Tabulation table = tabulate(type, integration_rule(cell.family, row.points));
  const int dimension = cell.dimension, n_dofs = dimension * cell.n_nodes, n_stress = static_cast<int>(row.stress.size());
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
        coordinates[at] = cell.nodes[i] + 2 + shake(random);  // away from the axis
        displacement[at] = 0.01 * shake(random);
      }
      parameter[2 * b * LACON_LANES + lane] = 2000;
      parameter[(2 * b + 1) * LACON_LANES + lane] = 0.3;
    }
  lacon_solid_batch batch{};
  batch.struct_size = sizeof batch;
  batch.n_blocks = blocks;
  batch.n_nodes = cell.n_nodes;
  batch.dimension = dimension;
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
  // the least that an isotropic law takes: one product of gradients for each pair of nodes at each point; the law then needs
  // the sums alone
  const double elements = blocks * LACON_LANES, pairs = cell.n_nodes * (cell.n_nodes + 1) / 2.0;
  bench::report(state, {.items = elements,
                        .flops = elements * table.n_points * pairs * 2 * dimension * dimension,
                        .bytes = elements * static_cast<double>(sizeof(double)) * n_dofs * (n_dofs + 1) / 2});
}

struct Row {
  const char* modelisation;
  std::vector<CellType> cells;
};

const bool registered = [] {
  const std::vector<CellType> plane{CellType::TRIA3, CellType::TRIA6, CellType::QUAD4, CellType::QUAD8, CellType::QUAD9};
  for (const Row& row : {Row{"3D",
                             {CellType::TETRA4, CellType::TETRA10, CellType::PENTA6, CellType::PENTA15, CellType::PYRAM5,
                              CellType::PYRAM13, CellType::HEXA8, CellType::HEXA20, CellType::HEXA27}},
                         Row{"D_PLAN", plane}, Row{"AXIS", plane}})
    for (const CellType type : row.cells)
      for (const char* option : {"ELAS/PETIT", "ELAS/GREEN_LAGRANGE"}) {
        const std::string name = "stiffness " + std::string(row.modelisation) + "/" + bench::name_of(type) + " " + option;
        benchmark::RegisterBenchmark(name.c_str(), stiffness, row.modelisation, type, option);
      }
  return true;
}();

}  // namespace
