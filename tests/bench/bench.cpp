#include "bench.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <numeric>
#include <string>

#include "lacon/operators/crea_maillage/order_change.hpp"
#include "lacon/operators/program/blas.hpp"
#include "yardsticks.hpp"

namespace lacon::bench {
namespace {

double dgemm = 0, copy = 0;  // 1e9 a second

/// How a cube is cut into linear cells; its vertices have the numbers of HEXA8, 8 is its centre.
struct CubeRow {
  Family family;
  std::vector<std::string_view> cells;
};
const std::vector<CubeRow>& cube_rows() {
  static const std::vector<CubeRow> rows{{Family::HEXA, {"01234567"}},
                                         {Family::PENTA, {"013457", "123567"}},
                                         {Family::PYRAM, {"01238", "04518", "15628", "26738", "37408", "47658"}},
                                         {Family::TETRA, {"0126", "0236", "0376", "0746", "0456", "0516"}}};
  return rows;
}
constexpr std::array<std::array<int, 3>, 9> corners{
    {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 1, 1}}};  // in half sides

}  // namespace

void report(benchmark::State& state, const Work& work) {
  const double runs = static_cast<double>(state.iterations());
  const auto rate = [&](double amount) { return benchmark::Counter(runs * amount, benchmark::Counter::kIsRate); };
  state.counters["items/s"] = rate(work.items);
  if (work.flops > 0) {
    state.counters["GF/s"] = rate(1e-9 * work.flops);
    state.counters["of_dgemm"] = rate(1e-9 * work.flops / dgemm);
  }
  if (work.bytes > 0) {
    state.counters["GB/s"] = rate(1e-9 * work.bytes);
    state.counters["of_copy"] = rate(1e-9 * work.bytes / copy);
  }
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::ofstream("/proc/self/clear_refs") << 5;  // the kernel forgets the peak
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::string name_of(CellType type) { return std::string(catalog::cell(type).name); }

Mesh box(CellType type, int n, int layers) {
  const catalog::CellRow& row = catalog::cell(type);
  const catalog::CellRow& linear = catalog::cell(row.linear);
  const auto cube =
      std::find_if(cube_rows().begin(), cube_rows().end(), [&](const CubeRow& r) { return r.family == row.family; });
  Mesh mesh;
  mesh.dimension = 3;
  std::map<std::array<int, 3>, std::int32_t> numbers;
  const auto node = [&](const std::array<int, 3>& at) {
    const auto [where, is_new] = numbers.try_emplace(at, static_cast<std::int32_t>(mesh.n_nodes()));
    if (is_new)
      for (const int coordinate : at) mesh.coordinates.push_back(0.5 * coordinate);
    return where->second;
  };
  std::vector<std::vector<std::int32_t>> tops;
  std::vector<CellType> top_types;
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (const std::string_view vertices : cube->cells) {
          std::vector<std::int32_t> nodes;
          for (const char v : vertices) {
            const std::array<int, 3>& corner = corners[static_cast<std::size_t>(v - '0')];
            nodes.push_back(node({2 * i + corner[0], 2 * j + corner[1], 2 * k + corner[2]}));
          }
          mesh.add_cell(linear.type, nodes);
          if (k + 1 < layers) continue;
          for (const catalog::FacetRow& facet : linear.facets) {
            std::vector<std::int32_t> skin;
            for (const std::int8_t local : facet.nodes) skin.push_back(nodes[static_cast<std::size_t>(local)]);
            if (std::all_of(skin.begin(), skin.end(), [&](std::int32_t s) { return mesh.point(s)[2] == layers; })) {
              tops.push_back(skin);
              top_types.push_back(facet.type);
            }
          }
        }
  Group top{"TOP", {}};
  for (std::size_t t = 0; t < tops.size(); ++t) {
    top.members.push_back(static_cast<std::int32_t>(mesh.n_cells()));
    mesh.add_cell(top_types[t], tops[t]);
  }
  mesh.cell_groups.push_back(top);
  std::vector<std::int32_t> all(mesh.n_cells());
  std::iota(all.begin(), all.end(), 0);
  if (row.order == 2) make_quadratic(mesh, all);
  if (mesh.types.front() != type) make_complete(mesh, all);
  return mesh;
}

}  // namespace lacon::bench

int main(int argc, char** argv) {
  using namespace lacon::bench;
  lacon::set_up_blas(argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  dgemm = dgemm_gflops();
  copy = copy_gbytes();
  peak_megabytes();
  benchmark::AddCustomContext("dgemm_gflops", std::to_string(dgemm));
  benchmark::AddCustomContext("copy_gbytes", std::to_string(copy));
  benchmark::RunSpecifiedBenchmarks();
}
