#include "lacon/operators/proj_champ/proj_champ.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/cell_locator.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/selection.hpp"

namespace lacon {
namespace {

/// A node of the mesh that fields go to, and what they are taken from there.
struct Place {
  std::int32_t node;
  PointInCell from;
};

/// Where a mesh is taken from: nodes in the cells of another one.
class Projection {
 public:
  /// @param label of the mesh `from`
  Projection(const Mesh& from, const Mesh& to, const Keywords& keywords, std::string_view label)
      : from_(from), zero_on_(keywords.yes("PROL_ZERO") ? to.n_nodes() : 0) {
    std::vector<Keywords> parts = keywords.factors("VIS_A_VIS");
    if (parts.empty()) parts.emplace_back();
    std::vector<char> done(to.n_nodes(), 0);
    std::size_t outside = 0;
    double farthest = 0;
    for (const Keywords& part : parts) {
      const CellLocator locator(from, cells_of(from, part));
      for (const std::int32_t node : nodes_of(to, part)) {
        if (std::exchange(done[static_cast<std::size_t>(node)], 1)) continue;
        const auto point = to.point(node);
        std::optional<PointInCell> found = locator.find({point[0], point[1], point[2]}, keywords.optional_real("DISTANCE_MAX"));
        if (!found && !keywords.has("DISTANCE_MAX")) found = locator.find({point[0], point[1], point[2]}, HUGE_VAL);
        if (!found) continue;
        if (found->outside) {
          ++outside;
          farthest = std::max(farthest, found->distance);
        }
        places_.push_back({node, std::move(*found)});
      }
    }
    if (places_.empty() && zero_on_ == 0) fail("PROJCHAMP_2", {{"mesh", std::string(label)}});
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.node < b.node; });
    if (outside > 0 && farthest > keywords.optional_real("DISTANCE_ALARME").value_or(0))
      inform("PROJCHAMP_3", {{"count", std::to_string(outside)}, {"distance", fmt::format("{:.3g}", farthest)}});
  }

  Field operator()(const Field& field) const {
    const std::vector<std::int64_t> row = places(field, from_.n_nodes());
    const std::size_t width = field.n_components();
    Field made = field;
    made.support.clear();
    made.values.clear();
    made.present.clear();
    std::size_t next = 0;  // node that a row is yet to be made for, where there is one for each
    const auto zeros_up_to = [&](std::size_t end) {
      for (; next < std::min(end, zero_on_); ++next) {
        made.support.push_back(static_cast<std::int32_t>(next));
        made.values.insert(made.values.end(), width, 0.0);
        made.present.insert(made.present.end(), width, Field::there);
      }
    };
    for (const Place& place : places_) {
      zeros_up_to(static_cast<std::size_t>(place.node));
      next = static_cast<std::size_t>(place.node) + 1;
      const auto nodes = from_.cells[static_cast<std::size_t>(place.from.cell)];
      made.support.push_back(place.node);
      for (std::size_t c = 0; c < width; ++c) {
        const auto [value, presence] = value_at(field, row, nodes, place.from.weights, c);
        made.values.push_back(value);
        made.present.push_back(presence == Field::absent && zero_on_ > 0 ? Field::there : presence);
      }
    }
    zeros_up_to(zero_on_);
    return without_empty_rows(made);
  }

 private:
  static std::vector<std::int32_t> cells_of(const Mesh& mesh, const Keywords& part) {
    std::vector<std::int32_t> cells;
    for (const std::string& group : part.texts("GROUP_MA_1"))
      for (const std::int32_t cell : cells_of_group(mesh, group, part.path("GROUP_MA_1"))) cells.push_back(cell);
    if (part.has("GROUP_MA_1")) return cells;
    cells.resize(mesh.n_cells());
    std::iota(cells.begin(), cells.end(), 0);
    return cells;
  }
  static std::vector<std::int32_t> nodes_of(const Mesh& mesh, const Keywords& part) {
    std::vector<std::int32_t> cells;
    for (const std::string& group : part.texts("GROUP_MA_2"))
      for (const std::int32_t cell : cells_of_group(mesh, group, part.path("GROUP_MA_2"))) cells.push_back(cell);
    if (!part.has("GROUP_MA_2") && !part.has("GROUP_NO_2")) {
      cells.resize(mesh.n_cells());
      std::iota(cells.begin(), cells.end(), 0);
    }
    std::vector<std::int32_t> nodes = nodes_of_cells(mesh, cells);
    for (const std::string& group : part.texts("GROUP_NO_2"))
      for (const std::int32_t node : nodes_of_group(mesh, group, part.path("GROUP_NO_2"))) nodes.push_back(node);
    return nodes;
  }

  const Mesh& from_;
  std::size_t zero_on_;  ///< PROL_ZERO: 0 is the value of those of so many nodes that have none
  std::vector<Place> places_;
};

/// The mesh that fields go to: its id.
std::string target(const Keywords& keywords, const Base& base) {
  const auto model = keywords.optional_concept("MODELE_2");
  return model ? base.model(*model).mesh : keywords.concept_id("MAILLAGE_2");
}

/// CHAM_GD: a field of its own.
void project_field(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const Field field = base.field(keywords.concept_id("CHAM_GD"));
  if (field.location != Location::nodes || field.quantity.ends_with("_F"))
    fail("PROJCHAMP_1", {{"keyword", keywords.path("CHAM_GD")}, {"field", field.name}});
  check_own_mesh(base, field.mesh, keywords, "MAILLAGE_1", "MODELE_1");
  const std::string mesh = target(keywords, base);
  const Mesh here = base.mesh(field.mesh), there = base.mesh(mesh);
  Field made = Projection(here, there, keywords, base.label(field.mesh))(field);
  made.name = order.result_label;
  made.mesh = mesh;
  base.store(made);
}

}  // namespace

void proj_champ(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  if (keywords.has("CHAM_GD")) return project_field(order, base);
  const Result from = base.result(keywords.concept_id("RESULTAT"));
  check_own_mesh(base, from.mesh, keywords, "MAILLAGE_1", "MODELE_1");
  const auto model = keywords.optional_concept("MODELE_2");
  const std::vector<std::int64_t> orders = selected_orders(base, from, keywords);
  Result to = part_of(from, orders);
  to.version = 0;
  to.label = order.result_label;
  to.model = model.value_or("");
  to.mesh = target(keywords, base);
  to.material_field = "";
  to.stages = {{}};
  to.tables.clear();
  const Mesh here = base.mesh(from.mesh), there = base.mesh(to.mesh);
  const Projection project(here, there, keywords, base.label(from.mesh));
  std::vector<std::string> names = keywords.texts("NOM_CHAM");
  const bool all = names.empty();
  if (all)
    for (const auto& [name, files] : from.fields) names.push_back(name);
  for (const std::string& name : names)
    for (const std::int64_t o : orders) {
      if (all && !from.fields.at(name).contains(o)) continue;
      Field field = base.field(from, name, o);
      if (field.location != Location::nodes) {
        if (all) continue;
        fail("PROJCHAMP_1", {{"keyword", keywords.path("NOM_CHAM")}, {"field", name}});
      }
      base.add_field(to, project(field));
    }
  base.store(to);
}

}  // namespace lacon
