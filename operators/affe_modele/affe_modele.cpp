#include "lacon/operators/affe_modele/affe_modele.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

constexpr double flat = 1e-10;  // a node of a plane model may leave the plane by this fraction of the mesh's extent

std::string join(std::span<const std::string> names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string cell_types(const std::map<CellType, std::int64_t>& counts) {
  std::vector<std::string> parts;
  for (const auto& [type, count] : counts) parts.push_back(fmt::format("{} {}", count, catalog::cell(type).name));
  return join(parts);
}

/// The row of each cell type under a modelisation, or nullptr.
std::vector<const catalog::ElementRow*> rows_of(const Registry& registry, const std::string& modelisation,
                                                const std::string& keyword) {
  const std::vector<std::string> known = registry.modelisations();
  if (std::find(known.begin(), known.end(), modelisation) == known.end())
    fail("MODELE_1", {{"keyword", keyword}, {"modelisation", modelisation}, {"known", join(known)}});
  std::vector<const catalog::ElementRow*> rows;
  for (const catalog::CellRow& cell : catalog::cells()) rows.push_back(registry.find_element(modelisation, cell.type));
  return rows;
}

void check_plane(const Mesh& mesh, std::int32_t cell, const std::string& modelisation, double extent) {
  for (const std::int32_t node : mesh.cells[static_cast<std::size_t>(cell)]) {
    const double z = mesh.point(static_cast<std::size_t>(node))[2];
    if (!(std::abs(z) <= flat * extent))
      fail("MODELE_3", {{"modelisation", modelisation},
                        {"node", node_name(node)},
                        {"cell", cell_name(cell)},
                        {"z", fmt::format("{:g}", z)}});
  }
}

/// The largest coordinate difference along an axis.
double extent_of(const Mesh& mesh) {
  double extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = axis; i < mesh.coordinates.size(); i += 3) {
      low = std::min(low, mesh.coordinates[i]);
      high = std::max(high, mesh.coordinates[i]);
    }
    extent = std::max(extent, high - low);
  }
  return extent;
}

}  // namespace

Model affe_modele(const Mesh& mesh, const Registry& registry, const Keywords& keywords) {
  Model model;
  model.dimension = 0;
  std::vector<const catalog::ElementRow*> given(mesh.n_cells(), nullptr);
  std::vector<std::string> left_by(mesh.n_cells());  // the last modelisation that has no element for the cell
  const double extent = extent_of(mesh);
  for (const Keywords& factor : keywords.factors("AFFE")) {
    const std::string modelisation = factor.text("MODELISATION"), phenomenon = factor.text("PHENOMENE");
    const auto rows = rows_of(registry, modelisation, factor.path("MODELISATION"));
    std::vector<std::int32_t> cells;
    if (factor.has("TOUT")) {
      cells.resize(mesh.n_cells());
      std::iota(cells.begin(), cells.end(), 0);
    }
    for (const std::string& group : factor.texts("GROUP_MA")) {
      const auto members = cells_of_group(mesh, group, factor.path("GROUP_MA"));
      cells.insert(cells.end(), members.begin(), members.end());
    }
    std::int64_t count = 0;
    std::map<CellType, std::int64_t> without;
    for (const std::int32_t cell : cells) {
      const CellType type = mesh.types[static_cast<std::size_t>(cell)];
      const catalog::ElementRow* row = rows[static_cast<std::size_t>(type)];
      left_by[static_cast<std::size_t>(cell)] = row ? "" : modelisation;
      if (!row) {
        ++without[type];
        continue;
      }
      if (row->phenomenon != phenomenon)
        fail("MODELE_6", {{"keyword", factor.path("PHENOMENE")},
                          {"modelisation", modelisation},
                          {"phenomenon", std::string(row->phenomenon)}});
      if (model.dimension != 0 && model.dimension != catalog::dimension_of(row->geometry))
        fail("MODELE_4", {{"keyword", factor.path("MODELISATION")}, {"cell", cell_name(cell)}});
      model.dimension = catalog::dimension_of(row->geometry);
      model.phenomenon = phenomenon;
      if (model.dimension == 2) check_plane(mesh, cell, modelisation, extent);
      given[static_cast<std::size_t>(cell)] = row;
      ++count;
    }
    if (count == 0) {
      std::vector<std::string> served;
      for (const catalog::ElementRow* row : rows)
        if (row) served.emplace_back(catalog::cell(row->cell).name);
      fail("MODELE_2", {{"keyword", factor.path("AFFE")},
                        {"modelisation", modelisation},
                        {"served", join(served)},
                        {"found", cells.empty() ? "none" : cell_types(without)}});
    }
  }

  std::map<CellType, std::int64_t> without;
  std::map<std::string, std::int64_t> counts;
  bool body = false;
  for (std::size_t cell = 0; cell < given.size(); ++cell) {
    if (!given[cell]) {
      if (!left_by[cell].empty() && mesh.row(cell).dimension == model.dimension)
        fail("MODELE_8", {{"modelisation", left_by[cell]},
                          {"kind", std::string(mesh.row(cell).name)},
                          {"cell", cell_name(static_cast<std::int32_t>(cell))}});
      ++without[mesh.types[cell]];
      model.element.push_back(-1);
      continue;
    }
    body = body || given[cell]->role == catalog::Role::solid;
    const std::string name(given[cell]->name);
    auto at = std::find(model.elements.begin(), model.elements.end(), name);
    if (at == model.elements.end()) at = model.elements.insert(at, name);
    model.element.push_back(static_cast<std::int32_t>(at - model.elements.begin()));
    ++counts[name];
  }
  for (const auto& [name, count] : counts) fmt::print("  {:<24} {:>9} {}\n", name, count, part("cells"));
  if (!body) inform("MODELE_7", {{"space", model.dimension == 3 ? "space" : "the plane"}});
  if (!without.empty()) inform("MODELE_5", {{"cells", cell_types(without)}});
  return model;
}

}  // namespace lacon
