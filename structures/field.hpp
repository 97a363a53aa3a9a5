#pragma once
// A field on nodes, cells, or integration points, on the whole mesh or a part of it.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacon {

namespace hdf5 {
class Group;
}

/// Where the values of a field live.
enum class Location {
  nodes,         ///< NOEU: one row a node
  gauss_points,  ///< ELGA: one row an integration point
  cell_nodes,    ///< ELNO: one row a node of a cell
  cells          ///< ELEM: one row a cell
};

std::string_view location_name(Location location);  ///< "NOEU", "ELGA", "ELNO", "ELEM"
Location find_location(std::string_view name);

struct Field {
  /// What `present` says of a value.
  enum Presence : std::uint8_t {
    absent = 0,    ///< there is none
    there = 1,     ///< as any other
    stand_in = 2,  ///< shown and read at its place, but no part of extrema, sums, means and norms: LAGS_C beside its carriers
    marker = 3     ///< as a stand-in, but no value: no_value says that there is none, JEU = -1 without a master
  };
  static constexpr double no_value = -1;  ///< what is shown for a marker

  std::string name;      ///< "DEPL"
  std::string quantity;  ///< row of catalog/quantities.toml: "DEPL_R"
  Location location = Location::nodes;
  std::vector<std::string> components;
  std::vector<std::int32_t> support;   ///< nodes or cells on which it lives
  std::vector<std::int64_t> offset;    ///< ELGA, ELNO: rows of each cell, (n + 1); otherwise empty
  std::vector<double> values;          ///< (rows, components)
  std::vector<std::uint8_t> present;   ///< (rows, components) of Presence; empty: all are there
  std::vector<std::string> functions;  ///< of a quantity that ends in _F: ids; `values` are indices into this list
  std::string mesh;                    ///< id of the mesh
  std::int64_t order = 0;
  double instant = 0;

  std::size_t n_components() const { return components.size(); }
  std::size_t n_rows() const { return components.empty() ? 0 : values.size() / components.size(); }
  double& at(std::size_t row, std::size_t component) { return values[row * components.size() + component]; }
  double at(std::size_t row, std::size_t component) const { return values[row * components.size() + component]; }
  Presence presence(std::size_t row, std::size_t component) const {
    return present.empty() ? there : static_cast<Presence>(present[row * components.size() + component]);
  }
  bool has(std::size_t row, std::size_t component) const { return presence(row, component) != absent; }
  /// Whether a value enters extrema, sums, means and norms.
  bool counts(std::size_t row, std::size_t component) const { return presence(row, component) == there; }
  /// First row of support[i]; of i = support.size(), the end.
  std::size_t first_row(std::size_t i) const { return offset.empty() ? i : static_cast<std::size_t>(offset[i]); }
  /// Index of a component, or -1.
  int component(std::string_view component_name) const;
};

/// A field, the values of which may be made some rows at a time, when they are wanted: no more of them is there at once.
struct FieldRows {
  template <class T>
  using Fill = std::function<void(const Field& field, std::size_t first, std::span<T> rows)>;  ///< whole rows from that one on

  Field field;  ///< without what is made
  Fill<double> values;
  Fill<std::uint8_t> present;  ///< where values are made and not all are there

  FieldRows(Field whole) : field(std::move(whole)) {}
  FieldRows(Field head, Fill<double> make, Fill<std::uint8_t> which)
      : field(std::move(head)), values(std::move(make)), present(std::move(which)) {}
  /// With all of its values.
  Field whole() &&;
};

/// What is made of values like these, whatever it makes of them: nothing where one is absent, a marker where one is a marker, a
/// stand-in where one stands in.
constexpr Field::Presence made_of(Field::Presence first, Field::Presence second) {
  return first == Field::absent || second == Field::absent ? Field::absent : std::max(first, second);
}
/// What counts of a value that is taken `factor` times: of a marker or stand-in nothing where that is 0.
constexpr Field::Presence taken(Field::Presence presence, double factor) {
  return factor == 0 ? std::min(presence, Field::there) : presence;
}
/// What a mixture with a marker has come to is no value: Field::no_value takes its place.
void put_markers(Field& field);

/// The first of several greatest (or least) values of a component. Stand-ins are looked at only where nothing else is.
struct Extreme {
  double value;
  std::size_t place, row;  ///< index into Field::support, row of it
};
/// @param wanted(place) of what places. Empty where the component has no value there
std::optional<Extreme> find_extreme(const Field& field, std::size_t component, bool greatest,
                                    const std::function<bool(std::size_t)>& wanted);

Field read_field(const std::filesystem::path& file);
/// Without what grows with the mesh: support, offset, values, present.
Field read_field_head(const std::filesystem::path& file);
/// What a file says of the field itself, next to what every file or concept has.
void write_field_content(const hdf5::Group& root, const Field& field);
/// Written whole or not at all.
void write_field(const std::filesystem::path& file, const FieldRows& rows);

}  // namespace lacon
