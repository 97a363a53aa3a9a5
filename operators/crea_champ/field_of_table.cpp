#include "lacon/operators/crea_champ/field_of_table.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/names.hpp"

namespace lacon {
namespace {

/// Which row of a field a row of a table is about, by its columns NOEUD, MAILLE and POINT.
class TableRows {
 public:
  TableRows(const Table& table, const Field& field, const Mesh& mesh)
      : table_(table), field_(field), mesh_(mesh), on_nodes_(field.location == Location::nodes) {
    places_ = places(field, on_nodes_ ? mesh.n_nodes() : mesh.n_cells());
    owner_ = &column(on_nodes_ ? "NOEUD" : "MAILLE");
    if (field.location == Location::gauss_points || (field.location == Location::cell_nodes && !has("NOEUD")))
      point_ = &column("POINT");
    else if (field.location == Location::cell_nodes)
      node_ = &column("NOEUD");
  }

  /// Throws CREACHAMP_18 for a row that names no such place.
  std::size_t operator()(std::size_t row) const {
    const std::int32_t owner = entity(*owner_, row, on_nodes_ ? Entity::node : Entity::cell);
    const std::int64_t place = places_[static_cast<std::size_t>(owner)];
    if (place < 0) refuse(*owner_, row);
    const std::size_t first = field_.first_row(static_cast<std::size_t>(place));
    const std::size_t count = field_.first_row(static_cast<std::size_t>(place) + 1) - first;
    std::size_t inside = 0;
    if (point_) {
      const auto* const number = std::get_if<std::int64_t>(&point_->cells[row]);
      if (!number || *number < 1 || *number > static_cast<std::int64_t>(count)) refuse(*point_, row);
      inside = static_cast<std::size_t>(*number - 1);
    } else if (node_) {
      const auto nodes = mesh_.cells[static_cast<std::size_t>(owner)];
      inside = static_cast<std::size_t>(std::ranges::find(nodes, entity(*node_, row, Entity::node)) - nodes.begin());
      if (inside >= count) refuse(*node_, row);
    }
    return first + inside;
  }

 private:
  bool has(std::string_view name) const { return std::ranges::count(table_.columns, name, &Table::Column::name) > 0; }
  const Table::Column& column(std::string_view name) const {
    const auto at = std::ranges::find(table_.columns, name, &Table::Column::name);
    if (at == table_.columns.end()) fail("CREACHAMP_17", {{"column", std::string(name)}, {"where", location_text()}});
    return *at;
  }
  std::string location_text() const { return std::string(location_name(field_.location)); }
  std::int32_t entity(const Table::Column& column, std::size_t row, Entity kind) const {
    const auto* const name = std::get_if<std::string>(&column.cells[row]);
    const auto found = name ? find_by_name(mesh_, *name, kind) : std::nullopt;
    if (!found) refuse(column, row);
    return *found;
  }
  [[noreturn]] static void refuse(const Table::Column& column, std::size_t row) {
    const Table::Cell& cell = column.cells[row];
    std::string text;
    if (const auto* const name = std::get_if<std::string>(&cell)) text = *name;
    if (const auto* const number = std::get_if<std::int64_t>(&cell)) text = std::to_string(*number);
    fail("CREACHAMP_18", {{"column", column.name}, {"row", std::to_string(row + 1)}, {"cell", text}});
  }

  const Table& table_;
  const Field& field_;
  const Mesh& mesh_;
  bool on_nodes_;
  std::vector<std::int64_t> places_;
  const Table::Column *owner_ = nullptr, *point_ = nullptr, *node_ = nullptr;
};

}  // namespace

Field field_of_table(const Table& table, const Ground& ground, const FieldType& type) {
  static const std::set<std::string_view> heads{"INST", "COOR_X", "COOR_Y", "COOR_Z", "ABSC_CURV"};
  std::vector<const Table::Column*> columns;
  std::vector<std::string> names;
  for (const Table::Column& column : table.columns) {
    if (column.type != "R" || heads.contains(column.name)) continue;
    check_component(type, column.name, "TABLE");
    columns.push_back(&column);
    names.push_back(column.name);
  }
  if (columns.empty() || type.of_functions()) fail("CREACHAMP_19", {{"type", type.text}});
  Field field = empty_field(ground, type, names);
  const TableRows rows(table, field, ground.mesh());
  for (std::size_t r = 0; r < table.n_rows(); ++r) {
    const std::size_t row = rows(r);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto* const value = std::get_if<double>(&columns[c]->cells[r]);
      if (!value) continue;
      field.at(row, c) = *value;
      field.present[row * field.n_components() + c] = Field::there;
    }
  }
  return field;
}

}  // namespace lacon
