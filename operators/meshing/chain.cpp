#include "lacon/operators/meshing/chain.hpp"

#include <algorithm>
#include <map>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {

std::vector<std::int32_t> chain_of_lines(const Mesh& mesh, const std::string& group, const std::string& keyword) {
  const auto cells = cells_of_group(mesh, group, keyword);
  const auto refuse = [&](std::int32_t cell, const char* why) {
    fail("LIGNCOUPE_4", {{"keyword", keyword}, {"group", group}, {"cell", cell_name(cell)}, {"why", part(why)}});
  };
  std::map<std::int32_t, std::vector<std::size_t>> around;  // vertex -> cells, by place in the group
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto cell = static_cast<std::size_t>(cells[i]);
    if (mesh.row(cell).dimension != 1) refuse(cells[i], "no_line_cell");
    for (const std::int32_t vertex : mesh.cells[cell].first(2)) {
      around[vertex].push_back(i);
      if (around[vertex].size() > 2) refuse(cells[i], "more_than_two_cells");
    }
  }
  std::vector<char> used(cells.size(), 0);
  // nodes beyond `start` when leaving it through `i`, up to an end or a cell that is used
  const auto walk = [&](std::size_t i, std::int32_t start) {
    std::vector<std::int32_t> nodes;
    while (true) {
      used[i] = 1;
      const auto own = mesh.cells[static_cast<std::size_t>(cells[i])];
      const bool forward = own[0] == start;
      std::vector<std::int32_t> middle(own.begin() + 2, own.end());
      if (!forward) std::reverse(middle.begin(), middle.end());
      nodes.insert(nodes.end(), middle.begin(), middle.end());
      start = own[forward ? 1 : 0];
      nodes.push_back(start);
      const auto& next = around.at(start);
      const auto free = std::find_if(next.begin(), next.end(), [&](std::size_t j) { return !used[j]; });
      if (free == next.end()) return nodes;
      i = *free;
    }
  };
  const std::int32_t first = mesh.cells[static_cast<std::size_t>(cells[0])][0];
  std::vector<std::int32_t> forward = walk(0, first), nodes;
  const auto& at_first = around.at(first);
  if (const auto back = std::find_if(at_first.begin(), at_first.end(), [&](std::size_t j) { return !used[j]; });
      back != at_first.end()) {
    nodes = walk(*back, first);
    std::reverse(nodes.begin(), nodes.end());
  }
  if (const auto left = std::find(used.begin(), used.end(), 0); left != used.end())
    refuse(cells[static_cast<std::size_t>(left - used.begin())], "not_connected");
  nodes.push_back(first);
  nodes.insert(nodes.end(), forward.begin(), forward.end());
  return nodes;
}

}  // namespace lacon
