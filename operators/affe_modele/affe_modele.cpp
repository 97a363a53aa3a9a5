#include "lacon/operators/affe_modele/affe_modele.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/conformity.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

constexpr double flat = 1e-10;   // a node of a plane model may leave the plane by this fraction of the mesh's extent
constexpr double behind = 1e-6;  // likewise one of a model of revolution the side of its axis

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

void check_radius(const Mesh& mesh, std::int32_t cell, const std::string& modelisation, double extent) {
  for (const std::int32_t node : mesh.cells[static_cast<std::size_t>(cell)]) {
    const double radius = mesh.point(static_cast<std::size_t>(node))[0];
    if (radius < -behind * extent)
      fail("MODELE_9", {{"modelisation", modelisation},
                        {"node", node_name(node)},
                        {"cell", cell_name(cell)},
                        {"x", fmt::format("{:g}", radius)}});
  }
}

/// The cells that an occurrence of AFFE names; those of several groups may be there twice.
std::vector<std::int32_t> cells_named_by(const Mesh& mesh, const Keywords& factor) {
  std::vector<std::int32_t> cells;
  if (factor.has("TOUT")) {
    cells.resize(mesh.n_cells());
    std::iota(cells.begin(), cells.end(), 0);
  }
  for (const std::string& group : factor.texts("GROUP_MA")) {
    const auto members = cells_of_group(mesh, group, factor.path("GROUP_MA"));
    cells.insert(cells.end(), members.begin(), members.end());
  }
  return cells;
}

/// Displacements gape or overlap where cells do not share what they should, and nothing else ever says so: tell it here, before
/// hours of computing (MODELE_10 to MODELE_13).
void tell_misfits(const Mesh& mesh, int dimension, std::span<const char> solids) {
  const auto named = [&](std::int32_t cell) {
    return fmt::format("{} {}", mesh.row(static_cast<std::size_t>(cell)).name, cell_name(cell));
  };
  const auto with_place = [&](std::int32_t node) {
    const auto p = mesh.point(static_cast<std::size_t>(node));
    return dimension == 3 ? fmt::format("{} ({:g}, {:g}, {:g})", node_name(node), p[0], p[1], p[2])
                          : fmt::format("{} ({:g}, {:g})", node_name(node), p[0], p[1]);
  };
  const auto vertices = [&](const Misfit& misfit) {
    std::vector<std::string> names;
    for (const std::int32_t node : misfit.vertices) names.push_back(with_place(node));
    return join(names);
  };
  const Misfits all = misfits(mesh, dimension, solids);
  const auto tell = [&](std::string_view id, const Misfit& misfit) {
    if (misfit.count > 0)
      inform(id, {{"count", std::to_string(misfit.count)},
                  {"cell", named(misfit.cell)},
                  {"other", misfit.other < 0 ? "" : named(misfit.other)},
                  {"nodes", vertices(misfit)},
                  {"node", misfit.node < 0 ? "" : with_place(misfit.node)}});
  };
  tell("MODELE_10", all.middles);
  tell("MODELE_11", all.diagonals);
  tell("MODELE_12", all.hanging);
  tell("MODELE_13", all.coincident);
}

/// Gives elements to cells, one occurrence of AFFE after the other: the last one counts.
class Assignment {
 public:
  explicit Assignment(const Mesh& mesh)
      : mesh_(mesh), extent_(extent(mesh)), given_(mesh.n_cells(), nullptr), left_by_(mesh.n_cells()) {}

  /// Throws MODELE_1 to MODELE_4, MODELE_6 and MODELE_9.
  void assign(const Registry& registry, const Keywords& factor);
  /// Throws MODELE_8 where a body's cell has no element; says what elements there are (MODELE_5, MODELE_7), and
  /// where bodies do not conform (MODELE_10 to MODELE_13).
  Model model();

 private:
  void check(const catalog::ElementRow& row, std::int32_t cell, const Keywords& factor) const;

  const Mesh& mesh_;
  double extent_;
  Model model_{.dimension = 0};
  std::vector<const catalog::ElementRow*> given_;  ///< to each cell, or nullptr
  std::vector<std::string> left_by_;               ///< of each cell: the last modelisation, where that has no element for it
};

/// What a cell is about to get must fit its occurrence, and what other cells have.
void Assignment::check(const catalog::ElementRow& row, std::int32_t cell, const Keywords& factor) const {
  const std::string modelisation = factor.text("MODELISATION");
  const int dimension = catalog::dimension_of(row.geometry);
  if (row.phenomenon != factor.text("PHENOMENE"))
    fail("MODELE_6",
         {{"keyword", factor.path("PHENOMENE")}, {"modelisation", modelisation}, {"phenomenon", std::string(row.phenomenon)}});
  if (model_.dimension != 0 && model_.dimension != dimension)
    fail("MODELE_4", {{"keyword", factor.path("MODELISATION")}, {"cell", cell_name(cell)}});
  if (dimension == 2) check_plane(mesh_, cell, modelisation, extent_);
  if (row.geometry == catalog::Geometry::axis) check_radius(mesh_, cell, modelisation, extent_);
}

void Assignment::assign(const Registry& registry, const Keywords& factor) {
  const std::string modelisation = factor.text("MODELISATION");
  const auto rows = rows_of(registry, modelisation, factor.path("MODELISATION"));
  const std::vector<std::int32_t> cells = cells_named_by(mesh_, factor);
  std::map<CellType, std::int64_t> without;
  bool serves = false;
  for (const std::int32_t cell : cells) {
    const CellType type = mesh_.types[static_cast<std::size_t>(cell)];
    const catalog::ElementRow* row = rows[static_cast<std::size_t>(type)];
    left_by_[static_cast<std::size_t>(cell)] = row ? "" : modelisation;
    if (!row) {
      ++without[type];
      continue;
    }
    check(*row, cell, factor);
    model_.dimension = catalog::dimension_of(row->geometry);
    model_.phenomenon = row->phenomenon;
    given_[static_cast<std::size_t>(cell)] = row;
    serves = true;
  }
  if (serves) return;
  std::vector<std::string> served;
  for (const catalog::ElementRow* row : rows)
    if (row) served.emplace_back(catalog::cell(row->cell).name);
  fail("MODELE_2", {{"keyword", factor.path("AFFE")},
                    {"modelisation", modelisation},
                    {"served", join(served)},
                    {"found", cells.empty() ? part("none") : cell_types(without)}});
}

Model Assignment::model() {
  std::map<CellType, std::int64_t> without;
  std::map<std::string, std::int64_t> counts;
  std::vector<char> solid(given_.size(), 0);
  for (std::size_t cell = 0; cell < given_.size(); ++cell) {
    const catalog::ElementRow* const row = given_[cell];
    if (!row) {
      if (!left_by_[cell].empty() && mesh_.row(cell).dimension == model_.dimension)
        fail("MODELE_8", {{"modelisation", left_by_[cell]},
                          {"kind", std::string(mesh_.row(cell).name)},
                          {"cell", cell_name(static_cast<std::int32_t>(cell))}});
      ++without[mesh_.types[cell]];
      model_.element.push_back(-1);
      continue;
    }
    solid[cell] = row->role == catalog::Role::solid;
    const std::string name(row->name);
    auto at = std::find(model_.elements.begin(), model_.elements.end(), name);
    if (at == model_.elements.end()) at = model_.elements.insert(at, name);
    model_.element.push_back(static_cast<std::int32_t>(at - model_.elements.begin()));
    ++counts[name];
  }
  for (const auto& [name, count] : counts) fmt::print("  {:<24} {:>9} {}\n", name, count, part("cells"));
  if (std::ranges::count(solid, 0) == std::ssize(solid))
    inform("MODELE_7", {{"where", part(model_.dimension == 3 ? "in_space" : "in_the_plane")}});
  if (!without.empty()) inform("MODELE_5", {{"cells", cell_types(without)}});
  tell_misfits(mesh_, model_.dimension, solid);
  return std::move(model_);
}

}  // namespace

Model affe_modele(const Mesh& mesh, const Registry& registry, const Keywords& keywords) {
  Assignment assignment(mesh);
  for (const Keywords& factor : keywords.factors("AFFE")) assignment.assign(registry, factor);
  return assignment.model();
}

}  // namespace lacon
