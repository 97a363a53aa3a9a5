#include "lacon/structures/formats/listing.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <limits>
#include <map>
#include <ostream>
#include <string>

#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

void list_groups(std::ostream& out, const std::string& what, const std::vector<Group>& groups) {
  if (groups.empty()) return;
  fmt::print(out, "  {:<26}{:>10}\n", what, groups.size());
  for (const Group& group : groups) fmt::print(out, "    {:<24}{:>10}\n", group.name, group.members.size());
}

/// Where a row of a field is: "N12", "M3", "M3 N12", "M3 point 2".
struct RowName {
  const Mesh& mesh;
  const Field& field;

  std::string operator()(std::size_t entity, std::size_t row) const {
    const std::int32_t number = field.support[entity];
    if (field.location == Location::nodes) return node_name(number);
    const std::string cell = cell_name(number);
    if (field.location == Location::cells) return cell;
    const std::size_t local = row - static_cast<std::size_t>(field.offset[entity]);
    if (field.location == Location::cell_nodes)
      return cell + " " + node_name(mesh.cells[static_cast<std::size_t>(number)][local]);
    return cell + " point " + std::to_string(local + 1);
  }
};

/// Visit every row as (entity, row).
template <class Visit>
void each_row(const Field& field, Visit visit) {
  for (std::size_t i = 0; i < field.support.size(); ++i) {
    const std::size_t first = field.offset.empty() ? i : static_cast<std::size_t>(field.offset[i]);
    const std::size_t end = field.offset.empty() ? i + 1 : static_cast<std::size_t>(field.offset[i + 1]);
    for (std::size_t row = first; row < end; ++row) visit(i, row);
  }
}

void list_extreme(std::ostream& out, const Mesh& mesh, const Field& field, const char* what, bool greatest) {
  const RowName name{mesh, field};
  for (std::size_t k = 0; k < field.n_components(); ++k)
    if (const std::optional<Extreme> found = find_extreme(field, k, greatest, [](std::size_t) { return true; }))
      fmt::print(out, "  {} {:<8} {:>20.12E}  at {}\n", what, field.components[k], found->value,
                 name(found->place, found->row));
}

}  // namespace

void list_field(std::ostream& out, const Mesh& mesh, const Field& field, std::string_view title, const FieldListing& what) {
  fmt::print(out, "\n{}, order {}, instant {:.12E}\n", title, field.order, field.instant);
  if (what.values) {
    const RowName name{mesh, field};
    const bool coordinates = what.coordinates && field.location == Location::nodes;
    fmt::print(out, "  {:<18}", "");
    if (coordinates)
      for (std::size_t k = 0; k < static_cast<std::size_t>(mesh.dimension); ++k) fmt::print(out, "{:>21}", "XYZ"[k]);
    for (const std::string& component : field.components) fmt::print(out, "{:>21}", component);
    fmt::print(out, "\n");
    each_row(field, [&](std::size_t i, std::size_t row) {
      fmt::print(out, "  {:<18}", name(i, row));
      if (coordinates)
        for (std::size_t k = 0; k < static_cast<std::size_t>(mesh.dimension); ++k)
          fmt::print(out, " {:>20.12E}", mesh.point(static_cast<std::size_t>(field.support[i]))[k]);
      for (std::size_t k = 0; k < field.n_components(); ++k) {
        if (field.has(row, k))
          fmt::print(out, " {:>20.12E}", field.at(row, k));
        else
          fmt::print(out, "{:>21}", "-");
      }
      fmt::print(out, "\n");
    });
  }
  if (what.greatest) list_extreme(out, mesh, field, "greatest", true);
  if (what.least) list_extreme(out, mesh, field, "least", false);
}

void list_mesh(std::ostream& out, const Mesh& mesh, bool full) {
  fmt::print(out, "  {:<26}{:>10}\n", "dimension", mesh.dimension);
  fmt::print(out, "  {:<26}{:>10}\n", part("nodes"), mesh.n_nodes());
  fmt::print(out, "  {:<26}{:>10}\n", part("cells"), mesh.n_cells());
  std::map<CellType, std::size_t> count;
  for (const CellType type : mesh.types) ++count[type];
  for (const auto& [type, n] : count) fmt::print(out, "    {:<24}{:>10}\n", catalog::cell(type).name, n);
  list_groups(out, part("groups_of_cells"), mesh.cell_groups);
  list_groups(out, part("groups_of_nodes"), mesh.node_groups);
  if (!full) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(mesh.dimension); ++k) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < mesh.n_nodes(); ++i) {
      low = std::min(low, mesh.coordinates[3 * i + k]);
      high = std::max(high, mesh.coordinates[3 * i + k]);
    }
    fmt::print(out, "  {} from {:.9g} to {:.9g}\n", "XYZ"[k], low, high);
  }
}

}  // namespace lacon
