#include "lacon/operators/meshing/patch_turn.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "lacon/catalog/contact.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

using Nodes = std::vector<std::int32_t>;

/// The same skin cell, beginning at another of its vertices: mid nodes go with their edges, and the one in the middle stays.
Nodes beginning_at(const catalog::CellRow& row, std::span<const std::int32_t> nodes, std::size_t vertex) {
  Nodes moved(nodes.begin(), nodes.end());
  if (row.dimension == 1) return moved;  // an edge has one beginning
  const std::size_t corners = row.edges.size();
  for (std::size_t first = 0; first + corners <= moved.size(); first += corners)
    std::rotate(moved.begin() + static_cast<std::ptrdiff_t>(first), moved.begin() + static_cast<std::ptrdiff_t>(first + vertex),
                moved.begin() + static_cast<std::ptrdiff_t>(first + corners));
  return moved;
}

/// The carriers of a sub-cell are where its rank wants them, and nowhere else.
bool carries(const catalog::SlaveRow& slave, std::span<const std::int32_t> nodes, std::span<const std::int32_t> carriers) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool wanted = std::ranges::find(slave.carriers, static_cast<std::int8_t>(i)) != slave.carriers.end();
    if (wanted != (std::ranges::find(carriers, nodes[i]) != carriers.end())) return false;
  }
  return true;
}

/// The nodes of a sub-cell in an order that serves this rank; nothing: it cannot have the rank.
Nodes order_for(const Mesh& mesh, std::int32_t cell, int kind, std::size_t rank, std::span<const std::int32_t> carriers) {
  const catalog::CellRow& row = mesh.row(static_cast<std::size_t>(cell));
  const catalog::SlaveRow* slave = catalog::find_slave(kind, static_cast<int>(rank));
  if (!slave || slave->cell != row.type) return {};
  for (std::size_t vertex = 0; vertex < row.edges.size(); ++vertex)
    if (Nodes nodes = beginning_at(row, mesh.cells[static_cast<std::size_t>(cell)], vertex); carries(*slave, nodes, carriers))
      return nodes;
  return {};
}

}  // namespace

std::vector<std::int32_t> patches_to_turn(const Mesh& mesh, std::span<const std::int32_t> cells, const std::string& where) {
  std::vector<std::int32_t> found;
  if (!mesh.patches) return found;
  for (std::size_t p = 0; p < mesh.patches->size(); ++p) {
    const auto own = mesh.patches->cells[p];
    const auto turned = [&](std::int32_t cell) { return std::ranges::binary_search(cells, cell); };
    const auto count = std::ranges::count_if(own, turned);
    if (count == 0) continue;
    if (count < std::ssize(own))
      fail("ORIE_5", {{"where", where},
                      {"turned", cell_name(*std::ranges::find_if(own, turned))},
                      {"left", cell_name(*std::ranges::find_if_not(own, turned))},
                      {"zone", mesh.patches->zone_group[static_cast<std::size_t>(
                                   std::ranges::upper_bound(mesh.patches->zone_offset, static_cast<std::int64_t>(p)) -
                                   mesh.patches->zone_offset.begin() - 1)]}});
    found.push_back(static_cast<std::int32_t>(p));
  }
  return found;
}

void settle_turned(Mesh& mesh, std::span<const std::int32_t> patches) {
  for (const std::int32_t patch : patches) {
    const auto p = static_cast<std::size_t>(patch);
    const auto ranks = mesh.patches->cells[p];
    Nodes left(ranks.rbegin(), ranks.rend());  // turned, sub-cells follow each other the other way round
    for (std::size_t rank = 0; rank < ranks.size(); ++rank) {
      Nodes nodes;
      const auto fits = [&](std::int32_t cell) {
        nodes = order_for(mesh, cell, mesh.patches->kind[p], rank, mesh.patches->carriers[p]);
        return !nodes.empty();
      };
      const auto cell = std::ranges::find_if(left, fits);
      if (cell == left.end()) throw std::logic_error("a turned patch has no sub-cell for one of its ranks");
      std::ranges::copy(nodes, mesh.cells[static_cast<std::size_t>(*cell)].begin());
      ranks[rank] = *cell;
      left.erase(cell);
    }
  }
}

}  // namespace lacon
