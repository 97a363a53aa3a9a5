#include "lacon/operators/evolution/problem/loads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/problem/static_problem.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/mechanics.hpp"

namespace lacon {

namespace {

// Components of Load::gravity on cells that turn.
constexpr std::string_view angular_velocity[] = {"WX", "WY", "WZ"}, axis_point[] = {"X", "Y", "Z"};

/// What a load's terms become, function by function read once.
class Reader {
 public:
  Reader(const StaticProblem& problem, const Base& base, std::string label)
      : problem_(problem), base_(base), label_(std::move(label)) {}

  void set(TimedValues& values, std::size_t i, const LoadValue& value, std::span<const double> point) {
    if (value.function.empty()) return values.set(i, value.value);
    auto& function = functions_[value.function];
    if (!function) function = std::make_shared<StudyFunction>(base_, value.function);
    values.set(i, function, point);
  }

  std::int64_t dof(std::int32_t node, const std::string& component) const {
    const auto at = std::find(problem_.components.begin(), problem_.components.end(), component);
    if (at == problem_.components.end())
      fail("LOAD_2", {{"load", label_}, {"component", component}, {"node", node_name(node)}});
    return std::int64_t{node} * problem_.n_components() + (at - problem_.components.begin());
  }

  /// Terms on nodes: unknowns that are imposed, or forces, of which FX acts on DX.
  TimedValues nodal(const std::vector<LoadTerm>& terms, std::vector<std::int64_t>& dofs) {
    TimedValues values(terms.size());
    for (std::size_t i = 0; i < terms.size(); ++i) {
      std::string component = terms[i].component;
      if (component.front() == 'F') component.front() = 'D';
      dofs.push_back(dof(terms[i].place, component));
      set(values, i, terms[i].value, problem_.mesh.point(terms[i].place));
    }
    values.settle();
    return values;
  }

  /// Terms on cells, by kind of cell. @param by_mass the values are for each unit of mass
  void add_cells(const std::vector<LoadTerm>& terms, std::string_view option, bool by_mass, std::vector<LoadedCells>& all) {
    std::vector<std::int32_t> cells;
    for (const LoadTerm& term : terms) cells.push_back(term.place);
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    std::vector<std::vector<std::int32_t>> position;
    std::vector<ElementSet> sets = load_sets(problem_.model, *problem_.registry, option, cells, position);
    std::vector<std::pair<std::size_t, std::size_t>> place(cells.size());  // set and row of each cell
    for (std::size_t s = 0; s < sets.size(); ++s)
      for (std::size_t row = 0; row < position[s].size(); ++row) place[position[s][row]] = {s, row};
    std::vector<std::vector<double>> points;
    const std::size_t first = all.size();
    for (ElementSet& set : sets) {
      points.push_back(integration_points(set, problem_.mesh, problem_.mesh.coordinates));
      const std::size_t size = set.cells.size() * set.tabulation.n_points * n_load_values(*set.kernel);
      all.push_back({std::move(set), TimedValues(size)});
    }
    for (const LoadTerm& term : terms) {
      const auto [s, row] = place[std::lower_bound(cells.begin(), cells.end(), term.place) - cells.begin()];
      LoadedCells& loaded = all[first + s];
      const int width = n_load_values(*loaded.set.kernel), n_points = loaded.set.tabulation.n_points;
      int v = 0;
      while (v < width && term.component != loaded.set.kernel->parameters[v]) ++v;
      if (v == width)
        fail("LOAD_4", {{"load", label_}, {"component", term.component}, {"element", std::string(loaded.set.row->name)}});
      LoadValue value = term.value;
      if (by_mass) value.value *= density(term.place, *loaded.set.row);
      for (int p = 0; p < n_points; ++p) {
        const std::size_t point = row * n_points + p;
        set(loaded.values, point * width + v, value, std::span(points[s]).subspan(3 * point, 3));
      }
    }
    for (std::size_t s = first; s < all.size(); ++s) all[s].values.settle();
  }

  /// The centrifugal force of cells that turn, on the initial geometry.
  void add_rotation(const std::vector<LoadTerm>& terms, std::vector<LoadedCells>& all) {
    struct Turn {
      double velocity[3], point[3];
    };
    std::map<std::int32_t, Turn> turns;
    for (const LoadTerm& term : terms)
      for (std::size_t d = 0; d < 3; ++d) {
        if (term.component == angular_velocity[d]) turns[term.place].velocity[d] = term.value.value;
        if (term.component == axis_point[d]) turns[term.place].point[d] = term.value.value;
      }
    std::vector<std::int32_t> cells;
    for (const auto& [cell, turn] : turns) cells.push_back(cell);
    std::vector<std::vector<std::int32_t>> position;
    for (ElementSet& set : load_sets(problem_.model, *problem_.registry, "CHAR_MECA_FORC", cells, position)) {
      const std::vector<double> points = integration_points(set, problem_.mesh, problem_.mesh.coordinates);
      const auto width = static_cast<std::size_t>(n_load_values(*set.kernel)),
                 n_points = static_cast<std::size_t>(set.tabulation.n_points);
      TimedValues values(set.cells.size() * n_points * width);
      for (std::size_t at = 0; at < set.cells.size() * n_points; ++at) {
        const Turn& turn = turns.at(set.cells[at / n_points]);
        const double mass = density(set.cells[at / n_points], *set.row);
        double along = 0, square = 0, way[3];
        for (std::size_t d = 0; d < 3; ++d) {
          way[d] = points[3 * at + d] - turn.point[d];
          along += turn.velocity[d] * way[d];
          square += turn.velocity[d] * turn.velocity[d];
        }
        for (std::size_t d = 0; d < width; ++d)  // FX, FY, FZ
          values.set(at * width + d, mass * (square * way[d] - along * turn.velocity[d]));
      }
      all.push_back({std::move(set), std::move(values)});
    }
  }

 private:
  double density(std::int32_t cell, const catalog::ElementRow& row) const {
    if (!problem_.materials->has(cell))
      fail("ELEMENT_2", {{"cell", cell_name(cell)}, {"element", std::string(row.name)}, {"count", "1"}});
    return problem_.materials->parameter(cell, "ELAS/RHO", row.name);
  }

  const StaticProblem& problem_;
  const Base& base_;
  std::string label_;
  std::map<std::string, std::shared_ptr<const StudyFunction>> functions_;
};

/// PRE_SIGM: the forces that a field of stresses makes at nodes, on the initial geometry. Throws CREACHAMP_4 where it has other
/// points than the model's elements.
std::vector<LoadTerm> forces_of_stress(const StaticProblem& problem, const Base& base, const std::string& id) {
  const Mesh& mesh = problem.mesh;
  Field stress = base.field(id);
  stress.name = base.label(id);
  ModelPoints points(mesh, problem.model, *problem.registry);
  stress = moved_to(Ground(mesh, points), stress, field_type("ELGA_SIEF_R"), false);
  std::vector<char> bodies(mesh.n_cells());
  for (std::size_t cell = 0; cell < bodies.size(); ++cell) bodies[cell] = points.is_solid(cell);
  stress = restrict_to_cells(stress, bodies);
  const Field forces = nodal_forces(mesh, points, stress, std::vector<char>(mesh.n_cells(), 0), mesh.coordinates,
                                    std::vector<double>(stress.n_rows(), 1.0), "FORC_NODA");
  std::vector<LoadTerm> terms;
  for (std::size_t row = 0; row < forces.n_rows(); ++row)
    for (std::size_t d = 0; d < forces.n_components(); ++d)
      terms.push_back({forces.support[row], forces.components[d], {forces.at(row, d), ""}});
  return terms;
}

bool vary(const TimedLoad& load) {
  return load.nodal.depends_on_time() ||
         std::any_of(load.cells.begin(), load.cells.end(), [](const LoadedCells& c) { return c.values.depends_on_time(); });
}

}  // namespace

std::vector<double> TimedLoad::force(const StaticProblem& problem, double instant) const {
  if (steady) return *steady;
  std::vector<double> sum(problem.n_dofs(), 0.0);
  for (const LoadedCells& loaded : cells)
    evaluate_loads(loaded.set, problem.mesh, problem.mesh.coordinates, loaded.values.at(instant), false,
                   [&](const ElementValues& element) {
                     for (std::size_t i = 0; i < element.dofs.size(); ++i) sum[element.dofs[i]] += element.force[i];
                   });
  const std::vector<double> on_nodes = nodal.at(instant);
  for (std::size_t i = 0; i < nodal_dofs.size(); ++i) sum[nodal_dofs[i]] += on_nodes[i];
  return sum;
}

TimedLoad read_load(const StaticProblem& problem, const Base& base, const ResultLoad& excit, const std::string& path) {
  Load load = base.load(excit.load);
  TimedLoad timed;
  timed.label = base.label(excit.load);
  if (!excit.function.empty()) {
    timed.function.emplace(base, excit.function);
    timed.function->check_parameters(std::array{std::string_view("INST")}, path + "FONC_MULT");
  }
  Reader reader(problem, base, timed.label);
  timed.values = reader.nodal(load.imposed, timed.dofs);
  const auto field = std::find_if(load.nodal.begin(), load.nodal.end(), [](const LoadTerm& term) { return term.place < 0; });
  if (field != load.nodal.end()) {
    const std::vector<LoadTerm> forces = forces_of_stress(problem, base, field->value.function);
    load.nodal.erase(field);
    load.nodal.insert(load.nodal.end(), forces.begin(), forces.end());
  }
  timed.nodal = reader.nodal(load.nodal, timed.nodal_dofs);
  const bool follows = excit.type == "SUIV";
  if (follows &&
      !(load.nodal.empty() && load.force.empty() && load.gravity.empty() && load.strain.empty() && load.relations.empty()))
    fail("LOAD_5", {{"keyword", path + "TYPE_CHARGE"}, {"load", timed.label}});
  reader.add_cells(load.pressure, "CHAR_MECA_PRES", false, follows ? timed.following : timed.cells);
  reader.add_cells(load.force, "CHAR_MECA_FORC", false, timed.cells);
  std::vector<LoadTerm> gravity, rotation;
  for (const LoadTerm& term : load.gravity) (term.component.front() == 'F' ? gravity : rotation).push_back(term);
  reader.add_cells(gravity, "CHAR_MECA_FORC", true, timed.cells);
  reader.add_rotation(rotation, timed.cells);
  timed.relation_values = TimedValues(load.relations.size());
  for (std::size_t r = 0; r < load.relations.size(); ++r) {
    const Relation& relation = load.relations[r];
    DofRelation row{relation.source, {}, {}};
    for (const RelationTerm& term : relation.terms) {
      row.dofs.push_back(reader.dof(term.node, term.component));
      row.coefficients.push_back(term.coefficient);
    }
    reader.set(timed.relation_values, r, relation.value, problem.mesh.point(relation.terms.front().node));
    timed.relations.push_back(std::move(row));
  }
  timed.relation_values.settle();
  if (!vary(timed) && !(timed.cells.empty() && timed.nodal_dofs.empty())) timed.steady = timed.force(problem, 0.0);
  return timed;
}

Pressure largest_pressure(const StaticProblem& problem, double instant) {
  Pressure largest;
  for (const TimedLoad& load : problem.loads) {
    const double factor = std::abs(load.multiplier(instant));
    for (const std::vector<LoadedCells>* const loads : {&load.cells, &load.following})
      for (const LoadedCells& loaded : *loads) {
        if (loaded.set.option != "CHAR_MECA_PRES") continue;
        const std::vector<double> values = loaded.values.at(instant);
        const std::size_t width = values.size() / std::max<std::size_t>(loaded.set.cells.size(), 1);
        for (std::size_t i = 0; i < values.size(); ++i)
          if (const double value = factor * std::abs(values[i]); value > largest.value)
            largest = {value, loaded.set.cells[i / width]};
      }
  }
  return largest;
}

}  // namespace lacon
