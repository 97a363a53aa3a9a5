// From elements to a factor by Google Benchmark: pattern and sums of element matrices, elements evaluated and added, and on a
// cube of n^3 HEXA8 analysis, factorisation and solution by MUMPS.
#include <numeric>

#include "bench.hpp"
#include "lacon/assembly/element_sets.hpp"
#include "lacon/assembly/mumps_engine.hpp"
#include "yardsticks.hpp"

namespace {

using namespace lacon;

/// An elastic box of one kind of cell with nothing held, and its matrix.
struct Body {
  Mesh mesh;
  Model model;
  MaterialField field;
  Registry registry;
  std::vector<ElementSet> sets;
  Numbering numbering;
  Ragged<std::int32_t> cliques;

  Body(CellType type, int n) : mesh(bench::box(type, n, n)) {
    model.elements = {"3D/" + bench::name_of(type)};
    Behaviours behaviours{{"ELAS/PETIT"}, {}};
    for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
      const bool solid = mesh.types[c] == type;
      model.element.push_back(solid ? 0 : -1);
      field.material.push_back(solid ? 0 : -1);
      behaviours.of_cell.push_back(solid ? 0 : -1);
      if (solid) cliques.push_back(mesh.cells[c]);
    }
    field.materials = {"material_1"};
    const MaterialTable materials(field, {{{{"ELAS", {{"E", 2000.0}, {"NU", 0.3}}}}}}, {"STEEL"});
    sets = solid_sets(mesh, model, registry, materials, behaviours);
    numbering = number_equations(static_cast<std::int64_t>(mesh.n_nodes()), 3,
                                 std::vector<std::uint8_t>(mesh.coordinates.size(), 1), 0);
  }
  double n_elements() const { return static_cast<double>(cliques.size()); }
  /// The lower triangle of an element matrix.
  double matrix_bytes() const {
    const double n = 3.0 * static_cast<double>(cliques[0].size());
    return sizeof(double) * n * (n + 1) / 2;
  }
  void equations_of(std::span<const std::int32_t> nodes, std::vector<std::int64_t>& equations) const {
    equations.clear();
    for (const std::int32_t node : nodes)
      for (int d = 0; d < 3; ++d) equations.push_back(numbering.of(node, d));
  }
};

void pattern(benchmark::State& state, CellType type) {
  const Body body(type, static_cast<int>(state.range(0)));
  std::int64_t entries = 0;
  for (auto run : state) entries = SparseMatrix(body.numbering, body.cliques, {}).n_entries();
  bench::report(state, {.items = body.n_elements(), .bytes = 12.0 * static_cast<double>(entries)});
}

/// One element matrix into all places: read, the sum read and written.
void add(benchmark::State& state, CellType type) {
  const Body body(type, static_cast<int>(state.range(0)));
  SparseMatrix matrix(body.numbering, body.cliques, {});
  const std::vector<double> lower(static_cast<std::size_t>(body.matrix_bytes() / sizeof(double)), 1.0);
  std::vector<std::int64_t> equations;
  for (auto run : state)
    for (std::size_t c = 0; c < body.cliques.size(); ++c) {
      body.equations_of(body.cliques[c], equations);
      matrix.add(equations, lower);
    }
  bench::report(state, {.items = body.n_elements(), .bytes = 3 * body.matrix_bytes() * body.n_elements()});
}

/// The loop of a Newton iteration: kernels, and their matrices into the sum (LACON_THREADS threads).
void assemble(benchmark::State& state, CellType type) {
  const Body body(type, static_cast<int>(state.range(0)));
  SparseMatrix matrix(body.numbering, body.cliques, {});
  const std::vector<double> displacement(body.mesh.coordinates.size(), 0.0);
  std::vector<std::int64_t> equations;
  for (auto run : state)
    for (const ElementSet& set : body.sets)
      evaluate_solids(set, body.mesh, {.displacement = displacement}, SolidMatrix::tangent, {},
                      [&](const ElementValues& element) {
                        body.equations_of(body.mesh.cells[element.cell], equations);
                        matrix.add(equations, element.matrix);
                      });
  bench::report(state, {.items = body.n_elements(), .bytes = 3 * body.matrix_bytes() * body.n_elements()});
}

/// The matrix of a cube of n^3 HEXA8, analysed where that is not what is measured; factors in double precision.
struct Cube {
  Numbering numbering;
  SparseMatrix matrix;
  MumpsEngine engine{{.single_precision = MumpsOptions::Use::never}};

  explicit Cube(const benchmark::State& state)
      : numbering(bench::cube_numbering(static_cast<int>(state.range(0)))),
        matrix(bench::cube_matrix(numbering, static_cast<int>(state.range(0)))) {
    engine.analyse(matrix);
  }
  double size() const { return static_cast<double>(matrix.size()); }
};

void analyse(benchmark::State& state) {
  Cube cube(state);
  for (auto run : state) cube.engine.analyse(cube.matrix);
  bench::report(state, {.items = cube.size()});
}

void factor(benchmark::State& state) {
  Cube cube(state);
  Factorisation found;
  for (auto run : state) found = cube.engine.factorise(cube.matrix);
  bench::report(state, {.items = cube.size(), .flops = found.flops});
}

void substitute(benchmark::State& state) {
  Cube cube(state);
  const Factorisation found = cube.engine.factorise(cube.matrix);
  std::vector<double> side(static_cast<std::size_t>(cube.matrix.size()), 1.0);
  for (auto run : state) cube.engine.substitute(side);
  // every entry of the factor is used twice: forward and backward
  bench::report(state, {.items = cube.size(),
                        .flops = 4.0 * static_cast<double>(found.entries),
                        .bytes = 2 * sizeof(double) * static_cast<double>(found.entries)});
}

const bool registered = [] {
  const std::pair<const char*, void (*)(benchmark::State&, CellType)> of_elements[] = {
      {"pattern", pattern}, {"add", add}, {"assemble", assemble}};
  const std::pair<CellType, int> bodies[] = {{CellType::HEXA8, 40}, {CellType::TETRA10, 12}, {CellType::HEXA20, 16}};
  for (const auto& [what, work] : of_elements)
    for (const auto& [type, n] : bodies)
      benchmark::RegisterBenchmark((std::string(what) + " " + bench::name_of(type)).c_str(), work, type)
          ->Arg(n)
          ->Unit(benchmark::kMillisecond);
  const std::pair<const char*, void (*)(benchmark::State&)> of_cubes[] = {
      {"analyse", analyse}, {"factor", factor}, {"substitute", substitute}};
  for (const auto& [what, work] : of_cubes)
    benchmark::RegisterBenchmark((std::string(what) + " cube").c_str(), work)->Arg(20)->Arg(30)->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
