#include "lacon/structures/formats/listing.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <limits>
#include <map>
#include <ostream>

namespace lacon {
namespace {

void list_groups(std::ostream& out, const char* what, const std::vector<Group>& groups) {
  if (groups.empty()) return;
  fmt::print(out, "  {:<26}{:>10}\n", what, groups.size());
  for (const Group& group : groups) fmt::print(out, "    {:<24}{:>10}\n", group.name, group.members.size());
}

}  // namespace

void list_mesh(std::ostream& out, const Mesh& mesh, bool full) {
  fmt::print(out, "  {:<26}{:>10}\n", "dimension", mesh.dimension);
  fmt::print(out, "  {:<26}{:>10}\n", "nodes", mesh.n_nodes());
  fmt::print(out, "  {:<26}{:>10}\n", "cells", mesh.n_cells());
  std::map<CellType, std::size_t> count;
  for (const CellType type : mesh.types) ++count[type];
  for (const auto& [type, n] : count) fmt::print(out, "    {:<24}{:>10}\n", catalog::cell(type).name, n);
  list_groups(out, "groups of cells", mesh.cell_groups);
  list_groups(out, "groups of nodes", mesh.node_groups);
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
