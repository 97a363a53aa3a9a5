#include "lacon/operators/evolution/problem/static_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "lacon/assembly/solid_step.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/problem/behaviours.hpp"
#include "lacon/operators/evolution/problem/prestrain.hpp"
#include "lacon/operators/evolution/problem/relations.hpp"
#include "lacon/operators/evolution/problem/revolution_axis.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

/// The degrees of freedom that the elements' nodes have.
void find_dofs(StaticProblem& problem) {
  const std::vector<std::string>& all = problem.components = node_unknowns(problem.model, *problem.registry);
  problem.dimension = problem.model.dimension;
  problem.exists.assign(problem.mesh.n_nodes() * all.size(), 0);
  std::vector<std::vector<std::size_t>> columns;  // of each element
  for (const std::string& name : problem.model.elements) {
    columns.emplace_back();
    for (const std::string_view dof : problem.registry->find_element(name)->dofs)
      columns.back().push_back(static_cast<std::size_t>(std::find(all.begin(), all.end(), dof) - all.begin()));
  }
  for (std::size_t c = 0; c < problem.mesh.n_cells(); ++c) {
    if (problem.model.element[c] < 0) continue;
    for (const std::int32_t node : problem.mesh.cells[c])
      for (const std::size_t column : columns[problem.model.element[c]]) problem.exists[node * all.size() + column] = 1;
  }
}

void read_materials(StaticProblem& problem, const Base& base, const std::string& field) {
  problem.material_field = std::make_unique<MaterialField>(base.material_field(field));
  if (problem.material_field->mesh != problem.model.mesh)
    fail("EVOLUTION_1", {{"first", "CHAM_MATER"}, {"second", "MODELE"}, {"what", part("meshes")}});
  MaterialTemperatures temperatures = read_temperatures(base, field, problem.mesh);
  problem.materials = std::make_unique<MaterialTable>(lacon::read_materials(base, *problem.material_field, temperatures));
  problem.thermal = std::make_unique<ThermalMaterials>(base, *problem.material_field, std::move(temperatures));
}

/// THERMAL_8: materials whose temperature does nothing.
void warn_of_idle_temperatures(const StaticProblem& problem) {
  std::map<std::string, std::pair<std::int64_t, std::int32_t>> idle;  // cells and the first one
  for (const ElementSet& set : problem.solids)
    for (const std::int32_t cell : set.cells)
      if (const auto material = problem.thermal->idle(cell)) ++idle.try_emplace(*material, 0, cell).first->second.first;
  for (const auto& [material, cells] : idle)
    inform("THERMAL_8", {{"material", material}, {"count", std::to_string(cells.first)}, {"cell", cell_name(cells.second)}});
}

/// Whether the law takes the slope of ECRO_LINE by its curve, which does not follow E.
bool has_rigid_slope(const StaticProblem& problem, const ElementSet& set) {
  return set.kernel->takes_curve && behaviour_rows(*problem.registry, set.option).relation.hardening == "ECRO_LINE" &&
         !parameter_place(set, "ECRO_LINE/D_SIGM_EPSI");
}

/// Keep temperatures, and functions of them, only where solids are concerned. Throws BEHAVIOUR_5 for a law that takes none.
void check_temperatures(StaticProblem& problem) {
  warn_of_idle_temperatures(problem);
  bool any = false;
  const auto concerned = [&](std::int32_t cell) { return problem.thermal->concerns(cell); };
  for (const ElementSet& set : problem.solids) {
    const auto cell = std::ranges::find_if(set.cells, concerned);
    if (cell == set.cells.end()) continue;
    any = true;
    // stresses that turn with the body do not keep their elastic strain where moduli change
    const bool turns = set.kernel->has_memory && behaviour_rows(*problem.registry, set.option).deformation.turns_stress;
    if (!(set.kernel->takes_thermal_strain || starts_elastically(*problem.registry, set)) ||
        ((turns || has_rigid_slope(problem, set)) && problem.thermal->has_functions(set.cells)))
      fail("BEHAVIOUR_5", {{"behaviour", set.option}, {"cell", cell_name(*cell)}});
  }
  if (!any) problem.thermal.reset();
}

/// Say what V1, V2 of VARI_ELGA are under each behaviour that has internal variables.
void name_variables(const std::vector<ElementSet>& solids) {
  std::vector<std::pair<std::string, std::string>> said;
  for (const ElementSet& set : solids) {
    std::string names;
    for (int v = 0; v < set.n_point_variables; ++v)
      names += fmt::format("{}V{} = {}", v ? ", " : "", v + 1, set.kernel->variables[v]);
    const std::pair text(set.option, names);
    if (names.empty() || std::find(said.begin(), said.end(), text) != said.end()) continue;
    inform("BEHAVIOUR_4", {{"behaviour", set.option}, {"names", names}});
    said.push_back(text);
  }
}

/// A model with its degrees of freedom, before materials and loads.
StaticProblem read_model(const Order& order, const Base& base, const std::string& model_id) {
  StaticProblem problem;
  problem.model = base.model(model_id);
  problem.mesh = base.mesh(problem.model.mesh);
  problem.plugins = order.plugins;
  problem.registry = std::make_unique<Registry>(problem.plugins);
  find_dofs(problem);
  return problem;
}

}  // namespace

std::vector<double> StaticProblem::dead_force(double instant) const {
  std::vector<double> force(n_dofs(), 0.0);
  for (const TimedLoad& load : loads) {
    if (load.cells.empty() && load.nodal_dofs.empty()) continue;
    const double factor = load.multiplier(instant);
    const std::vector<double> own = load.force(*this, instant);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] += factor * own[i];
  }
  return force;
}

bool StaticProblem::has_following_loads() const {
  return std::any_of(loads.begin(), loads.end(), [](const TimedLoad& load) { return !load.following.empty(); });
}

void StaticProblem::following_forces(
    double instant, std::span<const double> displacement, bool with_matrix,
    const std::function<void(std::span<const std::int64_t>, std::span<const double>, std::span<const double>)>& use) const {
  if (!has_following_loads()) return;
  std::vector<double> coordinates;
  displace(mesh, displacement, dimension, coordinates);
  for (const TimedLoad& load : loads) {
    if (load.following.empty()) continue;
    const double factor = load.multiplier(instant);
    for (const LoadedCells& loaded : load.following) {
      std::vector<double> values = loaded.values.at(instant);
      for (double& value : values) value *= factor;
      evaluate_loads(loaded.set, mesh, coordinates, values, with_matrix,
                     [&](const ElementValues& element) { use(element.dofs, element.force, element.matrix); });
    }
  }
}

std::vector<double> StaticProblem::external_force(double instant, std::span<const double> displacement) const {
  std::vector<double> sum = dead_force(instant);
  following_forces(instant, displacement, false,
                   [&](std::span<const std::int64_t> dofs, std::span<const double> force, std::span<const double>) {
                     for (std::size_t i = 0; i < dofs.size(); ++i) sum[dofs[i]] += force[i];
                   });
  return sum;
}

std::vector<double> StaticProblem::imposed_values(double instant) const {
  std::vector<double> values(n_dofs(), 0.0);
  std::vector<const TimedLoad*> by(n_dofs(), nullptr);
  for (const TimedLoad& load : loads) {
    if (load.dofs.empty()) continue;
    const double factor = load.multiplier(instant);
    const std::vector<double> own = load.values.at(instant);
    for (std::size_t i = 0; i < load.dofs.size(); ++i) {
      const std::int64_t dof = load.dofs[i];
      const double value = factor * own[i];
      if (by[dof] && std::abs(value - values[dof]) > 1e-12 * std::max(std::abs(value), std::abs(values[dof])))
        fail("LOAD_1", {{"dof", dof_name(dof)},
                        {"first", by[dof]->label},
                        {"first_value", fmt::format("{:.15g}", values[dof])},
                        {"second", load.label},
                        {"second_value", fmt::format("{:.15g}", value)},
                        {"instant", fmt::format("{:.15g}", instant)}});
      by[dof] = &load;
      values[dof] = value;
    }
  }
  return values;
}

bool StaticProblem::is_of_revolution() const {
  return std::ranges::any_of(solids, [](const ElementSet& set) { return set.row->geometry == catalog::Geometry::axis; });
}

std::string StaticProblem::dof_name(std::int64_t dof) const {
  return node_name(dof / n_components()) + " " + components[dof % n_components()];
}

namespace {

constexpr double nearly_incompressible =
    0.49;  // bulk over shear modulus 50: fully integrated linear cells bend far too stiffly

/// EVOLUTION_37: a discrete element without characteristics would be none.
void check_springs(const StaticProblem& problem) {
  std::size_t count = 0;
  for (const std::int32_t element : problem.model.element)
    count += element >= 0 && problem.registry->find_element(problem.model.elements[element])->role == catalog::Role::discrete;
  if (count > problem.springs.size())
    fail("EVOLUTION_37", {{"count", std::to_string(count)}, {"springs", std::to_string(problem.springs.size())}});
}

/// EVOLUTION_21: linear cells, without plane stress, of a material that hardly changes its volume.
void warn_of_locking(const StaticProblem& problem) {
  std::int64_t count = 0;
  std::int32_t first = -1;
  double largest = 0;
  for (const ElementSet& set : problem.solids) {
    if (catalog::cell(set.row->cell).order > 1 || set.row->stress_state == catalog::StressState::plane_stress) continue;
    for (const std::int32_t cell : set.cells) {
      const double poisson = problem.materials->find(cell, "ELAS/NU").value_or(0);
      if (poisson <= nearly_incompressible) continue;
      if (count++ == 0) first = cell;
      largest = std::max(largest, poisson);
    }
  }
  if (count > 0)
    inform("EVOLUTION_21",
           {{"count", std::to_string(count)}, {"cell", cell_name(first)}, {"value", fmt::format("{:g}", largest)}});
}

/// BEHAVIOUR_7: body cells that COMPORTEMENT leaves out; BEHAVIOUR_8: elastic ones whose material has a tension curve.
void warn_of_other_behaviours(const StaticProblem& problem, const std::vector<Keywords>& occurrences) {
  const std::vector<bool> named = named_cells(problem.mesh, occurrences);
  struct Found {
    std::int64_t count = 0;
    std::int32_t first = -1;
    void add(std::int32_t cell) {
      if (count++ == 0) first = cell;
    }
  } left_out;
  std::set<std::string_view> curves;  // several laws take the same
  for (const catalog::RelationRow& law : catalog::relations())
    if (!law.hardening.empty()) curves.insert(law.hardening);
  std::map<std::pair<std::int32_t, std::string_view>, Found> elastic;  // by material and keyword of its curve
  for (const ElementSet& set : problem.solids)
    for (const std::int32_t cell : set.cells) {
      if (!named[static_cast<std::size_t>(cell)]) left_out.add(cell);
      if (set.option.starts_with("ELAS/"))
        for (const std::string_view curve : curves)
          if (problem.materials->has_law(cell, std::string(curve))) elastic[{problem.materials->of(cell), curve}].add(cell);
    }
  if (left_out.count > 0)
    inform("BEHAVIOUR_7", {{"count", std::to_string(left_out.count)}, {"cell", cell_name(left_out.first)}});
  for (const auto& [material, found] : elastic)
    inform("BEHAVIOUR_8", {{"material", problem.materials->label(found.first)},
                           {"keyword", std::string(material.second)},
                           {"count", std::to_string(found.count)},
                           {"cell", cell_name(found.first)}});
}

}  // namespace

StaticProblem read_problem(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const std::string model_id = keywords.concept_id("MODELE");
  StaticProblem problem = read_model(order, base, model_id);

  read_materials(problem, base, keywords.concept_id("CHAM_MATER"));
  problem.solids = solid_sets(problem.mesh, problem.model, *problem.registry, *problem.materials,
                              read_behaviours(problem.mesh, keywords.factors("COMPORTEMENT")));
  warn_of_other_behaviours(problem, keywords.factors("COMPORTEMENT"));
  name_variables(problem.solids);
  warn_of_locking(problem);
  check_temperatures(problem);

  if (const auto given = keywords.optional_concept("CARA_ELEM")) {
    const ElementCharacteristics characteristics = base.element_characteristics(*given);
    if (characteristics.model != model_id)
      fail("EVOLUTION_1", {{"first", "CARA_ELEM"}, {"second", "MODELE"}, {"what", part("models")}});
    problem.springs = characteristics.springs;
  }
  check_springs(problem);

  problem.imposed.assign(problem.n_dofs(), 0);
  std::vector<std::string> seen;
  ModelPoints points(problem.mesh, problem.model, *problem.registry);
  for (const Keywords& excit : keywords.factors("EXCIT")) {
    const std::string load_id = excit.concept_id("CHARGE");
    if (std::find(seen.begin(), seen.end(), load_id) != seen.end())
      fail("LOAD_3", {{"keyword", excit.path("CHARGE")}, {"load", base.label(load_id)}});
    seen.push_back(load_id);
    if (base.load(load_id).model != model_id)
      fail("EVOLUTION_1", {{"first", excit.path("CHARGE")}, {"second", "MODELE"}, {"what", part("models")}});
    const std::vector<HeldDirection> held = held_directions(problem.mesh, std::vector{base.load(load_id)});
    problem.held.insert(problem.held.end(), held.begin(), held.end());
    const ResultLoad load{load_id, excit.optional_concept("FONC_MULT").value_or(""), excit.text("TYPE_CHARGE")};
    problem.loads.push_back(read_load(problem, base, load, excit.path("")));
    problem.initial_strains.add(base, load, problem.mesh, points);
    for (const std::int64_t dof : problem.loads.back().dofs) problem.imposed[dof] = 1;
  }
  check_laws(*problem.registry, problem.initial_strains, problem.solids);
  tell_of_axis(problem);
  if (const auto contact = keywords.optional_concept("CONTACT")) {
    problem.contact = base.contact(*contact);
    if (problem.contact->model != model_id)
      fail("EVOLUTION_1", {{"first", "CONTACT"}, {"second", "MODELE"}, {"what", part("models")}});
    problem.model = problem.contact->completed(std::move(problem.model));
    problem.offsets.emplace(problem.mesh, *problem.contact, base);
  }
  std::vector<std::uint8_t> free(problem.n_dofs());
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = problem.exists[i] && !problem.imposed[i];
  std::int64_t n_multipliers = problem.n_patches();
  for (const TimedLoad& load : problem.loads) n_multipliers += static_cast<std::int64_t>(load.relations.size());
  problem.numbering =
      number_equations(static_cast<std::int64_t>(problem.mesh.n_nodes()), problem.n_components(), free, n_multipliers);
  Relations(problem).tell_dependent();
  return problem;
}

StaticProblem read_loads(const Order& order, const Base& base, const Result& result, const ResultStage& stage) {
  StaticProblem problem = read_model(order, base, result.model);
  if (!result.material_field.empty()) read_materials(problem, base, result.material_field);
  for (const ResultLoad& load : stage.loads) problem.loads.push_back(read_load(problem, base, load, "EXCIT/"));
  return problem;
}

}  // namespace lacon
