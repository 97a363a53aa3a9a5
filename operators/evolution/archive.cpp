#include "lacon/operators/evolution/archive.hpp"

#include <algorithm>

namespace lacon {

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

Field stress_field(const StaticProblem& problem, const std::vector<std::vector<double>>& stresses) {
  Field field{.name = "SIEF_ELGA", .quantity = "SIEF_R", .location = Location::gauss_points, .offset = {0}};
  for (const ElementSet& set : problem.solids)
    for (const std::string_view name : set.row->stress)
      if (field.component(name) < 0) field.components.emplace_back(name);
  // cells in ascending order, whatever set they belong to
  struct Place {
    std::int32_t cell;
    std::size_t set, index;
  };
  std::vector<Place> places;
  for (std::size_t s = 0; s < problem.solids.size(); ++s)
    for (std::size_t i = 0; i < problem.solids[s].cells.size(); ++i) places.push_back({problem.solids[s].cells[i], s, i});
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.cell < b.cell; });
  for (const Place& place : places) {
    const ElementSet& set = problem.solids[place.set];
    const std::size_t n_points = set.tabulation.n_points, n_stress = set.row->stress.size();
    field.support.push_back(place.cell);
    for (std::size_t p = 0; p < n_points; ++p) {
      const std::size_t first = field.values.size();
      field.values.resize(first + field.n_components(), 0.0);
      field.present.resize(first + field.n_components(), 0);
      for (std::size_t k = 0; k < n_stress; ++k) {
        const int c = field.component(set.row->stress[k]);
        field.values[first + c] = stresses[place.set][(place.index * n_points + p) * n_stress + k];
        field.present[first + c] = 1;
      }
    }
    field.offset.push_back(field.offset.back() + static_cast<std::int64_t>(n_points));
  }
  if (std::all_of(field.present.begin(), field.present.end(), [](std::uint8_t p) { return p != 0; })) field.present.clear();
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
