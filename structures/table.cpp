#include "lacon/structures/table.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {

Table Table::of(const std::vector<std::pair<std::string, std::string>>& columns, std::string title) {
  Table table;
  table.title = std::move(title);
  for (const auto& [name, type] : columns) table.columns.push_back({name, type, {}});
  return table;
}

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns.size()) throw std::logic_error("a row of a table has as many cells as there are columns");
  for (std::size_t k = 0; k < row.size(); ++k) columns[k].cells.push_back(std::move(row[k]));
}

namespace {

/// The cells as values of type T, empty ones where a cell is missing.
template <class T>
std::vector<T> values_of(const Table::Column& column) {
  std::vector<T> values;
  for (const Table::Cell& cell : column.cells) values.push_back(cell.index() == 0 ? T{} : std::get<T>(cell));
  return values;
}

template <class T>
std::vector<Table::Cell> cells_of(std::vector<T> values) {
  return {std::make_move_iterator(values.begin()), std::make_move_iterator(values.end())};
}

}  // namespace

void write_table(const hdf5::Group& group, const Table& table) {
  std::vector<std::string> names, types;
  for (const Table::Column& column : table.columns) {
    names.push_back(column.name);
    types.push_back(column.type);
  }
  group.set("title", table.title);
  group.write_strings("columns", names);
  group.write_strings("types", types);
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const Table::Column& column = table.columns[k];
    const std::string values = "values/" + std::to_string(k);
    if (column.type == "I")
      group.write(values, values_of<std::int64_t>(column));
    else if (column.type == "R")
      group.write(values, values_of<double>(column));
    else
      group.write_strings(values, values_of<std::string>(column));
    std::vector<std::uint8_t> present;
    for (const Table::Cell& cell : column.cells) present.push_back(cell.index() != 0);
    if (std::count(present.begin(), present.end(), 0)) group.write("present/" + std::to_string(k), present);
  }
}

Table read_table(const hdf5::Group& group) {
  Table table;
  table.title = group.text("title");
  const auto names = group.read_strings("columns"), types = group.read_strings("types");
  bool sound = names.size() == types.size();
  for (std::size_t k = 0; sound && k < names.size(); ++k) {
    const std::string number = std::to_string(k), values = "values/" + number;
    Table::Column column{names[k], types[k], {}};
    if (types[k] == "I")
      column.cells = cells_of(group.read<std::int64_t>(values));
    else if (types[k] == "R")
      column.cells = cells_of(group.read<double>(values));
    else
      column.cells = cells_of(group.read_strings(values));
    if (group.has("present/" + number)) {
      const auto present = group.read<std::uint8_t>("present/" + number);
      sound = present.size() == column.cells.size();
      for (std::size_t i = 0; sound && i < present.size(); ++i)
        if (!present[i]) column.cells[i] = std::monostate{};
    }
    sound = sound && (k == 0 || column.cells.size() == table.n_rows());
    table.columns.push_back(std::move(column));
  }
  if (!sound) fail("BASE_2", {{"file", group.path().string()}, {"reason", part("table_does_not_fit")}});
  return table;
}

}  // namespace lacon
