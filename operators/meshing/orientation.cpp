#include "lacon/operators/meshing/orientation.hpp"

#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/patch_turn.hpp"
#include "lacon/operators/meshing/quality.hpp"
#include "lacon/operators/meshing/skin.hpp"

namespace lacon {

OrientationReport orient_skin(Mesh& mesh, const std::string& group, std::span<const std::int32_t> inside,
                              const std::string& keyword) {
  const int skin_dimension = mesh.dimension - 1;
  const auto members = cells_of_group(mesh, group, keyword);
  const NodeCells around(mesh);
  std::vector<char> allowed;
  if (!inside.empty()) {
    allowed.assign(mesh.n_cells(), 0);
    for (const std::int32_t c : inside) allowed[static_cast<std::size_t>(c)] = 1;
  }

  // all checks come before the first change
  OrientationReport report;
  std::vector<std::int32_t> to_turn;
  for (const std::int32_t skin : members) {
    const auto s = static_cast<std::size_t>(skin);
    if (mesh.row(s).dimension != skin_dimension)
      fail("ORIE_1", {{"keyword", keyword},
                      {"group", group},
                      {"cell", cell_name(skin)},
                      {"type", std::string(mesh.row(s).name)},
                      {"skin", skin_cells(mesh)}});
    std::vector<BodyCell> bodies = body_cells(mesh, around, s);
    if (!allowed.empty()) std::erase_if(bodies, [&](const BodyCell& b) { return !allowed[static_cast<std::size_t>(b.cell)]; });
    if (bodies.empty()) {
      report.without_body.push_back(skin);
      continue;
    }
    if (bodies.size() > 1)
      fail("ORIE_2", {{"keyword", keyword},
                      {"group", group},
                      {"cell", cell_name(skin)},
                      {"first", cell_name(bodies[0].cell)},
                      {"second", cell_name(bodies[1].cell)}});
    const auto b = static_cast<std::size_t>(bodies[0].cell);
    const double volume = central_jacobian(mesh.types[b], mesh.cells[b], mesh.coordinates);
    if (volume == 0)
      fail("ORIE_3", {{"keyword", keyword}, {"group", group}, {"cell", cell_name(skin)}, {"body", cell_name(bodies[0].cell)}});
    if (bodies[0].match.outward != (volume > 0)) to_turn.push_back(skin);
  }
  std::sort(to_turn.begin(), to_turn.end());  // a group may name a cell twice
  to_turn.erase(std::unique(to_turn.begin(), to_turn.end()), to_turn.end());
  const std::vector<std::int32_t> patches = patches_to_turn(mesh, to_turn, keyword + " '" + group + "'");
  for (const std::int32_t skin : to_turn) {
    const auto nodes = mesh.cells[static_cast<std::size_t>(skin)];
    std::ranges::copy(mirrored(mesh.types[static_cast<std::size_t>(skin)], nodes), nodes.begin());
  }
  settle_turned(mesh, patches);
  report.turned = static_cast<std::int64_t>(to_turn.size());
  return report;
}

}  // namespace lacon
