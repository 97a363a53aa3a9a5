// DECOUPE_LAC in memory by Google Benchmark: cells of the mesh and macro-elements a second, for each kind of cell under the
// skin; bytes of coordinates and connectivity of the cut mesh against a copy. cutting.py measures the tool with its files.
#include "bench.hpp"
#include "lacon/operators/meshing/cut.hpp"

namespace {

using namespace lacon;

void cut(benchmark::State& state, CellType type, const char* option) {
  const Mesh mesh = bench::box(type, static_cast<int>(state.range(0)), 8);
  const std::vector<std::string> groups{"TOP"};
  std::size_t macro_elements = 0;
  double bytes = 0;
  for (auto run : state) {
    CutReport report;
    const Mesh made = cut_lac(mesh, groups, option, "DECOUPE_LAC/GROUP_MA_ESCL", report);
    macro_elements = made.patches->size();
    bytes = static_cast<double>(made.coordinates.size() * sizeof(double) + made.cells.values.size() * sizeof(std::int32_t) +
                                made.cells.offset.size() * sizeof(std::int64_t));
  }
  bench::report(state, {.items = static_cast<double>(mesh.n_cells()), .bytes = 2 * bytes});
  state.counters["macro_elements/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(macro_elements), benchmark::Counter::kIsRate);
}

struct Row {
  CellType type;
  const char* option;  ///< DECOUPE_HEXA
  int n;               ///< macro-elements along a side of the skin, of cubes
};

const bool registered = [] {
  for (const Row& row :
       {Row{CellType::HEXA8, "PYRA", 50}, Row{CellType::HEXA8, "PYRA", 100}, Row{CellType::HEXA8, "PYRA", 200},
        Row{CellType::HEXA8, "HEXA", 100}, Row{CellType::HEXA20, "PYRA", 50}, Row{CellType::HEXA27, "HEXA", 50},
        Row{CellType::PENTA6, "PYRA", 50}, Row{CellType::PENTA15, "PYRA", 50}, Row{CellType::PYRAM5, "PYRA", 50},
        Row{CellType::PYRAM13, "PYRA", 50}, Row{CellType::TETRA4, "PYRA", 50}, Row{CellType::TETRA10, "PYRA", 50}}) {
    const bool hexahedron = catalog::cell(row.type).family == Family::HEXA;
    const std::string name = "cut " + bench::name_of(row.type) + (hexahedron ? std::string(" in ") + row.option : "");
    benchmark::RegisterBenchmark(name.c_str(), cut, row.type, row.option)->Arg(row.n)->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
