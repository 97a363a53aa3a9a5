#pragma once
// A field on nodes, cells, or integration points, on the whole mesh or a part of it.
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
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
  std::string name;      ///< "DEPL"
  std::string quantity;  ///< row of catalog/quantities.toml: "DEPL_R"
  Location location = Location::nodes;
  std::vector<std::string> components;
  std::vector<std::int32_t> support;   ///< nodes or cells on which it lives
  std::vector<std::int64_t> offset;    ///< ELGA, ELNO: rows of each cell, (n + 1); otherwise empty
  std::vector<double> values;          ///< (rows, components)
  std::vector<std::uint8_t> present;   ///< (rows, components), 0 where a component does not exist; empty: everywhere
  std::vector<std::string> functions;  ///< of a quantity that ends in _F: ids; `values` are indices into this list
  std::string mesh;                    ///< id of the mesh
  std::int64_t order = 0;
  double instant = 0;

  std::size_t n_components() const { return components.size(); }
  std::size_t n_rows() const { return components.empty() ? 0 : values.size() / components.size(); }
  double& at(std::size_t row, std::size_t component) { return values[row * components.size() + component]; }
  double at(std::size_t row, std::size_t component) const { return values[row * components.size() + component]; }
  bool has(std::size_t row, std::size_t component) const {
    return present.empty() || present[row * components.size() + component] != 0;
  }
  /// First row of support[i]; of i = support.size(), the end.
  std::size_t first_row(std::size_t i) const { return offset.empty() ? i : static_cast<std::size_t>(offset[i]); }
  /// Index of a component, or -1.
  int component(std::string_view component_name) const;
};

Field read_field(const std::filesystem::path& file);
/// Without what grows with the mesh: support, offset, values, present.
Field read_field_head(const std::filesystem::path& file);
/// What a file says of the field itself, next to what every file or concept has.
void write_field_content(const hdf5::Group& root, const Field& field);
/// Written whole or not at all.
void write_field(const std::filesystem::path& file, const Field& field);

}  // namespace lacon
