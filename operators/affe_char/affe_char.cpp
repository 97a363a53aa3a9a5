#include "lacon/operators/affe_char/affe_char.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/affe_char/component_names.hpp"
#include "lacon/operators/affe_char/nodal_forces.hpp"
#include "lacon/operators/affe_char/places.hpp"
#include "lacon/operators/affe_char/relations.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/meshing/skin.hpp"
#include "lacon/operators/program/study_function.hpp"

namespace lacon {
namespace {

// ---------------------------------------------------------------------------------------------------- nodes

/// CHARGE_26: nodes that have unknowns from skin cells alone, and lie where a body has a node. Skins that stand for a body in
/// contact have nodes of their own, elsewhere.
void tell_loose(const LoadScene& scene, const std::vector<NamedPlaces>& places) {
  std::set<std::array<double, 3>> of_bodies;  // once there is a reason to look
  bool looked = false;
  const auto place = [&](std::int32_t node) {
    const auto point = scene.mesh.point(static_cast<std::size_t>(node));
    return std::array{point[0], point[1], point[2]};
  };
  std::map<std::string, std::vector<std::int32_t>> loose;  // by source: names of nodes are one each
  for (const NamedPlaces& named : places)
    for (const std::int32_t node : named.members) {
      if (scene.dofs[static_cast<std::size_t>(node)] == 0 || scene.is_of_a_body[static_cast<std::size_t>(node)]) continue;
      if (!std::exchange(looked, true))
        for (std::size_t i = 0; i < scene.is_of_a_body.size(); ++i)
          if (scene.is_of_a_body[i]) of_bodies.insert(place(static_cast<std::int32_t>(i)));
      if (of_bodies.contains(place(node))) loose[named.source].push_back(node);
    }
  for (const auto& [source, nodes] : loose)
    inform("CHARGE_26", {{"keyword", source}, {"count", std::to_string(nodes.size())}, {"node", node_name(nodes.front())}});
}

/// Values of every component in `components` that an occurrence gives, on the nodes that it names. A force FX acts on DX.
void load_nodes(const LoadScene& scene, const std::vector<Keywords>& factors, std::span<const std::string_view> components,
                std::string_view conflict, std::vector<LoadTerm>& terms) {
  GivenTerms given(scene, conflict, terms);
  const auto places_of = [&](const Keywords& factor) {
    std::vector<NamedPlaces> places = named_nodes(scene, factor);
    tell_loose(scene, places);
    return places;
  };
  for (const Keywords& factor : factors)
    for (const NamedPlaces& named : places_of(factor))
      for (const std::string_view component : components) {
        if (!factor.has(component)) continue;
        const LoadValue value = value_of(scene.base, factor, component);
        for (const std::int32_t node : named.members) {
          std::string dof(component);
          if (dof.front() == 'F') dof.front() = 'D';
          scene.check_dof(node, dof, named.source);
          given.add(node, part("place_node", {{"node", node_name(node)}}), std::string(component), value, named.source);
        }
      }
}

constexpr std::string_view angular_velocity[] = {"WX", "WY", "WZ"}, axis_point[] = {"X", "Y", "Z"};  // of ROTATION

// ---------------------------------------------------------------------------------------------------- cells

/// A factor keyword that loads cells.
struct CellKeyword {
  const char* keyword;
  const char* option;      ///< whose kernel does it
  int space, codimension;  ///< of the cells' elements; space 0: any
  const char* carrier;     ///< the part that says what these cells are
  std::vector<LoadTerm> Load::*terms;
};
const CellKeyword cell_keywords[] = {
    {"PRES_REP", "CHAR_MECA_PRES", 0, 1, "skin_cell", &Load::pressure},
    {"FORCE_CONTOUR", "CHAR_MECA_FORC", 2, 1, "edge_of_body", &Load::force},
    {"FORCE_FACE", "CHAR_MECA_FORC", 3, 1, "face_of_body", &Load::force},
    {"FORCE_INTERNE", "CHAR_MECA_FORC", 0, 0, "body_cell", &Load::force},
};

bool fits(const LoadScene& scene, const CellKeyword& kind, std::int32_t cell) {
  const catalog::ElementRow* row = scene.element(cell);
  if (!row || !scene.registry.has_kernel(*row, kind.option)) return false;
  const int space = catalog::dimension_of(row->geometry);
  return (kind.space == 0 || kind.space == space) && space - catalog::cell(row->cell).dimension == kind.codimension;
}

/// Alarms and errors about the side of skin cells under pressure (VERI_NORM).
class OrientationCheck {
 public:
  OrientationCheck(const LoadScene& scene) : scene_(scene), sides_(scene.mesh) {}
  void operator()(std::span<const std::int32_t> cells, const std::string& source) const {
    std::vector<std::int32_t> inward, alone, between;
    for (const std::int32_t cell : cells) {
      const Side side = sides_.seen_from(bodies(cell));
      if (side == Side::inward) inward.push_back(cell);
      if (side == Side::alone) alone.push_back(cell);
      if (side == Side::between) between.push_back(cell);
    }
    if (!inward.empty())
      fail("CHARGE_7", {{"keyword", source}, {"count", std::to_string(inward.size())}, {"cell", cell_name(inward.front())}});
    if (!alone.empty())
      inform("CHARGE_8", {{"keyword", source}, {"count", std::to_string(alone.size())}, {"cell", cell_name(alone.front())}});
    if (between.empty()) return;
    const auto around = bodies(between.front());
    inform("CHARGE_27", {{"keyword", source},
                         {"count", std::to_string(between.size())},
                         {"cell", cell_name(between.front())},
                         {"first", cell_name(around[0].cell)},
                         {"second", cell_name(around[1].cell)}});
  }

 private:
  /// Of several that have the skin cell as a facet those of the model: it is the outside of a model that ends there.
  std::vector<BodyCell> bodies(std::int32_t skin_cell) const {
    std::vector<BodyCell> found = sides_.bodies(skin_cell);
    const auto elsewhere = [&](const BodyCell& body) { return !scene_.element(body.cell); };
    if (found.size() > 1 && !std::ranges::all_of(found, elsewhere)) std::erase_if(found, elsewhere);
    return found;
  }

  const LoadScene& scene_;
  SkinSides sides_;
};

/// CHARGE_6: the cell cannot carry the load.
[[noreturn]] void refuse_cell(const LoadScene& scene, std::int32_t cell, const char* carrier, const std::string& source) {
  fail("CHARGE_6", {{"keyword", source},
                    {"cell", cell_name(cell)},
                    {"type", std::string(scene.mesh.row(static_cast<std::size_t>(cell)).name)},
                    {"carrier", part(carrier)}});
}

/// CHARGE_9: its element knows no such component.
[[noreturn]] void refuse_component(const LoadScene& scene, std::int32_t cell, const std::string& component,
                                   const std::vector<std::string>& known, const std::string& source) {
  fail("CHARGE_9", {{"keyword", source},
                    {"component", component},
                    {"cell", cell_name(cell)},
                    {"element", std::string(scene.element(cell)->name)},
                    {"known", fmt::format("{}", fmt::join(known, ", "))}});
}

void check_cell(const LoadScene& scene, const CellKeyword& kind, std::int32_t cell, const std::string& component,
                const std::string& source) {
  if (!fits(scene, kind, cell)) refuse_cell(scene, cell, kind.carrier, source);
  const char* const* values = scene.registry.kernel(*scene.element(cell), kind.option, LACON_LOAD).parameters;
  std::vector<std::string> known;
  for (; *values; ++values) known.emplace_back(*values);
  if (std::find(known.begin(), known.end(), component) == known.end()) refuse_component(scene, cell, component, known, source);
}

void load_cells(Load& load, const LoadScene& scene, const Keywords& keywords) {
  GivenTerms pressures(scene, "CHARGE_5", load.pressure), forces_on_cells(scene, "CHARGE_5", load.force);
  std::optional<OrientationCheck> orientation;
  for (const CellKeyword& kind : cell_keywords)
    for (const Keywords& factor : keywords.factors(kind.keyword)) {
      const bool is_pressure = kind.terms == &Load::pressure;
      for (const NamedPlaces& named : named_cells(scene, factor, [&](std::int32_t c) { return fits(scene, kind, c); })) {
        for (const std::string component : {"PRES", "CISA_2D", "FX", "FY", "FZ"}) {
          if (!factor.has(component)) continue;
          const LoadValue value = value_of(scene.base, factor, component);
          for (const std::int32_t cell : named.members) {
            check_cell(scene, kind, cell, component, named.source);
            (is_pressure ? pressures : forces_on_cells)
                .add(cell, part("place_cell", {{"cell", cell_name(cell)}}), component, value, named.source);
          }
        }
        if (!is_pressure || !keywords.yes("VERI_NORM")) continue;
        if (!orientation) orientation.emplace(scene);
        (*orientation)(named.members, named.source);
      }
    }
}

/// PESANTEUR: GRAVITE along DIRECTION on body cells.
void load_gravity(Load& load, const LoadScene& scene, const Keywords& keywords) {
  const CellKeyword kind{"PESANTEUR", "CHAR_MECA_FORC", 0, 0, "body_cell", &Load::gravity};
  GivenTerms given(scene, "CHARGE_5", load.gravity);
  for (const Keywords& factor : keywords.factors(kind.keyword)) {
    std::vector<double> direction = factor.reals("DIRECTION");
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    const auto refuse = [&](const std::string& reason) {
      fail("CHARGE_10", {{"keyword", factor.path("DIRECTION")}, {"reason", reason}, {"remedy", part("remedy_gravity")}});
    };
    if (!(length > 0)) refuse(part("no_length"));
    for (double& component : direction) component /= length;
    for (const NamedPlaces& named : named_cells(scene, factor, [&](std::int32_t c) { return fits(scene, kind, c); }))
      for (const std::int32_t cell : named.members) {
        check_cell(scene, kind, cell, "FX", named.source);
        const catalog::ElementRow& row = *scene.element(cell);
        if (row.geometry != catalog::Geometry::space && direction[2] != 0) refuse(part("out_of_plane"));
        if (row.geometry == catalog::Geometry::axis && direction[0] != 0) refuse(part("not_along_axis"));
        for (std::size_t d = 0; d < static_cast<std::size_t>(catalog::dimension_of(row.geometry)); ++d)
          given.add(cell, part("place_cell", {{"cell", cell_name(cell)}}), std::string(force_along[d]),
                    {factor.real("GRAVITE") * direction[d], ""}, named.source);
      }
  }
}

/// ROTATION: bodies that turn round an axis; in the plane it is normal to it, in axisymmetry that of revolution.
void load_rotation(Load& load, const LoadScene& scene, const Keywords& keywords) {
  const CellKeyword kind{"ROTATION", "CHAR_MECA_FORC", 0, 0, "body_cell", &Load::gravity};
  GivenTerms given(scene, "CHARGE_5", load.gravity);
  for (const Keywords& factor : keywords.factors(kind.keyword)) {
    const std::vector<double> along = factor.reals("AXE");
    std::vector<double> centre = factor.reals("CENTRE");
    centre.resize(3, 0.0);
    const double length = std::hypot(along[0], along[1], along[2]);
    const auto refuse = [&](const std::string& keyword, const std::string& reason) {
      fail("CHARGE_10", {{"keyword", factor.path(keyword)}, {"reason", reason}, {"remedy", part("remedy_rotation")}});
    };
    if (!(length > 0)) refuse("AXE", part("no_length"));
    for (const NamedPlaces& named : named_cells(scene, factor, [&](std::int32_t c) { return fits(scene, kind, c); }))
      for (const std::int32_t cell : named.members) {
        check_cell(scene, kind, cell, "FX", named.source);
        const catalog::Geometry geometry = scene.element(cell)->geometry;
        if (geometry == catalog::Geometry::plane && (along[0] != 0 || along[1] != 0))
          refuse("AXE", part("not_normal_to_plane"));
        if (geometry == catalog::Geometry::axis && (along[0] != 0 || along[2] != 0))
          refuse("AXE", part("not_axis_of_revolution"));
        if (geometry == catalog::Geometry::axis && centre[0] != 0) refuse("CENTRE", part("not_on_axis"));
        for (std::size_t d = 0; d < 3; ++d) {
          given.add(cell, part("place_cell", {{"cell", cell_name(cell)}}), std::string(angular_velocity[d]),
                    {factor.real("VITESSE") * along[d] / length, ""}, named.source);
          given.add(cell, part("place_cell", {{"cell", cell_name(cell)}}), std::string(axis_point[d]), {centre[d], ""},
                    named.source);
        }
      }
  }
}

/// The field that a keyword names, of cells or their integration points, on the model's mesh, in place of values by cell.
/// Throws CREACHAMP_5, FIELDS_6.
LoadTerm term_of_field(const LoadScene& scene, const Keywords& factor, const std::string& keyword,
                       const std::string& quantity) {
  const std::string id = factor.concept_id(keyword);
  const Field field = scene.base.field_head(id);
  check_same_mesh(scene.base, scene.model.mesh, field.mesh);
  const std::string types[] = {"ELGA_" + quantity, "ELEM_" + quantity};
  check_field(field, std::array<std::string_view, 2>{types[0], types[1]}, factor.path(keyword), scene.base.label(id));
  return {-1, keyword, {0.0, id}};
}

/// PRE_EPSI: strains without stress on body cells; the components are those of the element's stresses.
void load_strains(Load& load, const LoadScene& scene, const Keywords& keywords) {
  GivenTerms given(scene, "CHARGE_5", load.strain);
  const auto is_body = [&](std::int32_t cell) {
    const catalog::ElementRow* row = scene.element(cell);
    return row && row->role == catalog::Role::solid;
  };
  for (const Keywords& factor : keywords.factors("PRE_EPSI"))
    for (const NamedPlaces& named : named_cells(scene, factor, is_body))
      for (const std::string component : {"EPXX", "EPYY", "EPZZ", "EPXY", "EPXZ", "EPYZ"}) {
        if (!factor.has(component)) continue;
        const LoadValue value = value_of(scene.base, factor, component);
        for (const std::int32_t cell : named.members) {
          if (!is_body(cell)) refuse_cell(scene, cell, "body_cell", named.source);
          std::vector<std::string> known;
          for (const std::string_view stress : scene.element(cell)->stress)
            known.push_back("EP" + std::string(stress.substr(2)));
          if (std::find(known.begin(), known.end(), component) == known.end())
            refuse_component(scene, cell, component, known, named.source);
          given.add(cell, part("place_cell", {{"cell", cell_name(cell)}}), component, value, named.source);
        }
      }
  for (const Keywords& factor : keywords.factors("PRE_EPSI"))
    if (factor.has("EPSI")) load.strain.push_back(term_of_field(scene, factor, "EPSI", "EPSI_R"));
}

/// The displacements that an occurrence imposes, and those that LIAISON='ENCASTRE' or BLOCAGE='DEPLACEMENT' hold: all of the
/// model.
void add_imposed(std::vector<Keywords>& imposed, const Keywords& factor, int dimension) {
  imposed.push_back(factor);
  const std::vector<std::string> held = factor.texts("BLOCAGE");
  if (!factor.has("LIAISON") && std::find(held.begin(), held.end(), "DEPLACEMENT") == held.end()) return;
  nlohmann::json values = factor.values();
  for (int d = 0; d < dimension; ++d) values[translation[d]] = 0.0;
  imposed.emplace_back(std::move(values), factor.path(""));
}

}  // namespace

Load affe_char(const Mesh& mesh, const Model& model, Registry& registry, const Base& base, const Keywords& keywords) {
  const LoadScene scene = make_scene(mesh, model, registry, base);
  Load load;
  std::vector<Keywords> imposed;
  for (const char* const keyword : {"MECA_IMPO", "DDL_IMPO", "FACE_IMPO", "ARETE_IMPO"})
    for (const Keywords& factor : keywords.factors(keyword)) add_imposed(imposed, factor, model.dimension);
  load_nodes(scene, imposed, unknowns(), "CHARGE_4", load.imposed);
  load_nodes(scene, along_the_mesh(scene, keywords.factors("FORCE_NODALE")), force_along, "CHARGE_5", load.nodal);
  load_edges(load, scene, keywords);
  load_cells(load, scene, keywords);
  load_gravity(load, scene, keywords);
  load_rotation(load, scene, keywords);
  load_strains(load, scene, keywords);
  for (const Keywords& factor : keywords.factors("PRE_SIGM"))
    load.nodal.push_back(term_of_field(scene, factor, "SIGM", "SIEF_R"));
  add_relations(load, scene, keywords);

  std::size_t stressed = 0;  // cells of fields
  const auto cells = [&](const std::vector<LoadTerm>& terms) {
    std::vector<std::int32_t> places;
    for (const LoadTerm& term : terms) {
      if (term.place >= 0)
        places.push_back(term.place);
      else if (const Field field = base.field(term.value.function); term.component == "SIGM")
        stressed = field.support.size();
      else
        places.insert(places.end(), field.support.begin(), field.support.end());
    }
    std::sort(places.begin(), places.end());
    return static_cast<std::size_t>(std::unique(places.begin(), places.end()) - places.begin());
  };
  const std::tuple<std::size_t, const char*> lines[] = {{load.imposed.size(), "imposed_dofs"},
                                                        {cells(load.nodal), "nodes_under_forces"},
                                                        {cells(load.pressure), "cells_under_pressure"},
                                                        {cells(load.force), "cells_under_forces"},
                                                        {cells(load.gravity), "cells_under_gravity"},
                                                        {cells(load.strain), "cells_with_strains"},
                                                        {stressed, "cells_with_stresses"},
                                                        {load.relations.size(), "relations_between"}};
  std::string text;
  for (const auto& [count, what] : lines)
    if (count > 0) text += (text.empty() ? "" : ", ") + part(what, {{"count", std::to_string(count)}});
  fmt::print("  {}\n", text);
  return load;
}

}  // namespace lacon
