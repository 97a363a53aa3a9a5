#include "lacon/operators/defi_contact/defi_contact.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <utility>

#include "lacon/catalog/contact.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/named_nodes.hpp"
#include "lacon/operators/meshing/skin.hpp"
#include "lacon/operators/program/study_function.hpp"
#include "lacon/pairing/normals.hpp"

namespace lacon {
namespace {

std::string number(std::size_t n) { return std::to_string(n); }

/// What the method asks of the command as a whole, before any mesh is looked at.
void check_method(const Keywords& keywords, const std::vector<Keywords>& zones) {
  if (keywords.text("FORMULATION") != "CONTINUE") fail("LAC_1", {{"found", keywords.text("FORMULATION")}});
  const std::string algorithm = zones.front().text("ALGO_CONT");
  for (const Keywords& zone : zones)
    if (zone.text("ALGO_CONT") != algorithm)
      fail("CONTACT3_4", {{"keyword", zone.path("ALGO_CONT")}, {"first", algorithm}, {"other", zone.text("ALGO_CONT")}});
  if (algorithm != "LAC") fail("LAC_2", {{"keyword", zones.front().path("ALGO_CONT")}, {"found", algorithm}});
  if (keywords.text("FROTTEMENT") != "SANS") fail("CONTACT4_4", {{"found", keywords.text("FROTTEMENT")}});
  for (const char* keyword : {"ALGO_RESO_GEOM", "ALGO_RESO_CONT"})
    if (keywords.text(keyword) != "NEWTON") fail("CONTACT4_1", {{"keyword", keyword}, {"found", keywords.text(keyword)}});
  for (const Keywords& zone : zones)
    if (zone.text("ADAPTATION") != "NON")
      fail("CONTACT_95", {{"keyword", zone.path("ADAPTATION")}, {"found", zone.text("ADAPTATION")}});
}

/// The place of a group among those given to DECOUPE_LAC, or -1.
int cut_zone(const Patches& patches, const std::string& group) {
  const auto at = std::find(patches.zone_group.begin(), patches.zone_group.end(), group);
  return at == patches.zone_group.end() ? -1 : static_cast<int>(at - patches.zone_group.begin());
}

/// Every group of DECOUPE_LAC is the slave of one zone, and every slave is such a group.
void check_zones(const Patches& patches, std::string_view mesh_label, const std::vector<Keywords>& zones) {
  std::string prepared;
  for (const std::string& group : patches.zone_group) prepared += (prepared.empty() ? "" : ", ") + group;
  std::set<std::string> used;
  for (const Keywords& zone : zones) {
    const std::string slave = zone.text("GROUP_MA_ESCL"), master = zone.text("GROUP_MA_MAIT");
    if (cut_zone(patches, slave) < 0 && cut_zone(patches, master) >= 0)
      fail("CONTACT4_5", {{"keyword", zone.path("GROUP_MA_ESCL")},
                          {"group", slave},
                          {"reason", part("skins_look_swapped", {{"master", master}})}});
    if (cut_zone(patches, slave) < 0)
      fail("CONTACT2_18", {{"keyword", zone.path("GROUP_MA_ESCL")}, {"group", slave}, {"prepared", prepared}});
    used.insert(slave);
  }
  if (zones.size() != patches.zone_group.size() || used.size() != zones.size())
    fail("CONTACT2_17", {{"zones", number(zones.size())},
                         {"used", number(used.size())},
                         {"groups", number(patches.zone_group.size())},
                         {"prepared", prepared},
                         {"mesh", std::string(mesh_label)}});
}

/// Skin cells that AFFE_MODELE left out get the element of their body's modelisation, where it knows contact.
void complete_skins(const Mesh& mesh, const Model& model, const Registry& registry, const SkinSides& sides,
                    std::span<const std::int32_t> cells, std::vector<SkinElement>& skins) {
  for (const std::int32_t cell : cells) {
    if (model.element[static_cast<std::size_t>(cell)] >= 0) continue;
    for (const BodyCell& body : sides.bodies(cell)) {
      const std::int32_t element = model.element[static_cast<std::size_t>(body.cell)];
      if (element < 0) continue;
      const catalog::ElementRow* of_body = registry.find_element(model.elements[static_cast<std::size_t>(element)]);
      const catalog::ElementRow* row =
          of_body ? registry.find_element(of_body->modelisation, mesh.types[static_cast<std::size_t>(cell)]) : nullptr;
      if (!row || !registry.has_kernel(*row, "RIGI_CONT")) continue;
      skins.push_back({cell, std::string(row->name)});
      break;
    }
  }
}

/// A skin cell needs an element that knows contact.
void check_elements(const Mesh& mesh, const Model& model, const Registry& registry, std::span<const std::int32_t> cells,
                    const std::string& where) {
  for (const std::int32_t cell : cells) {
    const auto c = static_cast<std::size_t>(cell);
    const std::string type(mesh.row(c).name);
    if (mesh.row(c).dimension != model.dimension - 1)
      fail("CONTACT_96", {{"where", where}, {"cell", cell_name(cell)}, {"type", type}, {"reason", part("no_skin_of_model")}});
    const std::int32_t element = model.element[c];
    if (element < 0) fail("LAC_4", {{"where", where}, {"cell", cell_name(cell)}, {"type", type}});
    const std::string& name = model.elements[static_cast<std::size_t>(element)];
    if (name.starts_with("COQUE_3D/")) fail("CONTACT_94", {{"where", where}, {"cell", cell_name(cell)}});
    const catalog::ElementRow* row = registry.find_element(name);
    if (!row || !registry.has_kernel(*row, "RIGI_CONT"))
      fail("CONTACT_96", {{"where", where},
                          {"cell", cell_name(cell)},
                          {"type", type},
                          {"reason", part("element_without_contact", {{"element", name}})}});
  }
}

/// Contact of a ring (weights with r) and of a plate in one computation has no meaning: all skins are axisymmetric, or none.
void check_axisymmetry(const Model& model, const Registry& registry, const std::vector<ContactZone>& zones) {
  std::int32_t with = -1, without = -1;  // a cell of either kind
  const auto element = [&](std::int32_t cell) -> const std::string& {
    return model.elements[static_cast<std::size_t>(model.element[static_cast<std::size_t>(cell)])];
  };
  for (const ContactZone& zone : zones)
    for (const auto* cells : {&zone.slave, &zone.master})
      for (const std::int32_t cell : *cells)
        (registry.find_element(element(cell))->geometry == catalog::Geometry::axis ? with : without) = cell;
  if (with < 0 || without < 0) return;
  fail("LAC_6", {{"with", cell_name(with)},
                 {"with_element", element(with)},
                 {"without", cell_name(without)},
                 {"without_element", element(without)}});
}

/// The body lies behind every skin cell: METHOD.md 2.1, VERI_NORM.
void check_sides(const SkinSides& sides, std::span<const std::int32_t> cells, const std::string& where,
                 const std::string& group) {
  std::vector<std::int32_t> inward, alone;
  for (const std::int32_t cell : cells) {
    const Side side = sides[cell];
    if (side == Side::inward) inward.push_back(cell);
    if (side == Side::alone) alone.push_back(cell);
  }
  if (!inward.empty())
    fail("MODELISA4_24",
         {{"where", where}, {"group", group}, {"count", number(inward.size())}, {"cell", cell_name(inward.front())}});
  if (!alone.empty())
    inform("CONTACT2_20", {{"where", where}, {"count", number(alone.size())}, {"cell", cell_name(alone.front())}});
}

/// Nothing touches a face between two cells of bodies: what comes near lies on the surface of the body around.
void check_outside(const Model& model, const SkinSides& sides, std::span<const std::int32_t> cells, const std::string& keyword,
                   const std::string& group) {
  for (const std::int32_t cell : cells) {
    std::vector<BodyCell> bodies = sides.bodies(cell);
    std::erase_if(bodies, [&](const BodyCell& body) { return model.element[static_cast<std::size_t>(body.cell)] < 0; });
    refuse_inner(bodies, cell, keyword, group);
  }
}

/// A body that AFFE_MODELE forgot leaves its skin without stiffness: the matrix would be singular, without a word of why.
void check_bodies(const Model& model, const SkinSides& sides, std::span<const std::int32_t> cells, const std::string& where) {
  std::vector<std::pair<std::int32_t, std::int32_t>> bare;  // skin cell, body cell
  for (const std::int32_t cell : cells) {
    const std::vector<BodyCell> bodies = sides.bodies(cell);
    const auto has_element = [&](const BodyCell& body) { return model.element[static_cast<std::size_t>(body.cell)] >= 0; };
    if (!bodies.empty() && std::ranges::none_of(bodies, has_element)) bare.emplace_back(cell, bodies.front().cell);
  }
  if (bare.empty()) return;
  const auto [skin, body] = bare.front();
  inform("CONTACT2_22",
         {{"where", where}, {"count", number(bare.size())}, {"cell", cell_name(skin)}, {"body", cell_name(body)}});
}

/// The slave group holds the sub-cells of its patches, all of them and no others.
void check_patches(const Patches& patches, const ContactZone& zone, const std::string& keyword) {
  std::vector<std::int32_t> in_patches, in_group = zone.slave;
  for (const std::int32_t patch : zone.patches) {
    const auto cells = patches.cells[static_cast<std::size_t>(patch)];
    in_patches.insert(in_patches.end(), cells.begin(), cells.end());
  }
  std::sort(in_patches.begin(), in_patches.end());
  std::sort(in_group.begin(), in_group.end());
  if (in_patches != in_group)
    fail("CONTACT4_5", {{"keyword", keyword},
                        {"group", zone.slave_group},
                        {"reason", part("sub_cells_differ", {{"cells", number(in_group.size())},
                                                             {"patches", number(zone.patches.size())},
                                                             {"others", number(in_patches.size())}})}});
}

void add_slaves(Contact& contact, const ContactZone& zone, const Mesh& mesh) {
  for (const std::int32_t patch : zone.patches) {
    const auto p = static_cast<std::size_t>(patch);
    const auto cells = mesh.patches->cells[p];
    for (std::size_t rank = 0; rank < cells.size(); ++rank) {
      const std::int32_t cell = cells[rank];
      const catalog::SlaveRow* row = catalog::find_slave(mesh.patches->kind[p], static_cast<int>(rank));
      const CellType type = mesh.types[static_cast<std::size_t>(cell)];
      if (!row || row->cell != type)
        fail("LAC_5", {{"group", zone.slave_group},
                       {"cell", cell_name(cell)},
                       {"type", std::string(catalog::cell(type).name)},
                       {"kind", std::to_string(mesh.patches->kind[p])},
                       {"rank", number(rank + 1)}});
      contact.slaves.push_back({cell, patch, static_cast<std::int32_t>(rank), std::string(row->element)});
    }
  }
}

/// Patches that SANS_GROUP_NO and its kin leave out: a condition of contact belongs to a whole patch, so that one that meets
/// such a node has none.
void leave_out(const Mesh& mesh, const Keywords& keywords, ContactZone& zone) {
  constexpr const char* names[] = {"SANS_GROUP_NO", "SANS_GROUP_MA", "SANS_NOEUD", "SANS_MAILLE"};
  const auto given = std::ranges::find_if(names, [&](const char* name) { return keywords.has(name); });
  if (given == std::end(names)) return;
  const std::vector<char> out = nodes_left_out(mesh, keywords);
  for (const std::int32_t patch : zone.patches) {
    const std::vector<std::int32_t> nodes = nodes_of_cells(mesh, mesh.patches->cells[static_cast<std::size_t>(patch)]);
    if (std::ranges::any_of(nodes, [&](std::int32_t node) { return out[static_cast<std::size_t>(node)] != 0; }))
      zone.held_open.push_back(patch);
  }
  const std::string path = keywords.path(*given);
  if (zone.held_open.empty()) inform("LAC_7", {{"keyword", path}, {"group", zone.slave_group}});
  if (zone.held_open.size() == zone.patches.size()) inform("LAC_8", {{"keyword", path}, {"group", zone.slave_group}});
}

ContactZone make_zone(const Mesh& mesh, const Base& base, const Keywords& keywords) {
  ContactZone zone;
  zone.slave_group = keywords.text("GROUP_MA_ESCL");
  zone.master_group = keywords.text("GROUP_MA_MAIT");
  const auto slave = cells_of_group(mesh, zone.slave_group, keywords.path("GROUP_MA_ESCL"));
  const auto master = cells_of_group(mesh, zone.master_group, keywords.path("GROUP_MA_MAIT"));
  zone.slave.assign(slave.begin(), slave.end());
  zone.master.assign(master.begin(), master.end());
  std::sort(zone.master.begin(), zone.master.end());  // a group may name a cell twice: one contact cell is enough
  zone.master.erase(std::unique(zone.master.begin(), zone.master.end()), zone.master.end());
  for (const std::int32_t cell : zone.slave)
    if (std::binary_search(zone.master.begin(), zone.master.end(), cell))
      fail("LAC_3", {{"slave", zone.slave_group}, {"master", zone.master_group}, {"cell", cell_name(cell)}});
  const auto cut = static_cast<std::size_t>(cut_zone(*mesh.patches, zone.slave_group));
  for (std::int64_t patch = mesh.patches->zone_offset[cut]; patch < mesh.patches->zone_offset[cut + 1]; ++patch)
    zone.patches.push_back(static_cast<std::int32_t>(patch));
  zone.jacobian = keywords.text("TYPE_JACOBIEN");
  zone.search = keywords.text("TYPE_APPA");
  zone.initial_status = keywords.text("CONTACT_INIT");
  zone.tolerance = keywords.real("RESI_APPA");
  zone.distance_limit = keywords.real("COEF_MULT_APPA");
  zone.resolution = keywords.text("RESOLUTION");
  zone.gliding = keywords.text("GLISSIERE");
  if (zone.resolution == "NON") zone.overlap_tolerance = keywords.real("TOLE_INTERP");
  if (keywords.has("DIST_ESCL")) zone.slave_offset = value_of(base, keywords, "DIST_ESCL");
  if (keywords.has("DIST_MAIT")) zone.master_offset = value_of(base, keywords, "DIST_MAIT");
  if (zone.resolution == "NON")
    zone.held_open = zone.patches;
  else
    leave_out(mesh, keywords, zone);
  return zone;
}

/// The first cell of a slave skin that is a master of the other zone. @param master sorted
const std::int32_t* shared_cell(const ContactZone& slave, const ContactZone& master) {
  const auto found =
      std::ranges::find_if(slave.slave, [&](std::int32_t cell) { return std::ranges::binary_search(master.master, cell); });
  return found == slave.slave.end() ? nullptr : &*found;
}

/// Two zones that hold the same skins, each of them as the slave once: conditions of contact that say the same twice.
void check_passes(const std::vector<ContactZone>& zones) {
  const auto touches = [](const ContactZone& zone) { return zone.held_open.size() < zone.patches.size(); };
  for (auto second = zones.begin(); second != zones.end(); ++second)
    for (auto first = zones.begin(); first != second; ++first) {
      const std::int32_t *one = shared_cell(*first, *second), *other = shared_cell(*second, *first);
      if (one && other && touches(*first) && touches(*second))
        fail("LAC_10", {{"first", first->slave_group},
                        {"first_cell", cell_name(*one)},
                        {"second", second->slave_group},
                        {"second_cell", cell_name(*other)}});
    }
}

/// Normals are averaged per zone: a node of two slave skins would have two.
void check_shared_nodes(const Mesh& mesh, const std::vector<ContactZone>& zones) {
  std::vector<std::int32_t> owner(mesh.n_nodes(), -1);
  for (std::size_t z = 0; z < zones.size(); ++z)
    for (const std::int32_t node : nodes_of_cells(mesh, zones[z].slave)) {
      std::int32_t& first = owner[static_cast<std::size_t>(node)];
      if (first >= 0)
        fail("CONTACT2_16", {{"first", zones[static_cast<std::size_t>(first)].slave_group},
                             {"second", zones[z].slave_group},
                             {"node", node_name(node)}});
      first = static_cast<std::int32_t>(z);
    }
}

/// A mean normal at the corner of a body is that of none of its faces, and contact pushes there in a direction of its own.
void check_corners(const Mesh& mesh, const ContactZone& zone) {
  constexpr double corner = 30 * std::numbers::pi / 180;  // from the mean: faces that meet at 120 degrees
  for (const auto& [cells, group] : {std::pair(zone.slave, zone.slave_group), std::pair(zone.master, zone.master_group)}) {
    const Surface surface = surface_of(mesh, cells, mesh.coordinates);
    const TurnedNormals turned = turned_normals(surface, nodal_normals(surface), corner);
    if (turned.count)
      inform("CONTACT2_21", {{"group", group}, {"count", std::to_string(turned.count)}, {"node", node_name(turned.first)}});
  }
}

}  // namespace

Contact defi_contact(const Mesh& mesh, const Model& of_bodies, const Registry& registry, const Base& base,
                     const Keywords& keywords) {
  const std::string mesh_label = base.label(of_bodies.mesh);
  const std::vector<Keywords> factors = keywords.factors("ZONE");
  check_method(keywords, factors);
  if (!mesh.patches || mesh.patches->size() == 0) fail("CONTACT4_2", {{"mesh", mesh_label}});
  check_zones(*mesh.patches, mesh_label, factors);

  Contact contact;
  contact.mesh = of_bodies.mesh;
  contact.smoothing = keywords.yes("LISSAGE");
  const std::string variation = keywords.text("VARIATION_JEU");
  contact.frozen_gap = variation == "FIGEE";
  contact.verify_normals = keywords.yes("VERI_NORM");
  contact.resi_geom = keywords.real("RESI_GEOM");
  contact.elastic_iterations = keywords.integer("CONT_STAT_ELAS");
  contact.stops_at_overlap = keywords.yes("STOP_INTERP");
  const SkinSides sides(mesh);
  for (const Keywords& factor : factors) {
    const ContactZone zone = make_zone(mesh, base, factor);
    for (const auto* cells : {&zone.slave, &zone.master})
      complete_skins(mesh, contact.completed(of_bodies), registry, sides, *cells, contact.skins);
    const Model model = contact.completed(of_bodies);
    check_patches(*mesh.patches, zone, factor.path("GROUP_MA_ESCL"));
    for (const auto& [keyword, group, cells] : {std::tuple("GROUP_MA_ESCL", zone.slave_group, zone.slave),
                                                std::tuple("GROUP_MA_MAIT", zone.master_group, zone.master)}) {
      const std::string where = factor.path(keyword) + " '" + group + "'";
      check_elements(mesh, model, registry, cells, where);
      refuse_degenerate(mesh, cells, factor.path(keyword), group);
      check_bodies(model, sides, cells, where);
      check_outside(model, sides, cells, factor.path(keyword), group);
      if (contact.verify_normals) check_sides(sides, cells, where, group);
    }
    add_slaves(contact, zone, mesh);
    contact.zones.push_back(zone);
    fmt::print("  {}{}\n",
               part("zone_of_contact", {{"number", std::to_string(contact.zones.size())},
                                        {"slave", zone.slave_group},
                                        {"cells", std::to_string(zone.slave.size())},
                                        {"patches", std::to_string(zone.patches.size())},
                                        {"master", zone.master_group},
                                        {"master_cells", std::to_string(zone.master.size())}}),
               zone.held_open.empty() ? "" : part("patches_held_open", {{"count", std::to_string(zone.held_open.size())}}));
  }
  if (!contact.skins.empty())
    fmt::print("  {}\n", part("skins_get_elements", {{"count", std::to_string(contact.skins.size())}}));
  check_passes(contact.zones);
  check_axisymmetry(contact.completed(of_bodies), registry, contact.zones);
  if (contact.smoothing) {
    check_shared_nodes(mesh, contact.zones);
    for (const ContactZone& zone : contact.zones) check_corners(mesh, zone);
  }
  return contact;
}

}  // namespace lacon
