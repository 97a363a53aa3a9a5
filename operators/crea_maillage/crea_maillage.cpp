#include "lacon/operators/crea_maillage/crea_maillage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/crea_maillage/order_change.hpp"
#include "lacon/operators/crea_maillage/restriction.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/checks.hpp"
#include "lacon/operators/meshing/cut.hpp"
#include "lacon/operators/meshing/named_nodes.hpp"
#include "lacon/operators/meshing/quality.hpp"

namespace lacon {
namespace {

LacCut cut_of(const Keywords& factor, std::int64_t info) {
  LacCut cut{.groups = factor.texts("GROUP_MA_ESCL"),
             .option = factor.text("DECOUPE_HEXA"),
             .node_groups = !factor.has("GROUP_NO_COMPLET")  ? SkinGroups::tell
                            : factor.yes("GROUP_NO_COMPLET") ? SkinGroups::complete
                                                             : SkinGroups::keep,
             .details = info > 1,
             .keyword = factor.path("GROUP_MA_ESCL")};
  if (cut.option != "PYRA" && cut.option != "HEXA")
    fail("KEYWORD_18", {{"keyword", factor.path("DECOUPE_HEXA")}, {"expected", "PYRA, HEXA"}});
  return cut;
}

/// @param nodes, cells how many there were
void print_counts(std::size_t nodes, std::size_t cells, const Mesh& after) {
  fmt::print("  {:<5} {:>8} -> {:>8}\n  {:<5} {:>8} -> {:>8}\n", part("nodes"), nodes, after.n_nodes(), part("cells"), cells,
             after.n_cells());
}

/// "SEG3, TRIA6": the types of the cells of all patches.
std::string slave_types(const Mesh& mesh) {
  std::set<std::string_view> names;
  for (std::size_t patch = 0; patch < mesh.patches->size(); ++patch)
    for (const std::int32_t cell : mesh.patches->cells[patch]) names.insert(mesh.row(static_cast<std::size_t>(cell)).name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Below it a cell is named as badly shaped: METHOD.md 1.6 on cells with several slave faces.
constexpr double poor_quality = 0.1;

/// What the cut does to the shape of cells: a line, with `details` quantiles and the worst cells too.
void print_quality(const CutReport& report, const Mesh& after, bool details) {
  const Quality &was = report.before, &is = report.after;
  const auto place = [&](std::int32_t cell) {
    const std::string groups = groups_with(after, cell);
    return cell_name(cell) + (groups.empty() ? "" : " (" + groups + ")");
  };
  const auto shown = [](double value) { return fmt::format("{:.3f}", value); };
  fmt::print("  {}\n", part("jacobian_of_cut", {{"least", shown(was.least())},
                                                {"largest", shown(was.quantiles.back())},
                                                {"least_after", shown(is.least())},
                                                {"largest_after", shown(is.quantiles.back())}}));
  if (details) {
    fmt::print("    {:8} {:>9} {:>8}", "", part("cells"), part("mean"));
    for (const double fraction : Quality::fractions) fmt::print(" {:>6g} %", 100 * fraction);
    for (const auto& [name, quality] : {std::pair(part("before_cut"), &was), std::pair(part("after_cut"), &is)}) {
      fmt::print("\n    {:8} {:>9} {:>8.4f}", name, quality->n_cells, quality->mean);
      for (const double value : quality->quantiles) fmt::print(" {:>8.4f}", value);
    }
    fmt::print("\n    {}\n", part("worst_after_cut"));
    for (const auto& [value, cell] : is.worst)
      fmt::print("    {:8.4f}  {} {}\n", value, after.row(static_cast<std::size_t>(cell)).name, place(cell));
  }
  if (is.least() < poor_quality)
    inform("DECOUPE_9", {{"value", fmt::format("{:.3g}", is.least())},
                         {"cell", place(is.worst.front().second)},
                         {"before", fmt::format("{:.3g}", was.least())}});
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

/// CREA_POI1: a point cell on each of some nodes, behind all other cells; each node gets one.
void add_points(Mesh& mesh, const Keywords& factor) {
  std::vector<std::int32_t> nodes = nodes_by_name(mesh, factor, "NOEUD");
  const auto append = [&](const auto& members) { nodes.insert(nodes.end(), members.begin(), members.end()); };
  if (factor.has("TOUT")) {
    nodes.resize(mesh.n_nodes());
    std::iota(nodes.begin(), nodes.end(), 0);
  }
  for (const std::string& group : factor.texts("GROUP_NO")) append(nodes_of_group(mesh, group, factor.path("GROUP_NO")));
  for (const std::string& group : factor.texts("GROUP_MA"))
    append(nodes_of_cells(mesh, cells_of_group(mesh, group, factor.path("GROUP_MA"))));
  std::ranges::sort(nodes);
  const auto twice = std::ranges::unique(nodes);
  nodes.erase(twice.begin(), twice.end());
  std::vector<std::int32_t> made;
  for (const std::int32_t node : nodes) {
    made.push_back(static_cast<std::int32_t>(mesh.n_cells()));
    mesh.add_cell(CellType::POI1, {&node, 1});
  }
  for (const std::string& name : factor.texts("NOM_GROUP_MA")) {
    if (mesh.find_cell_group(name))
      fail("GROUPE_1",
           {{"keyword", factor.path("NOM_GROUP_MA")}, {"what", part("cell")}, {"group", name}, {"remove", "DETR_GROUP_MA"}});
    mesh.cell_groups.push_back({name, made});
  }
}

/// The keywords that change the order of cells, the part that tells it, and what does it.
struct Change {
  const char* keyword;
  const char* what;
  std::int64_t (*make)(Mesh&, std::span<const std::int32_t>);
};
const Change changes[] = {{"LINE_QUAD", "cells_quadratic", make_quadratic},
                          {"QUAD_LINE", "cells_linear", make_linear},
                          {"HEXA20_27", "cells_complete", make_complete}};

}  // namespace

Mesh cut_and_tell(Mesh mesh, const LacCut& cut) {
  const std::size_t nodes = mesh.n_nodes(), cells = mesh.n_cells();
  CutReport report;
  Mesh made = cut_lac(std::move(mesh), cut.groups, cut.option, cut.keyword, report);
  for (const CutZone& zone : report.zones) {
    if (zone.turned > 0) inform("DECOUPE_7", {{"count", std::to_string(zone.turned)}, {"group", zone.group}});
    fmt::print("  {} {:<24} {:>8} {}\n", part("zone"), zone.group, zone.patches, part("macro_elements"));
  }
  if (cut.node_groups == SkinGroups::complete) complete_node_groups(report, made);
  if (report.new_cells > 0)
    inform("MESH1_3", {{"nodes", std::to_string(report.new_nodes)}, {"cells", std::to_string(report.new_cells)}});
  else
    inform("DECOUPE_10", {{"count", std::to_string(made.patches->size())}, {"types", slave_types(made)}});
  if (cut.node_groups == SkinGroups::tell) tell_node_groups(report, made);
  print_quality(report, made, cut.details);
  print_counts(nodes, cells, made);
  return made;
}

Mesh crea_maillage(Mesh mesh, const Keywords& keywords, std::string_view label) {
  const std::size_t nodes = mesh.n_nodes(), cells = mesh.n_cells();
  if (keywords.has("DECOUPE_LAC")) {
    const auto occurrences = keywords.factors("DECOUPE_LAC");
    if (occurrences.size() != 1) fail("KEYWORD_18", {{"keyword", "DECOUPE_LAC"}, {"expected", part("given_once")}});
    const LacCut cut = cut_of(occurrences[0], keywords.integer("INFO"));
    refuse_cut_mesh(mesh, cut.keyword, label);
    return cut_and_tell(std::move(mesh), cut);
  }
  if (keywords.has("RESTREINT")) {
    refuse_cut_mesh(mesh, "RESTREINT", label);
    Mesh made = restricted(mesh, keywords.factors("RESTREINT").at(0));
    print_counts(nodes, cells, made);
    return made;
  }
  if (keywords.has("CREA_POI1")) {
    for (const Keywords& factor : keywords.factors("CREA_POI1")) add_points(mesh, factor);
    print_counts(nodes, cells, mesh);
    return mesh;
  }
  const auto change =
      std::find_if(std::begin(changes), std::end(changes), [&](const Change& c) { return keywords.has(c.keyword); });
  if (change == std::end(changes))
    fail("ORDER_2", {{"keyword", "DECOUPE_LAC, LINE_QUAD, QUAD_LINE, HEXA20_27, RESTREINT or CREA_POI1"}});
  refuse_cut_mesh(mesh, change->keyword, label);
  for (const Keywords& factor : keywords.factors(change->keyword))
    fmt::print("  {}: {}\n", change->keyword,
               part(change->what, {{"count", std::to_string(change->make(mesh, chosen(mesh, factor)))}}));
  tell_what_hangs(mesh);
  print_counts(nodes, cells, mesh);
  return mesh;
}

}  // namespace lacon
