#pragma once
// A table: named columns of one type each, with missing cells. docs/structures.md, section 2.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lacon::hdf5 {
class Group;
}

namespace lacon {

struct Table {
  using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;  ///< monostate: missing
  struct Column {
    std::string name;
    std::string type;         ///< I, R, K8, K16, K24, K32, K80
    std::vector<Cell> cells;  ///< one for each row
  };

  std::string title;
  std::vector<Column> columns;

  /// A table without rows. @param columns {name, type} of each
  static Table of(const std::vector<std::pair<std::string, std::string>>& columns, std::string title = {});
  /// Add a row, one cell for each column in their order.
  void add(std::vector<Cell> row);
  std::size_t n_rows() const { return columns.empty() ? 0 : columns.front().cells.size(); }
};

void write_table(const hdf5::Group& group, const Table& table);
/// Throws BASE_2 where the columns do not fit each other.
Table read_table(const hdf5::Group& group);

}  // namespace lacon
