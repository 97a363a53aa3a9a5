#include "lacon/operators/crea_maillage/crea_maillage.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/crea_maillage/order_change.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/cut.hpp"

namespace lacon {
namespace {

Mesh cut(const Mesh& mesh, const Keywords& factor) {
  CutReport report;
  const std::vector<std::string> groups = factor.texts("GROUP_MA_ESCL");
  const std::string option = factor.text("DECOUPE_HEXA");
  if (option != "PYRA" && option != "HEXA")
    fail("ORDER_4", {{"keyword", factor.path("DECOUPE_HEXA")}, {"expected", "PYRA or HEXA"}});
  Mesh made = cut_lac(mesh, groups, option, factor.path("GROUP_MA_ESCL"), report);
  for (const CutZone& zone : report.zones) {
    if (zone.turned > 0) inform("DECOUPE_7", {{"count", std::to_string(zone.turned)}, {"group", zone.group}});
    fmt::print("  zone {:<24} {:>8} macro-elements\n", zone.group, zone.patches);
  }
  inform("MESH1_3", {{"nodes", std::to_string(report.new_nodes)}, {"cells", std::to_string(report.new_cells)}});
  return made;
}

/// The cells that TOUT or GROUP_MA name.
std::vector<std::int32_t> chosen(const Mesh& mesh, const Keywords& factor) {
  std::vector<std::int32_t> cells;
  if (factor.has("TOUT")) {
    cells.resize(mesh.n_cells());
    std::iota(cells.begin(), cells.end(), 0);
    return cells;
  }
  if (!factor.has("GROUP_MA")) fail("ORDER_2", {{"keyword", factor.path("TOUT") + " or GROUP_MA"}});
  for (const std::string& group : factor.texts("GROUP_MA")) {
    const auto members = cells_of_group(mesh, group, factor.path("GROUP_MA"));
    cells.insert(cells.end(), members.begin(), members.end());
  }
  return cells;
}

/// The keywords that change the order of cells, and what does it.
struct Change {
  const char* keyword;
  const char* what;
  std::int64_t (*make)(Mesh&, std::span<const std::int32_t>);
};
const Change changes[] = {{"LINE_QUAD", "quadratic", make_quadratic},
                          {"QUAD_LINE", "linear", make_linear},
                          {"HEXA20_27", "complete: HEXA27, QUAD9", make_complete}};

}  // namespace

Mesh crea_maillage(const Mesh& mesh, const Keywords& keywords) {
  Mesh made;
  if (keywords.has("DECOUPE_LAC")) {
    const auto occurrences = keywords.factors("DECOUPE_LAC");
    if (occurrences.size() != 1) fail("ORDER_4", {{"keyword", "DECOUPE_LAC"}, {"expected", "given once"}});
    made = cut(mesh, occurrences[0]);
  } else {
    const auto change =
        std::find_if(std::begin(changes), std::end(changes), [&](const Change& c) { return keywords.has(c.keyword); });
    if (change == std::end(changes)) fail("ORDER_2", {{"keyword", "DECOUPE_LAC, LINE_QUAD, QUAD_LINE or HEXA20_27"}});
    refuse_cut_mesh(mesh, change->keyword);
    made = mesh;
    for (const Keywords& factor : keywords.factors(change->keyword))
      fmt::print("  {}: {} cells became {}\n", change->keyword, change->make(made, chosen(made, factor)), change->what);
  }
  fmt::print("  nodes {:>8} -> {:>8}\n  cells {:>8} -> {:>8}\n", mesh.n_nodes(), made.n_nodes(), mesh.n_cells(),
             made.n_cells());
  return made;
}

}  // namespace lacon
