#include "lacon/operators/evolution/state_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/contact/contact_field.hpp"
#include "lacon/operators/evolution/problem/prestrain.hpp"
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

/// Values of the solid sets at integration points, row by row. Cells are in ascending order, whatever set they belong to; a set
/// without components is left out.
class PointRows {
 public:
  /// @param field gets its components, cells and offsets
  PointRows(Field& field, const StaticProblem& problem, std::vector<std::string> (*components_of)(const ElementSet&))
      : sets_(problem.solids) {
    std::size_t n_cells = 0;
    for (const ElementSet& set : sets_) {
      components_.emplace_back();
      for (const std::string& name : components_of(set)) {
        if (field.component(name) < 0) field.components.push_back(name);
        components_.back().push_back(static_cast<std::size_t>(field.component(name)));
      }
      if (!components_.back().empty()) n_cells += set.cells.size();
    }
    field.support.reserve(n_cells);
    for (std::size_t s = 0; s < sets_.size(); ++s)
      if (!components_[s].empty()) field.support.insert(field.support.end(), sets_[s].cells.begin(), sets_[s].cells.end());
    std::ranges::sort(field.support);
    field.offset.reserve(n_cells + 1);
    field.offset.assign(1, 0);
    std::vector<CellRange> at = cells_of(field, 0, n_cells);
    for_each_cell(field, 0, n_cells, at, [&](std::size_t, std::size_t set, std::size_t) {
      field.offset.push_back(field.offset.back() + sets_[set].tabulation.n_points);
    });
  }

  bool has_all(std::size_t n_components) const {
    return std::ranges::all_of(components_, [&](const auto& own) { return own.empty() || own.size() == n_components; });
  }

  void fill_values(const StaticState& state, PointQuantity quantity, const Field& field, std::size_t first,
                   std::span<double> rows) const {
    const auto [begin, end] = places_of(field, first, rows.size());
    const std::vector<CellRange> cells = cells_of(field, begin, end);
    std::vector<std::vector<double>> fetched;
    if (state.kept) fetched = state.kept->values(quantity, cells);
    for_each_row(field, first, rows.size(), [&](std::size_t row, std::size_t set, std::size_t cell, std::size_t point) {
      const std::vector<std::size_t>& own = components_[set];
      const std::vector<double>& here = fetched.empty() ? state.points[set].*member_of(quantity) : fetched[set];
      const std::size_t before = fetched.empty() ? cell : cell - cells[set].first;
      const std::size_t at = before * width_of(sets_[set], quantity) + point * own.size();
      for (std::size_t k = 0; k < own.size(); ++k) rows[row * field.n_components() + own[k]] = here[at + k];
    });
  }

  void fill_present(const Field& field, std::size_t first, std::span<std::uint8_t> rows) const {
    std::ranges::fill(rows, Field::absent);
    for_each_row(field, first, rows.size(), [&](std::size_t row, std::size_t set, std::size_t, std::size_t) {
      for (const std::size_t component : components_[set]) rows[row * field.n_components() + component] = Field::there;
    });
  }

 private:
  /// Places in the support that have the rows of some values: first, end.
  static std::pair<std::size_t, std::size_t> places_of(const Field& field, std::size_t first, std::size_t n_values) {
    const auto end_row = static_cast<std::int64_t>(first + n_values / field.n_components());
    const auto begin = std::ranges::upper_bound(field.offset, static_cast<std::int64_t>(first)) - field.offset.begin() - 1;
    const auto end = std::ranges::lower_bound(field.offset, end_row) - field.offset.begin();
    return {static_cast<std::size_t>(begin), static_cast<std::size_t>(end)};
  }
  /// Of each set the cells between those of two places.
  std::vector<CellRange> cells_of(const Field& field, std::size_t begin, std::size_t end) const {
    std::vector<CellRange> ranges(sets_.size());
    if (begin == end) return ranges;
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      const std::vector<std::int32_t>& cells = sets_[s].cells;  // ascending
      const auto first = std::ranges::lower_bound(cells, field.support[begin]);
      const auto last = std::ranges::upper_bound(cells, field.support[end - 1]);
      ranges[s] = {static_cast<std::size_t>(first - cells.begin()), static_cast<std::size_t>(last - first)};
    }
    return ranges;
  }
  /// Call use(place, set, cell of the set). @param at where the cells of each set begin
  template <class Use>
  void for_each_cell(const Field& field, std::size_t begin, std::size_t end, std::vector<CellRange> at, const Use& use) const {
    std::size_t set = 0;
    const auto is_next = [&](std::int32_t cell) {
      return !components_[set].empty() && at[set].count > 0 && sets_[set].cells[at[set].first] == cell;
    };
    for (std::size_t place = begin; place < end; ++place) {
      while (!is_next(field.support[place])) set = (set + 1) % sets_.size();
      use(place, set, at[set].first);
      ++at[set].first;
      --at[set].count;
    }
  }
  /// Call use(row, counted from `first`, set, cell of the set, point of the cell).
  template <class Use>
  void for_each_row(const Field& field, std::size_t first, std::size_t n_values, const Use& use) const {
    const auto [begin, end] = places_of(field, first, n_values);
    const std::size_t end_row = first + n_values / field.n_components();
    for_each_cell(field, begin, end, cells_of(field, begin, end), [&](std::size_t place, std::size_t set, std::size_t cell) {
      const std::size_t own = field.first_row(place), behind = std::min(field.first_row(place + 1), end_row);
      for (std::size_t row = std::max(own, first); row < behind; ++row) use(row - first, set, cell, row - own);
    });
  }

  const std::vector<ElementSet>& sets_;
  std::vector<std::vector<std::size_t>> components_;  ///< of each set, in the field
};

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
    const auto refuse = [&](const std::string& lack) {
      fail("EVOLUTION_11", {{"label", label}, {"field", field.name}, {"cell", cell_name(cell)}, {"lack", lack}});
    };
    if (place[cell] < 0) refuse(part("no_values_there"));
    const std::size_t first = field.first_row(place[cell]), end = field.first_row(place[cell] + 1);
    if (end - first != static_cast<std::size_t>(set.tabulation.n_points))
      refuse(
          part("other_points", {{"found", std::to_string(end - first)}, {"needed", std::to_string(set.tabulation.n_points)}}));
    for (std::size_t row = first; row < end; ++row)
      for (const std::string& name : names) {
        const int component = field.component(name);
        if (component < 0 || !field.has(row, component))
          refuse(part("no_component_there", {{"component", name}, {"needed", fmt::format("{}", fmt::join(names, ", "))}}));
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

/// A field whose rows are made when they are written. @param field its names; problem and state must outlive it
FieldRows point_field(Field field, const StaticProblem& problem, const StaticState& state, PointQuantity quantity,
                      std::vector<std::string> (*components_of)(const ElementSet&)) {
  const auto rows = std::make_shared<const PointRows>(field, problem, components_of);
  FieldRows made(std::move(field));
  made.values = [rows, &state, quantity](const Field& of, std::size_t first, std::span<double> some) {
    std::ranges::fill(some, 0.0);
    rows->fill_values(state, quantity, of, first, some);
  };
  if (!rows->has_all(made.field.n_components()))
    made.present = [rows](const Field& of, std::size_t first, std::span<std::uint8_t> some) {
      rows->fill_present(of, first, some);
    };
  return made;
}

}  // namespace

FieldRows stress_field(const StaticProblem& problem, const StaticState& state) {
  return point_field({.name = "SIEF_ELGA", .quantity = "SIEF_R", .location = Location::gauss_points}, problem, state,
                     PointQuantity::stress, stress_names);
}

FieldRows variable_field(const StaticProblem& problem, const StaticState& state) {
  return point_field({.name = "VARI_ELGA", .quantity = "VARI_R", .location = Location::gauss_points}, problem, state,
                     PointQuantity::variable, variable_names);
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
  const KeptContact kept = read_kept_contact(base.folder() / result.fields.at("CONT_ELEM").at(order), "begun_without_masters");
  for (const std::int64_t patch : kept.covers)
    if (patch >= 0 && patch < problem.n_patches()) state.kept_covers.push_back(static_cast<std::size_t>(patch));
  state.kept_pairing = kept.pairing;
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
  for (const ElementSet& set : problem.solids) state.points.push_back(natural_points(set));
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
  const bool has_fields = given.has("DEPL") || given.has("SIGM") || given.has("VARI");
  if (has_fields && !problem.initial_strains.empty())
    inform("EVOLUTION_78", {});  // nothing says what the stresses know of them
  return state;
}

}  // namespace lacon
