#include "lacon/operators/evolution/archive.hpp"

#include <algorithm>
#include <functional>
#include <span>

namespace lacon {
namespace {

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
  if (std::all_of(field.present.begin(), field.present.end(), [](std::uint8_t p) { return p != 0; })) field.present.clear();
}

}  // namespace

Field displacement_field(const StaticProblem& problem, const StaticState& state) {
  Field field{.name = "DEPL", .quantity = "DEPL_R", .location = Location::nodes, .components = problem.components};
  if (problem.contact) field.components.emplace_back("LAGS_C");
  const std::size_t width = field.components.size(), dimension = problem.dimension;
  std::vector<std::int32_t> row(problem.mesh.n_nodes(), -1);
  for (std::size_t node = 0; node < problem.mesh.n_nodes(); ++node) {
    if (!problem.exists[node * dimension]) continue;
    row[node] = static_cast<std::int32_t>(field.support.size());
    field.support.push_back(static_cast<std::int32_t>(node));
    for (std::size_t c = 0; c < width; ++c) {
      field.values.push_back(c < dimension ? state.displacement[node * dimension + c] : 0.0);
      if (problem.contact) field.present.push_back(c < dimension);
    }
  }
  if (problem.contact)
    for (std::size_t p = 0; p < problem.mesh.patches->size(); ++p)
      for (const std::int32_t node : problem.mesh.patches->carriers[p]) {
        field.at(row[node], dimension) = state.patches.lambda[p];
        field.present[row[node] * width + dimension] = 1;
      }
  return field;
}

Field stress_field(const StaticProblem& problem, const StaticState& state) {
  Field field{.name = "SIEF_ELGA", .quantity = "SIEF_R", .location = Location::gauss_points, .offset = {0}};
  fill_points(
      field, problem,
      [](const ElementSet& set) { return std::vector<std::string>(set.row->stress.begin(), set.row->stress.end()); },
      [&](std::size_t s) { return std::span<const double>(state.points[s].stress); });
  return field;
}

Field variable_field(const StaticProblem& problem, const StaticState& state) {
  Field field{.name = "VARI_ELGA", .quantity = "VARI_R", .location = Location::gauss_points, .offset = {0}};
  const auto names = [](const ElementSet& set) {
    std::vector<std::string> variables;
    for (int v = 1; v <= set.kernel->n_variables; ++v) variables.push_back("V" + std::to_string(v));
    return variables;
  };
  fill_points(field, problem, names, [&](std::size_t s) { return std::span<const double>(state.points[s].variable); });
  return field;
}

Field contact_field(const StaticProblem& problem, const StaticState& state, const ContactState& contact) {
  Field field{.name = "CONT_ELEM",
              .quantity = "CLAC_R",
              .location = Location::cells,
              .components = {"CONT", "PRES", "JEU", "COEFSURF", "PRESCOOR"}};
  std::vector<SlaveElement> slaves = problem.contact->slaves;
  std::sort(slaves.begin(), slaves.end(), [](const SlaveElement& a, const SlaveElement& b) { return a.cell < b.cell; });
  for (const SlaveElement& slave : slaves) {
    const std::size_t p = slave.patch;
    const Status status = state.patches.status[p];
    const bool paired = status != Status::unpaired;
    const double pressure = paired ? state.patches.lambda[p] : 0, coverage = paired ? contact.coverage(p) : 0;
    field.support.push_back(slave.cell);
    for (const double value :
         {static_cast<double>(status), pressure, paired ? contact.gap(p) : -1.0, coverage, coverage * pressure})
      field.values.push_back(value);
  }
  return field;
}

}  // namespace lacon
