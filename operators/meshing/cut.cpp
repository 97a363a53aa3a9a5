#include "lacon/operators/meshing/cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "lacon/catalog/cuts.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/quality.hpp"
#include "lacon/operators/meshing/subdivision.hpp"

namespace lacon {
namespace {

using Nodes = std::vector<std::int32_t>;

/// A slave cell, its body cell before any cut, and the zone it belongs to.
struct Slave {
  std::int32_t cell;
  std::int32_t body;
  std::size_t zone;
};

/// Cells while they are cut: a cell that was cut has the sub-cells that replace it. The first ones are those of the mesh; only
/// what changes is kept here.
class Forest {
 public:
  explicit Forest(const Mesh& mesh) : mesh_(mesh) {}

  CellType type(std::int32_t cell) const { return is_of_mesh(cell) ? mesh_.types[index(cell)] : types_[added(cell)]; }
  std::span<const std::int32_t> nodes(std::int32_t cell) const {
    if (!is_of_mesh(cell)) return nodes_[added(cell)];
    const auto at = turned_.find(cell);
    return at == turned_.end() ? mesh_.cells[index(cell)] : std::span<const std::int32_t>(at->second);
  }
  void turn(std::int32_t cell) {
    Nodes nodes_now = mirrored(type(cell), nodes(cell));
    (is_of_mesh(cell) ? turned_[cell] : nodes_[added(cell)]) = std::move(nodes_now);
  }

  std::int32_t add(CellType type, Nodes nodes, std::int32_t parent) {
    const auto cell = static_cast<std::int32_t>(size());
    types_.push_back(type);
    nodes_.push_back(std::move(nodes));
    children_[parent].push_back(cell);
    return cell;
  }

  /// Visit what is left of a cell after all cuts so far, in order; stops where `visit` returns true, and says whether it did.
  template <class Visit>
  bool leaves(std::int32_t cell, const Visit& visit) const {
    const auto at = children_.find(cell);
    if (at == children_.end()) return visit(cell);
    return std::any_of(at->second.begin(), at->second.end(), [&](std::int32_t child) { return leaves(child, visit); });
  }

  std::size_t size() const { return mesh_.n_cells() + types_.size(); }
  /// The cells of the mesh that were cut, ascending.
  Nodes cut_cells() const {
    Nodes cells;
    for (const auto& [cell, children] : children_)
      if (is_of_mesh(cell)) cells.push_back(cell);
    return cells;
  }

 private:
  static std::size_t index(std::int32_t cell) { return static_cast<std::size_t>(cell); }
  bool is_of_mesh(std::int32_t cell) const { return index(cell) < mesh_.n_cells(); }
  std::size_t added(std::int32_t cell) const { return index(cell) - mesh_.n_cells(); }

  const Mesh& mesh_;
  std::vector<CellType> types_;  ///< of the cells that were added
  std::vector<Nodes> nodes_;
  std::map<std::int32_t, Nodes> turned_;    ///< cells of the mesh whose nodes have another order
  std::map<std::int32_t, Nodes> children_;  ///< of the cells that were cut
};

/// Append the images of reference points of a cell (isoparametric, METHOD.md 1.2-3) to the coordinates; returns their numbers.
Nodes add_nodes(CellType type, const Nodes& nodes, std::span<const double> points, std::vector<double>& coordinates) {
  const auto d = static_cast<std::size_t>(catalog::cell(type).dimension);
  Nodes added;
  for (std::size_t p = 0; p < points.size() / d; ++p) {
    const auto point = image(type, nodes, points.subspan(p * d, d), coordinates);
    added.push_back(static_cast<std::int32_t>(coordinates.size() / 3));
    coordinates.insert(coordinates.end(), point.begin(), point.end());
  }
  return added;
}

void append(Nodes& to, const Nodes& more) { to.insert(to.end(), more.begin(), more.end()); }

using Point = std::array<double, 3>;

Point point_of(std::span<const double> coordinates, std::int32_t node) {
  const auto at = coordinates.subspan(3 * static_cast<std::size_t>(node), 3);
  return {at[0], at[1], at[2]};
}

/// How far the mid node of an edge is from the middle of its vertices. @param edge of the cell's row
Point bulge(const catalog::CellRow& row, std::size_t edge, std::span<const std::int32_t> nodes,
            std::span<const double> coordinates) {
  const Point a = point_of(coordinates, nodes[static_cast<std::size_t>(row.edges[edge].first)]),
              b = point_of(coordinates, nodes[static_cast<std::size_t>(row.edges[edge].second)]),
              middle = point_of(coordinates, nodes[static_cast<std::size_t>(row.n_vertices) + edge]);
  return {middle[0] - (a[0] + b[0]) / 2, middle[1] - (a[1] + b[1]) / 2, middle[2] - (a[2] + b[2]) / 2};
}

double length(Point p) { return std::hypot(p[0], p[1], p[2]); }

constexpr double flat = 1e-9;  ///< a bulge below this fraction of the size of a facet or cell is round-off

/// Whether the mid nodes of a quadratic cell are in the middle of its edges, up to `flat` of the longest.
bool has_straight_edges(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates) {
  const catalog::CellRow& row = catalog::cell(type);
  double longest = 0, largest = 0;
  for (std::size_t e = 0; e < row.edges.size(); ++e) {
    const Point a = point_of(coordinates, nodes[static_cast<std::size_t>(row.edges[e].first)]),
                b = point_of(coordinates, nodes[static_cast<std::size_t>(row.edges[e].second)]);
    longest = std::max(longest, length({b[0] - a[0], b[1] - a[1], b[2] - a[2]}));
    largest = std::max(largest, length(bulge(row, e, nodes, coordinates)));
  }
  return largest <= flat * longest;
}

/// Whether the vertices of a facet lie in a plane, up to `flat` of its size.
bool is_plane(CellType type, const Nodes& nodes, std::span<const double> coordinates) {
  const Point origin = point_of(coordinates, nodes[0]);
  const auto from_origin = [&](std::size_t i) {
    const Point p = point_of(coordinates, nodes[i]);
    return Point{p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
  };
  const Point a = from_origin(1), b = from_origin(2);
  const Point normal{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const double area = length(normal);
  for (std::size_t i = 3; i < static_cast<std::size_t>(catalog::cell(type).n_vertices); ++i) {
    const Point p = from_origin(i);
    if (std::abs(p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2]) > flat * std::sqrt(area) * area) return false;
  }
  return true;
}

/// Put the new mid nodes of a sub-cell into the middle of their vertices. A cell with straight edges that is no parallelepiped
/// bends the straight lines of its reference cell: the isoparametric images would give its sub-cells curved edges, over which
/// no rule is exact, and its shape is the same without.
void straighten(CellType type, const Nodes& sub_cell, const Nodes& added, std::vector<double>& coordinates) {
  const catalog::CellRow& row = catalog::cell(type);
  for (std::size_t e = 0; e < row.edges.size(); ++e) {
    const std::int32_t middle = sub_cell[static_cast<std::size_t>(row.n_vertices) + e];
    if (std::ranges::find(added, middle) == added.end()) continue;
    const Point shift = bulge(row, e, sub_cell, coordinates);
    for (std::size_t k = 0; k < 3; ++k) coordinates[3 * static_cast<std::size_t>(middle) + k] -= shift[k];
  }
}

/// Every check on the groups and their cells, before anything is cut.
std::vector<Slave> find_slaves(const Mesh& mesh, std::span<const std::string> groups, const std::string& keyword) {
  const int skin_dimension = mesh.dimension - 1;
  Nodes near;  // the nodes at which body_cells() looks around
  for (const std::string& name : groups)
    if (const Group* group = mesh.find_cell_group(name))
      for (const std::int32_t cell : group->members) near.push_back(mesh.cells[static_cast<std::size_t>(cell)][0]);
  const NodeCells around(mesh, near, mesh.dimension);
  std::vector<Slave> slaves;
  std::map<std::int32_t, std::size_t> zone_of;                    // of a slave cell
  std::map<std::pair<std::int32_t, int>, std::int32_t> slave_of;  // of a facet of a body cell
  for (std::size_t zone = 0; zone < groups.size(); ++zone) {
    const std::string& group = groups[zone];
    if (std::find(groups.begin(), groups.begin() + static_cast<std::ptrdiff_t>(zone), group) !=
        groups.begin() + static_cast<std::ptrdiff_t>(zone))
      fail("DECOUPE_1", {{"keyword", keyword}, {"group", group}});
    for (const std::int32_t cell : cells_of_group(mesh, group, keyword)) {
      const auto c = static_cast<std::size_t>(cell);
      if (mesh.row(c).dimension != skin_dimension)
        fail("DECOUPE_4",
             {{"keyword", keyword},
              {"group", group},
              {"cell", cell_name(cell)},
              {"type", std::string(mesh.row(c).name)},
              {"skin", skin_dimension == 1 ? "segments (SEG2, SEG3)" : "faces (TRIA3, TRIA6, QUAD4, QUAD8, QUAD9)"}});
      if (const auto [at, fresh] = zone_of.emplace(cell, zone); !fresh)
        fail("DECOUPE_2", {{"keyword", keyword}, {"cell", cell_name(cell)}, {"first", groups[at->second]}, {"second", group}});
      const std::vector<BodyCell> bodies = body_cells(mesh, around, c);
      if (bodies.empty())
        fail("MESH1_2",
             {{"keyword", keyword}, {"group", group}, {"cell", cell_name(cell)}, {"type", std::string(mesh.row(c).name)}});
      if (bodies.size() > 1)
        fail("DECOUPE_3", {{"keyword", keyword},
                           {"group", group},
                           {"cell", cell_name(cell)},
                           {"first", cell_name(bodies[0].cell)},
                           {"second", cell_name(bodies[1].cell)}});
      const BodyCell& body = bodies[0];
      if (const auto [at, fresh] = slave_of.emplace(std::pair(body.cell, body.match.facet), cell); !fresh)
        fail("DECOUPE_5", {{"keyword", keyword},
                           {"group", group},
                           {"first", cell_name(at->second)},
                           {"second", cell_name(cell)},
                           {"body", cell_name(body.cell)}});
      const auto b = static_cast<std::size_t>(body.cell);
      if (!is_sound(jacobian_range(mesh.types[b], mesh.cells[b], mesh.coordinates)))
        fail("DECOUPE_6", {{"keyword", keyword},
                           {"group", group},
                           {"what", "the body cell " + cell_name(body.cell) + " under the slave cell " + cell_name(cell)},
                           {"type", std::string(mesh.row(b).name)}});
      slaves.push_back({cell, body.cell, zone});
    }
  }
  return slaves;
}

/// Cut one slave cell and what its body cell has become. @return its sub-cells by rank, as numbers of the forest
Nodes cut_slave(Forest& forest, const Slave& slave, const std::string& group, std::string_view option,
                const std::string& keyword, std::vector<double>& coordinates, Patches& patches, CutZone& zone) {
  std::int32_t body = -1;
  FacetMatch match{};
  forest.leaves(slave.body, [&](std::int32_t leaf) {
    const auto found = match_facet(forest.type(leaf), forest.nodes(leaf), forest.type(slave.cell), forest.nodes(slave.cell));
    if (found) {
      body = leaf;
      match = *found;
    }
    return found.has_value();
  });
  if (body < 0) throw std::logic_error("a cut of " + cell_name(slave.body) + " has lost the facet of " + cell_name(slave.cell));

  const auto refuse = [&](const std::string& reason) {
    fail("CREALAC_1", {{"keyword", keyword},
                       {"group", group},
                       {"cell", cell_name(slave.cell)},
                       {"skin", std::string(catalog::cell(forest.type(slave.cell)).name)},
                       {"body_cell", cell_name(slave.body)},
                       {"body", std::string(catalog::cell(forest.type(body)).name)},
                       {"reason", reason}});
  };
  const catalog::CutRow* cut = catalog::find_cut(forest.type(slave.cell), forest.type(body), option);
  if (!cut) refuse("there is no cut for this pair");
  if (!match.outward) {
    forest.turn(slave.cell);
    ++zone.turned;
    match = match_facet(forest.type(body), forest.nodes(body), forest.type(slave.cell), forest.nodes(slave.cell)).value();
  }

  // the body cell turned so that its facet lies where the row expects it
  const auto placement = std::ranges::find(cut->placements, match.facet, &catalog::Placement::facet);
  if (placement == cut->placements.end()) refuse("the facet is of another type");
  const auto of_cell = forest.nodes(slave.cell);
  const Nodes skin(of_cell.begin(), of_cell.end());
  Nodes turned_body = pick(forest.nodes(body), placement->nodes);
  const auto n_vertices = cut->facet.size();
  const std::int32_t first = turned_body[static_cast<std::size_t>(cut->facet[0])];
  const auto start = static_cast<std::size_t>(
      std::find(skin.begin(), skin.begin() + static_cast<std::ptrdiff_t>(n_vertices), first) - skin.begin());
  const catalog::FacetRow& facet = catalog::cell(forest.type(body)).facets[static_cast<std::size_t>(match.facet)];
  Nodes of_facet = pick(forest.nodes(body), facet.nodes), of_skin = skin;
  std::ranges::sort(of_facet);
  std::ranges::sort(of_skin);
  if (of_facet != of_skin) refuse("they share their vertices, but not their mid nodes");

  const Nodes new_skin = add_nodes(cut->skin, skin, cut->skin_nodes, coordinates);
  const Nodes new_body = add_nodes(cut->body, turned_body, cut->body_nodes, coordinates);
  Nodes on_skin = skin;
  append(on_skin, new_skin);
  append(turned_body, pick(new_skin, cut->turned.subspan(start * new_skin.size(), new_skin.size())));
  append(turned_body, new_body);
  append(zone.skin_nodes, new_skin);
  append(zone.body_nodes, new_body);
  if (catalog::cell(cut->skin).dimension == 2 && catalog::cell(cut->skin).order == 2) {
    if (has_straight_edges(cut->skin, skin, coordinates) && is_plane(cut->skin, skin, coordinates))
      for (const catalog::SubCell& sub : cut->skin_cells) straighten(sub.type, pick(on_skin, sub.nodes), new_skin, coordinates);
    if (has_straight_edges(cut->body, forest.nodes(body), coordinates))
      for (const catalog::SubCell& sub : cut->body_cells)
        straighten(sub.type, pick(turned_body, sub.nodes), new_body, coordinates);
  }

  Nodes sub_cells;
  for (const catalog::SubCell& sub : cut->skin_cells)
    sub_cells.push_back(forest.add(sub.type, pick(on_skin, sub.nodes), slave.cell));
  for (const catalog::SubCell& sub : cut->body_cells) {
    const Nodes own = pick(turned_body, sub.nodes);
    if (!is_sound(jacobian_range(sub.type, own, coordinates)))
      fail("DECOUPE_6",
           {{"keyword", keyword},
            {"group", group},
            {"what", "a sub-cell of " + cell_name(slave.body) + ", cut under the slave cell " + cell_name(slave.cell) + ","},
            {"type", std::string(catalog::cell(sub.type).name)}});
    forest.add(sub.type, own, body);
  }
  patches.kind.push_back(cut->kind);
  patches.parent.push_back(slave.cell);
  patches.carriers.push_back(pick(on_skin, cut->carriers));
  ++zone.patches;
  return sub_cells;
}

}  // namespace

Mesh cut_lac(const Mesh& mesh, std::span<const std::string> groups, std::string_view option, std::string_view keyword,
             CutReport& report) {
  refuse_cut_mesh(mesh, keyword);
  const std::string path(keyword);
  const std::vector<Slave> slaves = find_slaves(mesh, groups, path);

  Mesh done;
  done.name = mesh.name;
  done.dimension = mesh.dimension;
  done.coordinates = mesh.coordinates;
  done.node_groups = mesh.node_groups;
  Patches& patches = done.patches.emplace();
  report = {};
  for (const std::string& group : groups) report.zones.push_back({group});

  Forest forest(mesh);
  Ragged<std::int32_t> sub_cells;  // of each patch, as numbers of the forest
  for (const Slave& slave : slaves) {
    report.zones[slave.zone].bodies.push_back(slave.body);
    sub_cells.push_back(
        cut_slave(forest, slave, groups[slave.zone], option, path, done.coordinates, patches, report.zones[slave.zone]));
  }

  // number what is left: sub-cells in place of the cell they come from, runs of other cells as they are
  std::vector<std::int32_t> number_of(forest.size(), -1);  // of a cell of the forest, in the cut mesh
  Ragged<std::int32_t> replaced_by;                        // cells of the cut mesh for each cell of the mesh
  replaced_by.offset.reserve(mesh.n_cells() + 1);
  replaced_by.values.reserve(forest.size());
  done.types.reserve(forest.size());
  done.cells.offset.reserve(forest.size() + 1);
  done.cells.values.reserve(mesh.cells.values.size() + 8 * (forest.size() - mesh.n_cells()));
  const auto keep = [&](std::size_t first, std::size_t end) {
    const auto start = static_cast<std::int32_t>(done.n_cells());
    const std::int64_t shift = done.cells.offset.back() - mesh.cells.offset[first];
    done.types.insert(done.types.end(), mesh.types.begin() + static_cast<std::ptrdiff_t>(first),
                      mesh.types.begin() + static_cast<std::ptrdiff_t>(end));
    done.cells.values.insert(done.cells.values.end(), mesh.cells.values.begin() + mesh.cells.offset[first],
                             mesh.cells.values.begin() + mesh.cells.offset[end]);
    for (std::size_t c = first; c < end; ++c) {
      done.cells.offset.push_back(mesh.cells.offset[c + 1] + shift);
      replaced_by.values.push_back(start + static_cast<std::int32_t>(c - first));
      replaced_by.offset.push_back(static_cast<std::int64_t>(replaced_by.values.size()));
    }
  };
  std::size_t kept = 0;
  for (const std::int32_t cell : forest.cut_cells()) {
    keep(kept, static_cast<std::size_t>(cell));
    kept = static_cast<std::size_t>(cell) + 1;
    Nodes heirs;
    forest.leaves(cell, [&](std::int32_t leaf) {
      const auto number = static_cast<std::int32_t>(done.n_cells());
      number_of[static_cast<std::size_t>(leaf)] = number;
      heirs.push_back(number);
      done.add_cell(forest.type(leaf), forest.nodes(leaf));
      return false;
    });
    replaced_by.push_back(heirs);
  }
  keep(kept, mesh.n_cells());
  done.cell_groups = inherited(mesh.cell_groups, replaced_by);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    Nodes own;
    for (const std::int32_t cell : sub_cells[p]) own.push_back(number_of[static_cast<std::size_t>(cell)]);
    patches.cells.push_back(own);
  }
  std::set<std::int32_t> bodies;
  for (CutZone& zone : report.zones) {
    std::ranges::sort(zone.bodies);
    const auto twice = std::ranges::unique(zone.bodies);
    zone.bodies.erase(twice.begin(), twice.end());
    bodies.insert(zone.bodies.begin(), zone.bodies.end());
    patches.zone_group.push_back(zone.group);
    patches.zone_offset.push_back(patches.zone_offset.back() + zone.patches);
  }
  for (const std::int32_t body : bodies) {
    const auto heirs = std::as_const(replaced_by)[static_cast<std::size_t>(body)];
    report.sub_cells.insert(report.sub_cells.end(), heirs.begin(), heirs.end());
  }
  report.new_nodes = static_cast<std::int64_t>(done.n_nodes() - mesh.n_nodes());
  report.new_cells = static_cast<std::int64_t>(done.n_cells() - mesh.n_cells());
  return done;
}

void complete_node_groups(const Mesh& before, const CutReport& report, Mesh& cut) {
  std::vector<char> inside;
  const auto holds = [&](std::span<const std::int32_t> cells) {
    const std::vector<std::int32_t> nodes = nodes_of_cells(before, cells);
    return std::ranges::all_of(nodes, [&](std::int32_t node) { return inside[static_cast<std::size_t>(node)] != 0; });
  };
  for (std::size_t g = 0; g < before.node_groups.size(); ++g) {
    inside.assign(before.n_nodes(), 0);
    for (const std::int32_t node : before.node_groups[g].members) inside[static_cast<std::size_t>(node)] = 1;
    for (const CutZone& zone : report.zones) {
      Nodes fresh;
      if (holds(before.find_cell_group(zone.group)->members)) append(fresh, zone.skin_nodes);
      if (!fresh.empty() && holds(zone.bodies)) append(fresh, zone.body_nodes);
      if (fresh.empty()) continue;
      append(cut.node_groups[g].members, fresh);
      inform("DECOUPE_8",
             {{"group", before.node_groups[g].name}, {"skin", zone.group}, {"count", std::to_string(fresh.size())}});
    }
  }
}

}  // namespace lacon
