#pragma once
// Two unit squares of one QUAD8 each, the upper one (slave) on the lower one (master), in plane strain: nodes 0 to 7 and 8
// to 15.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "lacon/operators/evolution/problem/static_problem.hpp"

namespace lacon::test {

constexpr double young = 2000.0, poisson = 0.3, pressure = 25.0, temperature = 1e6;

/// Nodes of the bottom, of both sides' axis, and of the middle of the slave skin.
inline const std::vector<std::int64_t> bottom{0, 1, 4}, axis{0, 3, 7, 8, 11, 15};
enum Cell : std::int32_t { master_skin, slave_skin, loaded_skin, lower_body, upper_body };

/// The problem without loads and equations. @param option "ELAS/PETIT"
/// @param modelisation D_PLAN or one of the plug-in in `folders`
inline StaticProblem two_squares(const std::string& option, bool contact, const std::string& modelisation = "D_PLAN",
                                 std::span<const std::filesystem::path> folders = {}) {
  StaticProblem problem;
  problem.mesh.dimension = 2;
  constexpr double corner[8][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}};
  for (const double bottom_of : {-1.0, 0.0})
    for (const auto& [x, y] : corner) problem.mesh.coordinates.insert(problem.mesh.coordinates.end(), {x, bottom_of + y, 0.0});
  const std::vector<std::int32_t> skins[] = {{2, 3, 6}, {8, 9, 12}, {10, 11, 14}};
  for (const auto& nodes : skins) problem.mesh.add_cell(CellType::SEG3, nodes);
  for (const std::int32_t first : {0, 8}) {
    std::vector<std::int32_t> nodes;
    for (std::int32_t i = 0; i < 8; ++i) nodes.push_back(first + i);
    problem.mesh.add_cell(CellType::QUAD8, nodes);
  }
  problem.model = {.mesh = {},
                   .phenomenon = "MECANIQUE",
                   .dimension = 2,
                   .elements = {modelisation + "/SEG3", modelisation + "/QUAD8"},
                   .element = {0, 0, 0, 1, 1}};
  problem.registry = std::make_unique<Registry>(folders);
  problem.components = node_unknowns(problem.model, *problem.registry);
  problem.material_field = std::make_unique<MaterialField>();
  problem.material_field->material.assign(5, 0);
  problem.materials = std::make_unique<MaterialTable>(
      *problem.material_field,
      std::vector<Material>{
          {{{"ELAS", {{"E", young}, {"NU", poisson}}}, {"ECRO_LINE", {{"SY", 10.0}, {"D_SIGM_EPSI", 100.0}}}}}},
      std::vector<std::string>{"STEEL"});
  problem.solids = solid_sets(problem.mesh, problem.model, *problem.registry, *problem.materials,
                              {{option}, std::vector<std::int32_t>(5, 0)});
  problem.exists.assign(problem.components.size() * problem.mesh.n_nodes(), 1);
  problem.imposed.assign(problem.exists.size(), 0);
  if (!contact) return problem;
  Patches& patches = problem.mesh.patches.emplace();
  patches.kind = {14};  // one SEG3, whose middle node carries LAGS_C
  patches.cells.push_back(std::vector<std::int32_t>{slave_skin});
  patches.carriers.push_back(std::vector<std::int32_t>{12});
  Contact& data = problem.contact.emplace();
  data.zones.push_back({.slave_group = "SLAVE",
                        .master_group = "MASTER",
                        .slave = {slave_skin},
                        .master = {master_skin},
                        .patches = {0},
                        .jacobian = "INITIAL",
                        .search = "RAPIDE",
                        .initial_status = "INTERPENETRE"});
  data.slaves.push_back({slave_skin, 0, 0, "LACS32D"});
  return problem;
}

/// Impose components of nodes.
inline TimedLoad hold(const std::vector<std::int64_t>& nodes, int component, double value = 0, int n_components = 2) {
  TimedLoad load;
  load.label = "HOLD";
  load.values = TimedValues(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    load.dofs.push_back(n_components * nodes[i] + component);
    load.values.set(i, value);
  }
  return load;
}

/// A pressure on the loaded skin.
inline TimedLoad press(const StaticProblem& problem, double value, bool following) {
  std::vector<std::vector<std::int32_t>> position;
  const std::vector<std::int32_t> cells{loaded_skin};
  std::vector<ElementSet> sets = load_sets(problem.model, *problem.registry, "CHAR_MECA_PRES", cells, position);
  TimedLoad load;
  load.label = "PRESS";
  for (ElementSet& set : sets) {
    const auto n_values = static_cast<std::size_t>(n_load_values(*set.kernel));  // the pressure is the first of them
    TimedValues values(static_cast<std::size_t>(set.tabulation.n_points) * n_values);
    for (std::size_t i = 0; i < values.size(); i += n_values) values.set(i, value);
    (following ? load.following : load.cells).push_back({std::move(set), std::move(values)});
  }
  return load;
}

/// Number the equations, once all loads are there.
inline void number(StaticProblem& problem) {
  std::int64_t multipliers = problem.n_patches();
  for (const TimedLoad& load : problem.loads) {
    for (const std::int64_t dof : load.dofs) problem.imposed[dof] = 1;
    multipliers += static_cast<std::int64_t>(load.relations.size());
  }
  std::vector<std::uint8_t> free(problem.n_dofs());
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = problem.exists[i] && !problem.imposed[i];
  problem.numbering =
      number_equations(static_cast<std::int64_t>(problem.mesh.n_nodes()), problem.n_components(), free, multipliers);
}

/// Held below and on its axis, pressed from above.
inline StaticProblem pressed_squares(const std::string& option = "ELAS/PETIT", bool following = false) {
  StaticProblem problem = two_squares(option, true);
  problem.loads.push_back(hold(bottom, 1));
  problem.loads.push_back(hold(axis, 0));
  problem.loads.push_back(press(problem, pressure, following));
  number(problem);
  return problem;
}

/// The same with a TEMP at each node, on which no kernel works: rows of a plug-in in `folder`, which name those of D_PLAN.
inline StaticProblem wide_squares(const std::filesystem::path& folder, const std::string& option, bool following) {
  std::filesystem::create_directories(folder);
  const std::string head =
      "[[element]]\nmodelisation = 'WIDE'\nphenomenon = 'MECANIQUE'\ngeometry = 'plane'\ndofs = ['DX', 'DY', 'TEMP']\n";
  std::ofstream(folder / "plugin.toml")
      << head << "role = 'solid'\nstress_state = 'plane_strain'\npoints = { QUAD8 = 9 }\n"
      << "stress = ['SIXX', 'SIYY', 'SIZZ', 'SIXY']\nkernels = { 'ELAS/PETIT' = 'solid/plane_strain_small_elastic', "
      << "'ELAS/GREEN_LAGRANGE' = 'solid/plane_strain_green_elastic' }\n"
      << head << "role = 'skin'\npoints = { SEG3 = 4 }\nstress = []\n"
      << "kernels = { CHAR_MECA_PRES = 'load/pressure_2d', RIGI_CONT = 'contact/lac_2d' }\n";
  StaticProblem problem = two_squares(option, true, "WIDE", std::array{folder});
  const int n = problem.n_components();
  std::vector<std::int64_t> all(problem.mesh.n_nodes());
  std::iota(all.begin(), all.end(), 0);
  problem.loads.push_back(hold(bottom, 1, 0, n));
  problem.loads.push_back(hold(axis, 0, 0, n));
  problem.loads.push_back(press(problem, pressure, following));
  problem.loads.push_back(hold(all, 2, temperature, n));
  number(problem);
  return problem;
}

inline std::vector<double> random_vector(std::size_t n, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<double> values(n);
  for (double& value : values) value = uniform(random);
  return values;
}

}  // namespace lacon::test
