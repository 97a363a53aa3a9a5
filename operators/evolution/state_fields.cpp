#include "lacon/operators/evolution/state_fields.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/contact/contact_field.hpp"
#include "lacon/operators/evolution/prestrain.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/internal_variables.hpp"
#include "lacon/structures/displacement.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {
namespace {

/// A field that has all of its values says so by an empty mask.
void clear_if_whole(Field& field) {
  if (std::all_of(field.present.begin(), field.present.end(), [](std::uint8_t p) { return p == Field::there; }))
    field.present.clear();
}

/// Fill a field at integration points from the values of the solid sets, (cells, points, components of the set). Cells are in
/// ascending order, whatever set they belong to; a set without components is left out.
void fill_points(Field& field, const StaticProblem& problem,
                 const std::function<std::vector<std::string>(const ElementSet&)>& components_of,
                 const std::function<std::span<const double>(std::size_t)>& values_of) {
  struct Place {
    std::int32_t cell;
    std::size_t set, index;
  };
  std::vector<Place> places;
  std::vector<std::vector<int>> components;  // of each set, in the field
  for (std::size_t s = 0; s < problem.solids.size(); ++s) {
    const std::vector<std::string> names = components_of(problem.solids[s]);
    components.emplace_back();
    for (const std::string& name : names) {
      if (field.component(name) < 0) field.components.push_back(name);
      components.back().push_back(field.component(name));
    }
    if (names.empty()) continue;
    for (std::size_t i = 0; i < problem.solids[s].cells.size(); ++i) places.push_back({problem.solids[s].cells[i], s, i});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.cell < b.cell; });
  std::size_t rows = 0;
  for (const Place& place : places) rows += static_cast<std::size_t>(problem.solids[place.set].tabulation.n_points);
  field.values.reserve(rows * field.n_components());  // the largest field there is: no more than its size
  field.present.reserve(rows * field.n_components());
  field.support.reserve(places.size());
  field.offset.reserve(places.size() + 1);
  for (const Place& place : places) {
    const std::vector<int>& own = components[place.set];
    const std::size_t n_points = problem.solids[place.set].tabulation.n_points;
    const std::span<const double> values = values_of(place.set).subspan(place.index * n_points * own.size());
    field.support.push_back(place.cell);
    for (std::size_t p = 0; p < n_points; ++p) {
      const std::size_t first = field.values.size();
      field.values.resize(first + field.n_components(), 0.0);
      field.present.resize(first + field.n_components(), 0);
      for (std::size_t k = 0; k < own.size(); ++k) {
        field.values[first + own[k]] = values[p * own.size() + k];
        field.present[first + own[k]] = 1;
      }
    }
    field.offset.push_back(field.offset.back() + static_cast<std::int64_t>(n_points));
  }
  clear_if_whole(field);
}

std::vector<std::string> stress_names(const ElementSet& set) { return {set.row->stress.begin(), set.row->stress.end()}; }

std::vector<std::string> variable_names(const ElementSet& set) {
  std::vector<std::string> names;
  for (int v = 1; v <= set.n_point_variables; ++v) names.push_back("V" + std::to_string(v));
  return names;
}

/// Where a cell or a node is in the support of a field; -1 elsewhere. @param size of the mesh
std::vector<std::int32_t> places_in(const Field& field, std::size_t size) {
  std::vector<std::int32_t> place(size, -1);
  for (std::size_t i = 0; i < field.support.size(); ++i) place[field.support[i]] = static_cast<std::int32_t>(i);
  return place;
}

/// The values of one set in a field that fill_points() made: (cells, points, components of the set). Throws EVOLUTION_11.
std::vector<double> points_of(const Field& field, const std::vector<std::int32_t>& place, const ElementSet& set,
                              const std::vector<std::string>& names, const std::string& label) {
  std::vector<double> values;
  for (const std::int32_t cell : set.cells) {
    const auto refuse = [&] { fail("EVOLUTION_11", {{"label", label}, {"field", field.name}, {"cell", cell_name(cell)}}); };
    if (place[cell] < 0) refuse();
    const std::size_t first = field.first_row(place[cell]), end = field.first_row(place[cell] + 1);
    if (end - first != static_cast<std::size_t>(set.tabulation.n_points)) refuse();
    for (std::size_t row = first; row < end; ++row)
      for (const std::string& name : names) {
        const int component = field.component(name);
        if (component < 0 || !field.has(row, component)) refuse();
        values.push_back(field.at(row, component));
      }
  }
  return values;
}

bool has_variables(const StaticProblem& problem) {
  return std::any_of(problem.solids.begin(), problem.solids.end(),
                     [](const ElementSet& set) { return set.n_point_variables > 0; });
}

bool has_field(const Result& result, const std::string& name, std::int64_t order) {
  const auto named = result.fields.find(name);
  return named != result.fields.end() && named->second.contains(order);
}

}  // namespace

FieldMakers fields_of(const Present& present) {
  const StaticProblem& problem = present.problem;
  const StaticState& state = present.state;
  FieldMakers fields;
  const ContactState* const contact = present.contact;
  fields["DEPL"] = [&, contact] { return displacement_field(problem, state, contact); };
  fields["SIEF_ELGA"] = [&] { return stress_field(problem, state); };
  if (has_variables(problem)) fields["VARI_ELGA"] = [&] { return variable_field(problem, state); };
  if (contact) {
    fields["CONT_ELEM"] = [&, contact] { return contact_field(*problem.contact, contact->geometry(), state.patches); };
    fields["CONT_NOEU"] = [&, contact] { return nodal_contact_field(problem.mesh, *problem.contact, *contact, state.patches); };
  }
  return fields;
}

FieldMakers observed_fields_of(const Present& present) {
  FieldMakers fields = fields_of(present);
  fields["FORC_NODA"] = [&problem = present.problem, forces = present.internal_forces] {
    return nodal_field(problem, forces());
  };
  return fields;
}

Field nodal_field(const StaticProblem& problem, std::span<const double> values) {
  Field field{.name = "FORC_NODA", .quantity = "DEPL_R", .location = Location::nodes, .components = problem.components};
  const std::size_t width = field.components.size();
  for (std::size_t node = 0; node < problem.mesh.n_nodes(); ++node) {
    const auto exists = std::span(problem.exists).subspan(node * width, width);
    if (!exists[0]) continue;
    field.support.push_back(static_cast<std::int32_t>(node));
    field.values.insert(field.values.end(), values.begin() + node * width, values.begin() + (node + 1) * width);
    field.present.insert(field.present.end(), exists.begin(), exists.end());
  }
  clear_if_whole(field);
  return field;
}

Field displacement_field(const StaticProblem& problem, const StaticState& state, const ContactState* contact) {
  Field field{.name = "DEPL", .quantity = "DEPL_R", .location = Location::nodes, .components = problem.components};
  if (problem.contact) field.components.emplace_back("LAGS_C");
  const std::size_t width = field.components.size(), own = problem.components.size();
  std::vector<std::int32_t> row(problem.mesh.n_nodes(), -1);
  for (std::size_t node = 0; node < problem.mesh.n_nodes(); ++node) {
    if (!problem.exists[node * own]) continue;
    row[node] = static_cast<std::int32_t>(field.support.size());
    field.support.push_back(static_cast<std::int32_t>(node));
    for (std::size_t c = 0; c < width; ++c) {
      field.values.push_back(c < own ? state.displacement[node * own + c] : 0.0);
      field.present.push_back(c < own && problem.exists[node * own + c]);
    }
  }
  if (contact)
    for (const auto& [node, pressure] : nodal_pressures(problem.mesh, *problem.contact, contact->geometry(), state.patches)) {
      field.at(row[node], own) = pressure;
      field.present[row[node] * width + own] = Field::stand_in;
    }
  if (problem.contact)
    for (std::size_t p = 0; p < problem.mesh.patches->size(); ++p)
      for (const std::int32_t node : problem.mesh.patches->carriers[p]) {
        field.at(row[node], own) = state.patches.lambda[p];
        field.present[row[node] * width + own] = 1;
      }
  clear_if_whole(field);
  return field;
}

namespace {

/// Values of each set, fetched once where processes keep them. The state must outlive it.
std::function<std::span<const double>(std::size_t)> values_in(const StaticState& state, PointQuantity quantity) {
  const auto rooms = std::make_shared<std::vector<std::vector<double>>>(state.n_sets());
  return [&state, quantity, rooms](std::size_t set) -> std::span<const double> {
    std::vector<double>& room = (*rooms)[set];
    return room.empty() ? values_of(state, set, quantity, room) : room;
  };
}

}  // namespace

Field stress_field(const StaticProblem& problem, const StaticState& state) {
  Field field{.name = "SIEF_ELGA", .quantity = "SIEF_R", .location = Location::gauss_points, .offset = {0}};
  fill_points(field, problem, stress_names, values_in(state, PointQuantity::stress));
  return field;
}

Field variable_field(const StaticProblem& problem, const StaticState& state) {
  Field field{.name = "VARI_ELGA", .quantity = "VARI_R", .location = Location::gauss_points, .offset = {0}};
  fill_points(field, problem, variable_names, values_in(state, PointQuantity::variable));
  return field;
}

namespace {

/// The initial strains under which a state was found.
void add_initial_strains(const StaticProblem& problem, const Base& base, const Result& result, std::int64_t order,
                         StaticState& state) {
  InitialStrains strains;
  ModelPoints points(problem.mesh, problem.model, *problem.registry);
  for (const ResultLoad& load : result.stage(order).loads) strains.add(base, load, problem.mesh, points);
  check_laws(*problem.registry, strains, problem.solids);
  const auto place = std::find(result.orders.begin(), result.orders.end(), order) - result.orders.begin();
  for (std::size_t s = 0; !strains.empty() && s < problem.solids.size(); ++s)
    state.points[s].initial = strains.at(result.instants[static_cast<std::size_t>(place)], problem.solids[s].cells,
                                         problem.solids[s].tabulation.n_points);
}

}  // namespace

std::filesystem::path path_of_masters(std::filesystem::path field) { return field.replace_extension(".masters.h5"); }

bool was_strained(const Base& base, const Result& result, std::int64_t order) {
  return std::ranges::any_of(result.stage(order).loads,
                             [&](const ResultLoad& load) { return !base.load(load.load).strain.empty(); });
}

StaticState archived_state(const StaticProblem& problem, const Base& base, const Result& result, std::int64_t order) {
  if (result.mesh != problem.model.mesh)
    fail("EVOLUTION_1", {{"first", "ETAT_INIT/EVOL_NOLI"}, {"second", "MODELE"}, {"what", part("meshes")}});
  StaticState state;
  state.displacement = nodal_values(problem.mesh, base.field(result, "DEPL", order), problem.components);
  for (std::size_t dof = 0; dof < problem.n_dofs(); ++dof)
    if (!problem.exists[dof]) state.displacement[dof] = 0;
  const Field stress = base.field(result, "SIEF_ELGA", order);
  const std::vector<std::int32_t> stress_place = places_in(stress, problem.mesh.n_cells());
  std::optional<Field> variable;
  std::vector<std::int32_t> variable_place(problem.mesh.n_cells(), -1);
  if (has_field(result, "VARI_ELGA", order)) {
    variable = base.field(result, "VARI_ELGA", order);
    variable_place = places_in(*variable, problem.mesh.n_cells());
  } else if (laws_have_variables(base, result, result.stage(order), *problem.registry)) {
    base.field(result, "VARI_ELGA", order);  // was not kept: what has flowed is not known, and not zero
  }
  std::int32_t fresh = -1;  // a cell whose law has internal variables now and had none
  for (const ElementSet& set : problem.solids) {
    PointValues& points = state.points.emplace_back();
    points.stress = points_of(stress, stress_place, set, stress_names(set), result.label);
    const auto starts = [&](std::int32_t cell) { return variable_place[cell] < 0; };
    if (set.n_point_variables > 0 && std::all_of(set.cells.begin(), set.cells.end(), starts)) {
      points.variable.assign(set.cells.size() * set.n_variables(), 0.0);
      fresh = set.cells.front();
    } else if (set.n_point_variables > 0) {
      points.variable = points_of(*variable, variable_place, set, variable_names(set), result.label);
    }
  }
  add_initial_strains(problem, base, result, order, state);
  if (fresh >= 0) inform("EVOLUTION_13", {{"label", result.label}, {"cell", cell_name(fresh)}});
  if (!problem.contact || !has_field(result, "CONT_ELEM", order)) return state;
  state.patches = patches_of(base.field(result, "CONT_ELEM", order), problem.mesh, *problem.contact, result.label);
  const std::filesystem::path masters = path_of_masters(base.folder() / result.fields.at("CONT_ELEM").at(order));
  if (!std::filesystem::exists(masters)) return state;  // of a result that another command made
  if (const hdf5::Reader root(masters); root.has("kept_covers"))
    for (const std::int64_t patch : root.read<std::int64_t>("kept_covers"))
      if (patch >= 0 && patch < problem.n_patches()) state.kept_covers.push_back(static_cast<std::size_t>(patch));
  return state;
}

StaticState given_state(const StaticProblem& problem, const Base& base, const Keywords& given) {
  const auto read = [&](const char* keyword, const std::string_view type) {
    Field field = base.field(given.concept_id(keyword));
    check_field(field, {&type, 1}, given.path(keyword), base.label(given.concept_id(keyword)));
    if (field.mesh != problem.model.mesh)
      fail("EVOLUTION_1", {{"first", given.path(keyword)}, {"second", "MODELE"}, {"what", part("meshes")}});
    field.name = keyword;
    return field;
  };
  const auto label = [&](const char* keyword) { return base.label(given.concept_id(keyword)); };
  StaticState state;
  state.displacement.assign(problem.n_dofs(), 0.0);
  if (given.has("DEPL")) state.displacement = nodal_values(problem.mesh, read("DEPL", "NOEU_DEPL_R"), problem.components);
  for (std::size_t dof = 0; dof < problem.n_dofs(); ++dof)
    if (!problem.exists[dof]) state.displacement[dof] = 0;
  for (const ElementSet& set : problem.solids)
    state.points.push_back({.stress = std::vector<double>(set.cells.size() * set.n_stress(), 0.0),
                            .variable = std::vector<double>(set.cells.size() * set.n_variables(), 0.0),
                            .thermal = {},
                            .parameter = {}});
  const auto fill = [&](const char* keyword, const char* type, std::vector<double> PointValues::*values, auto names) {
    if (!given.has(keyword)) return;
    const Field field = read(keyword, type);
    const std::vector<std::int32_t> place = places_in(field, problem.mesh.n_cells());
    for (std::size_t s = 0; s < problem.solids.size(); ++s)
      if (const std::vector<std::string> own = names(problem.solids[s]); !own.empty())
        state.points[s].*values = points_of(field, place, problem.solids[s], own, label(keyword));
  };
  fill("SIGM", "ELGA_SIEF_R", &PointValues::stress, stress_names);
  fill("VARI", "ELGA_VARI_R", &PointValues::variable, variable_names);
  return state;
}

}  // namespace lacon
