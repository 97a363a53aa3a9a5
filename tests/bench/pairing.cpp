// Pairing of two flat rectangles by Google Benchmark: linear in the number of facets (time ratio for four times the facets at
// most 4.6), and microseconds for each contact cell, alone and with gap and both integrals by the contact kernel.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <cmath>

#include "lacon/operators/evolution/contact_geometry.hpp"

namespace {

using namespace lacon;

/// A rectangle of n x n facets as part of a mesh; `up`: its normals look along +z. Inner nodes of triangles and nothing else
/// lie off the grid, so that all facets are affine.
std::vector<std::int32_t> add_skin(Mesh& mesh, int n, CellType type, bool up, double z) {
  const auto first = static_cast<std::int32_t>(mesh.n_nodes());
  std::vector<std::int32_t> cells;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double shake = type == CellType::TRIA3 && i % n != 0 && j % n != 0 ? 0.2 * std::sin(12.9898 * i + 78.233 * j) : 0;
      mesh.coordinates.insert(mesh.coordinates.end(), {(i + shake) / n, (j - shake) / n, z});
    }
  const auto add = [&](std::initializer_list<std::int32_t> nodes) {
    std::vector<std::int32_t> in_order(nodes);
    if (!up) std::reverse(in_order.begin(), in_order.end());
    cells.push_back(static_cast<std::int32_t>(mesh.types.size()));
    mesh.types.push_back(type);
    mesh.cells.push_back(in_order);
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::int32_t a = first + j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      if (type == CellType::QUAD4) {
        add({a, b, c, d});
      } else {
        add({a, b, c});
        add({a, c, d});
      }
    }
  return cells;
}

struct Skins {
  Mesh mesh;
  Model model;
  Contact contact;

  Skins(std::int64_t facets, CellType type) {
    const int cells_of_square = type == CellType::QUAD4 ? 1 : 2;
    const int n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(facets) / cells_of_square)));
    mesh.dimension = 3;
    ContactZone zone;
    zone.slave = add_skin(mesh, n, type, false, 0);
    zone.master = add_skin(mesh, n - n / 7, type, true, -0.01);
    zone.jacobian = "ACTUALISE";
    Patches patches;
    for (const std::int32_t cell : zone.slave) {
      const auto patch = static_cast<std::int32_t>(patches.kind.size());
      zone.patches.push_back(patch);
      patches.kind.push_back(0);
      contact.slaves.push_back({cell, patch, 0, ""});
    }
    mesh.patches = patches;
    contact.zones.push_back(zone);
    model.elements = {type == CellType::QUAD4 ? "3D/QUAD4" : "3D/TRIA3"};
    model.element.assign(mesh.types.size(), 0);
  }
};

void report(benchmark::State& state, std::size_t facets, std::size_t contact_cells) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double runs = static_cast<double>(state.iterations());
  state.counters["facets"] = static_cast<double>(facets);
  state.counters["contact_cells"] = static_cast<double>(contact_cells);
  state.counters["per_contact_cell"] =
      benchmark::Counter(runs * static_cast<double>(contact_cells), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024;
  state.SetComplexityN(static_cast<benchmark::IterationCount>(facets));
}

template <CellType type>
void pairing_alone(benchmark::State& state) {
  const Skins skins(state.range(0), type);
  const Surface slave = surface_of(skins.mesh, skins.contact.zones[0].slave, skins.mesh.coordinates),
                master = surface_of(skins.mesh, skins.contact.zones[0].master, skins.mesh.coordinates);
  std::size_t cells = 0;
  for (auto run : state) {
    cells = 0;
    pair_in_blocks(slave, master, {}, 256, [&](const Pairing& pairing) { cells += pairing.cells.size(); });
  }
  report(state, slave.size(), cells);
}

template <CellType type>
void with_gap_and_integrals(benchmark::State& state) {
  const Skins skins(state.range(0), type);
  static Registry registry;
  ContactGeometry geometry(skins.mesh, skins.model, skins.contact, registry);
  const std::vector<double> displacement(skins.mesh.coordinates.size(), 0.0);
  for (auto run : state) geometry.update(displacement);
  report(state, skins.contact.slaves.size(), geometry.cells().size());
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (const std::int64_t facets : {10'000, 40'000, 160'000, 640'000}) bench->Arg(facets);
  bench->Unit(benchmark::kMillisecond)->Complexity(benchmark::oN);
}

BENCHMARK(pairing_alone<CellType::QUAD4>)->Apply(sizes);
BENCHMARK(pairing_alone<CellType::TRIA3>)->Apply(sizes);
BENCHMARK(with_gap_and_integrals<CellType::QUAD4>)->Apply(sizes);
BENCHMARK(with_gap_and_integrals<CellType::TRIA3>)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
