#include "lacon/operators/fields/layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/quantities.hpp"
#include "lacon/operators/fields/extrapolation.hpp"

namespace lacon {
namespace {

constexpr std::array<std::pair<std::string_view, Location>, 5> prefixes{{{"NOEU", Location::nodes},
                                                                         {"ELGA", Location::gauss_points},
                                                                         {"ELNO", Location::cell_nodes},
                                                                         {"ELEM", Location::cells},
                                                                         {"CART", Location::cells}}};

/// The row of a quantity; of X_F that of X_R. nullptr where there is none.
const catalog::QuantityRow* quantity_row(std::string name) {
  if (name.ends_with("_F")) name.back() = 'R';
  const auto rows = catalog::quantities();
  const auto at = std::find_if(rows.begin(), rows.end(), [&](const catalog::QuantityRow& row) { return row.name == name; });
  return at == rows.end() ? nullptr : &*at;
}

bool is_internal_variable(const std::string& component) {
  return component.size() > 1 && component[0] == 'V' && std::all_of(component.begin() + 1, component.end(), ::isdigit);
}

/// Values of one component at the nodes of a cell, and whether all are there.
struct NodeValues {
  std::vector<double> values;
  bool whole = true;
};

/// Nodal values (NOEU or ELNO) cell by cell.
class CellNodes {
 public:
  CellNodes(const Mesh& mesh, const Field& field)
      : mesh_(mesh),
        field_(field),
        place_(places(field, field.location == Location::nodes ? mesh.n_nodes() : mesh.n_cells())) {}

  NodeValues operator()(std::size_t cell, std::size_t component) const {
    NodeValues found;
    const auto nodes = mesh_.cells[cell];
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const bool nodal = field_.location == Location::nodes;
      const std::int64_t at = place_[nodal ? static_cast<std::size_t>(nodes[a]) : cell];
      const std::size_t row = at < 0 ? 0 : field_.first_row(static_cast<std::size_t>(at)) + (nodal ? 0 : a);
      const bool here = at >= 0 && field_.counts(row, component);
      found.values.push_back(here ? field_.at(row, component) : 0.0);
      found.whole = found.whole && here;
    }
    return found;
  }

 private:
  const Mesh& mesh_;
  const Field& field_;
  std::vector<std::int64_t> place_;
};

void put(Field& field, std::size_t row, std::size_t component, double value, Field::Presence presence = Field::there) {
  field.at(row, component) = value;
  field.present[row * field.n_components() + component] = presence;
}

double dot(const double* first, const std::vector<double>& second) {
  return std::inner_product(second.begin(), second.end(), first, 0.0);
}

/// Nodal values to the points, nodes or middle of cells.
void from_nodes(const Ground& ground, const Field& field, Field& to) {
  const CellNodes at(ground.mesh(), field);
  for (std::size_t i = 0; i < to.support.size(); ++i) {
    const auto cell = static_cast<std::size_t>(to.support[i]);
    const CellPoints* points =
        to.location == Location::gauss_points ? &(*ground.points())(cell, ground.mesh().coordinates) : nullptr;
    for (std::size_t c = 0; c < field.n_components(); ++c) {
      const NodeValues nodes = at(cell, c);
      if (!nodes.whole) continue;
      const std::size_t n = nodes.values.size();
      if (to.location == Location::cells)
        put(to, i, c, std::accumulate(nodes.values.begin(), nodes.values.end(), 0.0) / static_cast<double>(n));
      for (std::size_t row = to.first_row(i); !to.offset.empty() && row < to.first_row(i + 1); ++row) {
        const std::size_t k = row - to.first_row(i);
        put(to, row, c, points ? dot(points->shape.data() + k * n, nodes.values) : nodes.values[k]);
      }
    }
  }
}

/// Values of cells to each of their rows; those of their points to one mean. A single stand-in stays one.
void from_cells(const Mesh& mesh, const Field& field, Field& to) {
  const std::vector<std::int64_t> place = places(field, mesh.n_cells());
  for (std::size_t i = 0; i < to.support.size(); ++i) {
    const std::int64_t at = place[static_cast<std::size_t>(to.support[i])];
    if (at < 0) continue;
    const std::size_t first = field.first_row(static_cast<std::size_t>(at)),
                      last = field.first_row(static_cast<std::size_t>(at) + 1);
    for (std::size_t c = 0; c < field.n_components(); ++c) {
      double sum = 0;
      Field::Presence presence = last == first + 1 ? field.presence(first, c) : last > first ? Field::there : Field::absent;
      for (std::size_t row = first; row < last; ++row) {
        sum += field.at(row, c);
        if (last > first + 1 && !field.counts(row, c)) presence = Field::absent;
      }
      for (std::size_t row = to.first_row(i); presence != Field::absent && row < to.first_row(i + 1); ++row)
        put(to, row, c, sum / static_cast<double>(last - first), presence);
    }
  }
}

/// The same places, on the ground's rows.
void same_rows(const Ground& ground, const Field& field, Field& to) {
  const bool nodal = to.location == Location::nodes;
  const std::vector<std::int64_t> place = places(field, nodal ? ground.mesh().n_nodes() : ground.mesh().n_cells());
  for (std::size_t i = 0; i < to.support.size(); ++i) {
    const std::int64_t at = place[static_cast<std::size_t>(to.support[i])];
    if (at < 0) continue;
    const std::size_t first = field.first_row(static_cast<std::size_t>(at));
    if (field.first_row(static_cast<std::size_t>(at) + 1) - first != to.first_row(i + 1) - to.first_row(i))
      fail("CREACHAMP_4", {{"field", field.name}, {"cell", cell_name(to.support[i])}});
    for (std::size_t row = to.first_row(i); row < to.first_row(i + 1); ++row)
      for (std::size_t c = 0; c < field.n_components(); ++c)
        if (const std::size_t source = first + row - to.first_row(i); field.has(source, c))
          put(to, row, c, field.at(source, c), field.presence(source, c));
  }
}

}  // namespace

FieldType field_type(const std::string& text) {
  const std::size_t bar = text.find('_');
  const auto at = std::find_if(prefixes.begin(), prefixes.end(), [&](const auto& p) { return p.first == text.substr(0, bar); });
  const std::string quantity = bar == std::string::npos ? "" : text.substr(bar + 1);
  if (at == prefixes.end() || (!quantity_row(quantity) && quantity != "VARI_R")) {
    std::vector<std::string_view> names;
    for (const catalog::QuantityRow& row : catalog::quantities()) names.push_back(row.name);
    fail("CREACHAMP_1", {{"type", text}, {"known", fmt::format("{}", fmt::join(names, ", "))}});
  }
  return {text, at->second, quantity};
}

void check_component(const FieldType& type, const std::string& component, const std::string& keyword) {
  if (type.quantity == "VARI_R" && is_internal_variable(component)) return;
  const catalog::QuantityRow* row = quantity_row(type.quantity);
  const auto known = row ? row->components : std::span<const std::string_view>();
  if (std::find(known.begin(), known.end(), component) != known.end()) return;
  fail("CREACHAMP_2", {{"keyword", keyword},
                       {"component", component},
                       {"type", type.text},
                       {"known", row ? fmt::format("{}", fmt::join(known, ", ")) : "V1, V2, ..."}});
}

std::pair<std::vector<std::int32_t>, std::vector<std::int64_t>> Ground::rows(Location location) const {
  std::pair<std::vector<std::int32_t>, std::vector<std::int64_t>> made;
  auto& [support, offset] = made;
  if (location == Location::gauss_points && !points_) fail("CREACHAMP_3", {});
  std::vector<std::int32_t> cells;
  for (std::size_t c = 0; c < mesh_.n_cells(); ++c)
    if (!points_ || points_->element(c)) cells.push_back(static_cast<std::int32_t>(c));
  if (location == Location::nodes) {
    if (points_) {
      support = nodes_of_cells(mesh_, cells);
    } else {
      support.resize(mesh_.n_nodes());
      std::iota(support.begin(), support.end(), 0);
    }
    return made;
  }
  support = cells;
  if (location == Location::cells) return made;
  offset.assign(1, 0);
  for (const std::int32_t cell : cells) {
    const auto c = static_cast<std::size_t>(cell);
    offset.push_back(offset.back() + (location == Location::gauss_points ? points_->n_points(c) : mesh_.row(c).n_nodes));
  }
  return made;
}

Field empty_field(const Ground& ground, const FieldType& type, std::vector<std::string> components) {
  Field field{.quantity = type.quantity, .location = type.location, .components = std::move(components)};
  std::tie(field.support, field.offset) = ground.rows(type.location);
  const std::size_t n_rows = field.first_row(field.support.size());
  field.values.assign(n_rows * field.n_components(), 0.0);
  field.present.assign(field.values.size(), 0);
  return field;
}

void zero_where_absent(Field& field) {
  std::replace(field.present.begin(), field.present.end(), static_cast<std::uint8_t>(Field::absent),
               static_cast<std::uint8_t>(Field::there));
}

Field without_empty_rows(const Field& field) {
  Field part = field_like(field, field.name, field.location);
  part.functions = field.functions;
  if (!field.offset.empty()) part.offset.assign(1, 0);
  const std::size_t width = field.n_components();
  for (std::size_t i = 0; i < field.support.size(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(field.first_row(i) * width),
               last = static_cast<std::ptrdiff_t>(field.first_row(i + 1) * width);
    if (std::none_of(field.present.begin() + first, field.present.begin() + last, [](std::uint8_t p) { return p != 0; }))
      continue;
    part.support.push_back(field.support[i]);
    part.values.insert(part.values.end(), field.values.begin() + first, field.values.begin() + last);
    part.present.insert(part.present.end(), field.present.begin() + first, field.present.begin() + last);
    if (!field.offset.empty()) part.offset.push_back(part.offset.back() + field.offset[i + 1] - field.offset[i]);
  }
  if (std::all_of(part.present.begin(), part.present.end(), [](std::uint8_t p) { return p == Field::there; }))
    part.present.clear();
  return part;
}

std::vector<std::int64_t> places(const Field& field, std::size_t count) {
  std::vector<std::int64_t> place(count, -1);
  for (std::size_t i = 0; i < field.support.size(); ++i)
    place[static_cast<std::size_t>(field.support[i])] = static_cast<std::int64_t>(i);
  return place;
}

PointValue value_at(const Field& field, const std::vector<std::int64_t>& row_of_node, std::span<const std::int32_t> nodes,
                    std::span<const double> weights, std::size_t component) {
  constexpr double round_off = 1e-10;
  PointValue found{0, Field::there};
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const std::int64_t row = row_of_node[static_cast<std::size_t>(nodes[a])];
    const Field::Presence presence = row < 0 ? Field::absent : field.presence(static_cast<std::size_t>(row), component);
    const bool has_part = std::abs(weights[a]) > round_off;
    if (presence != Field::absent)
      found.value += weights[a] * field.at(static_cast<std::size_t>(row), component);
    else if (has_part)
      return {};
    if (has_part) found.presence = made_of(found.presence, presence);
  }
  if (found.presence == Field::marker) found.value = Field::no_value;
  return found;
}

Field moved_to(const Ground& ground, const Field& field, const FieldType& type, bool zero_elsewhere) {
  Field to = empty_field(ground, type, field.components);
  const bool from_nodal = field.location == Location::nodes || field.location == Location::cell_nodes;
  if (field.location == type.location) {
    same_rows(ground, field, to);
  } else if (type.location == Location::nodes) {
    const Field cell_nodes = field.location == Location::cell_nodes
                                 ? field
                                 : moved_to(ground, field, {"", Location::cell_nodes, type.quantity}, false);
    same_rows(ground, cell_nodes_to_nodes(ground.mesh(), cell_nodes, ""), to);
  } else if (from_nodal) {
    from_nodes(ground, field, to);
  } else if (field.location == Location::gauss_points && type.location == Location::cell_nodes) {
    same_rows(ground, gauss_points_to_cell_nodes(ground.mesh(), field, ""), to);
  } else {
    from_cells(ground.mesh(), field, to);
  }
  if (zero_elsewhere) zero_where_absent(to);
  return without_empty_rows(to);
}

}  // namespace lacon
