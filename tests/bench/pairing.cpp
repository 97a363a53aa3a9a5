// Pairing by Google Benchmark. Its pieces: polygons clipped, points projected to facets. The whole, on two flat rectangles:
// linear in the number of facets (time ratio for four times the facets at most 4.6), and microseconds for each contact cell,
// alone, with gap and both integrals by the contact kernel, and once more with traces and derivatives of gaps.
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "bench.hpp"
#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/pairing/facet.hpp"
#include "lacon/pairing/polygon.hpp"

namespace {

using namespace lacon;

space::Polygon regular(int vertices, double turn) {
  space::Polygon polygon;
  for (int v = 0; v < vertices; ++v) {
    const double angle = turn + 2 * std::numbers::pi * v / vertices;
    polygon.push_back({std::cos(angle), std::sin(angle)});
  }
  return polygon;
}

/// Regular polygons by half-planes that pass near their middle, all cut in two.
void clip(benchmark::State& state) {
  constexpr int n = 256;
  std::vector<space::HalfPlane> halves;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi), off(-0.3, 0.3);
  for (int i = 0; i < n; ++i) {
    const double a = angle(random);
    halves.push_back({{off(random), off(random)}, {std::cos(a), std::sin(a)}, 0});
  }
  const space::Polygon polygon = regular(static_cast<int>(state.range(0)), 0.1);
  space::Polygon inside;
  for (auto run : state)
    for (const space::HalfPlane& half : halves) {
      space::clip(polygon, half, inside);
      benchmark::DoNotOptimize(inside.data());
    }
  bench::report(state, {.items = n});
}
BENCHMARK(clip)->Arg(3)->Arg(4)->Arg(8);

/// Points of a facet, a tenth of an edge bent where it can be, back to its reference cell.
void project(benchmark::State& state, CellType type, double bend) {
  constexpr int n = 256;
  const catalog::CellRow& cell = catalog::cell(type);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shake(-bend, bend), inner(0.05, 0.45);
  std::vector<Vec3> nodes;
  for (int i = 0; i < cell.n_nodes; ++i) {
    const double* at = cell.nodes.data() + 2 * i;
    nodes.push_back({at[0] + shake(random), at[1] + shake(random), 0});
  }
  const space::Map2 map = space::project(space::interpolate(type, nodes), {1, 0, 0}, {0, 1, 0});
  const space::Inverse inverse(map, cell.family);
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) points.push_back(map({inner(random), inner(random)}).x);
  for (auto run : state)
    for (const Vec2 point : points) {
      const std::optional<Vec2> found = inverse(point, 1e-13, 0.25);
      if (!found) state.SkipWithError("a point has no image");
      benchmark::DoNotOptimize(found);
    }
  bench::report(state, {.items = n});
}
BENCHMARK_CAPTURE(project, TRIA3, CellType::TRIA3, 0.1);
BENCHMARK_CAPTURE(project, QUAD4_parallelogram, CellType::QUAD4, 0.0);
BENCHMARK_CAPTURE(project, QUAD4, CellType::QUAD4, 0.1);
BENCHMARK_CAPTURE(project, TRIA6, CellType::TRIA6, 0.05);
BENCHMARK_CAPTURE(project, QUAD8, CellType::QUAD8, 0.1);
BENCHMARK_CAPTURE(project, QUAD9, CellType::QUAD9, 0.1);

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
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(mesh.n_nodes()));
    if (is_new) {
      for (std::size_t d = 0; d < 3; ++d) mesh.coordinates.push_back((mesh.point(a)[d] + mesh.point(b)[d]) / 2);
    }
    return at->second;
  };
  const auto add = [&](std::initializer_list<std::int32_t> nodes) {
    std::vector<std::int32_t> in_order(nodes);
    if (!up) std::reverse(in_order.begin(), in_order.end());
    for (std::size_t i = 0, count = in_order.size(); i < count && catalog::cell(type).order > 1; ++i)
      in_order.push_back(middle(in_order[i], in_order[(i + 1) % count]));
    cells.push_back(static_cast<std::int32_t>(mesh.types.size()));
    mesh.types.push_back(type);
    mesh.cells.push_back(in_order);
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::int32_t a = first + j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      if (catalog::cell(type).family == Family::QUAD) {
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
    const int cells_of_square = catalog::cell(type).family == Family::QUAD ? 1 : 2;
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
    model.elements = {"3D/" + std::string(catalog::cell(type).name)};
    model.element.assign(mesh.types.size(), 0);
  }
};

void report_pairing(benchmark::State& state, std::size_t facets, std::size_t contact_cells) {
  const double runs = static_cast<double>(state.iterations());
  bench::report(state, {.items = static_cast<double>(contact_cells)});
  state.counters["facets"] = static_cast<double>(facets);
  state.counters["contact_cells"] = static_cast<double>(contact_cells);
  state.counters["per_contact_cell"] =
      benchmark::Counter(runs * static_cast<double>(contact_cells), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["peak_MB"] = bench::peak_megabytes();
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
    PairingInParts pairing(slave, master);
    Pairing found;
    for (std::size_t first = 0; first < slave.size(); first += 128) {
      pairing.pair(first, std::min(first + 128, slave.size()), found);
      cells += found.cells.size();
    }
  }
  report_pairing(state, slave.size(), cells);
}

template <CellType type>
void with_gap_and_integrals(benchmark::State& state) {
  const Skins skins(state.range(0), type);
  static Registry registry;
  ContactGeometry geometry(skins.mesh, skins.model, skins.contact, registry);
  const std::vector<double> displacement(skins.mesh.coordinates.size(), 0.0);
  for (auto run : state) geometry.update(displacement);
  report_pairing(state, skins.contact.slaves.size(), geometry.cells().size());
}

/// Skins that are no longer what they were: Jacobians that vary along flat facets ask for rules of higher degree, warped facets
/// for normals that vary; warped ones of the second order are curved.
enum class Shape { flat, distorted, warped };

std::vector<double> displacement_to(Shape shape, const Mesh& mesh) {
  std::vector<double> displacement;
  for (std::size_t node = 0; node < mesh.n_nodes(); ++node) {
    const auto& x = mesh.point(node);
    const double u = 0.01 * std::sin(3 * x[0] + 2 * x[1]);
    if (shape == Shape::distorted)
      displacement.insert(displacement.end(), {u, -u, 0});
    else
      displacement.insert(displacement.end(), {0, 0, shape == Shape::warped ? u : 0});
  }
  return displacement;
}

template <CellType type, Shape shape>
void after_displacement(benchmark::State& state) {
  const Skins skins(state.range(0), type);
  static Registry registry;
  ContactGeometry geometry(skins.mesh, skins.model, skins.contact, registry);
  const std::vector<double> displacement = displacement_to(shape, skins.mesh);
  for (auto run : state) geometry.update(displacement);
  report_pairing(state, skins.contact.slaves.size(), geometry.cells().size());
}

/// Contact cells once more, with traces, and derivatives of their gaps, summed up for each slave cell: first ones, or second
/// ones too.
template <CellType type, int order, Shape shape>
void with_derivatives(benchmark::State& state) {
  const Skins skins(state.range(0), type);
  static Registry registry;
  ContactGeometry geometry(skins.mesh, skins.model, skins.contact, registry);
  geometry.update(displacement_to(shape, skins.mesh));
  const std::vector<std::int8_t> orders(geometry.n_patches(), order);
  for (auto run : state) benchmark::DoNotOptimize(geometry.vary(orders));
  report_pairing(state, skins.contact.slaves.size(), geometry.cells().size());
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (const std::int64_t facets : {10'000, 40'000, 160'000, 640'000, 1'000'000}) bench->Arg(facets);
  bench->Unit(benchmark::kMillisecond)->Complexity(benchmark::oN);
  bench->MinTime(3);  // more than the first run, which takes its memory from the system: Newton's method pairs again and again
}

BENCHMARK(pairing_alone<CellType::QUAD4>)->Apply(sizes);
BENCHMARK(pairing_alone<CellType::TRIA3>)->Apply(sizes);
BENCHMARK(with_gap_and_integrals<CellType::QUAD4>)->Apply(sizes);
BENCHMARK(with_gap_and_integrals<CellType::TRIA3>)->Apply(sizes);
BENCHMARK(after_displacement<CellType::QUAD4, Shape::distorted>)->Arg(10'000)->Unit(benchmark::kMillisecond);

/// Pairing with gaps, and derivatives, of one kind of skins: next to each other, for their ratios.
#define LACON_BENCH_DERIVATIVES(type, shape, facets)                                                        \
  BENCHMARK(after_displacement<CellType::type, Shape::shape>)->Arg(facets)->Unit(benchmark::kMillisecond);  \
  BENCHMARK(with_derivatives<CellType::type, 1, Shape::shape>)->Arg(facets)->Unit(benchmark::kMillisecond); \
  BENCHMARK(with_derivatives<CellType::type, 2, Shape::shape>)->Arg(facets)->Unit(benchmark::kMillisecond)
LACON_BENCH_DERIVATIVES(QUAD4, flat, 10'000);
LACON_BENCH_DERIVATIVES(QUAD4, warped, 10'000);
LACON_BENCH_DERIVATIVES(TRIA3, flat, 10'000);
LACON_BENCH_DERIVATIVES(TRIA3, warped, 10'000);
LACON_BENCH_DERIVATIVES(QUAD8, flat, 2'500);
LACON_BENCH_DERIVATIVES(QUAD8, warped, 2'500);
LACON_BENCH_DERIVATIVES(TRIA6, flat, 2'500);
LACON_BENCH_DERIVATIVES(TRIA6, warped, 2'500);

}  // namespace
